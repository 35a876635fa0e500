//! [`implausible`]: numbers that can be computed with, and look like a mistake: degrees for radians, revolutions per minute for radians per
//! second, percent for fractions, grams for kilograms.
//!
//! Each note says key and value, what is usual, and how to write the unit. Nothing is refused: other scales are allowed.

use std::f64::consts::TAU;

use crate::campaign::{Plan, SceneDraws};
use crate::control::capacity::Capacity;
use crate::math::vector::norm;
use crate::observables::Group;
use crate::observables::request::{NutationAxis, nearest_principal_axis};
use crate::sampling::SampleId;
use crate::sampling::keys::{Value, Written};
use crate::scene::{Parameter, Scene, SceneInput, WheelMode};
use crate::statistics::quantile::quantile;

/// Most draws that are looked at.
const DRAWS: u64 = 1000;
/// The fraction of the draws that may be beyond a limit.
const FEW: f64 = 0.01;
/// A rate of a wheel from which on it is noted, rad/s: 12,000 rpm. Reaction wheels have up to 6,000.
const FAST_WHEEL: f64 = 12_000.0 * TAU / 60.0;
/// A mass of the spacecraft from which on it is noted, kg. The largest satellites have some tons.
const HEAVY: f64 = 3000.0;
/// How far the principal axis may be off s3 without a note, degrees.
const OBLIQUE_DEG: f64 = 0.1;
/// A duration from which on it is noted, s: ten years of 365.25 days.
const LONG: f64 = 10.0 * YEAR;
/// A year of 365.25 days, s.
const YEAR: f64 = 365.25 * 86_400.0;
/// More observation points than these nobody asks for.
const MANY_POINTS: f64 = 1e7;
/// A relative spread from which on it is noted.
const WIDE: f64 = 0.5;

