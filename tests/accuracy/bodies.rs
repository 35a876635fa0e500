//! Bodies and actuators as files describe them: what is read, what is refused, and what errors of actuators do.

use crate::support::campaigns::{FUSELAGE, THRUSTERS, WHEEL1_AT_REST};
use crate::support::runs::{Run, adaptive, fixed, propagate};
use crate::support::scenes::{Kind, random};
use spindrift::campaign::{Overrides, Plan};
use spindrift::math::vector::{difference, norm};
use spindrift::propagation::Method;
use spindrift::run::{Grid, StateField};
use spindrift::sampling::SampleId;
use spindrift::scene::{
    ActuatorsInput, DebrisInput, MassErrors, PrincipalInertia, PrincipalMoments, Scene, WheelInput,
};

/// What a campaign says beyond the plainest spacecraft: keys of the tables of these names, and tables of its own.
#[derive(Clone, Copy, Default)]
struct Told<'a> {
    body: &'a str,
    wheel: &'a str,
    debris: &'a str,
    /// Of each thruster.
    thrusters: [&'a str; 3],
    rest: &'a str,
}

/// A campaign whose tables are filled in.
fn file(told: &Told<'_>) -> String {
    let Told { body, wheel, debris, thrusters: [p1, p2, p3], rest } = told;
    format!(
        "[campaign]\nname = \"bodies\"\nsamples = 4\nseed = 1\nduration_s = 1.0\n\
         [body]\n{body}\n{FUSELAGE}{WHEEL1_AT_REST}{wheel}\n{}{p1}\n{}{p2}\n{}{p3}\n\
         [debris]\n{debris}\n[initial]\nangular_velocity_rad_s = [0.1, 0.2, 1.0]\n{rest}\n",
        THRUSTERS[0], THRUSTERS[1], THRUSTERS[2]
    )
}

fn plan(told: Told<'_>) -> Result<Plan, String> {
    Plan::from_text("bodies.toml", &file(&told), Overrides::default()).map_err(|e| e.to_string())
}

const CUBE: &str = "side_m = 0.2\ndensity_kg_m3 = 2700.0";
const BURN: &str =
    "[[actuation]]\nstart_s = 0.25\nend_s = 0.5\nthrust_n = { p1 = 10, p2 = 20, p3 = 30 }\ntorque_n_m = { w1 = 1 }\n";
const ACTUATORS: &str = "[actuators]\nswitch_on_delay_s = 0.1\nswitch_off_delay_s = 0.2\n";

#[test]
fn every_key_is_read_and_reads_back() {
    let body = "principal_second_moments_kg_m2 = [100, 200, 300]\nprincipal_axes = [0.5, 0.5, -0.5, 0.5]\nmass_scale = 1.5\n\
        inertia_scale = 1.25\nstretch_log = [0.1, 0.2, 0.3]\nshear = [0.4, 0.5, 0.6]\ncenter_offset_m = [0.7, 0.8, 0.9]";
    let told = Told {
        body,
        wheel: "torque_scale = 2\ntorque_bias_n_m = 4\ntilt_rad = [0.07, 0.08]\nrate_rad_s = 9\nangle_rad = 10",
        debris: "mass_kg = 3\nprincipal_moments_kg_m2 = [3, 4, 5]",
        thrusters: [
            "tilt_rad = [0.01, 0.02]",
            "tilt_rad = [0.03, 0.04]\nthrust_scale = 0.5",
            "tilt_rad = [0.05, 0.06]\nthrust_scale = 2",
        ],
        rest: &format!("{BURN}{ACTUATORS}"),
    };
    let plan = plan(told).unwrap_or_else(|e| panic!("{e}"));
    let scene = &plan.nominal;
    let axes = [0.5, 0.5, -0.5, 0.5];
    let second = PrincipalMoments::Second([100.0, 200.0, 300.0]);
    assert_eq!(scene.body.principal, Some(PrincipalInertia { moments: second, axes }));
    let errors = MassErrors {
        mass_scale: 1.5,
        inertia_scale: 1.25,
        stretch_log: [0.1, 0.2, 0.3],
        shear: [0.4, 0.5, 0.6],
        center_offset_m: [0.7, 0.8, 0.9],
    };
    assert_eq!(scene.body.errors, errors);
    let moments = PrincipalMoments::Inertia([3.0, 4.0, 5.0]);
    let principal = PrincipalInertia { moments, axes: [1.0, 0.0, 0.0, 0.0] };
    assert_eq!(scene.debris, Some(DebrisInput::Principal { mass_kg: 3.0, principal }));
    let errors: Vec<_> = scene.thrusters.iter().map(|thruster| (thruster.tilt_rad, thruster.thrust_scale)).collect();
    assert_eq!(errors, [([0.01, 0.02], 1.0), ([0.03, 0.04], 0.5), ([0.05, 0.06], 2.0)]);
    let wheel = WheelInput {
        torque_scale: 2.0,
        torque_bias_n_m: 4.0,
        tilt_rad: [0.07, 0.08],
        rate_rad_s: 9.0,
        angle_rad: 10.0,
        ..WheelInput::named("w1", [0.0, 1.0, 0.0], [0.0, 0.0, 1.0])
    };
    assert_eq!(scene.wheels, [wheel]);
    assert_eq!(scene.actuators, ActuatorsInput { switch_on_delay_s: 0.1, switch_off_delay_s: 0.2 });
    let again = Plan::from_text("plan.toml", &plan.text(), Overrides::default()).unwrap_or_else(|e| panic!("{e}"));
    assert_eq!(again, plan);
}

