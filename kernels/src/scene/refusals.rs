//! Every refusal of a scene by its key, and the nearest accepted scene.

use super::input::SceneInput;
use super::schema::{
    ActuationInput, DebrisInput, OrbitInput, PrincipalInertia, PrincipalMoments, WheelInput, WheelMode,
};
use super::{Name, Scene, samples};

/// A change of Berdoz's scene.
type Change = fn(&mut SceneInput);

fn changed(change: Change) -> SceneInput {
    let mut input = samples::table_two();
    input.actuation = vec![arc(0.0, 1.0), arc(2.0, 3.0)];
    change(&mut input);
    input
}

fn arc(start_s: f64, end_s: f64) -> ActuationInput {
    ActuationInput::idle(start_s, end_s).with_thrust(&[1.0]).with_torque(&[0.5, 0.25])
}

fn low_orbit() -> OrbitInput {
    OrbitInput { semi_major_axis_m: Some(7.0e6), ..OrbitInput::DEFAULT }
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
    &mut input.wheels[i]
}

fn by_mass(axial: f64) -> WheelInput {
    WheelInput {
        mass_kg: Some(50.0),
        axial_inertia_kg_m2: Some(axial),
        transverse_inertia_kg_m2: Some(1.0),
        ..WheelInput { name: Name::of("w1"), axis: [0.0, 1.0, 0.0], ..WheelInput::DEFAULT }
    }
}

/// Sets the mass of the body with its wheels, which have 106.03 kg.
fn includes_wheels(input: &mut SceneInput, mass_kg: f64) {
    input.parts.clear();
    input.body.includes_wheels = true;
    input.body.mass_kg = Some(mass_kg);
    input.body.center_of_mass_m = Some([0.0, 0.0, 1.5]);
    input.body.inertia_kg_m2 = Some([[300.0, 0.0, 0.0], [0.0, 300.0, 0.0], [0.0, 0.0, 200.0]]);
}

