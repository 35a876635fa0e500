//! `spindrift check`: what a campaign would run.

use std::fmt::Write as _;

use crate::analysis::observed::Observed;
use crate::analysis::part_columns::RowNames;
use crate::campaign::{Plan, failed_device};
use crate::cli::arguments::CheckOptions;
use crate::cli::command_outcome::{CommandOutcome, Failure};
use crate::cli::{completed_text, dispersions, scene_text, screen};
use crate::control::capacity::Capacity;
use crate::control::laws::asked;
use crate::ensemble::Ensemble;
use crate::ensemble::influence;
use crate::ensemble::plausibility::implausible;
use crate::ensemble::probe::{AuditProbe, LongRun, RunProbe, part_of_run};
use crate::ensemble::run_cost::parts;
use crate::ensemble::undefined;
use crate::findings::loss;
use crate::findings::number::{brief, bytes, counted, short, trimmed};
use crate::math::Isa;
use crate::observables::{Group, Request};
use crate::ode::{PACE_STEPS, is_out_of_reach};
use crate::report::screen::reason_lines;
use crate::run::{StateField, Status};
use crate::scene::{Scene, WheelMode};
use crate::storage::rows_file;
use crate::table::wrapped::wrapped;
use crate::workflow::isa;
use crate::workflow::source::plan;
use crate::workflow::workload::Workload;

/// Runs the command.
///
/// # Errors
/// Where the campaign file is wrong.
pub fn run(options: &CheckOptions) -> Result<CommandOutcome, Failure> {
    let plan = plan(&options.file, options.changed.overrides())?;
    let (text, outcome) = text(&plan, isa()?, options.verbose)?;
    screen::print(&text)?;
    if options.plan {
        // as it is in a file
        screen::print(&format!("\n== Plan (hash {})\n{}", plan.hash(), plan.text()))?;
    }
    Ok(outcome)
}

/// What `plan` would run, on one screen or with all that is known, and how the command ends.
///
/// # Errors
/// Where its nominal scene is not physical.
pub fn text(plan: &Plan, isa: Isa, is_verbose: bool) -> Result<(String, CommandOutcome), Failure> {
    asked::refuse_unanswered(plan.loop_spec()).map_err(Failure::Input)?;
    let ensemble = Ensemble::new(plan, isa);
    let scene = Scene::resolve(&plan.nominal)
        .map_err(|errors| Failure::Input(errors.iter().map(|error| format!("{error}\n")).collect()))?;
    let probe = RunProbe::new(&ensemble);
    let mut text = summary(plan);
    if probe.is_hopeless() {
        text += &failures(plan, &probe);
    }
    let written = (|| {
        let unseen = influence::notes(plan, ensemble.isa());
        let undefined =
            undefined::notes(plan, ensemble.isa()).into_iter().chain(undefined_observables(&ensemble, &probe));
        let notes: Vec<String> =
            plan.notes().into_iter().chain(implausible(plan)).chain(unseen).chain(undefined).collect();
        if !notes.is_empty() {
            section(&mut text, "Notes")?;
        }
        notes.iter().try_for_each(|note| writeln!(text, "{note}"))?;
        text += &estimate(&ensemble, &probe);
        text += &audit_estimate(&ensemble);
        section(&mut text, "Dispersions")?;
        if is_verbose {
            dispersions::table(&mut text, plan)?;
            section(&mut text, "Mass properties of the nominal scene")?;
            scene_text::masses(&mut text, &plan.nominal, &scene.mass)?;
            section(&mut text, "Momenta and torques of the nominal scene")?;
            scene_text::momenta(&mut text, &plan.nominal, &scene, &plan.analysis.display)?;
        } else {
            dispersions::list(&mut text, plan)?;
            section(&mut text, "Nominal scene")?;
            writeln!(text, "{}", scene_text::in_short(&scene))?;
        }
        writeln!(text, "{}", scene_text::attitude(&plan.nominal.initial))?;
        if let Some(spec) = plan.loop_spec() {
            if is_verbose {
                section(&mut text, "Torque of the control loop")?;
            }
            Capacity::of(spec, &scene).lines(spec).iter().try_for_each(|line| writeln!(text, "{line}"))?;
        }
        happenings(&mut text, plan)?;
        if is_verbose {
            computed(&mut text, &ensemble)?;
        } else {
            writeln!(text, "\n{MORE}")?;
        }
        std::fmt::Result::Ok(())
    })();
    written.map_err(Failure::files)?;
    let failed = probe.failed() as u64;
    let outcome = if probe.is_hopeless() { CommandOutcome::SomeFailed(failed) } else { CommandOutcome::Done };
    Ok((wrapped(&text, screen::width()), outcome))
}