#[test]
fn contradictions_are_refused_by_key_with_a_remedy() {
    let unit = "inertia_kg_m2 = [[3, 0, 0], [0, 3, 0], [0, 0, 2]]";
    let told = Told { debris: CUBE, ..Told::default() };
    let late = format!("{BURN}[actuators]\nswitch_off_delay_s = -0.25\n");
    let misspelt = format!("{BURN}[actuators]\nswitch_on_delay = 1\n");
    for (told, key, says) in [
        (
            Told { body: &format!("{unit}\nprincipal_moments_kg_m2 = [3, 3, 2]"), ..told },
            "body.inertia_kg_m2",
            "left out where principal_moments",
        ),
        (
            Told { body: "principal_moments_kg_m2 = [3, 3, 2]\nprincipal_second_moments_kg_m2 = [1, 1, 1]", ..told },
            "body.principal_second_moments_kg_m2",
            "left out where",
        ),
        (Told { body: "principal_axes = [1, 0, 0, 0]", ..told }, "body.principal_axes", "no principal moments"),
        (
            Told { body: "principal_moments_kg_m2 = [1, 1, 3]", ..told },
            "body.principal_moments_kg_m2",
            "cannot fail in this way",
        ),
        (Told { body: "mass_scale = 0", ..told }, "body.mass_scale", "above zero"),
        (Told { body: "stretch_log = [0, 0]", ..told }, "body.stretch_log", "3 finite numbers"),
        (Told { debris: "mass_kg = 3", ..told }, "debris.inertia_kg_m2", "given with mass_kg"),
        (
            Told { debris: &format!("mass_kg = 3\nside_m = 0.2\n{unit}"), ..told },
            "debris.side_m",
            "left out where the debris is given by mass",
        ),
        (Told { debris: unit, ..told }, "debris.mass_kg", "add mass_kg"),
        (
            Told { debris: "side_m = 0.2\nsize_m = [1, 1, 1]\ndensity_kg_m3 = 1", ..told },
            "debris.size_m",
            "left out where side_m is given",
        ),
        (Told { rest: ACTUATORS, ..told }, "actuators", "no [[actuation]]"),
        (
            Told { thrusters: ["thrust_scale = -1", "", ""], rest: BURN, ..told },
            "thrusters.p1.thrust_scale",
            "does not pull",
        ),
        (Told { rest: &late, ..told }, "actuators.switch_off_delay_s", "ends after it starts"),
        (
            Told { thrusters: ["", "thrust_scales = 1", ""], rest: BURN, ..told },
            "thrusters.p2.thrust_scales",
            "did you mean thrust_scale?",
        ),
        (Told { rest: &misspelt, ..told }, "actuators.switch_on_delay", "did you mean switch_on_delay_s?"),
    ] {
        let message = plan(told).map(|_| ()).expect_err(key);
        assert!(message.contains(&format!(" {key}")) && message.contains(says), "{key}: {message}");
    }
}

