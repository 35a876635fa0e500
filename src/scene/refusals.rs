//! Every refusal of a scene by its key, and the nearest scene that is accepted.

use super::input::SceneInput;
use super::schema::{ActuationInput, DebrisInput, PrincipalInertia, PrincipalMoments, WheelInput, WheelMode};
use super::{Scene, samples};

/// A change of the report's scene.
type Change = fn(&mut SceneInput);

fn changed(change: Change) -> SceneInput {
    let mut input = samples::table_two();
    input.actuation = vec![arc(0.0, 1.0), arc(2.0, 3.0)];
    change(&mut input);
    input
}

fn arc(start_s: f64, end_s: f64) -> ActuationInput {
    ActuationInput { start_s, end_s, thrust_n: [1.0, 0.0, 0.0], torque_n_m: [0.5, 0.25] }
}

fn below(x: f64) -> f64 {
    f64::from_bits(x.to_bits() - 1)
}

const TINY: f64 = 1e-9;
const UNIT: [[f64; 3]; 3] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

fn principal(moments: PrincipalMoments) -> PrincipalInertia {
    PrincipalInertia { moments, axes: [1.0, 0.0, 0.0, 0.0] }
}

fn irregular(moments: PrincipalMoments) -> DebrisInput {
    DebrisInput::Principal { mass_kg: 1.0, principal: principal(moments) }
}

fn wheel(input: &mut SceneInput, i: usize) -> &mut WheelInput {
    input.wheels[i].as_mut().expect("Table II has both wheels")
}

