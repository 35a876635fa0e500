//! [`Capacity`]: the axes about which a loop has torque in both directions, and the nominal momentum that its wheels
//! can store and its thrusters unload.

use super::allocation::{ThrustAllocation, WheelTorque};
use super::observes::Observes;
use super::sensor_spec::SensorSpec;
use super::spec::LoopSpec;
use super::vector::{difference, dot, norm, product, scaled, sum};
use crate::math::symmetric::principal_axes;
use crate::scene::Scene;

/// Threshold of a torque in the sum of two projections: above rounding, 1e-16, and below the square of any real
/// alignment, 1e-12.
const NOTHING: f64 = 1e-13;

/// Torque of a loop, and the nominal angular momentum about the centre of mass that it can take. Axes are unit vectors
/// in F_s.
#[derive(Clone, Debug, PartialEq)]
pub struct Capacity {
    /// Momentum within the span of the wheels' axes, N m s.
    pub within_reach: f64,
    /// Most momentum in its direction that the wheels can store within their speed limits, shared by least norm, N m s.
    pub wheels: f64,
    /// Momentum about axes without torque in both directions, N m s.
    pub out_of_reach: f64,
    /// Axes that span the torques of the wheels.
    pub wheel_axes: Vec<[f64; 3]>,
    /// Axes that span the two-sided torques of the thrusters, with the total thrust and the net force for 1 N m, N.
    pub thruster_axes: Vec<([f64; 3], [f64; 2])>,
    /// Number of axes about which they can unload the wheels; without a net force if the force is held.
    pub unloaded_axes: usize,
    /// Axes without two-sided torque of wheels or thrusters.
    pub free_axes: Vec<[f64; 3]>,
}

impl Capacity {
    /// Capacity of the loop `spec` in the nominal scene `scene`, as flight software believes it.
    pub fn of(spec: &LoopSpec, scene: &Scene) -> Self {
        let (mass, initial) = (&scene.mass, &scene.initial);
        let mut momentum = product(mass.inertia, initial.omega_se_s);
        for (wheel, rate) in mass.wheels.iter().zip(initial.wheel_rates) {
            momentum = sum(momentum, scaled(wheel.axial * rate, wheel.axis));
        }
        let wheels = WheelTorque::of_loop(scene, &spec.wheels);
        let reached = product(wheels.reachable, momentum);
        let shares = wheels.motors(reached);
        let most = |(share, place): (f64, &usize)| {
            mass.wheels[*place].axial * scene.actuators.wheels[*place].speed_limit / share.abs()
        };
        // a zero share sets no limit
        let limits = shares.into_iter().zip(&spec.wheels).filter(|(share, _)| *share != 0.0).map(most);
        let within_reach = norm(reached);
        let thrusters = ThrustAllocation::of_loop(&spec.believed(scene), &spec.thrusters, wheels.reachable);
        let (two_sided, unloading) =
            (thrusters.two_sided_torques(false), thrusters.two_sided_torques(spec.holds_force));
        let both = std::array::from_fn(|i| sum(wheels.reachable[i], two_sided[i]));
        let free_axes: Vec<[f64; 3]> = axes(both, |moment| moment <= NOTHING);
        let out_of_reach = free_axes.iter().map(|axis| dot(*axis, momentum).powi(2)).sum::<f64>().sqrt();
        let with_cost = |axis: [f64; 3]| {
            // without a net force wherever possible
            let holds_force = spec.holds_force && norm(difference(product(unloading, axis), axis)) < 1e-6;
            (axis, thrusters.cost(axis, holds_force))
        };
        Capacity {
            within_reach,
            wheels: limits.fold(f64::INFINITY, f64::min) * within_reach.max(f64::MIN_POSITIVE),
            out_of_reach,
            wheel_axes: axes(wheels.reachable, |moment| moment > 0.5),
            thruster_axes: axes(two_sided, |moment| moment > 0.5).into_iter().map(with_cost).collect(),
            unloaded_axes: (0..3).map(|i| unloading[i][i]).sum::<f64>().round() as usize,
            free_axes,
        }
    }

    pub fn lines(&self, spec: &LoopSpec) -> Vec<String> {
        let mut lines = Vec::new();
        if !spec.wheels.is_empty() {
            lines.push(format!("wheels: torque about {}", names(&self.wheel_axes)));
        }
        for (axis, [total, force]) in &self.thruster_axes {
            let with = if *force > NOTHING * total {
                format!("and a net force of {force:.4} N")
            } else {
                "without a net force".to_owned()
            };
            let name = names(&[*axis]);
            lines.push(format!(
                "thrusters: torque in both directions about {name}; 1 N m takes {total:.4} N of thrust, {with}"
            ));
        }
        if !spec.thrusters.is_empty() && self.thruster_axes.is_empty() {
            lines.push("thrusters: torque in both directions about no axis".to_owned());
        }
        if !spec.rods.is_empty() {
            lines.push("torque rods: torque across the magnetic field".to_owned());
        } else if !self.free_axes.is_empty() {
            let free = names(&self.free_axes);
            lines.push(format!("neither wheels nor thrusters have torque in both directions about {free}"));
        }
        lines
    }

