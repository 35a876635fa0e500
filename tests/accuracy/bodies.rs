//! Bodies and actuators of files: refused draws, tensors, and errors of actuators.

use crate::support::{campaigns::THRUSTERS, prelude::*};

fn plan(debris: &str, rest: &str) -> Result<Plan, String> {
    let text = format!(
        "[campaign]\nname = \"bodies\"\nsamples = 4\nseed = 1\nduration_s = 1.0\n{FUSELAGE}{WHEEL1_AT_REST}{}\
         [debris]\n{debris}\n[initial]\nangular_velocity_rad_s = [0.1, 0.2, 1.0]\n{rest}\n",
        THRUSTERS.concat()
    );
    parsed(&text).map_err(|e| e.to_string())
}

#[test]
fn draws_that_pull_or_turn_inside_out_are_invalid() {
    let disperse = |key: &str, std: f64| {
        format!("[[disperse]]\nparameter = \"{key}\"\ndistribution = \"normal\"\nstd = {std:?}\n")
    };
    let thrust_scales = ["p1", "p2", "p3"].map(|name| format!("thrusters.{name}.thrust_scale"));
    // P(1 + z < 0) for any of three: 1 - 0.8413^3 = 0.404; P(0.25 + 0.25 z < 0): 0.159
    for (keys, std, share) in
        [(&thrust_scales[..], 1.0, 0.404), (&["actuators.switch_off_delay_s".to_owned()][..], 0.25, 0.159)]
    {
        let dispersed: String = keys.iter().map(|key| disperse(key, std)).collect();
        let burn = "[[actuation]]\nstart_s = 0.25\nend_s = 0.5\nthrust_n = { p1 = 10, p2 = 20, p3 = 30 }\n";
        let plan = plan("side_m = 0.2\ndensity_kg_m3 = 2700.0", &format!("{burn}{dispersed}"));
        let plan = plan.unwrap();
        const COUNT: u64 = 2000;
        let refused = draws::seen(&plan, 1..=COUNT, |input, _| Scene::resolve(input).err());
        let refused: Vec<_> = refused.into_iter().flatten().collect();
        assert!(refused.iter().all(|errors| keys.contains(&errors[0].key.to_string())), "{:?}", refused[0]);
        let sigma = (share * (1.0 - share) / COUNT as f64).sqrt();
        let found = refused.len() as f64 / COUNT as f64;
        assert!((found - share).abs() < 3.29 * sigma, "{keys:?}: {found} {share}");
    }
}

/// Law: a debris turns as in its principal frame, whatever its products of inertia.
#[test]
fn a_debris_turns_as_in_its_principal_frame() {
    let grid = Grid::uniform(4.0, 9);
    let rate = [0.7, -0.4, 1.1];
    let motion = |method: Method, tensor: [[f64; 3]; 3], rate: [f64; 3]| {
        let kind = Kind { wheels: [true; 2], debris: 1, products: false, offset: false, forced: false };
        let mut input = random(kind, 23, 4.0);
        input.debris = Some(DebrisInput::Tensor { mass_kg: 20.0, inertia_kg_m2: tensor });
        let mut scene = resolved(&input);
        scene.initial.omega_de_d = rate;
        let control = if method.has_fixed_step() { fixed(1e-3) } else { adaptive(1e-12) };
        propagate(method, control, &grid, &[scene]).remove(0)
    };
    for [xy, xz, yz] in [[0.5, 0.0, 0.0], [0.0, 0.5, 0.0], [0.0, 0.0, 0.5], [0.5, 0.5, 0.5], [0.3, -0.2, 0.4]] {
        let tensor = [[4.0, xy, xz], [xy, 4.0, yz], [xz, yz, 4.0]];
        let axes = nalgebra::Matrix3::from_fn(|i, j| tensor[i][j]).symmetric_eigen();
        let turned = axes.eigenvectors;
        let [a, b, c] = [0, 1, 2].map(|i| axes.eigenvalues[i]);
        let principal = [[a, 0.0, 0.0], [0.0, b, 0.0], [0.0, 0.0, c]];
        let hand = turned.determinant();
        let into = hand * turned.transpose() * nalgebra::Vector3::from(rate);
        for method in Method::ALL {
            let (own, other) = (motion(method, tensor, rate), motion(method, principal, into.into()));
            let mut changed = 0.0_f64;
            for point in 0..grid.points() {
                let found = own.table.at::<3>(StateField::DebrisRate, point);
                let expected = other.table.at::<3>(StateField::DebrisRate, point);
                let expected: [f64; 3] = (hand * turned * nalgebra::Vector3::from(expected)).into();
                assert!(norm(difference(found, expected)) < 1e-9, "{}: {found:?} {expected:?}", method.name());
                changed = changed.max(norm(difference(found, rate)));
            }
            assert!(changed > 0.01, "{}: an axis that is not principal does not stay: {changed}", method.name());
        }
    }
}

#[test]
fn a_scaled_actuator_is_a_scaled_command() {
    let kind = Kind { wheels: [true; 2], debris: 0, products: true, offset: true, forced: true };
    let mut scaled = random(kind, 21, 1.0);
    for interval in &mut scaled.actuation {
        interval.thrust_n[0] *= 2.0;
        interval.thrust_n[2] = 0.0;
        interval.torque_n_m[1] *= 0.5;
    }
    let mut errors = random(kind, 21, 1.0);
    errors.thrusters[0].thrust_scale = 2.0;
    errors.thrusters[2].thrust_scale = 0.0;
    errors.wheels[1].torque_scale = 0.5;
    let mut off = errors.clone();
    off.thrusters.iter_mut().for_each(|thruster| thruster.thrust_scale = 0.0);
    off.wheels.iter_mut().for_each(|wheel| wheel.torque_scale = 0.0);
    let scene = |input| resolved(input);
    let scenes = [scene(&off), scene(&errors), scene(&scaled)];
    let runs: Vec<Run> = propagate(Method::Taylor, adaptive(1e-16), &Grid::uniform(1.0, 9), &scenes);
    assert_eq!(runs[1].bits(), runs[2].bits(), "factors of two leave no rounding");
    let impulse = |run: &Run| norm(run.table.at::<3>(StateField::Impulse, 8));
    assert_eq!(impulse(&runs[0]), 0.0);
    assert!(impulse(&runs[1]) > 1.0);
}