/// A key with the length of its value from which on it is noted, SI; the factor to and the name of the unit in which people know it, and what is usual.
type Row = (&'static str, f64, f64, &'static str, &'static str);

/// What is noted by its key alone.
const TABLE: &[Row] = &[
    (
        "angular_velocity_rad_s",
        1.0,
        360.0 / TAU,
        "deg/s",
        "usual values are below 0.1 rad/s, or a few turns a minute for a spinning body; degrees are written with their unit, \"30 deg/s\"",
    ),
    (
        "debris_relative_angular_velocity_rad_s",
        1.0,
        360.0 / TAU,
        "deg/s",
        "tumbling debris turns at most some tenths of a radian a second; degrees are written with their unit, \"30 deg/s\"",
    ),
    (
        "rate_rad_s",
        FAST_WHEEL,
        60.0 / TAU,
        "rpm",
        "usual values are up to 6000 rpm; revolutions are written with their unit, \"3000 rpm\"",
    ),
    (
        "tilt_rad",
        0.1,
        360.0 / TAU,
        "deg",
        "usual values are below 0.02 rad; degrees are written with their unit, \"0.1 deg\"",
    ),
    (
        "angle_rad",
        TAU,
        360.0 / TAU,
        "deg",
        "usual values are 0 to 2 pi; degrees are written with their unit, \"30 deg\"",
    ),
];

/// The numbers of `plan` that look like a mistake, a sentence each.
pub fn implausible(plan: &Plan) -> Vec<String> {
    let mut notes = sizes(plan);
    notes.extend(driven_wheels(&plan.nominal));
    notes.extend(mass(&plan.nominal));
    notes.extend(plan.dispersed.iter().flat_map(|dispersion| {
        let name = dispersion.parameter.name();
        wide_spreads(&dispersion.distribution.written).into_iter().map(move |spread| {
            format!("{name}, {spread}: a spread of half the nominal value or more; percentages are written with their unit, \"2 %\"")
        })
    }));
    notes.extend(nutation(plan));
    notes.extend(coarse_grid(plan));
    if let (Some(spec), Ok(scene)) = (plan.law.as_ref().and_then(|law| law.spec()), Scene::resolve(&plan.nominal)) {
        notes.extend(Capacity::of(spec, &scene).notes(spec));
    }
    let duration = plan.grid.duration();
    if duration >= LONG {
        let years = digits(duration / YEAR);
        let note = format!(
            "campaign.duration_s = {}: that is {years} years; usual durations are seconds to days",
            digits(duration)
        );
        notes.insert(0, note);
    }
    let late = plan.nominal.actuation.iter().position(|arc| arc.start_s >= duration);
    notes.extend(late.map(|arc| {
        format!(
            "actuation[{arc}].start_s = {:?}: it starts at the end of the run or later (campaign.duration_s = {duration:?})",
            plan.nominal.actuation[arc].start_s
        )
    }));
    notes
}

/// That nutation about s3 has a part that is no motion: the principal axis is another one.
fn nutation(plan: &Plan) -> Option<String> {
    if !plan.groups.contains(&Group::Motion) || plan.nutation_axis != NutationAxis::SpinAxis {
        return None;
    }
    let inertia = Scene::resolve(&plan.nominal).ok()?.mass.inertia;
    let [x, y, z] = nearest_principal_axis(inertia);
    let angle = libm::atan2(libm::hypot(x, y), z).to_degrees();
    (angle > OBLIQUE_DEG).then(|| {
        format!(
            "the principal axis is {} deg off s3: a steady spin about it has that nutation angle; observe.nutation_axis = \"principal\" measures from the axis itself",
            digits(angle)
        )
    })
}

/// That extremes between the observation points are missed: the body turns half a turn or more from one to the next.
fn coarse_grid(plan: &Plan) -> Option<String> {
    let step = plan.grid.duration() / (plan.grid.points().max(2) - 1) as f64;
    let rate = norm(plan.nominal.initial.angular_velocity_rad_s);
    let turn = rate * step;
    (turn >= core::f64::consts::PI).then(|| {
        let enough = libm::ceil(rate * plan.grid.duration() / core::f64::consts::PI * 4.0) + 1.0;
        let remedy = match enough < MANY_POINTS {
            true => format!("{enough} points see an eighth of a turn"),
            false => "no number of points is enough for so many turns".to_owned(),
        };
        format!(
            "observe.points = {}: the body makes {} turns from one point to the next, and extremes in between are missed; {remedy}",
            plan.grid.points(),
            digits(turn / TAU)
        )
    })
}

/// The rows of the table, of the nominal scene or as they are dispersed.
fn sizes(plan: &Plan) -> Vec<String> {
    let scene = &plan.nominal;
    let row_of = |parameter: Parameter| TABLE.iter().find(|row| row.0 == parameter.facts().key);
    let size = |parameter: Parameter, scene: &SceneInput| {
        (0..parameter.width()).filter_map(|component| parameter.value(scene, component)).fold(0.0, libm::hypot)
    };
    let judged = Parameter::all(scene).filter(|parameter| parameter.exists(scene));
    let judged: Vec<(Parameter, &Row)> = judged.filter_map(|parameter| Some((parameter, row_of(parameter)?))).collect();
    let mut draws = SceneDraws::new(plan);
    let mut drawn: Vec<Vec<f64>> = vec![Vec::new(); judged.len()];
    for sample in 1..plan.samples.min(DRAWS + 1) {
        let input = draws.input(SampleId(sample));
        judged.iter().zip(&mut drawn).for_each(|((parameter, _), sizes)| sizes.push(size(*parameter, input)));
    }
    let note = |((parameter, row), mut sizes): (&(Parameter, &Row), Vec<f64>)| {
        let (_, limit, factor, unit, usual) = **row;
        sizes.sort_by(f64::total_cmp);
        let nominal = size(*parameter, scene);
        let large = quantile(&sizes, 1.0 - FEW).filter(|size| *size >= limit);
        let (found, how) = if nominal >= limit { (nominal, "") } else { (large?, ", as dispersed, in 1 draw of 100") };
        let known = digits(found * factor);
        Some(format!("{}{how}: {} {} is {known} {unit}; {usual}", parameter.name(), digits(found), parameter.unit()))
    };
    judged.iter().zip(drawn).filter_map(note).collect()
}

/// Wheels that are slower at the start, and which the torques of the schedule bring to a rate that is noted.
fn driven_wheels(input: &SceneInput) -> Vec<String> {
    let Ok(scene) = Scene::resolve(input) else { return Vec::new() };
    let turning = input.wheels.iter().filter(|wheel| wheel.mode != WheelMode::Locked);
    let note = |(place, wheel): (usize, &crate::scene::WheelInput)| {
        let (mut rate, mut most) = (wheel.rate_rad_s, 0.0_f64);
        for arc in &scene.schedule {
            rate += arc.applied.motor_torque[place] * (arc.end() - arc.start) / scene.mass.wheels[place].axial;
            most = most.max(rate.abs());
        }
        (most >= FAST_WHEEL && wheel.rate_rad_s.abs() < FAST_WHEEL).then(|| {
            let rpm = digits(most * 60.0 / TAU);
            format!(
                "wheels.{}: the torques of [[actuation]] bring it to about {rpm} rpm; usual values are up to 6000 rpm",
                wheel.name
            )
        })
    };
    turning.enumerate().filter_map(note).collect()
}

fn mass(input: &SceneInput) -> Option<String> {
    let mass = Scene::resolve(input).ok()?.mass.total;
    (mass >= HEAVY).then(|| {
        format!(
            "the spacecraft has a mass of {} kg; usual values are 1 kg to some tons: check densities and sizes; grams and millimetres are written with their unit, \"50 g\", \"20 mm\"",
            digits(mass)
        )
    })
}

/// The keys of a distribution that are a spread relative to the nominal value, of [`WIDE`] and more; those of a distribution within it too.
fn wide_spreads(written: &Written) -> Vec<String> {
    let wide = |(key, value): (&str, &Value)| match value {
        Value::Distribution(_, within) => wide_spreads(within),
        Value::Numbers(values)
            if key.starts_with("relative_") && values.numbers().iter().any(|number| number.abs() >= WIDE) =>
        {
            vec![format!("{key} = {}", values.text())]
        }
        _ => Vec::new(),
    };
    written.entries().flat_map(wide).collect()
}

/// A number with four significant digits.
fn digits(value: f64) -> String {
    let rounded: f64 = format!("{value:.3e}").parse().unwrap_or(value);
    if (1e-3..1e7).contains(&rounded.abs()) || rounded == 0.0 { format!("{rounded}") } else { format!("{rounded:e}") }
}