    /// Warnings; none if the momentum fits and can be unloaded.
    pub fn notes(&self, spec: &LoopSpec) -> Vec<String> {
        let mut notes = Vec::new();
        if self.within_reach > self.wheels {
            notes.push(format!(
                "the wheels of the loop can take {:.3} N m s of the nominal momentum of {:.3} N m s along their axes: \
                they saturate when the body is stopped",
                self.wheels, self.within_reach
            ));
        }
        if !self.free_axes.is_empty() && spec.phases.iter().any(|phase| phase.law.is_some()) {
            notes.push(format!(
                "neither wheels nor thrusters of the loop have torque in both directions about {}: the loop cannot \
                control the attitude about it; add wheels or thrusters",
                names(&self.free_axes)
            ));
        }
        // rounding of the projections
        if spec.rods.is_empty() && self.out_of_reach > 1e-9 * (self.within_reach + self.out_of_reach) {
            notes.push(format!(
                "{:.3} N m s of the nominal momentum are about {}: the loop cannot stop it",
                self.out_of_reach,
                names(&self.free_axes)
            ));
        }
        if !spec.wheels.is_empty() && !spec.thrusters.is_empty() && self.unloaded_axes < 3 {
            let axes = ["no axis", "one axis", "two axes"][self.unloaded_axes];
            let held = if spec.holds_force { " without a net force" } else { "" };
            notes.push(format!(
                "the thrusters of the loop have torque in both directions{held} about {axes} alone: momentum of the \
                wheels about the others cannot be unloaded without a turn"
            ));
        }
        let is_read = |sensor: &SensorSpec| matches!(sensor.observes(), Observes::Field(_)) && !spec.rods.is_empty();
        if spec.knows_the_truth() && !spec.sensors.iter().all(is_read) {
            notes.push("estimator = \"perfect\" reads no sensor: [[sensors]] has no effect on the runs".to_owned());
        }
        notes
    }
}

/// The principal axes of `matrix` with moments that `is_meant` accepts; those of F_s if all are.
fn axes(matrix: [[f64; 3]; 3], is_meant: impl Fn(f64) -> bool) -> Vec<[f64; 3]> {
    let (moments, c_sb) = principal_axes(matrix);
    let found: Vec<[f64; 3]> = (0..3).filter(|i| is_meant(moments[*i])).map(|i| c_sb.map(|row| row[i])).collect();
    if found.len() == 3 { vec![[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]] } else { found }
}

/// Names of `axes` in F_s, or their components.
fn names(axes: &[[f64; 3]]) -> String {
    let name = |axis: &[f64; 3]| {
        let place = (0..3).find(|i| {
            let unit: [f64; 3] = std::array::from_fn(|j| if *i == j { axis[j].signum() } else { 0.0 });
            norm(difference(*axis, unit)) < 1e-6
        });
        let [x, y, z] = axis;
        place.map_or_else(|| format!("({x:.4}, {y:.4}, {z:.4})"), |i| format!("s{}", i + 1))
    };
    if axes.is_empty() { "no axis".to_owned() } else { axes.iter().map(name).collect::<Vec<_>>().join(", ") }
}

#[cfg(test)]
mod tests {
    use crate::campaign::{Overrides, Plan};
    use crate::control::capacity::Capacity;
    use crate::scene::Scene;

    fn capacity(changes: &[(&str, &str)]) -> (Capacity, Vec<String>) {
        let mut text = include_str!("../../campaigns/detumble.toml").to_owned();
        for (from, to) in changes {
            assert!(text.contains(from), "{from}");
            text = text.replace(from, to);
        }
        let plan = Plan::from_text("d.toml", &text, Overrides::default()).unwrap_or_else(|error| panic!("{error}"));
        let spec = plan.loop_spec().expect("a loop").clone();
        let found = Capacity::of(&spec, &Scene::resolve(&plan.nominal).expect("physical"));
        let notes = found.notes(&spec);
        (found, notes)
    }

    /// Law: the momentum of Berdoz's spacecraft along s2, s3 fits into the wheels up to J Omega; along s1 only P2 and
    /// P3 take it.
    #[test]
    fn momenta_fit_or_not() {
        let (found, notes) = capacity(&[]);
        let [x, y, z] = [0.5, 0.8, -1.0].map(|rate: f64| rate.to_radians());
        let expected = (3_055.375_141_124_116 * y).hypot(1_687.280_032_907_598_8 * z);
        assert!((found.within_reach / expected - 1.0).abs() < 1e-12);
        assert_eq!(found.out_of_reach, 0.0, "{x}");
        // w1 has the larger share and saturates first
        let most = 1.656_699_250_916_492_6 * 40.0 * core::f64::consts::PI * expected / (3_055.375_141_124_116 * y);
        assert!((found.wheels / most - 1.0).abs() < 1e-12);
        assert_eq!((found.thruster_axes.len(), notes.len()), (1, 1), "{notes:?}");
        let (_, fast) = capacity(&[("\"0.8 deg/s\"", "\"40 deg/s\"")]);
        assert!(fast.len() == 2 && fast[0].contains("saturate"), "{fast:?}");
        let (found, alone) = capacity(&[
            ("thrusters = [\"p1\", \"p2\", \"p3\"]\nmodulation = \"pulse_width\"\nisp_s = 220.0\n", ""),
            ("\n[[require]]\nobservable = \"propellant_kg\"\nquantile = 0.95\nat_most = 0.2\n", ""),
        ]);
        assert!((found.out_of_reach / (3_054.590_970_145_349 * x) - 1.0).abs() < 1e-12);
        let says = ["in both directions about s1: the loop cannot control", "about s1: the loop cannot stop it"];
        assert!(alone.len() == 2 && alone.iter().zip(says).all(|(note, says)| note.contains(says)), "{alone:?}");
    }
}
