//! Bodies and actuators as files describe them: what is read, what is refused, and what errors of actuators do.

use crate::support::runs::{Run, adaptive, propagate};
use crate::support::scenes::{Kind, random};
use spindrift::campaign::{Overrides, Plan};
use spindrift::math::vector::{difference, norm};
use spindrift::propagation::Method;
use spindrift::run::{Grid, StateField};
use spindrift::sampling::SampleId;
use spindrift::scene::{ActuatorsInput, DebrisInput, MassErrors, PrincipalInertia, PrincipalMoments, Scene};

/// A campaign whose tables `fuselage`, `debris` and `rest` are filled in.
fn file(fuselage: &str, debris: &str, rest: &str) -> String {
    format!(
        "[campaign]\nname = \"bodies\"\nsamples = 4\nseed = 1\nduration_s = 1.0\n[fuselage]\nwall_thickness_m = 0.03\n\
         outer_radius_m = 1.0\nlength_m = 3.0\ndensity_kg_m3 = 2700.0\nthruster_offset_m = 0.5\n{fuselage}\n[wheel1]\n\
         radius_m = 0.25\nlength_m = 0.1\nstation_m = 1.0\ndensity_kg_m3 = 2700.0\n[debris]\n{debris}\n[initial]\n\
         angular_velocity_rad_s = [0.1, 0.2, 1.0]\n{rest}"
    )
}

fn plan(fuselage: &str, debris: &str, rest: &str) -> Result<Plan, String> {
    Plan::from_text("bodies.toml", &file(fuselage, debris, rest), Overrides::default()).map_err(|e| e.to_string())
}

const CUBE: &str = "side_m = 0.2\ndensity_kg_m3 = 2700.0";
const BURN: &str = "[[actuation]]\nstart_s = 0.25\nend_s = 0.5\nthrust_n = [10, 20, 30]\ntorque_n_m = [1, 0]\n";
const ACTUATORS: &str = "[actuators]\nthrust_scale = [1, 0.5, 2]\nthruster1_tilt_rad = [0.01, 0.02]\nthruster2_tilt_rad = [0.03, 0.04]\n\
    thruster3_tilt_rad = [0.05, 0.06]\nswitch_on_delay_s = 0.1\nswitch_off_delay_s = 0.2\ntorque_scale = [2, 3]\n\
    torque_bias_n_m = [4, 5]\n";

#[test]
fn every_key_is_read_and_reads_back() {
    let fuselage = "principal_second_moments_kg_m2 = [100, 200, 300]\nprincipal_axes = [0.5, 0.5, -0.5, 0.5]\nmass_scale = 1.5\n\
        inertia_scale = 1.25\nstretch_log = [0.1, 0.2, 0.3]\nshear = [0.4, 0.5, 0.6]\ncenter_offset_m = [0.7, 0.8, 0.9]";
    let debris = "mass_kg = 3\nprincipal_moments_kg_m2 = [3, 4, 5]";
    let plan = plan(fuselage, debris, &format!("{BURN}{ACTUATORS}")).unwrap_or_else(|e| panic!("{e}"));
    let scene = &plan.nominal;
    let axes = [0.5, 0.5, -0.5, 0.5];
    let second = PrincipalMoments::Second([100.0, 200.0, 300.0]);
    assert_eq!(scene.fuselage.principal, Some(PrincipalInertia { moments: second, axes }));
    let errors = MassErrors {
        mass_scale: 1.5,
        inertia_scale: 1.25,
        stretch_log: [0.1, 0.2, 0.3],
        shear: [0.4, 0.5, 0.6],
        center_offset_m: [0.7, 0.8, 0.9],
    };
    assert_eq!(scene.fuselage.errors, errors);
    let moments = PrincipalMoments::Inertia([3.0, 4.0, 5.0]);
    let principal = PrincipalInertia { moments, axes: [1.0, 0.0, 0.0, 0.0] };
    assert_eq!(scene.debris, Some(DebrisInput::Principal { mass_kg: 3.0, principal }));
    let actuators = ActuatorsInput {
        thrust_scale: [1.0, 0.5, 2.0],
        thruster1_tilt_rad: [0.01, 0.02],
        thruster2_tilt_rad: [0.03, 0.04],
        thruster3_tilt_rad: [0.05, 0.06],
        switch_on_delay_s: 0.1,
        switch_off_delay_s: 0.2,
        torque_scale: [2.0, 3.0],
        torque_bias_n_m: [4.0, 5.0],
    };
    assert_eq!(scene.actuators, actuators);
    let again = Plan::from_text("plan.toml", &plan.text(), Overrides::default()).unwrap_or_else(|e| panic!("{e}"));
    assert_eq!(again, plan);
}

