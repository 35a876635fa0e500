//! [`capacity()`]: the capacity of a loop in its nominal scene.

use super::allocation::{ThrustAllocation, WheelTorque};
use crate::loops::capacity::{Capacity, NOTHING};
use crate::loops::spec::LoopSpec;
use crate::loops::vector::{difference, dot, norm, product, scaled, sum};
use crate::math::symmetric::principal_axes;
use crate::scene::Scene;

/// Capacity of the loop `spec` in the nominal scene `scene`, as flight software believes it.
pub fn capacity(spec: &LoopSpec, scene: &Scene) -> Capacity {
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
    let (two_sided, unloading) = (thrusters.two_sided_torques(false), thrusters.two_sided_torques(spec.holds_force));
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

/// The principal axes of `matrix` with moments that `is_meant` accepts; those of F_s if all are.
fn axes(matrix: [[f64; 3]; 3], is_meant: impl Fn(f64) -> bool) -> Vec<[f64; 3]> {
    let (moments, c_sb) = principal_axes(matrix);
    let found: Vec<[f64; 3]> = (0..3).filter(|i| is_meant(moments[*i])).map(|i| c_sb.map(|row| row[i])).collect();
    if found.len() == 3 { vec![[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]] } else { found }
}

#[cfg(test)]
mod tests {
    use crate::campaign::Plan;
    use crate::control::tables::Overrides;
    use crate::loops::capacity::Capacity;
    use crate::scene::Scene;

    fn capacity(changes: &[(&str, &str)]) -> (Capacity, Vec<String>) {
        let mut text = include_str!("../../../../campaigns/detumble.toml").to_owned();
        for (from, to) in changes {
            assert!(text.contains(from), "{from}");
            text = text.replace(from, to);
        }
        let plan = Plan::from_text("d.toml", &text, Overrides::default()).unwrap_or_else(|error| panic!("{error}"));
        let spec = plan.loop_spec().expect("a loop").clone();
        let found = super::capacity(&spec, &Scene::resolve(&plan.nominal).expect("physical"));
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