/// The observables of the file that are not a number in runs that the probe has made, a sentence each.
fn undefined_observables(ensemble: &Ensemble<'_>, probe: &RunProbe) -> Vec<String> {
    let (plan, names, statuses) = (ensemble.plan(), RowNames::new(ensemble), probe.rows.statuses());
    let own = plan.analysis.derived.iter().map(|derived| derived.name.as_str());
    let note = |observed: Observed| {
        let undefined = observed.undefined(&names.of(&probe.rows)).ok()?;
        let rows = (0..undefined.len()).filter(|row| undefined[*row] && statuses[*row] == Status::Done);
        let rows: Vec<usize> = rows.collect();
        let first = probe.rows.samples()[*rows.first()?];
        Some(format!(
            "[[observable]] {}: it is not a number in {} of the first {} samples, first in sample {first}: it is null \
             there, and leaves a requirement undecided",
            observed.quantity.name(),
            rows.len(),
            probe.count(),
        ))
    };
    Observed::named(plan, own).into_iter().filter_map(note).collect()
}

/// Reasons of failures that are listed.
const MOST_REASONS: usize = 8;
/// How to see what the screen leaves out.
const MORE: &str = "--verbose: percentiles, masses, momenta, what is integrated; --plan: every key";

/// What the campaign asks, and what it runs.
fn summary(plan: &Plan) -> String {
    let steps = match plan.step_s {
        Some(step) => format!("steps of {} s", trimmed(step, 6)),
        None => format!("tolerance {:e}", plan.tolerance.relative),
    };
    let (rows, seconds) = (counted(plan.rows(), "run"), trimmed(plan.grid.duration(), 6));
    let requirements = match plan.analysis.requirements.len() {
        0 => "no requirement".to_owned(),
        count => counted(count, "requirement"),
    };
    format!(
        "{}{}: {rows} of {seconds} s, method {}, {steps}, {requirements}\n",
        completed_text::question(plan.description.as_deref()),
        plan.name,
        plan.method.name(),
    )
}

/// What the probe found where runs failed: how many, and why.
fn failures(plan: &Plan, probe: &RunProbe) -> String {
    let (failed, count) = (probe.failed(), probe.count());
    let lost = match plan.analysis.requirements.len() {
        0 => "there would be no statistics",
        1 => "there would be no statistics, and the requirement would fail",
        _ => "there would be no statistics, and the requirements would fail",
    };
    let head = if probe.is_hopeless() { format!("EVERY RUN FAILS: {lost}\n") } else { String::new() };
    format!(
        "{head}{failed} of the first {} failed:\n{}",
        counted(count, "run"),
        reason_lines(loss::reasons(&probe.reasons(), count as u64).iter(), MOST_REASONS, usize::MAX)
    )
}

fn section(text: &mut String, title: &str) -> std::fmt::Result {
    let gap = if text.is_empty() { "" } else { "\n" };
    writeln!(text, "{gap}== {title}")
}

/// Which devices fail and when, and what runs are watched for.
fn happenings(text: &mut String, plan: &Plan) -> std::fmt::Result {
    if !plan.nominal.failures.is_empty() {
        section(text, "Failures of the nominal scene")?;
    }
    for failure in &plan.nominal.failures {
        let (name, at) = (failure.name, failure.at_s);
        let device = failed_device(&plan.nominal, failure.device);
        let end = plan.grid.duration();
        let unseen = if at < end { "" } else { ": not before the end" };
        writeln!(text, "{name}: {device} at {at} s{unseen}")?;
    }
    if plan.events.is_empty() && plan.extremes.is_empty() {
        return Ok(());
    }
    section(text, if plan.extremes.is_empty() { "Events" } else { "Events and extremes" })?;
    for event in &plan.events {
        let ends = if event.ends_run { "; the run ends there" } else { "" };
        writeln!(text, "{}: {}{ends}", event.name, event.says())?;
    }
    for extreme in &plan.extremes {
        writeln!(text, "{}: {}", extreme.name, extreme.says())?;
    }
    let (points, spacing) = (plan.grid.points(), plan.grid.duration() / (plan.grid.points() - 1) as f64);
    let spacing = trimmed(spacing, 6);
    writeln!(
        text,
        "seen at {points} points, {spacing} s apart: two crossings between neighbouring points are not seen \
        (observe.points)"
    )
}

