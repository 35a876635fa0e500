//! What makes a scene physical beyond the limits of single keys, which [`super::schema`] states.
//!
//! `written` checks what was written, `derived` what follows from it (masses and inertias that overflow, vanish or are
//! not positive definite). Both only collect problems, so that one check of an input finds them all.

use super::error::Problems;
use super::input::SceneInput;
use super::mass::{Body, MassProperties};
use super::schedule::applied;
use super::schema::{FuselageInput, WheelMode, limit::shown};
use super::table::Table;
use crate::math::symmetric::is_positive_definite;

/// Collects what is wrong with the numbers as written.
pub(super) fn written(input: &SceneInput, problems: &mut Problems) {
    let has_debris = input.debris.is_some();
    input.fuselage.check_all(problems);
    geometry(&input.fuselage, problems);
    for (instance, wheel) in input.wheels.iter().enumerate() {
        if let Some(wheel) = wheel {
            wheel.check(has_debris, problems, |key| format!("{}.{key}", Table::Wheel.headers()[instance]).into());
        }
    }
    if let Some(debris) = &input.debris {
        debris.check(problems);
    }
    input.initial.check(has_debris, problems, |key| format!("initial.{key}").into());
    input.environment.check(has_debris, problems, |key| format!("environment.{key}").into());
    if input.actuation.is_empty() {
        return;
    }
    let before = problems.0.len();
    arcs(input, problems);
    input.actuators.check(has_debris, problems, |key| format!("actuators.{key}").into());
    if problems.0.len() == before {
        switches(input, problems);
    }
}

/// Collects what keeps the walls of the fuselage from enclosing a volume.
fn geometry(fuselage: &FuselageInput, problems: &mut Problems) {
    let (wall, radius, length) = (fuselage.wall_thickness_m, fuselage.outer_radius_m, fuselage.length_m);
    let passed = |value: f64| value.is_finite() && value > 0.0;
    const KEY: &str = "fuselage.wall_thickness_m";
    if passed(wall) && passed(radius) && wall >= radius {
        let allowed = format!("below fuselage.outer_radius_m = {radius:?}");
        problems.add(KEY, shown(&[wall]), allowed, "make the wall thinner or the radius larger");
    }
    if passed(wall) && passed(length) && 2.0 * wall >= length {
        let allowed = format!("below half of fuselage.length_m = {length:?}");
        problems.add(KEY, shown(&[wall]), allowed, "make the end plates thinner or the fuselage longer");
    }
}

/// Collects what is wrong with the schedule.
fn arcs(input: &SceneInput, problems: &mut Problems) {
    let mut previous_end = 0.0;
    for (i, arc) in input.actuation.iter().enumerate() {
        let before = problems.0.len();
        let key = |name: &str| format!("actuation[{i}].{name}");
        arc.check(false, problems, |name| key(name).into());
        if problems.0.len() > before {
            continue;
        }
        if arc.start_s < previous_end {
            let (allowed, remedy) = if i == 0 {
                ("zero or later".to_owned(), "a run starts at time zero")
            } else {
                let allowed = format!("no earlier than actuation[{}].end_s = {previous_end:?}", i - 1);
                (allowed, "put the arcs in order, not overlapping")
            };
            problems.add(key("start_s"), shown(&[arc.start_s]), allowed, remedy);
        }
        if arc.end_s <= arc.start_s {
            let allowed = format!("later than its start_s = {:?}", arc.start_s);
            problems.add(key("end_s"), shown(&[arc.end_s]), allowed, "end the arc after its start, or leave it out");
        }
        previous_end = arc.end_s.max(previous_end);
        torques(input, i, problems);
    }
}

/// Collects the motor torques of arc `index` on wheels that take none.
fn torques(input: &SceneInput, index: usize, problems: &mut Problems) {
    let torque_n_m = input.actuation[index].torque_n_m;
    for (wheel, header) in Table::Wheel.headers().iter().enumerate().filter(|(wheel, _)| torque_n_m[*wheel] != 0.0) {
        let (allowed, remedy) = match input.wheels[wheel].map(|wheel| wheel.mode) {
            Some(WheelMode::Free) => continue,
            Some(WheelMode::SpeedHeld) => (
                format!("zero for {header}, whose speed its motor holds"),
                "set that torque to zero, or the wheel's wheel_mode to \"free\"",
            ),
            None => (
                format!("zero for {header}, which this spacecraft does not have"),
                "set that torque to zero or describe the wheel",
            ),
        };
        problems.add(format!("actuation[{index}].torque_n_m"), shown(&torque_n_m), allowed, remedy);
    }
}

/// Collects where delays make arcs end before they start, or overlap. Only the first is reported: the delays are common to
/// all.
fn switches(input: &SceneInput, problems: &mut Problems) {
    let delays = &input.actuators;
    let commanded = |index: usize| {
        let command = &input.actuation[index];
        format!("such that actuation[{index}], commanded from {:?} to {:?},", command.start_s, command.end_s)
    };
    for index in 0..input.actuation.len() {
        let arc = applied(input, index);
        let next = (index + 1 < input.actuation.len()).then(|| applied(input, index + 1).start);
        let allowed = if arc.end() <= arc.start {
            format!("{} ends after it starts", commanded(index))
        } else if next.is_some_and(|next| arc.end() > next) {
            format!("{} ends before the next starts", commanded(index))
        } else {
            continue;
        };
        let written = format!("{:?}", (delays.switch_on_delay_s, delays.switch_off_delay_s));
        let remedy = "make the delays (on, off) smaller, or nearer to each other";
        problems.add("actuators.switch_off_delay_s", written, allowed, remedy);
        return;
    }
}

/// Collects what is wrong with what follows from an input whose numbers all passed.
pub(super) fn derived(input: &SceneInput, mass: &MassProperties, problems: &mut Problems) {
    let is_normal = |value: f64| value.is_finite() && value >= f64::MIN_POSITIVE;
    let mut body = |key: &'static str, mass: f64, moments: [f64; 3]| {
        let passed = is_normal(mass) && moments.into_iter().all(is_normal);
        if !passed {
            problems.add(
                key,
                format!("{:?}", (mass, moments)),
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
            passed &= body(Table::Wheel.headers()[i], wheel.mass, [wheel.axial, wheel.transverse, wheel.transverse]);
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
            format!("{:?}", mass.inertia_free),
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
