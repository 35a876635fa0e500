//! [`notes`]: likely mistakes in the structure of a control loop (numbers: `ensemble::plausibility`).

use super::parameters::{ConditionNumbers, LoopNumbers, PhaseNumbers};
use super::stability::beyond_limit;
use crate::dynamics::effects::{Effect, ForceModel, Form};
use crate::loops::attitude_law::LawSettings;
use crate::loops::declared::limit;
use crate::loops::observes::Observes;
use crate::loops::phase::Next;
use crate::loops::sensor_spec::SensorSpec;
use crate::loops::spec::{LoopSpec, PhaseSpec};
use crate::sampling::SampleId;
use crate::scene::{ControlInput, DeclaredTable, Name, Scene};

/// Relative tolerance for equal times: a sum of two has an error of 1e-16.
const SAME: f64 = 1e-12;
/// See [`crate::loops::LawMaker::notes`].
pub fn notes(spec: &LoopSpec, numbers: &ControlInput, scene: &Scene, duration: f64) -> Vec<String> {
    let phases: Vec<(&PhaseSpec, &DeclaredTable)> = spec.phases.iter().zip(&numbers.guidance).collect();
    let mut notes = order(&spec.phases);
    for (place, (phase, table)) in phases.iter().enumerate() {
        notes.extend(condition(phase, table, duration));
        notes.extend(slew(spec, numbers, (phase, table)));
        notes.extend(stability(spec, numbers, scene, place));
    }
    notes.extend(fast_wheels(spec, scene));
    notes.extend(window(&numbers.law, duration));
    notes.extend(unknown_effects(scene));
    notes.extend(transfers_about_a_point_mass(&phases, scene));
    notes.extend(directions_alone(spec));
    notes
}

/// Sensors of one direction only: the rotation about it is not observed at once.
fn directions_alone(spec: &LoopSpec) -> Option<String> {
    let is_whole = spec.sensors.iter().any(|sensor| matches!(sensor.kind.observes, Observes::Attitude(_)));
    let mut directions = spec
        .sensors
        .iter()
        .filter(|sensor| matches!(sensor.kind.observes, Observes::Direction(_) | Observes::Field(_)));
    let is_alone = directions.next().is_some_and(|first| directions.all(|other| other.kind == first.kind));
    (is_alone && !is_whole && spec.has_filter()).then(|| {
        "control: no sensor measures the whole attitude: the estimate drifts about the direction that is measured"
            .to_owned()
    })
}

/// Effects on the spacecraft that filters and laws do not model.
fn unknown_effects(scene: &Scene) -> Option<String> {
    let is_unknown = |effect: &Effect| match effect {
        // filters know the commands of torque rods
        Effect::MagneticTorque => scene.environment.magnetic_dipole_a_m2.is_some(),
        other => !matches!(other.form(), Form::Translation | Form::Force),
    };
    let unknown: Vec<&str> = ForceModel::of(scene).effects().filter(is_unknown).map(Effect::key).collect();
    let (last, others) = unknown.split_last()?;
    let (listed, word) = match others {
        [] => ((*last).to_owned(), "it acts"),
        _ => (format!("{} and {last}", others.join(", ")), "they act"),
    };
    Some(format!(
        "control: the filters and laws of the loop do not model {listed}: {word} on the spacecraft as a disturbance"
    ))
}

/// Transfers about an oblate body, which guidance takes for a point mass.
fn transfers_about_a_point_mass(phases: &[(&PhaseSpec, &DeclaredTable)], scene: &Scene) -> Option<String> {
    let j2 = scene.orbit.and_then(|orbit| orbit.j2).filter(|j2| *j2 > 0.0)?;
    let (phase, _) = phases.iter().find(|(_, table)| number(table, "transfer_time_s") > 0.0)?;
    Some(format!(
        "guidance.{}: transfers are those of Clohessy & Wiltshire about a point mass; orbit.j2 = {j2:?} acts on both \
        bodies, and is a disturbance to them",
        phase.name
    ))
}

/// A stability window that outlasts the run.
fn window(table: &DeclaredTable, duration: f64) -> Option<String> {
    let LoopNumbers { stability_from: from, stability_window: window, .. } = LoopNumbers::of(table);
    let is_beyond = from + window > duration * (1.0 + SAME) || from > 0.0 && from >= duration;
    is_beyond.then(|| {
        let start = if from > 0.0 { format!("stability_from_s = {from:?}") } else { "the start".to_owned() };
        let last = if window > 0.0 { format!(", stability_window_s = {window:?}") } else { String::new() };
        format!(
            "control: the window of stability from {start}{last} is not over at campaign.duration_s = {duration:?}: \
            relative_performance_error_rms_rad and relative_performance_error_peak_to_peak_rad are null in every run"
        )
    })
}

/// First number of `key`; zero in tables without it.
fn number(table: &DeclaredTable, key: &str) -> f64 {
    table.named(key).map_or(0.0, |numbers| numbers[0])
}

fn is_followed(phase: &PhaseSpec, by: usize) -> bool {
    phase.next == Next::Phase(by) || phase.otherwise == Some(by)
}