/// What is integrated and why, and what is not; nothing of what scene and method do not have.
fn computed(text: &mut String, ensemble: &Ensemble<'_>) -> std::fmt::Result {
    section(text, "What is computed")?;
    let reasons = ensemble.request().reasons();
    for field in StateField::ALL.into_iter().filter(|field| has(ensemble.request(), *field)) {
        match reasons.iter().find(|(needed, _)| *needed == field) {
            Some((_, reason)) => writeln!(text, "{}: needed by {reason}", field_name(field))?,
            None => writeln!(text, "{}: not computed: no requested observable needs it", field_name(field))?,
        }
    }
    let scene = &ensemble.plan().nominal;
    let acting = ensemble.request().actuated;
    let is_held = scene.wheels.iter().any(|wheel| wheel.mode == WheelMode::SpeedHeld);
    for (term, exists, scheduled, held) in [
        ("thrust", !scene.thrusters.is_empty(), acting.thrusters, false),
        ("wheel motors", !scene.turning_wheels().is_empty(), acting.motors, is_held),
    ] {
        let why = match (scheduled, held) {
            (true, true) => "needed to hold the speed of wheels",
            (true, false) => "needed by the schedule",
            _ => "not computed: no command of the schedule acts",
        };
        if exists {
            writeln!(text, "{term}: {why}")?;
        }
    }
    let columns = ensemble.request().columns();
    let has_columns = |group: &&Group| columns.iter().any(|column| column.group == **group);
    let (with, without): (Vec<&Group>, Vec<&Group>) = ensemble.plan().groups.iter().partition(has_columns);
    let names = |groups: Vec<&Group>| groups.iter().map(|group| group.name()).collect::<Vec<_>>().join(", ");
    writeln!(text, "observed groups: {}", names(with))?;
    if !without.is_empty() {
        writeln!(text, "groups without columns in such scenes: {}", names(without))?;
    }
    Ok(())
}

/// Whether scenes and method of the request have a field.
fn has(request: &Request, field: StateField) -> bool {
    match field {
        StateField::DebrisPosition
        | StateField::DebrisVelocity
        | StateField::DebrisAttitude
        | StateField::DebrisRate => request.debris,
        StateField::WheelRates | StateField::WheelAngles => !request.wheels.is_empty(),
        StateField::Work => request.actuated.any(),
        StateField::Impulse => request.actuated.thrusters,
        StateField::AngularImpulse => request.actuated.external(),
        StateField::Dcm | StateField::Residuals | StateField::KineticEnergies => request.constrained,
        StateField::Rate | StateField::Attitude | StateField::ComPosition | StateField::ComVelocity => true,
    }
}

fn field_name(field: StateField) -> &'static str {
    match field {
        StateField::Rate => "angular velocity of the body",
        StateField::Attitude => "attitude quaternion",
        StateField::WheelRates => "wheel rates",
        StateField::WheelAngles => "wheel angles",
        StateField::ComPosition => "position of the centre of mass",
        StateField::ComVelocity => "velocity of the centre of mass",
        StateField::Work => "work of actuators and torques on the body",
        StateField::Impulse => "impulse of the thrusters",
        StateField::AngularImpulse => "angular impulse of thrusters and torques on the body",
        StateField::DebrisPosition => "position of the debris",
        StateField::DebrisVelocity => "velocity of the debris",
        StateField::DebrisAttitude => "attitude of the debris",
        StateField::DebrisRate => "angular velocity of the debris",
        StateField::Dcm => "direction cosine matrix (null_space method)",
        StateField::Residuals => "constraint residuals (null_space method)",
        StateField::KineticEnergies => "kinetic energies of the redundant states (null_space method)",
    }
}

