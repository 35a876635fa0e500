//! What a campaign would run: its question, what runs cost, what is dispersed, the nominal scene, what is integrated.

use crate::campaign::{Plan, failed_device};
use crate::control::capacity::Capacity;
use crate::ensemble::Ensemble;
use crate::ensemble::probe::{AuditProbe, LongRun, RunProbe, part_of_run};
use crate::findings::finding::{Finding, Kind};
use crate::findings::number::{brief, bytes, counted, short, trimmed};
use crate::findings::{dispersions, loss, scene};
use crate::observables::{Group, Request};
use crate::ode::{PACE_STEPS, is_out_of_reach};
use crate::run::{StateField, Status};
use crate::scene::{Scene, WheelMode};

/// What is known of a campaign before it runs.
#[derive(Debug)]
pub struct Probed<'p> {
    pub ensemble: &'p Ensemble<'p>,
    /// Its nominal scene.
    pub scene: Scene,
    /// Its first runs.
    pub runs: RunProbe,
    /// Their audits, or the sample whose audit takes too long; `None` of a campaign without audits.
    pub audits: Option<Result<AuditProbe, crate::sampling::SampleId>>,
    /// What its file should say otherwise, each a sentence.
    pub notes: Vec<String>,
    /// Files of rows, and their columns.
    pub files: [u64; 2],
    /// Disk space and memory, bytes.
    pub needs: [f64; 2],
    pub cores: usize,
}

/// Reasons of failures that are listed.
const MOST_REASONS: usize = 8;
/// How to see what a screen leaves out.
const MORE: &str = "--verbose: percentiles, masses, momenta, what is integrated; --plan: every key";

/// A sentence in the section `title`.
fn about(title: &str, sentence: String) -> Finding {
    Finding::new(Kind::Note, "check", title, sentence)
}

/// All of it, or what a screen has place for; titles are those of sections.
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
    let capacity = plan.loop_spec().map(|spec| Capacity::of(spec, &probed.scene).lines(spec));
    list.extend(capacity.into_iter().flatten().map(|line| about(nominal, line)));
    list.extend(happenings(plan));
    if is_verbose {
        list.extend(computed(probed.ensemble));
    } else {
        list.push(about("", MORE.to_owned()));
    }
    list
}

/// What the campaign runs.
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
    format!("{}: {rows} of {seconds} s, method {}, {steps}, {requirements}", plan.name, plan.method.name())
}

/// What the probe found where runs failed: how many, and why.
fn failures(title: &str, plan: &Plan, probe: &RunProbe) -> Vec<Finding> {
    let (failed, count) = (probe.failed(), probe.count());
    let lost = match plan.analysis.requirements.len() {
        0 => "there would be no statistics",
        1 => "there would be no statistics, and the requirement would fail",
        _ => "there would be no statistics, and the requirements would fail",
    };
    let head = probe.is_hopeless().then(|| about(title, format!("EVERY RUN FAILS: {lost}")));
    let mut children = loss::reasons(&probe.reasons(), count as u64);
    let more = children.len().saturating_sub(MOST_REASONS);
    children.truncate(MOST_REASONS);
    let all = about(title, format!("{failed} of the first {} failed:", counted(count, "run")));
    let more = (more > 0).then(|| about(title, format!("    and {}", counted(more, "more reason"))));
    head.into_iter().chain([Finding { children, ..all }]).chain(more).collect()
}

/// Which devices fail and when, and what runs are watched for.
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

/// What is integrated and why, and what is not; nothing of what scene and method do not have.
fn computed(ensemble: &Ensemble<'_>) -> Vec<Finding> {
    let about = |sentence: String| self::about("What is computed", sentence);
    let (request, scene) = (ensemble.request(), &ensemble.plan().nominal);
    let reasons = request.reasons();
    let field = |field: StateField| {
        let reason = reasons.iter().find(|(needed, _)| *needed == field);
        let why = reason.map_or("not computed: no requested observable needs it".to_owned(), |(_, reason)| {
            format!("needed by {reason}")
        });
        about(format!("{}: {why}", field_name(field)))
    };
    let mut list: Vec<Finding> = StateField::ALL.into_iter().filter(|field| has(request, *field)).map(field).collect();
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

/// Time, from a probe of the first samples; disk space and memory; time of the audits.
fn estimate(probed: &Probed<'_>) -> Vec<Finding> {
    let Probed { ensemble, runs: probe, files, needs, cores, .. } = probed;
    let plan = ensemble.plan();
    if let Some(LongRun { sample, reached }) = probe.too_long {
        let duration = plan.grid.duration();
        let end = if is_out_of_reach(plan.max_steps, reached, duration) {
            let (most, remedy) = (plan.max_steps, loss::remedy(Status::StepLimit).unwrap_or_default());
            format!("; at that pace integrator.max_steps ({most}) does not suffice; {remedy}")
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
        brief(probe.seconds * plan.rows() as f64 / *cores as f64),
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

/// Time of the audits, extrapolated from a probe of the first samples.
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
