//! What makes a scene physical: every refusal, by key and number.
//!
//! `written` checks what a person wrote, `derived` what follows from it (masses and inertias that overflow, vanish or are
//! not positive definite). Both only gather problems, so that one look at an input finds them all.

use super::error::Problems;
use super::input::{
    ActuationInput, ActuatorsInput, DebrisInput, FuselageInput, InitialInput, MassErrors, PrincipalInertia,
    PrincipalMoments, SceneInput, WheelInput, WheelMode,
};
use super::mass::{Body, MassProperties};
use super::schedule::applied;
use crate::math::symmetric::{is_positive_definite, principal_axes};

/// How far the norm of a written attitude quaternion may be from one: six written digits make 1e-6; it is then normalised.
pub const UNIT_NORM_TOLERANCE: f64 = 1e-6;

/// Slack of symmetry and triangle inequality, relative to the trace: the rounding of a tensor that was computed elsewhere
/// (rotated, shifted to another centre), and no more.
pub const INERTIA_SLACK: f64 = 16.0 * f64::EPSILON;

const WHEEL_TABLES: [&str; 2] = ["wheel1", "wheel2"];

/// The numeric keys of a wheel's table: radius, length, station, density, offset, tilt.
const WHEEL_KEYS: [[&str; 6]; 2] = [
    [
        "wheel1.radius_m",
        "wheel1.length_m",
        "wheel1.station_m",
        "wheel1.density_kg_m3",
        "wheel1.offset_m",
        "wheel1.tilt_rad",
    ],
    [
        "wheel2.radius_m",
        "wheel2.length_m",
        "wheel2.station_m",
        "wheel2.density_kg_m3",
        "wheel2.offset_m",
        "wheel2.tilt_rad",
    ],
];

/// Gathers what is wrong with the numbers as written.
pub(super) fn written(input: &SceneInput, problems: &mut Problems) {
    fuselage(&input.fuselage, problems);
    for (wheel, keys) in input.wheels.iter().zip(WHEEL_KEYS) {
        if let Some(WheelInput { radius_m, length_m, station_m, density_kg_m3, offset_m, tilt_rad, mode: _ }) = *wheel {
            problems.positive(keys[0], radius_m);
            problems.positive(keys[1], length_m);
            problems.finite(keys[2], station_m);
            problems.positive(keys[3], density_kg_m3);
            problems.all_finite(keys[4], offset_m);
            problems.all_finite(keys[5], tilt_rad);
        }
    }
    if let Some(debris) = input.debris {
        match debris {
            DebrisInput::Cube { side_m, density_kg_m3 } => {
                problems.positive("debris.side_m", side_m);
                problems.positive("debris.density_kg_m3", density_kg_m3);
            }
            DebrisInput::Box { size_m, density_kg_m3 } => {
                problems.all_positive("debris.size_m", size_m);
                problems.positive("debris.density_kg_m3", density_kg_m3);
            }
            DebrisInput::Tensor { mass_kg, inertia_kg_m2 } => {
                problems.positive("debris.mass_kg", mass_kg);
                inertia("debris.inertia_kg_m2", inertia_kg_m2, problems);
            }
            DebrisInput::Principal { mass_kg, principal: written } => {
                problems.positive("debris.mass_kg", mass_kg);
                principal(&DEBRIS_PRINCIPAL, &written, problems);
            }
        }
    }
    initial(input, &input.initial, problems);
    if actuation(input, problems) && actuators(&input.actuators, problems) {
        switches(input, problems);
    }
}

/// The keys of an inertia by principal moments: of inertia, second, axes.
const FUSELAGE_PRINCIPAL: [&str; 3] =
    ["fuselage.principal_moments_kg_m2", "fuselage.principal_second_moments_kg_m2", "fuselage.principal_axes"];
const DEBRIS_PRINCIPAL: [&str; 3] =
    ["debris.principal_moments_kg_m2", "debris.principal_second_moments_kg_m2", "debris.principal_axes"];