#[test]
fn contradictions_are_refused_by_key_with_a_remedy() {
    let unit = "inertia_kg_m2 = [[3, 0, 0], [0, 3, 0], [0, 0, 2]]";
    for (fuselage, debris, rest, key, says) in [
        (
            &*format!("{unit}\nprincipal_moments_kg_m2 = [3, 3, 2]"),
            CUBE,
            "",
            "fuselage.inertia_kg_m2",
            "left out where principal_moments",
        ),
        (
            "principal_moments_kg_m2 = [3, 3, 2]\nprincipal_second_moments_kg_m2 = [1, 1, 1]",
            CUBE,
            "",
            "fuselage.principal_second_moments_kg_m2",
            "left out where",
        ),
        ("principal_axes = [1, 0, 0, 0]", CUBE, "", "fuselage.principal_axes", "no principal moments"),
        (
            "principal_moments_kg_m2 = [1, 1, 3]",
            CUBE,
            "",
            "fuselage.principal_moments_kg_m2",
            "cannot fail in this way",
        ),
        ("mass_scale = 0", CUBE, "", "fuselage.mass_scale", "above zero"),
        ("stretch_log = [0, 0]", CUBE, "", "fuselage.stretch_log", "3 finite numbers"),
        ("", "mass_kg = 3", "", "debris.inertia_kg_m2", "given with mass_kg"),
        (
            "",
            &*format!("mass_kg = 3\nside_m = 0.2\n{unit}"),
            "",
            "debris.side_m",
            "left out where the debris is given by mass",
        ),
        ("", unit, "", "debris.mass_kg", "add mass_kg"),
        (
            "",
            "side_m = 0.2\nsize_m = [1, 1, 1]\ndensity_kg_m3 = 1",
            "",
            "debris.size_m",
            "left out where side_m is given",
        ),
        ("", CUBE, ACTUATORS, "actuators", "no [[actuation]]"),
        (
            "",
            CUBE,
            &*format!("{BURN}[actuators]\nthrust_scale = [-1, 1, 1]\n"),
            "actuators.thrust_scale",
            "does not pull",
        ),
        (
            "",
            CUBE,
            &*format!("{BURN}[actuators]\nswitch_off_delay_s = -0.25\n"),
            "actuators.switch_off_delay_s",
            "ends after it starts",
        ),
        (
            "",
            CUBE,
            &*format!("{BURN}[actuators]\nthrust_scales = 1\n"),
            "actuators.thrust_scales",
            "did you mean thrust_scale?",
        ),
    ] {
        let message = plan(fuselage, debris, rest).expect_err(key);
        assert!(message.contains(&format!(" {key}")) && message.contains(says), "{key}: {message}");
    }
}

/// What a draw makes impossible is an invalid sample with its reason, and nothing is drawn again.
#[test]
fn draws_that_pull_or_turn_inside_out_are_invalid() {
    let disperse = |key: &str, std: f64| {
        format!("[[disperse]]\nparameter = \"actuators.{key}\"\ndistribution = \"normal\"\nstd = {std:?}\n")
    };
    // P(1 + z < 0) for any of three: 1 - 0.8413^3 = 0.404; P(0.25 + 0.25 z < 0): 0.159
    for (key, std, share) in [("thrust_scale", 1.0, 0.404), ("switch_off_delay_s", 0.25, 0.159)] {
        let plan = plan("", CUBE, &format!("{BURN}{}", disperse(key, std))).unwrap_or_else(|e| panic!("{e}"));
        let (mut sampler, mut input) = (plan.dispersions.sampler(), plan.nominal.clone());
        let mut applied = vec![0.0; plan.dispersions.columns().len()];
        const COUNT: u64 = 2000;
        let mut refused = 0;
        for sample in 1..=COUNT {
            sampler.draw(SampleId(sample), &mut input, &mut applied);
            if let Err(errors) = Scene::resolve(&input) {
                assert_eq!(errors[0].key, format!("actuators.{key}"));
                refused += 1;
            }
        }
        let sigma = (share * (1.0 - share) / COUNT as f64).sqrt();
        let found = f64::from(refused) / COUNT as f64;
        assert!((found - share).abs() < 3.29 * sigma, "{key}: {found} {share}");
    }
}

/// A thruster that fails, and one that works again, are in the same campaign: what is integrated follows from the commands.
#[test]
fn a_scaled_actuator_is_a_scaled_command() {
    let kind = Kind { wheels: [true; 2], debris: 0, products: true, offset: true, forced: true };
    let mut scaled = random(kind, 21, 1.0);
    for interval in &mut scaled.actuation {
        interval.thrust_n = [interval.thrust_n[0] * 2.0, interval.thrust_n[1], 0.0];
        interval.torque_n_m[1] *= 0.5;
    }
    let mut errors = random(kind, 21, 1.0);
    errors.actuators.thrust_scale = [2.0, 1.0, 0.0];
    errors.actuators.torque_scale = [1.0, 0.5];
    let mut off = errors.clone();
    off.actuators.thrust_scale = [0.0; 3];
    off.actuators.torque_scale = [0.0; 2];
    let scene = |input| Scene::resolve(input).expect("a physical scene");
    // the first scene says what is integrated: that nothing works in it must not matter to the others
    let scenes = [scene(&off), scene(&errors), scene(&scaled)];
    let runs: Vec<Run> = propagate(Method::Taylor, adaptive(1e-16), &Grid::uniform(1.0, 9), &scenes);
    assert_eq!(runs[1].bits(), runs[2].bits(), "factors of two leave no rounding");
    let impulse = |run: &Run| norm(run.table.at::<3>(StateField::Impulse, 8));
    assert_eq!(impulse(&runs[0]), 0.0);
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
    assert!(norm(off) > 1e-3, "a burn that is late turns with the body: {}", norm(off));
}