/// Key, what the message must say, the change that is refused, and its nearest neighbour that is accepted.
const REFUSALS: &[(&str, &str, Change, Change)] = &[
    (
        "fuselage.wall_thickness_m",
        "below fuselage.outer_radius_m = 1.0",
        |input| input.fuselage.wall_thickness_m = 1.0,
        |input| input.fuselage.wall_thickness_m = below(1.0),
    ),
    (
        "fuselage.wall_thickness_m",
        "below half of fuselage.length_m = 0.06",
        |input| input.fuselage.length_m = 0.06,
        |input| input.fuselage.length_m = 0.06 + 1e-17,
    ),
    (
        "fuselage.wall_thickness_m",
        "above zero",
        |input| input.fuselage.wall_thickness_m = 0.0,
        |input| input.fuselage.wall_thickness_m = TINY,
    ),
    (
        "fuselage.outer_radius_m",
        "above zero",
        |input| input.fuselage.outer_radius_m = -1.0,
        |input| input.fuselage.outer_radius_m = 0.031,
    ),
    (
        "fuselage.length_m",
        "a finite number",
        |input| input.fuselage.length_m = f64::NAN,
        |input| input.fuselage.length_m = 0.061,
    ),
    (
        "fuselage.density_kg_m3",
        "above zero",
        |input| input.fuselage.density_kg_m3 = 0.0,
        |input| input.fuselage.density_kg_m3 = TINY,
    ),
    (
        "fuselage.thruster_offset_m",
        "zero or above",
        |input| input.fuselage.thruster_offset_m = -TINY,
        |input| input.fuselage.thruster_offset_m = 0.0,
    ),
    (
        "fuselage.mass_kg",
        "above zero",
        |input| input.fuselage.mass_kg = Some(0.0),
        |input| input.fuselage.mass_kg = Some(TINY),
    ),
    (
        "fuselage.center_of_mass_m",
        "finite numbers",
        |input| input.fuselage.center_of_mass_m = Some([0.0, f64::INFINITY, 0.0]),
        |input| input.fuselage.center_of_mass_m = Some([0.0, 1e3, 0.0]),
    ),
    (
        "fuselage.inertia_kg_m2",
        "symmetric",
        |input| input.fuselage.inertia_kg_m2 = Some([[1.0, 2e-14, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]),
        |input| input.fuselage.inertia_kg_m2 = Some([[1.0, 1e-14, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]),
    ),
    (
        "fuselage.inertia_kg_m2",
        "positive definite",
        |input| input.fuselage.inertia_kg_m2 = Some([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 0.0]]),
        |input| input.fuselage.inertia_kg_m2 = Some([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, TINY]]),
    ),
    (
        "fuselage.inertia_kg_m2",
        "exceeds the sum of the other two",
        |input| input.fuselage.inertia_kg_m2 = Some([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 2.0 + 1e-13]]),
        |input| input.fuselage.inertia_kg_m2 = Some([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 2.0]]),
    ),
    ("wheel1.radius_m", "above zero", |input| wheel(input, 0).radius_m = 0.0, |input| wheel(input, 0).radius_m = TINY),
    ("wheel2.length_m", "above zero", |input| wheel(input, 1).length_m = -0.1, |input| wheel(input, 1).length_m = TINY),
    (
        "wheel2.station_m",
        "a finite number",
        |input| wheel(input, 1).station_m = f64::INFINITY,
        |input| wheel(input, 1).station_m = -1.0,
    ),
    (
        "wheel1.density_kg_m3",
        "above zero",
        |input| wheel(input, 0).density_kg_m3 = 0.0,
        |input| wheel(input, 0).density_kg_m3 = TINY,
    ),
    (
        "wheel2.offset_m",
        "finite",
        |input| wheel(input, 1).offset_m[0] = f64::NAN,
        |input| wheel(input, 1).offset_m = [-1.0, 1.0],
    ),
    (
        "wheel1.tilt_rad",
        "finite",
        |input| wheel(input, 0).tilt_rad[1] = f64::INFINITY,
        |input| wheel(input, 0).tilt_rad = [-1.0, 4.0],
    ),
    (
        "wheel1",
        "positive and finite",
        |input| wheel(input, 0).radius_m = 1e-160,
        |input| wheel(input, 0).radius_m = 1e-75,
    ),
    (
        "debris.side_m",
        "above zero",
        |input| input.debris = Some(DebrisInput::Cube { side_m: 0.0, density_kg_m3: 1.0 }),
        |input| input.debris = Some(DebrisInput::Cube { side_m: TINY, density_kg_m3: 1.0 }),
    ),
    (
        "debris.size_m",
        "above zero, each",
        |input| input.debris = Some(DebrisInput::Box { size_m: [1.0, 0.0, 1.0], density_kg_m3: 1.0 }),
        |input| input.debris = Some(DebrisInput::Box { size_m: [1.0, TINY, 1.0], density_kg_m3: 1.0 }),
    ),
    (
        "debris.density_kg_m3",
        "above zero",
        |input| input.debris = Some(DebrisInput::Cube { side_m: 1.0, density_kg_m3: -1.0 }),
        |input| input.debris = Some(DebrisInput::Cube { side_m: 1.0, density_kg_m3: TINY }),
    ),
    (
        "debris.mass_kg",
        "above zero",
        |input| input.debris = Some(DebrisInput::Tensor { mass_kg: 0.0, inertia_kg_m2: UNIT }),
        |input| input.debris = Some(DebrisInput::Tensor { mass_kg: TINY, inertia_kg_m2: UNIT }),
    ),
    (
        "debris.inertia_kg_m2",
        "positive definite",
        |input| input.debris = Some(DebrisInput::Tensor { mass_kg: 1.0, inertia_kg_m2: [[0.0; 3]; 3] }),
        |input| input.debris = Some(DebrisInput::Tensor { mass_kg: 1.0, inertia_kg_m2: UNIT }),
    ),
    (
        "debris.principal_moments_kg_m2",
        "no moment exceeds the sum of the other two",
        |input| input.debris = Some(irregular(PrincipalMoments::Inertia([1.0, 1.0, 2.0 + 1e-13]))),
        |input| input.debris = Some(irregular(PrincipalMoments::Inertia([1.0, 1.0, 2.0]))),
    ),
    (
        "fuselage.principal_moments_kg_m2",
        "above zero, each",
        |input| input.fuselage.principal = Some(principal(PrincipalMoments::Inertia([1.0, 1.0, 0.0]))),
        |input| input.fuselage.principal = Some(principal(PrincipalMoments::Inertia([1.0, 1.0, TINY]))),
    ),
    (
        "fuselage.principal_second_moments_kg_m2",
        "above zero, each",
        |input| input.fuselage.principal = Some(principal(PrincipalMoments::Second([1.0, -TINY, 1.0]))),
        |input| input.fuselage.principal = Some(principal(PrincipalMoments::Second([1.0, TINY, 1e9]))),
    ),
    (
        "fuselage.principal_axes",
        "norm 1",
        |input| {
            let axes = [0.0; 4];
            input.fuselage.principal = Some(PrincipalInertia { moments: PrincipalMoments::Inertia([1.0; 3]), axes });
        },
        |input| input.fuselage.principal = Some(principal(PrincipalMoments::Inertia([1.0; 3]))),
    ),
    (
        "fuselage.mass_scale",
        "above zero",
        |input| input.fuselage.errors.mass_scale = 0.0,
        |input| input.fuselage.errors.mass_scale = TINY,
    ),
    (
        "fuselage.inertia_scale",
        "above zero",
        |input| input.fuselage.errors.inertia_scale = -TINY,
        |input| input.fuselage.errors.inertia_scale = TINY,
    ),
    (
        "fuselage.stretch_log",
        "finite",
        |input| input.fuselage.errors.stretch_log[1] = f64::NAN,
        |input| input.fuselage.errors.stretch_log[1] = -3.0,
    ),
    (
        "fuselage.shear",
        "finite",
        |input| input.fuselage.errors.shear[1] = f64::INFINITY,
        |input| input.fuselage.errors.shear[1] = -3.0,
    ),
    (
        "fuselage.center_offset_m",
        "finite",
        |input| input.fuselage.errors.center_offset_m[1] = f64::INFINITY,
        |input| input.fuselage.errors.center_offset_m[1] = -3.0,
    ),
    (
        "actuators.thrust_scale",
        "does not pull",
        |input| input.actuators.thrust_scale[1] = -TINY,
        |input| input.actuators.thrust_scale[1] = 0.0,
    ),
    (
        "actuators.torque_scale",
        "finite",
        |input| input.actuators.torque_scale[1] = f64::NAN,
        |input| input.actuators.torque_scale[1] = -1.0,
    ),
    (
        "actuators.switch_off_delay_s",
        "actuation[0], commanded from 0.0 to 1.0, ends after it starts",
        |input| input.actuators.switch_off_delay_s = -1.0,
        |input| input.actuators.switch_off_delay_s = -1.0 + TINY,
    ),
    (
        "actuators.switch_off_delay_s",
        "actuation[0], commanded from 0.0 to 1.0, ends before the next starts",
        |input| input.actuators.switch_off_delay_s = 1.0 + TINY,
        |input| input.actuators.switch_off_delay_s = 1.0,
    ),
    (
        "initial.attitude",
        "norm 1",
        |input| input.initial.attitude = [1.0 + 2e-6, 0.0, 0.0, 0.0],
        |input| input.initial.attitude = [1.0 + 0.9e-6, 0.0, 0.0, 0.0],
    ),
    (
        "initial.debris_attitude",
        "norm 1",
        |input| input.initial.debris_attitude = [0.0; 4],
        |input| input.initial.debris_attitude = [0.0, 0.6, -0.8, 0.0],
    ),
    (
        "initial.angular_velocity_rad_s",
        "finite",
        |input| input.initial.angular_velocity_rad_s[1] = f64::NAN,
        |input| input.initial.angular_velocity_rad_s[1] = 0.0,
    ),
    (
        "initial.wheel_rates_rad_s",
        "finite",
        |input| input.initial.wheel_rates_rad_s[1] = f64::NEG_INFINITY,
        |input| input.initial.wheel_rates_rad_s[1] = 0.0,
    ),
    (
        "actuation[0].start_s",
        "zero or later",
        |input| input.actuation[0].start_s = -TINY,
        |input| input.actuation[0].start_s = 0.0,
    ),
    (
        "actuation[0].end_s",
        "later than its start_s = 0.0",
        |input| input.actuation[0].end_s = 0.0,
        |input| input.actuation[0].end_s = TINY,
    ),
    (
        "actuation[1].start_s",
        "no earlier than actuation[0].end_s = 1.0",
        |input| input.actuation[1].start_s = below(1.0),
        |input| input.actuation[1].start_s = 1.0,
    ),
    (
        "actuation[1].thrust_n",
        "does not pull",
        |input| input.actuation[1].thrust_n[2] = -TINY,
        |input| input.actuation[1].thrust_n[2] = 0.0,
    ),
    (
        "actuation[1].torque_n_m",
        "finite",
        |input| input.actuation[1].torque_n_m[0] = f64::NAN,
        |input| input.actuation[1].torque_n_m[0] = -1.0,
    ),
    (
        "actuation[0].torque_n_m",
        "wheel1",
        |input| {
            input.wheels[0] = None;
            input.actuation[1].torque_n_m[0] = 0.0;
        },
        |input| {
            input.wheels[0] = None;
            input.actuation[0].torque_n_m[0] = 0.0;
            input.actuation[1].torque_n_m[0] = 0.0;
        },
    ),
    (
        "actuation[1].torque_n_m",
        "wheel2, whose speed its motor holds",
        |input| {
            input.actuation[0].torque_n_m[1] = 0.0;
            wheel(input, 1).mode = WheelMode::SpeedHeld;
        },
        |input| {
            input.actuation[0].torque_n_m[1] = 0.0;
            input.actuation[1].torque_n_m[1] = 0.0;
            wheel(input, 1).mode = WheelMode::SpeedHeld;
        },
    ),
];

#[test]
fn each_refusal_names_its_key_and_its_neighbour_is_accepted() {
    for &(key, says, refused, accepted) in REFUSALS {
        let errors = Scene::resolve(&changed(refused)).expect_err(key);
        assert_eq!(errors.len(), 1, "{key}: {errors:?}");
        assert_eq!(errors[0].key, key);
        assert!(errors[0].to_string().contains(says), "{}", errors[0]);
        if let Err(errors) = Scene::resolve(&changed(accepted)) {
            panic!("{key}: the neighbour is refused: {}", errors[0]);
        }
    }
}