/// What a draw makes impossible is an invalid sample with its reason, and nothing is drawn again.
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
        let plan = plan(Told { debris: CUBE, rest: &format!("{BURN}{dispersed}"), ..Told::default() })
            .unwrap_or_else(|e| panic!("{e}"));
        let (mut sampler, mut input) = (plan.dispersions.sampler(), plan.nominal.clone());
        let mut applied = vec![0.0; plan.dispersions.columns().len()];
        const COUNT: u64 = 2000;
        let mut refused = 0;
        for sample in 1..=COUNT {
            sampler.draw(SampleId(sample), &mut input, &mut applied);
            if let Err(errors) = Scene::resolve(&input) {
                assert!(keys.contains(&errors[0].key.to_string()), "{}", errors[0].key);
                refused += 1;
            }
        }
        // 3.29 standard errors of a share of 2000 draws: two-sided alpha = 1e-3 for each of the two; the seed is fixed
        let sigma = (share * (1.0 - share) / COUNT as f64).sqrt();
        let found = f64::from(refused) / COUNT as f64;
        assert!((found - share).abs() < 3.29 * sigma, "{keys:?}: {found} {share}");
    }
}

/// Law: a debris turns as the same body described in its principal frame, whichever products of inertia its tensor has, with equal moments on
/// the diagonal too; for every method.
#[test]
fn a_debris_turns_as_in_its_principal_frame() {
    let grid = Grid::uniform(4.0, 9);
    let rate = [0.7, -0.4, 1.1];
    let motion = |method: Method, tensor: [[f64; 3]; 3], rate: [f64; 3]| {
        let kind = Kind { wheels: [true; 2], debris: 1, products: false, offset: false, forced: false };
        let mut input = random(kind, 23, 4.0);
        input.debris = Some(DebrisInput::Tensor { mass_kg: 20.0, inertia_kg_m2: tensor });
        let mut scene = Scene::resolve(&input).expect("a physical scene");
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
        // a frame of the other hand changes the sign of a rate, which is a pseudovector
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

/// A thruster that fails, and one that works again, are in the same campaign: what is integrated follows from the commands.
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
    let scene = |input| Scene::resolve(input).expect("a physical scene");
    // the first scene says what is integrated: that nothing works in it must not matter to the others
    let scenes = [scene(&off), scene(&errors), scene(&scaled)];
    let runs: Vec<Run> = propagate(Method::Taylor, adaptive(1e-16), &Grid::uniform(1.0, 9), &scenes);
    assert_eq!(runs[1].bits(), runs[2].bits(), "factors of two leave no rounding");
    let impulse = |run: &Run| norm(run.table.at::<3>(StateField::Impulse, 8));
    assert_eq!(impulse(&runs[0]), 0.0);
    // that the thrusters of the others do work; measured: 6.7 N s
    assert!(impulse(&runs[1]) > 1.0);
}

/// Law: delays of all switches by the same time are a later burn, and in free motion before it nothing else.
#[test]
fn a_delay_moves_the_burn() {
    let kind = Kind { wheels: [true; 2], debris: 0, products: true, offset: true, forced: true };
    let mut late = random(kind, 22, 1.0);
    for interval in &mut late.actuation {
        (interval.start_s, interval.end_s) = (interval.start_s + 0.0625, interval.end_s + 0.0625);
    }
    let mut delayed = random(kind, 22, 1.0);
    delayed.actuators.switch_on_delay_s = 0.0625;
    delayed.actuators.switch_off_delay_s = 0.0625;
    let run = |input| {
        let scene = Scene::resolve(input).expect("a physical scene");
        propagate(Method::Taylor, adaptive(1e-16), &Grid::uniform(1.0, 9), &[scene]).remove(0)
    };
    let (late, delayed, nominal) = (run(&late), run(&delayed), run(&random(kind, 22, 1.0)));
    assert_eq!(late.bits(), delayed.bits());
    let off = difference(late.table.at::<3>(StateField::Impulse, 8), nominal.table.at::<3>(StateField::Impulse, 8));
    // measured: 13.6 N s
    assert!(norm(off) > 1e-3, "a burn that is late turns with the body: {}", norm(off));
}