/// Time, from a probe of the first samples; disk space and memory.
fn estimate(ensemble: &Ensemble<'_>, probe: &RunProbe) -> String {
    let plan = ensemble.plan();
    let count = probe.count();
    if let Some(LongRun { sample, reached }) = probe.too_long {
        let duration = plan.grid.duration();
        let end = if is_out_of_reach(plan.max_steps, reached, duration) {
            format!(
                "; at that pace integrator.max_steps ({}) does not suffice; {}",
                plan.max_steps,
                loss::remedy(Status::StepLimit).unwrap_or_default()
            )
        } else {
            String::new()
        };
        return format!(
            "\n== Estimate\ntime and disk space cannot be estimated: sample {sample} needs more than {PACE_STEPS} \
            steps, which lead to {} s of {} s{end}\n",
            trimmed(reached, 6),
            trimmed(duration, 6)
        );
    }
    let failed = if probe.failed() == 0 || probe.is_hopeless() { String::new() } else { failures(plan, probe) };
    let parts = parts(plan, ensemble.isa()).count();
    let work = Workload::of_campaign((ensemble, plan.rows()), None, None, None);
    let cores = cores();
    let looks = match plan.looks()[..] {
        [_, .., most] => format!(" (the first look of [stop], which may go on to {most})"),
        _ => String::new(),
    };
    format!(
        "\n== Estimate, from {}{}\n\
         {} ms per run on one core; {}{looks} on {}: about {} s\n\
         {}; {} of rows, page and tables: about {}; memory: at most {}\n\
         {failed}",
        part_of_run(plan).map_or(String::new(), |part| format!("the first {} s of ", trimmed(part, 6))),
        counted(count, "run"),
        brief(probe.seconds * 1e3),
        counted(plan.rows(), "sample"),
        counted(cores, "core"),
        brief(probe.seconds * plan.rows() as f64 / cores as f64),
        counted(rows_file::columns(ensemble).len(), "column"),
        counted(parts, "file"),
        bytes(work.disk as u64),
        bytes(work.memory as u64),
    )
}

/// Time of the audits, extrapolated from a probe of the first samples.
fn audit_estimate(ensemble: &Ensemble<'_>) -> String {
    let plan = ensemble.plan();
    if plan.audit_fraction == 0.0 {
        return "no audit (--audit 0.01 compares one run in a hundred with a reference solution)\n".to_owned();
    }
    let AuditProbe { seconds, count } = match AuditProbe::new(ensemble) {
        Ok(probe) => probe,
        Err(sample) => {
            return format!(
                "the time of audits cannot be estimated: that of sample {sample} needs more than {PACE_STEPS} steps\n"
            );
        }
    };
    let audits = plan.audit_fraction * plan.rows() as f64;
    let cores = cores();
    format!(
        "audit of {} of the samples, from {}: {:.1} ms each; about {} audits on {}: {} s more\n",
        if plan.audit_fraction == 1.0 { "all".to_owned() } else { short(plan.audit_fraction) },
        counted(count, "audit"),
        seconds * 1e3,
        short(libm::round(audits)),
        counted(cores, "core"),
        short(seconds * audits / cores as f64),
    )
}

fn cores() -> usize {
    std::thread::available_parallelism().map_or(1, std::num::NonZeroUsize::get)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::campaign::Overrides;

    /// Law: `check` says at how many points events are looked for, and the time between neighbouring ones, which is
    /// that of the grid.
    #[test]
    fn the_points_of_events_are_those_of_the_grid() {
        let event =
            "\n[[event]]\nname = \"tipped\"\nquantity = \"spin_axis_angle_rad\"\nvalue = 0.7\nends_run = true\n";
        let text = include_str!("../../campaigns/spin_sweep.toml").to_owned() + event;
        for points in [3, 6, 101] {
            let text = text.replace("points = 101", &format!("points = {points}"));
            let plan = Plan::from_text("spin_sweep", &text, Overrides::default()).expect("valid");
            let times = plan.grid.times();
            let mut said = String::new();
            happenings(&mut said, &plan).expect("text");
            let known = format!("seen at {points} points, {} s apart:", trimmed(times[1] - times[0], 6));
            assert!(times.len() == points && said.contains(&known), "{known} {said}");
        }
    }
}
