//! A preview of a campaign: question, cost, dispersions, nominal scene and integrated states.

use crate::campaign::{Plan, failed_device};
use crate::ensemble::Ensemble;
use crate::ensemble::probe::{AuditProbe, LongRun, RunProbe, part_of_run};
use crate::ensemble::run_cost::campaign_seconds;
use crate::findings::finding::{Finding, Kind};
use crate::findings::number::{brief, bytes, counted, duration, short, trimmed};
use crate::findings::{dispersions, loss, scene};
use crate::loops::ControlLaw;
use crate::observables::{Group, Request};
use crate::ode::{PACE_STEPS, is_out_of_reach};
use crate::run::{StateField, Status};
use crate::scene::{Scene, WheelMode};

#[derive(Debug)]
pub struct Probed<'p> {
    pub ensemble: &'p Ensemble<'p>,
    pub scene: Scene,
    pub runs: RunProbe,
    /// Probe of their audits, or the sample whose audit takes too long; `None` without audits.
    pub audits: Option<Result<AuditProbe, crate::sampling::SampleId>>,
    /// Suggested corrections to the file, one sentence each.
    pub notes: Vec<String>,
    /// Number of row files and of their columns.
    pub files: [u64; 2],
    /// Disk space and memory, bytes.
    pub needs: [f64; 2],
    pub cores: usize,
}

const MOST_REASONS: usize = 8;
/// Points to the details that a screen omits.
const MORE: &str = "--verbose: percentiles, masses, momenta, what is integrated; --plan: every key";

fn about(title: &str, sentence: String) -> Finding {
    Finding::new(Kind::Note, "check", title, sentence)
}

/// All findings, or the subset that fits a screen; titles name the sections.
pub fn findings(probed: &Probed<'_>, is_verbose: bool) -> Vec<Finding> {
    let plan = probed.ensemble.plan();
    let mut list = vec![about("", summary(plan))];
    if probed.runs.is_hopeless() {
        list.extend(failures("", plan, &probed.runs));
    }
    list.extend(probed.notes.iter().map(|note| about("Notes", note.clone())));
    list.extend(estimate(probed));
    let nominal = if is_verbose {
        list.extend(dispersions::drawn(plan));
        list.extend(scene::masses(&plan.nominal, &probed.scene.mass));
        list.extend(scene::momenta(&plan.nominal, &probed.scene, &plan.analysis.display));
        "Start of the nominal scene"
    } else {
        list.extend(dispersions::list(plan));
        list.push(about("Nominal scene", scene::in_short(&probed.scene)));
        "Nominal scene"
    };
    list.push(about(nominal, scene::attitude(&plan.nominal.initial)));
    let of_law = |law: &ControlLaw| Some(law.maker().capacity(&probed.scene)?.lines(law.spec()?));
    let capacity = plan.law.as_ref().and_then(of_law);
    list.extend(capacity.into_iter().flatten().map(|line| about(nominal, line)));
    list.extend(happenings(plan));
    if is_verbose {
        list.extend(computed(probed.ensemble));
    } else {
        list.push(about("", MORE.to_owned()));
    }
    list
}

fn summary(plan: &Plan) -> String {
    let steps = match plan.step_s {
        Some(step) => format!("steps of {} s", trimmed(step, 6)),
        None => format!("tolerance {:e}", plan.tolerance.relative),
    };
    let (rows, duration) = (counted(plan.rows(), "run"), duration(plan.grid.duration()));
    let requirements = match plan.analysis.requirements.len() {
        0 => "no requirement".to_owned(),
        count => counted(count, "requirement"),
    };
    format!("{}: {rows} of {duration}, method {}, {steps}, {requirements}", plan.name, plan.method.name())
}