/// Key, text of the message, refused change, nearest accepted change.
const REFUSALS: &[(&str, &str, Change, Change)] = &[
    (
        "body.parts.fuselage.wall_thickness_m",
        "below outer_radius_m = 1.0",
        |input| input.parts[0].wall_thickness_m = Some(1.0),
        |input| input.parts[0].wall_thickness_m = Some(below(1.0)),
    ),
    (
        "body.parts.fuselage.wall_thickness_m",
        "below half of length_m = 0.06",
        |input| input.parts[0].length_m = Some(0.06),
        |input| input.parts[0].length_m = Some(0.06 + 1e-17),
    ),
    (
        "body.parts.fuselage.wall_thickness_m",
        "above zero",
        |input| input.parts[0].wall_thickness_m = Some(0.0),
        |input| input.parts[0].wall_thickness_m = Some(TINY),
    ),
    (
        "body.parts.fuselage.outer_radius_m",
        "above zero",
        |input| input.parts[0].outer_radius_m = Some(-1.0),
        |input| input.parts[0].outer_radius_m = Some(0.031),
    ),
    (
        "body.parts.fuselage.length_m",
        "a finite number",
        |input| input.parts[0].length_m = Some(f64::NAN),
        |input| input.parts[0].length_m = Some(0.061),
    ),
    (
        "body.parts.fuselage.density_kg_m3",
        "above zero",
        |input| input.parts[0].density_kg_m3 = Some(0.0),
        |input| input.parts[0].density_kg_m3 = Some(TINY),
    ),
    (
        "thrusters.p2.position_m",
        "finite",
        |input| input.thrusters[1].position_m[1] = f64::NAN,
        |input| input.thrusters[1].position_m[1] = 0.0,
    ),
    (
        "thrusters.p1.direction",
        "not all zero",
        |input| input.thrusters[0].direction = [0.0; 3],
        |input| input.thrusters[0].direction = [0.0, TINY, 0.0],
    ),
    (
        "wheels.w1.axis",
        "not all zero",
        |input| wheel(input, 0).axis = [0.0; 3],
        |input| wheel(input, 0).axis = [0.0, -2.0, 1.0],
    ),
    (
        "wheels.w1.axial_inertia_kg_m2",
        "at most twice",
        |input| *wheel(input, 0) = by_mass(2.0 + 1e-12),
        |input| *wheel(input, 0) = by_mass(2.0),
    ),
    (
        "body.mass_kg",
        "without its wheels",
        |input| includes_wheels(input, 106.0),
        |input| includes_wheels(input, 107.0),
    ),
    (
        "body.inertia_kg_m2",
        "is the inertia of a body",
        |input| {
            includes_wheels(input, 500.0);
            input.body.inertia_kg_m2 = Some([[90.0, 0.0, 0.0], [0.0, 90.0, 0.0], [0.0, 0.0, 3.0]]);
        },
        |input| includes_wheels(input, 500.0),
    ),
    ("body.mass_kg", "above zero", |input| input.body.mass_kg = Some(0.0), |input| input.body.mass_kg = Some(TINY)),
    (
        "body.center_of_mass_m",
        "finite numbers",
        |input| input.body.center_of_mass_m = Some([0.0, f64::INFINITY, 0.0]),
        |input| input.body.center_of_mass_m = Some([0.0, 1e3, 0.0]),
    ),
    (
        "body.inertia_kg_m2",
        "symmetric",
        |input| input.body.inertia_kg_m2 = Some([[1.0, 2e-14, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]),
        |input| input.body.inertia_kg_m2 = Some([[1.0, 1e-14, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]),
    ),
    (
        "body.inertia_kg_m2",
        "positive definite",
        |input| input.body.inertia_kg_m2 = Some([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 0.0]]),
        |input| input.body.inertia_kg_m2 = Some([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, TINY]]),
    ),
    (
        "body.inertia_kg_m2",
        "exceeds the sum of the other two",
        |input| input.body.inertia_kg_m2 = Some([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 2.0 + 1e-13]]),
        |input| input.body.inertia_kg_m2 = Some([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 2.0]]),
    ),
    (
        "wheels.w1.radius_m",
        "above zero",
        |input| wheel(input, 0).radius_m = Some(0.0),
        |input| wheel(input, 0).radius_m = Some(TINY),
    ),
    (
        "wheels.w2.length_m",
        "above zero",
        |input| wheel(input, 1).length_m = Some(-0.1),
        |input| wheel(input, 1).length_m = Some(TINY),
    ),
    (
        "wheels.w2.position_m",
        "finite numbers",
        |input| wheel(input, 1).position_m[2] = f64::INFINITY,
        |input| wheel(input, 1).position_m[2] = -1.0,
    ),
    (
        "wheels.w1.density_kg_m3",
        "above zero",
        |input| wheel(input, 0).density_kg_m3 = Some(0.0),
        |input| wheel(input, 0).density_kg_m3 = Some(TINY),
    ),
    (
        "wheels.w2.position_m",
        "finite",
        |input| wheel(input, 1).position_m[0] = f64::NAN,
        |input| wheel(input, 1).position_m = [-1.0, 1.0, 2.0],
    ),
    (
        "wheels.w1.tilt_rad",
        "finite",
        |input| wheel(input, 0).tilt_rad[1] = f64::INFINITY,
        |input| wheel(input, 0).tilt_rad = [-1.0, 4.0],
    ),
    (
        "wheels.w1",
        "positive and finite",
        |input| wheel(input, 0).radius_m = Some(1e-160),
        |input| wheel(input, 0).radius_m = Some(1e-75),
    ),
    ("body", "at most 1e150", |input| input.body.mass_kg = Some(1e308), |input| input.body.mass_kg = Some(1e140)),
    ("body", "at most 1e150", |input| includes_wheels(input, 1e308), |input| includes_wheels(input, 1e150)),
    (
        "body",
        "at most 1e150",
        |input| input.body.principal = Some(principal(PrincipalMoments::Inertia([1.1e150; 3]))),
        |input| input.body.principal = Some(principal(PrincipalMoments::Inertia([1e150; 3]))),
    ),
    (
        "wheels.w1",
        "at most 1e150",
        |input| wheel(input, 0).density_kg_m3 = Some(1e308),
        |input| wheel(input, 0).density_kg_m3 = Some(1e140),
    ),
    (
        "debris",
        "at most 1e150",
        |input| input.debris = Some(DebrisInput::Tensor { mass_kg: 1e308, inertia_kg_m2: UNIT }),
        |input| input.debris = Some(DebrisInput::Tensor { mass_kg: 1e150, inertia_kg_m2: UNIT }),
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
        "body.principal_moments_kg_m2",
        "above zero, each",
        |input| input.body.principal = Some(principal(PrincipalMoments::Inertia([1.0, 1.0, 0.0]))),
        |input| input.body.principal = Some(principal(PrincipalMoments::Inertia([1.0, 1.0, TINY]))),
    ),
    (
        "body.principal_second_moments_kg_m2",
        "above zero, each",
        |input| input.body.principal = Some(principal(PrincipalMoments::Second([1.0, -TINY, 1.0]))),
        |input| input.body.principal = Some(principal(PrincipalMoments::Second([1.0, TINY, 1e9]))),
    ),
    (
        "body.principal_axes",
        "norm 1",
        |input| {
            let axes = [0.0; 4];
            input.body.principal = Some(PrincipalInertia { moments: PrincipalMoments::Inertia([1.0; 3]), axes });
        },
        |input| input.body.principal = Some(principal(PrincipalMoments::Inertia([1.0; 3]))),
    ),
    (
        "body.mass_scale",
        "above zero",
        |input| input.body.errors.mass_scale = 0.0,
        |input| input.body.errors.mass_scale = TINY,
    ),
    (
        "body.inertia_scale",
        "above zero",
        |input| input.body.errors.inertia_scale = -TINY,
        |input| input.body.errors.inertia_scale = TINY,
    ),
    (
        "body.stretch_log",
        "finite",
        |input| input.body.errors.stretch_log[1] = f64::NAN,
        |input| input.body.errors.stretch_log[1] = -3.0,
    ),
    (
        "body.shear",
        "finite",
        |input| input.body.errors.shear[1] = f64::INFINITY,
        |input| input.body.errors.shear[1] = -3.0,
    ),
    (
        "body.center_offset_m",
        "finite",
        |input| input.body.errors.center_offset_m[1] = f64::INFINITY,
        |input| input.body.errors.center_offset_m[1] = -3.0,
    ),
    (
        "thrusters.p2.thrust_scale",
        "does not pull",
        |input| input.thrusters[1].thrust_scale = -TINY,
        |input| input.thrusters[1].thrust_scale = 0.0,
    ),
    (
        "wheels.w2.torque_scale",
        "finite",
        |input| wheel(input, 1).torque_scale = f64::NAN,
        |input| wheel(input, 1).torque_scale = -1.0,
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
        "actuation[0].switch_off_delay_s",
        "actuation[0], commanded from 0.0 to 1.0, ends before the next starts",
        |input| input.actuation[0].errors.switch_off_delay_s = 1.0 + TINY,
        |input| input.actuation[0].errors.switch_off_delay_s = 1.0,
    ),
    (
        "actuation[1].thrust_scale",
        "does not pull",
        |input| input.actuation[1].errors.thrust_scale = -TINY,
        |input| input.actuation[1].errors.thrust_scale = 0.0,
    ),
    (
        "actuation[1].torque_scale",
        "finite",
        |input| input.actuation[1].errors.torque_scale = f64::INFINITY,
        |input| input.actuation[1].errors.torque_scale = -1.0,
    ),
    (
        "initial.attitude",
        "norm 1",
        |input| input.initial.attitude = [1.0 + 2e-6, 0.0, 0.0, 0.0],
        |input| input.initial.attitude = [1.0 + 0.9e-6, 0.0, 0.0, 0.0],
    ),
    (
        "initial.attitude",
        "attitude_orbital",
        |input| {
            input.orbit = Some(low_orbit());
            input.initial.attitude_orbital = Some([0.0, 1.0, 0.0, 0.0]);
            input.initial.attitude = [0.0, 1.0, 0.0, 0.0];
        },
        |input| {
            input.orbit = Some(low_orbit());
            input.initial.attitude_orbital = Some([0.0, 1.0, 0.0, 0.0]);
        },
    ),
    (
        "initial.angular_velocity_rad_s",
        "angular_velocity_orbital_rad_s",
        |input| {
            input.orbit = Some(low_orbit());
            input.initial.angular_velocity_orbital_rad_s = Some([0.0; 3]);
            input.initial.angular_velocity_rad_s = [0.0, 0.1, 0.0];
        },
        |input| {
            input.orbit = Some(low_orbit());
            input.initial.angular_velocity_rad_s = [0.0; 3];
            input.initial.angular_velocity_orbital_rad_s = Some([0.0; 3]);
        },
    ),
    (
        "initial.attitude_orbital",
        "without an [orbit]",
        |input| input.initial.attitude_orbital = Some([0.0, 1.0, 0.0, 0.0]),
        |input| input.initial.attitude_orbital = None,
    ),
    (
        "initial.angular_velocity_orbital_rad_s",
        "without an [orbit]",
        |input| {
            input.initial.angular_velocity_rad_s = [0.0; 3];
            input.initial.angular_velocity_orbital_rad_s = Some([0.0; 3]);
        },
        |input| input.initial.angular_velocity_rad_s = [0.0; 3],
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
        "wheels.w2.rate_rad_s",
        "finite",
        |input| wheel(input, 1).rate_rad_s = f64::NEG_INFINITY,
        |input| wheel(input, 1).rate_rad_s = 0.0,
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
        "actuation[1].thrust_n.p3",
        "does not pull",
        |input| input.actuation[1].thrust_n[2] = -TINY,
        |input| input.actuation[1].thrust_n[2] = 0.0,
    ),
    (
        "actuation[1].torque_n_m.w1",
        "finite",
        |input| input.actuation[1].torque_n_m[0] = f64::NAN,
        |input| input.actuation[1].torque_n_m[0] = -1.0,
    ),
    (
        "actuation[0].torque_n_m.w1",
        "w1, which is locked",
        |input| {
            wheel(input, 0).mode = WheelMode::Locked;
            input.actuation[1].torque_n_m[0] = 0.0;
        },
        |input| {
            wheel(input, 0).mode = WheelMode::Locked;
            input.actuation[0].torque_n_m[0] = 0.0;
            input.actuation[1].torque_n_m[0] = 0.0;
        },
    ),
    (
        "actuation[1].torque_n_m.w2",
        "w2, whose speed its motor holds",
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
