//! [`Capacity`]: whether the momentum of the nominal scene fits into the wheels of a loop, and about which axes its thrusters can take it out again.

use super::allocation::{ThrustAllocation, WheelTorque};
use super::spec::LoopSpec;
use crate::control::vector::{difference, norm, product, scaled, sum};
use crate::scene::Scene;

/// What a loop can do about the angular momentum of the nominal scene about its centre of mass.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Capacity {
    /// The part of the momentum within the span of the wheels' axes, N m s.
    pub within_reach: f64,
    /// The most that the wheels can take in its direction within their limits of speed, shared by least norm, N m s; infinite without limits.
    pub wheels: f64,
    /// The part across the axes of the wheels, N m s: thrusters alone can take it.
    pub across: f64,
    /// Number of axes about which the thrusters have torque in both directions.
    pub unloaded_axes: usize,
}

impl Capacity {
    /// Of the loop `spec` in the nominal scene `scene`.
    pub fn of(spec: &LoopSpec, scene: &Scene) -> Self {
        let (mass, initial) = (&scene.mass, &scene.initial);
        let mut momentum = product(mass.inertia, initial.omega_se_s);
        for (wheel, rate) in mass.wheels.iter().zip(initial.wheel_rates) {
            momentum = sum(momentum, scaled(wheel.axial * rate, wheel.axis));
        }
        let axes: Vec<[f64; 3]> = spec.wheels.iter().map(|place| mass.wheels[*place].axis).collect();
        let wheels = WheelTorque::new(&axes);
        let reached = product(wheels.reachable, momentum);
        let shares = wheels.motors(reached);
        let most = |(share, place): (f64, &usize)| {
            mass.wheels[*place].axial * scene.actuators.wheels[*place].speed_limit / share.abs()
        };
        // a share of zero limits nothing
        let limits = shares.into_iter().zip(&spec.wheels).filter(|(share, _)| *share != 0.0).map(most);
        let within_reach = norm(reached);
        let two_sided = if spec.thrusters.is_empty() {
            [[0.0; 3]; 3]
        } else {
            ThrustAllocation::of_loop(scene, &spec.thrusters).two_sided_torques()
        };
        let trace: f64 = (0..3).map(|i| two_sided[i][i]).sum();
        Capacity {
            within_reach,
            wheels: limits.fold(f64::INFINITY, f64::min) * within_reach.max(f64::MIN_POSITIVE),
            across: norm(difference(momentum, reached)),
            unloaded_axes: trace.round() as usize,
        }
    }

    /// What a person should know of it; nothing where all of it fits and can be unloaded.
    pub fn notes(&self, spec: &LoopSpec) -> Vec<String> {
        let mut notes = Vec::new();
        if self.within_reach > self.wheels {
            notes.push(format!(
                "the wheels of the loop can take {:.3} N m s of the nominal momentum of {:.3} N m s along their axes: they saturate when the body is stopped",
                self.wheels, self.within_reach
            ));
        }
        // rounding of the projection
        if self.across > 1e-9 * (self.within_reach + self.across) && self.unloaded_axes == 0 {
            notes.push(format!(
                "{:.3} N m s of the nominal momentum are across the axes of the loop's wheels, and no thrusters turn the body: the loop cannot stop it",
                self.across
            ));
        }
        if !spec.wheels.is_empty() && !spec.thrusters.is_empty() && self.unloaded_axes < 3 {
            let axes = ["no axis", "one axis", "two axes"][self.unloaded_axes];
            notes.push(format!(
                "the thrusters of the loop have torque in both directions about {axes} alone: momentum of the wheels about the others cannot be unloaded without a turn"
            ));
        }
        if spec.knows_the_truth() && !spec.sensors.is_empty() {
            notes.push("estimator = \"perfect\" reads no sensor: [[sensors]] has no effect on the runs".to_owned());
        }
        notes
    }
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
        let spec = plan.law.as_ref().and_then(|law| law.spec()).expect("a loop").clone();
        let found = Capacity::of(&spec, &Scene::resolve(&plan.nominal).expect("physical"));
        let notes = found.notes(&spec);
        (found, notes)
    }

    /// Law: the momentum of Berdoz's spacecraft along s2, s3 is within the wheels' limits where J Omega says so; that along s1 is for P2 and P3, about s1 alone.
    #[test]
    fn momenta_fit_or_not() {
        let (found, notes) = capacity(&[]);
        let [x, y, z] = [0.5, 0.8, -1.0].map(|rate: f64| rate.to_radians());
        let expected = (3_055.375_141_124_116 * y).hypot(1_687.280_032_907_598_8 * z);
        assert!((found.within_reach / expected - 1.0).abs() < 1e-12);
        assert!((found.across / (3_054.590_970_145_349 * x) - 1.0).abs() < 1e-12);
        // w1 is the first at its limit: it has the larger share
        let most = 1.656_699_250_916_492_6 * 40.0 * core::f64::consts::PI * expected / (3_055.375_141_124_116 * y);
        assert!((found.wheels / most - 1.0).abs() < 1e-12);
        assert_eq!((found.unloaded_axes, notes.len()), (1, 1), "{notes:?}");
        let (_, fast) = capacity(&[("\"0.8 deg/s\"", "\"40 deg/s\"")]);
        assert!(fast.len() == 2 && fast[0].contains("saturate"), "{fast:?}");
        let (_, alone) = capacity(&[
            ("thrusters = [\"p1\", \"p2\", \"p3\"]\nmodulation = \"pulse_width\"\nisp_s = 220.0\n", ""),
            ("\n[[require]]\nobservable = \"propellant_kg\"\nquantile = 0.95\nat_most = 0.2\n", ""),
        ]);
        assert!(alone.len() == 1 && alone[0].contains("cannot stop it"), "{alone:?}");
    }
}