fn failures(title: &str, plan: &Plan, probe: &RunProbe) -> Vec<Finding> {
    let (failed, count) = (probe.failed(), probe.count());
    let lost = match plan.analysis.requirements.len() {
        0 => "there would be no statistics",
        1 => "there would be no statistics, and the requirement would fail",
        _ => "there would be no statistics, and the requirements would fail",
    };
    let head = probe.is_hopeless().then(|| about(title, format!("EVERY RUN FAILS: {lost}")));
    let mut children = loss::reasons(plan, &probe.reasons(), count as u64);
    let more = children.len().saturating_sub(MOST_REASONS);
    children.truncate(MOST_REASONS);
    let all = about(title, format!("{failed} of the first {} failed:", counted(count, "run")));
    let more = (more > 0).then(|| about(title, format!("    and {}", counted(more, "more reason"))));
    head.into_iter().chain([Finding { children, ..all }]).chain(more).collect()
}

fn happenings(plan: &Plan) -> Vec<Finding> {
    let end = plan.grid.duration();
    let failure = |failure: &crate::scene::FailureInput| {
        let (name, at) = (failure.name, failure.at_s);
        let device = failed_device(&plan.nominal, failure.device);
        let unseen = if at < end { "" } else { ": not before the end" };
        about("Failures of the nominal scene", format!("{name}: {device} at {at} s{unseen}"))
    };
    let mut list: Vec<Finding> = plan.nominal.failures.iter().map(failure).collect();
    if plan.events.is_empty() && plan.extremes.is_empty() {
        return list;
    }
    let title = if plan.extremes.is_empty() { "Events" } else { "Events and extremes" };
    for event in &plan.events {
        let ends = if event.ends_run { "; the run ends there" } else { "" };
        list.push(about(title, format!("{}: {}{ends}", event.name, event.says())));
    }
    list.extend(plan.extremes.iter().map(|one| about(title, format!("{}: {}", one.name, one.says()))));
    let (points, spacing) = (plan.grid.points(), trimmed(end / (plan.grid.points() - 1) as f64, 6));
    list.push(about(
        title,
        format!(
            "seen at {points} points, {spacing} s apart: two crossings between neighbouring points are not seen \
             (observe.points)"
        ),
    ));
    list
}

/// The integrated states with the reason for each, and the states left out; skips whatever scene and method lack.
fn computed(ensemble: &Ensemble<'_>) -> Vec<Finding> {
    let about = |sentence: String| self::about("What is computed", sentence);
    let (request, scene) = (ensemble.request(), &ensemble.plan().nominal);
    let reasons = request.reasons();
    let line = |field: StateField| {
        let (name, exists) = state_field(request, field);
        let reason = reasons.iter().find(|(needed, _)| *needed == field);
        let why = reason.map_or("not computed: no requested observable needs it".to_owned(), |(_, reason)| {
            format!("needed by {reason}")
        });
        exists.then(|| about(format!("{name}: {why}")))
    };
    let mut list: Vec<Finding> = StateField::ALL.into_iter().filter_map(line).collect();
    let acting = request.actuated;
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
        list.extend(exists.then(|| about(format!("{term}: {why}"))));
    }
    let columns = request.columns();
    let has_columns = |group: &&Group| columns.iter().any(|column| column.group == **group);
    let (with, without): (Vec<&Group>, Vec<&Group>) = ensemble.plan().groups.iter().partition(has_columns);
    for (what, groups) in [("observed groups", with), ("groups without columns in such scenes", without)] {
        let names: Vec<&str> = groups.iter().map(|group| group.name()).collect();
        list.extend((!names.is_empty()).then(|| about(format!("{what}: {}", names.join(", ")))));
    }
    list
}