/// Phases that follow themselves, form endless cycles, or are unreachable.
fn order(phases: &[PhaseSpec]) -> Vec<String> {
    let grow = |mut set: Vec<bool>, joins: &dyn Fn(usize, &[bool]) -> bool| {
        while let Some(place) = (0..set.len()).find(|place| !set[*place] && joins(*place, &set)) {
            set[place] = true;
        }
        set
    };
    let first = (0..phases.len()).map(|place| place == 0).collect();
    let all = 0..phases.len();
    let reached = grow(first, &|place, set| all.clone().any(|from| set[from] && is_followed(&phases[from], place)));
    let last = phases.iter().map(|phase| !matches!(phase.next, Next::Phase(_))).collect();
    let ends = grow(last, &|place, set| all.clone().any(|next| set[next] && is_followed(&phases[place], next)));
    let mut notes = Vec::new();
    let mut endless = Vec::new();
    for (place, phase) in phases.iter().enumerate() {
        let name = phase.name;
        if !reached[place] {
            notes.push(format!("guidance.{name} is never reached: no phase that is flown is followed by it"));
        } else if is_followed(phase, place) {
            notes.push(format!(
                "guidance.{name} follows itself: it begins anew each time, and so do its law, hold_s and timeout_s; \
                without `until` a phase goes on to the end of the run"
            ));
        } else if !ends[place] {
            endless.push(phase.name.as_str());
        }
    }
    if endless.len() > 1 {
        notes.push(format!(
            "guidance: {} follow one another for ever: from none of them is there a way to \"launch\", or to a phase \
            without `until`",
            endless.join(", ")
        ));
    }
    notes
}

/// Conditions that are never met, always met, or have no time to hold.
fn condition(phase: &PhaseSpec, table: &DeclaredTable, duration: f64) -> Vec<String> {
    let Some(until) = &phase.until else { return Vec::new() };
    let (name, hold, timeout) = (phase.name, ConditionNumbers::of(table).hold, PhaseNumbers::of(table).timeout);
    let mut notes = Vec::new();
    let range = until.range(duration);
    if range == [0.0; 2] && phase.otherwise.is_none() {
        let what = if timeout > 0.0 { "the mission fails at its timeout_s" } else { "the phase never ends" };
        notes.push(format!("guidance.{name}.until = {:?} is never met, whatever the motion: {what}", until.text));
    } else if range == [1.0; 2] && until.asks_for("pointing_error_rad") {
        notes.push(format!(
            "guidance.{name}.until = {:?} is always met: angles are 0 to pi, in radians (5 deg are 0.0873)",
            until.text
        ));
    }
    let limits = [("its timeout_s", limit(timeout)), ("campaign.duration_s", duration)];
    if let Some((name_of_limit, most)) = limits.into_iter().find(|(_, most)| hold > *most) {
        notes.push(format!(
            "guidance.{name}.hold_s = {hold:?} is beyond {name_of_limit} = {most:?}: the condition never holds for so \
            long"
        ));
    }
    notes
}

/// A slew too fast for a star tracker.
fn slew(spec: &LoopSpec, numbers: &ControlInput, (phase, table): (&PhaseSpec, &DeclaredTable)) -> Vec<String> {
    let (name, rate) = (phase.name, number(table, "max_rate_rad_s"));
    let note = |(sensor, table): (&SensorSpec, &DeclaredTable)| {
        let most = number(table, "max_rate_rad_s");
        let is_tracker = matches!(sensor.kind.observes, Observes::Attitude(_)) && !spec.knows_the_truth();
        (is_tracker && most > 0.0 && rate > most).then(|| {
            format!(
                "guidance.{name}.max_rate_rad_s = {rate:?} is above sensors.{}.max_rate_rad_s = {most:?}: the tracker \
                gives nothing in such a slew",
                sensor.name
            )
        })
    };
    spec.sensors.iter().zip(&numbers.sensors).filter_map(note).collect()
}

/// A law with unstable small errors at the loop's period and delay.
fn stability(spec: &LoopSpec, numbers: &ControlInput, scene: &Scene, place: usize) -> Option<String> {
    let (phase, table) = (&spec.phases[place], &numbers.guidance[place]);
    let law = phase.law.as_ref()?;
    // a slew under a torque limit brakes on a curve without a gain at its end
    if number(table, "max_torque_n_m") > 0.0 {
        return None;
    }
    let settings = LawSettings {
        table,
        gyroscopic: phase.gyroscopic,
        period: spec.period,
        delay: LoopNumbers::of(&numbers.law).delay,
        sample: SampleId(0),
    };
    let beyond = beyond_limit((spec, place), (&spec.believed(scene), scene), &law.make(&settings), settings.delay)?;
    Some(format!("guidance.{}: {beyond}", phase.name))
}

/// Wheels above their speed limit at the start.
fn fast_wheels(spec: &LoopSpec, scene: &Scene) -> Vec<String> {
    let wheels = spec.wheel_names.iter().enumerate();
    let note = |(place, name): (usize, &Name)| {
        let (rate, limit) = (scene.initial.wheel_rates[place], scene.actuators.wheels[place].speed_limit);
        (rate.abs() > limit).then(|| {
            format!(
                "wheels.{name}.rate_rad_s = {rate:?} is above its speed_limit_rad_s = {limit:?} at the start: its \
                motor can only brake it"
            )
        })
    };
    wheels.filter_map(note).collect()
}
