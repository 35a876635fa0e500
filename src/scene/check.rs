//! What makes a scene physical: every refusal, by key and number.
//!
//! `written` checks what a person wrote, `derived` what follows from it (masses and inertias that overflow, vanish or are
//! not positive definite). Both only gather problems, so that one look at an input finds them all.

use super::error::Problems;
use super::input::{ActuationInput, DebrisShape, FuselageInput, InitialInput, SceneInput, WheelInput, WheelMode};
use super::mass::{Body, MassProperties};
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
        match debris.shape {
            DebrisShape::Cube { side_m } => {
                problems.positive("debris.side_m", side_m);
            }
            DebrisShape::Box { size_m } => {
                if problems.all_finite("debris.size_m", size_m) && size_m.iter().any(|&side| side <= 0.0) {
                    problems.add("debris.size_m", size_m, "above zero, each", "write positive sides");
                }
            }
        }
        problems.positive("debris.density_kg_m3", debris.density_kg_m3);
    }
    initial(input, &input.initial, problems);
    actuation(input, problems);
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

fn actuation(input: &SceneInput, problems: &mut Problems) {
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