/// Gathers what keeps principal moments and axes from being an inertia.
fn principal(keys: &[&'static str; 3], principal: &PrincipalInertia, problems: &mut Problems) {
    match principal.moments {
        PrincipalMoments::Inertia(moments) => {
            let [a, b, c] = moments;
            let slack = INERTIA_SLACK * (a + b + c);
            if problems.all_positive(keys[0], moments) && (a > b + c + slack || b > a + c + slack || c > a + b + slack)
            {
                problems.add(
                    keys[0],
                    moments,
                    "such that no moment exceeds the sum of the other two",
                    "no distribution of mass has these moments; principal_second_moments_kg_m2 cannot fail in this way",
                );
            }
        }
        PrincipalMoments::Second(moments) => {
            problems.all_positive(keys[1], moments);
        }
    }
    unit_quaternion(keys[2], principal.axes, problems);
}

/// Gathers what is wrong with errors of the fuselage's mass distribution.
fn mass_errors(errors: &MassErrors, problems: &mut Problems) {
    problems.positive("fuselage.mass_scale", errors.mass_scale);
    problems.all_finite("fuselage.stretch_log", errors.stretch_log);
    problems.all_finite("fuselage.shear", errors.shear);
    problems.all_finite("fuselage.center_offset_m", errors.center_offset_m);
}

fn fuselage(fuselage: &FuselageInput, problems: &mut Problems) {
    let (wall, radius, length) = (fuselage.wall_thickness_m, fuselage.outer_radius_m, fuselage.length_m);
    let wall_passed = problems.positive("fuselage.wall_thickness_m", wall);
    let radius_passed = problems.positive("fuselage.outer_radius_m", radius);
    let length_passed = problems.positive("fuselage.length_m", length);
    if wall_passed && radius_passed && wall >= radius {
        problems.add(
            "fuselage.wall_thickness_m",
            wall,
            format!("below fuselage.outer_radius_m = {radius:?}"),
            "make the wall thinner or the radius larger",
        );
    }
    if wall_passed && length_passed && 2.0 * wall >= length {
        problems.add(
            "fuselage.wall_thickness_m",
            wall,
            format!("below half of fuselage.length_m = {length:?}"),
            "make the end plates thinner or the fuselage longer",
        );
    }
    problems.positive("fuselage.density_kg_m3", fuselage.density_kg_m3);
    problems.not_negative("fuselage.thruster_offset_m", fuselage.thruster_offset_m);
    if let Some(mass) = fuselage.mass_kg {
        problems.positive("fuselage.mass_kg", mass);
    }
    if let Some(center) = fuselage.center_of_mass_m {
        problems.all_finite("fuselage.center_of_mass_m", center);
    }
    if let Some(tensor) = fuselage.inertia_kg_m2 {
        inertia("fuselage.inertia_kg_m2", tensor, problems);
    }
    if let Some(written) = fuselage.principal {
        principal(&FUSELAGE_PRINCIPAL, &written, problems);
    }
    mass_errors(&fuselage.errors, problems);
}

/// Gathers what keeps `tensor` from being the inertia of a body about its centre of mass.
fn inertia(key: &'static str, tensor: [[f64; 3]; 3], problems: &mut Problems) {
    if !tensor.iter().flatten().all(|entry| entry.is_finite()) {
        problems.add(key, tensor, "nine finite numbers", "write finite numbers");
        return;
    }
    let slack = INERTIA_SLACK * (tensor[0][0].abs() + tensor[1][1].abs() + tensor[2][2].abs());
    if [(0, 1), (0, 2), (1, 2)].iter().any(|&(i, j)| (tensor[i][j] - tensor[j][i]).abs() > slack) {
        problems.add(key, tensor, "symmetric", "write products of inertia equal on both sides of the diagonal");
        return;
    }
    let (moments, _) = principal_axes(tensor);
    let largest = moments.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let smallest = moments.iter().copied().fold(f64::INFINITY, f64::min);
    if smallest <= 0.0 || !is_positive_definite(tensor) {
        problems.add(
            key,
            tensor,
            format!("positive definite (its principal moments are {moments:?})"),
            "check signs; products of inertia are minus the integrals of x y",
        );
    } else if largest > (moments[0] + moments[1] + moments[2] - largest) + slack {
        problems.add(
            key,
            tensor,
            format!("such that no principal moment exceeds the sum of the other two (they are {moments:?})"),
            "no distribution of mass has these moments; check units and the point they refer to",
        );
    }
}

fn initial(input: &SceneInput, initial: &InitialInput, problems: &mut Problems) {
    problems.all_finite("initial.position_m", initial.position_m);
    problems.all_finite("initial.velocity_m_s", initial.velocity_m_s);
    unit_quaternion("initial.attitude", initial.attitude, problems);
    problems.all_finite("initial.angular_velocity_rad_s", initial.angular_velocity_rad_s);
    problems.all_finite("initial.wheel_angles_rad", initial.wheel_angles_rad);
    problems.all_finite("initial.wheel_rates_rad_s", initial.wheel_rates_rad_s);
    if input.debris.is_some() {
        problems.all_finite("initial.debris_position_m", initial.debris_position_m);
        problems.all_finite("initial.debris_velocity_m_s", initial.debris_velocity_m_s);
        unit_quaternion("initial.debris_attitude", initial.debris_attitude, problems);
        problems.all_finite(
            "initial.debris_relative_angular_velocity_rad_s",
            initial.debris_relative_angular_velocity_rad_s,
        );
    }
}

fn unit_quaternion(key: &'static str, q: [f64; 4], problems: &mut Problems) {
    if problems.all_finite(key, q) {
        let norm = q.iter().map(|x| x * x).sum::<f64>().sqrt();
        if (norm - 1.0).abs() > UNIT_NORM_TOLERANCE {
            problems.add(
                key,
                q,
                format!("a quaternion of norm 1 within {UNIT_NORM_TOLERANCE:?} (its norm is {norm:?})"),
                "divide the four numbers by the norm",
            );
        }
    }
}

/// Gathers what is wrong with the commands; whether nothing is.
fn actuation(input: &SceneInput, problems: &mut Problems) -> bool {
    let before = problems.0.len();
    let mut previous_end = 0.0;
    for (i, &ActuationInput { start_s, end_s, thrust_n, torque_n_m }) in input.actuation.iter().enumerate() {
        let key = |name: &str| format!("actuation[{i}].{name}");
        let numbers = [start_s, end_s, thrust_n[0], thrust_n[1], thrust_n[2], torque_n_m[0], torque_n_m[1]];
        if !numbers.iter().all(|number| number.is_finite()) {
            let written = (start_s, end_s, thrust_n, torque_n_m);
            problems.add(format!("actuation[{i}]"), written, "made of finite numbers", "write finite numbers");
            continue;
        }
        if start_s < previous_end {
            let (allowed, remedy) = if i == 0 {
                ("zero or later".to_owned(), "a run starts at time zero")
            } else {
                (
                    format!("no earlier than actuation[{}].end_s = {previous_end:?}", i - 1),
                    "put the stretches in order, not overlapping",
                )
            };
            problems.add(key("start_s"), start_s, allowed, remedy);
        }
        if end_s <= start_s {
            problems.add(
                key("end_s"),
                end_s,
                format!("later than its start_s = {start_s:?}"),
                "end the stretch after its start, or leave it out",
            );
        }
        previous_end = end_s.max(previous_end);
        if thrust_n.iter().any(|&thrust| thrust < 0.0) {
            problems.add(
                key("thrust_n"),
                thrust_n,
                "zero or above, each: a thruster does not pull",
                "use the opposite thruster",
            );
        }
        for (wheel, torque) in torque_n_m.into_iter().enumerate() {
            if torque == 0.0 {
                continue;
            }
            match input.wheels[wheel].map(|wheel| wheel.mode) {
                Some(WheelMode::Free) => {}
                Some(WheelMode::SpeedHeld) => problems.add(
                    key("torque_n_m"),
                    torque_n_m,
                    format!("zero for {}, whose speed its motor holds", WHEEL_TABLES[wheel]),
                    "set that torque to zero, or the wheel's wheel_mode to \"free\"",
                ),
                None => problems.add(
                    key("torque_n_m"),
                    torque_n_m,
                    format!("zero for {}, which this spacecraft does not have", WHEEL_TABLES[wheel]),
                    "set that torque to zero or describe the wheel",
                ),
            }
        }
    }
    problems.0.len() == before
}

/// Gathers what is wrong with the actuators; whether nothing is.
fn actuators(actuators: &ActuatorsInput, problems: &mut Problems) -> bool {
    let before = problems.0.len();
    let scale = actuators.thrust_scale;
    if problems.all_finite("actuators.thrust_scale", scale) && scale.iter().any(|&factor| factor < 0.0) {
        let allowed = "zero or above, each: a thruster does not pull";
        problems.add("actuators.thrust_scale", scale, allowed, "write zero for a thruster that does not work");
    }
    let keys = ["actuators.thruster1_tilt_rad", "actuators.thruster2_tilt_rad", "actuators.thruster3_tilt_rad"];
    for (key, tilt) in keys.into_iter().zip(actuators.tilts_rad()) {
        problems.all_finite(key, tilt);
    }
    problems.finite("actuators.switch_on_delay_s", actuators.switch_on_delay_s);
    problems.finite("actuators.switch_off_delay_s", actuators.switch_off_delay_s);
    problems.all_finite("actuators.torque_scale", actuators.torque_scale);
    problems.all_finite("actuators.torque_bias_n_m", actuators.torque_bias_n_m);
    problems.0.len() == before
}

/// Gathers where delays turn stretches inside out or into each other. Only the first is told: the delays are common to all.
fn switches(input: &SceneInput, problems: &mut Problems) {
    let delays = &input.actuators;
    let commanded = |index: usize| {
        let command = &input.actuation[index];
        format!("such that actuation[{index}], commanded from {:?} to {:?},", command.start_s, command.end_s)
    };
    for index in 0..input.actuation.len() {
        let stretch = applied(input, index);
        let next = (index + 1 < input.actuation.len()).then(|| applied(input, index + 1).start);
        let said = if stretch.end() <= stretch.start {
            format!("{} ends after it starts", commanded(index))
        } else if next.is_some_and(|next| stretch.end() > next) {
            format!("{} ends before the next starts", commanded(index))
        } else {
            continue;
        };
        let written = (delays.switch_on_delay_s, delays.switch_off_delay_s);
        let remedy = "make the delays (on, off) smaller, or nearer to each other";
        problems.add("actuators.switch_off_delay_s", written, said, remedy);
        return;
    }
}

/// Gathers what is wrong with what follows from an input whose numbers all passed.
pub(super) fn derived(input: &SceneInput, mass: &MassProperties, problems: &mut Problems) {
    let healthy = |value: f64| value.is_finite() && value >= f64::MIN_POSITIVE;
    let mut body = |key: &'static str, mass: f64, moments: [f64; 3]| {
        let passed = healthy(mass) && moments.into_iter().all(healthy);
        if !passed {
            problems.add(
                key,
                (mass, moments),
                "of a mass (kg) and moments of inertia (kg m^2) that are positive and finite numbers",
                "check the units of sizes and densities",
            );
        }
        passed
    };
    let diagonal = |tensor: [[f64; 3]; 3]| [tensor[0][0], tensor[1][1], tensor[2][2]];
    let Body { mass: fuselage, inertia, .. } = mass.fuselage;
    let mut passed = body("fuselage", fuselage, diagonal(inertia));
    for (i, wheel) in mass.wheels.iter().enumerate() {
        if input.wheels[i].is_some() {
            passed &= body(WHEEL_TABLES[i], wheel.mass, [wheel.axial, wheel.transverse, wheel.transverse]);
        }
    }
    if let Some(debris) = mass.debris {
        passed &= body("debris", debris.mass, diagonal(debris.inertia));
    }
    if passed {
        free_inertia(input.fuselage.inertia_kg_m2.is_some(), mass, problems);
    }
}

/// J* resists every change of omega, or the motion is not determined.
fn free_inertia(overridden: bool, mass: &MassProperties, problems: &mut Problems) {
    let finite = mass.inertia.iter().flatten().all(|entry| entry.is_finite()) && mass.total.is_finite();
    if !finite || !is_positive_definite(mass.inertia_free) {
        problems.add(
            if overridden { "fuselage.inertia_kg_m2" } else { "fuselage" },
            mass.inertia_free,
            "such that the spacecraft's inertia with freely turning wheels, J* (the value shown, kg m^2), is positive definite",
            "check the inertia override, and the units of sizes and densities",
        );
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::samples;

    #[test]
    fn a_free_inertia_that_is_not_positive_definite_is_refused() {
        let mut mass = MassProperties::of(&samples::table_two(), 1.0);
        let mut problems = Problems::default();
        free_inertia(false, &mass, &mut problems);
        assert!(problems.0.is_empty());
        mass.inertia_free[2][2] = -1e-9;
        free_inertia(true, &mass, &mut problems);
        assert_eq!(problems.0[0].key, "fuselage.inertia_kg_m2");
        assert!(problems.0[0].to_string().contains("J*"), "{}", problems.0[0]);
    }
}