/// The name of a state, and whether the scenes and the method of the request have it.
fn state_field(request: &Request, field: StateField) -> (&'static str, bool) {
    let (debris, wheels, acting) = (request.debris, !request.wheels.is_empty(), request.actuated);
    let constrained = request.constrained;
    match field {
        StateField::Rate => ("angular velocity of the body", true),
        StateField::Attitude => ("attitude quaternion", true),
        StateField::WheelRates => ("wheel rates", wheels),
        StateField::WheelAngles => ("wheel angles", wheels),
        StateField::ComPosition => ("position of the centre of mass", true),
        StateField::ComVelocity => ("velocity of the centre of mass", true),
        StateField::Work => ("work of actuators and torques on the body", acting.any()),
        StateField::Impulse => ("impulse of the thrusters", acting.thrusters),
        StateField::AngularImpulse => ("angular impulse of thrusters and torques on the body", acting.external()),
        StateField::DebrisPosition => ("position of the debris", debris),
        StateField::DebrisVelocity => ("velocity of the debris", debris),
        StateField::DebrisAttitude => ("attitude of the debris", debris),
        StateField::DebrisRate => ("angular velocity of the debris", debris),
        StateField::Dcm => ("direction cosine matrix (null_space method)", constrained),
        StateField::Residuals => ("constraint residuals (null_space method)", constrained),
        StateField::KineticEnergies => ("kinetic energies of the redundant states (null_space method)", constrained),
    }
}

/// Run time extrapolated from the probe; disk space, memory and audit time.
fn estimate(probed: &Probed<'_>) -> Vec<Finding> {
    let Probed { ensemble, runs: probe, files, needs, cores, .. } = probed;
    let plan = ensemble.plan();
    if let Some(LongRun { sample, reached }) = probe.too_long {
        let duration = plan.grid.duration();
        let end = if is_out_of_reach(plan.max_steps, reached, duration) {
            let remedy = loss::remedy(plan, Status::StepLimit).unwrap_or_default();
            format!("; at that pace the steps do not suffice; {remedy}")
        } else {
            String::new()
        };
        let (reached, duration) = (trimmed(reached, 6), trimmed(duration, 6));
        let said = format!(
            "time and disk space cannot be estimated: sample {sample} needs more than {PACE_STEPS} steps, which lead \
             to {reached} s of {duration} s{end}"
        );
        return vec![about("Estimate", said), audit_estimate("Estimate", probed)];
    }
    let of_run = part_of_run(plan).map_or(String::new(), |part| format!("the first {} s of ", trimmed(part, 6)));
    let title = format!("Estimate, from {of_run}{}", counted(probe.count(), "run"));
    let looks = match plan.looks()[..] {
        [_, .., most] => format!(" (the first look of [stop], which may go on to {most})"),
        _ => String::new(),
    };
    let time = format!(
        "{} ms per run on one core; {}{looks} on {}: about {} s",
        brief(probe.seconds * 1e3),
        counted(plan.rows(), "sample"),
        counted(*cores, "core"),
        brief(campaign_seconds(plan, probe.seconds, *cores)),
    );
    let [rows, columns] = *files;
    let [disk, memory] = needs.map(|needed| bytes(needed as u64));
    let space = format!(
        "{}; {} of rows, page and tables: about {disk}; memory: at most {memory}",
        counted(columns, "column"),
        counted(rows, "file"),
    );
    let failed = if probe.failed() == 0 || probe.is_hopeless() { Vec::new() } else { failures(&title, plan, probe) };
    let audits = audit_estimate(&title, probed);
    [about(&title, time), about(&title, space)].into_iter().chain(failed).chain([audits]).collect()
}

fn audit_estimate(title: &str, probed: &Probed<'_>) -> Finding {
    let plan = probed.ensemble.plan();
    let said = match &probed.audits {
        None => "no audit (--audit 0.01 compares one run in a hundred with a reference solution)".to_owned(),
        Some(Err(sample)) => format!(
            "the time of audits cannot be estimated: that of sample {sample} needs more than {PACE_STEPS} steps"
        ),
        Some(Ok(AuditProbe { seconds, count })) => {
            let audits = plan.audit_fraction * plan.rows() as f64;
            format!(
                "audit of {} of the samples, from {}: {:.1} ms each; about {} audits on {}: {} s more",
                if plan.audit_fraction == 1.0 { "all".to_owned() } else { short(plan.audit_fraction) },
                counted(*count, "audit"),
                seconds * 1e3,
                short(libm::round(audits)),
                counted(probed.cores, "core"),
                short(seconds * audits / probed.cores as f64),
            )
        }
    };
    about(title, said)
}
