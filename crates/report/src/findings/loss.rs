//! Runs without numbers, ends of missions, overconfident filters and `[stop]`.

use crate::analysis::analysed::Analysed;
use crate::analysis::missions::MissionShare;
use crate::analysis::observed::Observed;
use crate::analysis::statistics::ColumnStatistics;
use crate::analysis::statuses::Ended;
use crate::analysis::stopping::{LookFound, Stopping};
use crate::campaign::Plan;
use crate::campaign::stop::When;
use crate::ensemble::failure_reasons::with_numbers;
use crate::ensemble::{FailureReason, FailureReasons};
use crate::findings::finding::{Finding, Kind, Number};
use crate::findings::names;
use crate::findings::number::{brief, share, trimmed, with_unit, written};
use crate::loops::failure::Failure;
use crate::run::Status;
use crate::statistics::quantile::percent as exactly;

const LISTED: usize = 3;

/// The remedy for a status; `None` if the reason contains it.
pub fn remedy(plan: &Plan, status: Status) -> Option<String> {
    let tolerance = written(plan.tolerance.relative);
    Some(match status {
        Status::StepLimit => {
            format!("to fix: increase integrator.max_steps ({}) or tolerance ({tolerance})", plan.max_steps)
        }
        Status::StepFloor => format!("to fix: increase integrator.tolerance ({tolerance})"),
        Status::Inaccurate => match plan.step_s {
            Some(step) => format!("to fix: decrease integrator.step_s ({})", written(step)),
            None => format!("to fix: decrease integrator.tolerance ({tolerance})"),
        },
        Status::InvalidSample => {
            "to fix: choose distributions without such values, for instance truncated_normal".to_owned()
        }
        Status::Surface => {
            "to fix: raise the orbit, or end such runs before by an [[event]] with ends_run = true".to_owned()
        }
        _ => return None,
    })
}

/// A reason for people: six digits instead of all bits, words instead of column names, and no advice on a drawn value,
/// which nobody wrote.
pub fn readable(reason: &str) -> String {
    let is_error = |word: &str| word.ends_with("_error_max") || word.ends_with("_error_estimate");
    let said = |word: &str| if is_error(word) { names::of_column(word, "") } else { word.to_owned() };
    let parts: Vec<&str> = reason.split("; ").filter(|part| part.contains(REFUSED)).collect();
    let reason = if parts.is_empty() { reason.to_owned() } else { parts.join("; ") };
    let reason = reason.split(' ').map(said).collect::<Vec<_>>().join(" ");
    with_numbers(&reason, |number| {
        // keep a full stop after the number
        let digits = number.trim_end_matches('.');
        match digits.parse::<f64>() {
            Ok(value) if digits.contains('.') && digits.len() > 8 => trimmed(value, 6) + &number[digits.len()..],
            _ => number.to_owned(),
        }
    })
}

/// In the reason of a sample that is not physical; advice for who wrote the value follows.
const REFUSED: &str = ": must be ";

pub fn status_words(status: Status) -> &'static str {
    match status {
        Status::Done => "computed",
        Status::StepLimit => "computation failed: too many steps",
        Status::StepFloor => "computation failed: step too small",
        Status::NonFinite => "computation failed: not finite",
        Status::InvalidSample => "invalid: not physical",
        Status::Inaccurate => "inaccurate",
        Status::InternalError => "internal error",
        Status::Surface => "reached the surface",
        Status::Diverged => "the control loop diverged",
    }
}

/// A finding for each reason that left some of `runs` runs without numbers.
pub fn reasons(plan: &Plan, all: &FailureReasons, runs: u64) -> Vec<Finding> {
    let of = |one: &&FailureReason| {
        let which = if one.count == 1 { "" } else { "first " };
        let sentence = format!("{} ({which}sample {})", readable(&one.text).trim_end_matches('.'), one.first);
        let found = Finding::new(Kind::Loss, "reason", format!("{} {}", one.count, one.status.name()), sentence);
        let share = one.count as f64 / runs.max(1) as f64;
        let numbers = vec![Number::share("share of the runs", share, [f64::NAN; 2], runs)];
        let notes = remedy(plan, one.status).into_iter().collect();
        Finding { numbers, notes, sample: Some(one.first), ..found }
    };
    all.groups().iter().map(of).collect()
}

/// The number of computed runs, with the reasons for the others as children.
pub(super) fn losses(plan: &Plan, analysed: &Analysed) -> Vec<Finding> {
    let statuses = &analysed.tally.statuses;
    let (runs, ok) = (statuses.runs(), statuses.ok());
    let said = match (runs, ok) {
        (1, 1) => "the run was computed".to_owned(),
        (runs, ok) if runs == ok => format!("all {runs} runs were computed"),
        (runs, ok) => format!("{ok} of {runs} runs were computed"),
    };
    let of = |count: u64| Number::share("share of the runs", count as f64 / runs.max(1) as f64, [f64::NAN; 2], runs);
    let by_status = |one: &Ended| {
        let listed: Vec<String> = one.first.iter().take(LISTED).map(|(sample, _)| sample.to_string()).collect();
        let more = if one.count > listed.len() as u64 { ", ..." } else { "" };
        let sentence = format!("samples {}{more}", listed.join(", "));
        let found = Finding::new(Kind::Loss, "status", format!("{} {}", one.count, one.status.name()), sentence);
        Finding { numbers: vec![of(one.count)], sample: one.first.first().map(|(sample, _)| *sample), ..found }
    };
    let mut children = reasons(plan, statuses.reasons(), runs);
    if children.is_empty() {
        children = statuses.failed().map(by_status).collect();
    }
    vec![Finding { children, numbers: vec![of(ok)], ..Finding::new(Kind::Loss, "computed", "runs", said) }]
}

/// A finding for each way in which missions ended; empty without a loop.
pub(super) fn missions(plan: &Plan, analysed: &Analysed) -> Vec<Finding> {
    let missions = &analysed.missions;
    let Some(MissionShare { runs, missing, .. }) = missions.first() else { return Vec::new() };
    let is_stated = plan.analysis.requirements.iter().any(|one| one.observable() == Some("launched"));
    let of = |one: &MissionShare| {
        let ended = ended(one);
        let said = match (one.end, one.count == *runs) {
            ("not_failed", true) => format!("none of {runs} missions failed"),
            _ => format!("{} of {runs} missions {ended}: {}", one.count, share(one.shares(), one.interval)),
        };
        let found = Finding::new(Kind::Mission, format!("mission_{}", one.end), ended, said);
        let number = Number::share("share of the missions", one.shares()[0], one.interval, *runs);
        Finding { numbers: vec![number], rank: 1, ..found }
    };
    let is_good = |one: &MissionShare| ["launched", "not_failed"].contains(&one.end);
    let short = |one: &MissionShare| match is_good(one) {
        true => format!("{} of {runs} {}", share(one.shares(), one.interval), ended(one)),
        false => format!("{} {}", one.count, ended(one)),
    };
    let is_new = |one: &&MissionShare| !(is_good(one) && is_stated && *missing == 0);
    let mut said: Vec<String> = missions.iter().filter(is_new).map(short).collect();
    if missions.iter().all(|one| one.end == "not_failed") && *missing == 0 {
        said = vec![format!("none of {runs} failed")];
    }
    let all = Finding::new(Kind::Mission, "missions", "missions", said.join("; "));
    let all = (!said.is_empty()).then_some(all);
    let lost = (*missing > 0).then(|| {
        let verb = if *missing == 1 { "was" } else { "were" };
        let said = format!(
            "{missing} of {runs} dispersed runs {verb} not computed: each share is between none and all of them"
        );
        Finding { rank: 1, ..Finding::new(Kind::Mission, "missing", "", said) }
    });
    all.into_iter().chain(missions.iter().map(of)).chain(lost).collect()
}

/// If all missions fail, no input separates them.
pub(super) fn all_fail(missions: &[MissionShare]) -> Option<String> {
    let is_failed = |one: &MissionShare| words(one.end).starts_with("failed") && one.missing == 0;
    let runs = missions.first()?.runs;
    let all_do = missions.iter().filter(|one| one.count > 0).all(is_failed);
    (runs > 1 && all_do).then(|| format!("all {runs} missions fail, so no input decides which do"))
}

/// Normalised squared errors per degree of freedom have a median below 1 if the covariance is right (chi-square with 6
/// degrees: 0.89). Above 2, typical errors are at least half as large again.
const MOST_NEES: f64 = 2.0;

/// Filters whose errors exceed their covariance (Y. Bar-Shalom, X. R. Li & T. Kirubarajan, Estimation with Applications
/// to Tracking and Navigation, 2001, section 5.4).
pub(super) fn notes(plan: &Plan, analysed: &Analysed) -> Vec<Finding> {
    let of_column = |column: &ColumnStatistics| {
        column.quantity.name().strip_suffix("_nees_final")?;
        let median = column.quantiles.iter().find(|quantile| quantile.p == 0.5)?;
        overconfident(column.quantity.meaning(), median.value?, median.interval[0])
    };
    let found = analysed.statistics.columns.iter().filter_map(of_column);
    let found = found.map(|said| Finding::new(Kind::Note, "filter", "filter overconfident", said));
    let mut found: Vec<Finding> = found.collect();
    found.extend(unknown_to_filters(plan).filter(|_| !found.is_empty()));
    found
}

/// The dispersed errors of sensors that no filter estimates: all but the gyro's bias.
fn unknown_to_filters(plan: &Plan) -> Option<Finding> {
    let parameters = plan.dispersions.columns().iter().map(|column| column.parameter);
    let is_unknown = |name: &str| name.starts_with("sensors.") && !name.ends_with(".bias_rad_s");
    let mut names: Vec<_> = parameters.filter(|of| is_unknown(&of.name())).map(names::of_parameter).collect();
    names.dedup();
    let said = Finding::new(Kind::Note, "filter", "dispersed, and known to no filter", names.join(", "));
    (!names.is_empty()).then_some(Finding { rank: 1, ..said })
}

/// A warning from the `median` of the column with this `meaning`, whose interval begins at `lower`.
fn overconfident(meaning: &str, median: f64, lower: Option<f64>) -> Option<String> {
    let (_, rest) = meaning.split_once("estimation error of ").unwrap_or(("", meaning));
    let of = rest.split_once(" at the last tick").map_or(rest, |(of, _)| of);
    let estimate = of.split_once(" (or").map_or(of, |(of, _)| of);
    (median.is_finite() && lower.unwrap_or(median) > MOST_NEES).then(|| {
        let sigmas = brief(libm::sqrt(median));
        format!("median error of {estimate} {sigmas} sigma, not 1")
    })
}

pub(super) fn stop(plan: &Plan, analysed: &Analysed) -> Option<Finding> {
    let said = stop_text(plan, analysed.stopping.as_ref()?);
    Some(Finding::new(Kind::Stop, "stop", "stop", said))
}

/// The last look in one sentence, and the bias if it ended the campaign.
pub fn stop_text(plan: &Plan, stopping: &Stopping) -> String {
    let Some(stop) = &plan.analysis.stop else { return String::new() };
    let (what, goal) = match (&stopping.found, &stop.when) {
        (LookFound::Precision(look), When::Precise { observable, goal }) => {
            let observed = Observed::named(plan, core::iter::once(observable.as_str()));
            let quantity = observed.first().map(|observed| &observed.quantity);
            let unit = quantity.map_or("", |quantity| quantity.unit());
            let shown = plan.analysis.display.of(observable, unit);
            let [estimate, low, high] =
                [look.estimate, look.interval[0], look.interval[1]].map(|value| value.unwrap_or(f64::NAN));
            let number = Number::new("", (estimate, [low, high]), stopping.samples, unit, &shown);
            let wanted = with_unit(trimmed(shown.value(goal.half_width), 4), &shown.unit);
            let found = format!(
                "p{} of {} = {} at {}% confidence, wanted half width {}",
                exactly(goal.quantile),
                names::of_column(observable, unit),
                number.text(),
                trimmed(100.0 * look.confidence, 6),
                wanted,
            );
            (found, "precise enough")
        }
        (LookFound::Undecided(undecided), _) => {
            (format!("{undecided} of {} requirements undecided", plan.analysis.requirements.len()), "decided")
        }
        (LookFound::Precision(_), When::Decided) => (String::new(), "decided"),
    };
    let reached = match (stopping.is_reached(), stopping.ends()) {
        (true, _) => goal.to_owned(),
        (false, true) => format!("not {goal} with stop.max_samples"),
        (false, false) => format!("not {goal} yet"),
    };
    let bias = match (stopping.is_reached(), stopping.look) {
        (true, look) if look < stopping.looks => {
            ". The rows decided when to stop: estimates lean to the side that stops earlier"
        }
        _ => "",
    };
    let Stopping { look, looks, samples, .. } = stopping;
    format!("look {look} of at most {looks}, {samples} samples: {what}: {reached}{bias}")
}

/// The end of a mission, in words that follow "mission".
pub fn words(end: &str) -> &str {
    match end {
        "flying" => "still flying at the end of the run",
        "not_failed" => "did not fail",
        "timeout" => "failed: a phase took too long",
        "wheel_saturated" => "failed: a wheel was saturated",
        "lost_target" => "failed: the debris was lost",
        "keep_out" => "failed: too close to the debris",
        "no_axis" => "failed: the debris has no axis",
        "diverged" => "failed: diverged",
        "module_trap" => "failed: the module trapped",
        "module_fuel" => "failed: the module used up its fuel",
        other => other,
    }
}

/// As [`words`], with the phases that timed out.
pub fn ended(one: &MissionShare) -> String {
    let words = words(one.end);
    match &one.phases[..] {
        [] => words.to_owned(),
        [(name, count)] if *count == one.count => format!("{words} ({name})"),
        several => {
            let each: Vec<String> = several.iter().map(|(name, count)| format!("{name} {count}")).collect();
            format!("{words} ({})", each.join(", "))
        }
    }
}

/// The end of a run's mission from its columns; `None` if it neither failed nor launched.
pub fn of_row(row: &[(String, f64)]) -> Option<String> {
    let value = |name: &str| row.iter().find(|(column, _)| column == name).map(|(_, value)| *value);
    if value("launched") == Some(1.0) {
        return Some("mission launched".to_owned());
    }
    let failure = value("failure").filter(|code| *code >= 1.0)?;
    Some(format!("mission {}", words(Failure::NAMES.get(failure as usize)?)))
}

/// As [`of_row`], with the time: "mission failed at 812 s: a phase took too long".
pub fn of_run(row: &[(String, f64)]) -> Option<String> {
    let end = of_row(row)?;
    let time = row.iter().find(|(column, _)| column == "end_time_s").map(|(_, time)| *time);
    let Some(time) = time.filter(|time| time.is_finite()) else { return Some(end) };
    let (what, why) =
        end.split_once(": ").map_or((end.as_str(), String::new()), |(what, why)| (what, format!(": {why}")));
    Some(format!("{what} at {} s{why}", trimmed(time, 6)))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Known: long numbers are rounded; names, counts, short numbers and full stops stay; advice goes.
    #[test]
    fn long_numbers_are_rounded() {
        for (reason, said) in [
            ("the run reached 0.6315175779453478 s", "the run reached 0.631518 s"),
            ("at -1.2345678901234567e-7.", "at -1.23457e-7."),
            ("wheels.w1.mass_kg is 12.5; 1000000000 steps. 2.", "wheels.w1.mass_kg is 12.5; 1000000000 steps. 2."),
            ("sha 0123456789abc.5", "sha 0123456789abc.5"),
            ("a.b = -1.0: must be above zero; write a positive number", "a.b = -1.0: must be above zero"),
        ] {
            assert_eq!(readable(reason), said);
        }
    }

    /// Law: every status has its own words, a line in the documents, and a reason or a suitable remedy.
    #[test]
    fn every_status_is_explained() {
        let keys = include_str!("../../../../docs/campaign-files.md");
        let columns = include_str!("../../../../docs/columns.md");
        let plan = crate::findings::shipped::plan("no_debris");
        for (place, status) in Status::ALL.into_iter().enumerate() {
            let name = status.name();
            assert!(keys.contains(&format!("\n| `{name}` |")), "{name} is not in campaign-files.md");
            assert!(columns.contains(&format!(" {name},")) || columns.contains(&format!(" {name}. |")), "{name}");
            let others = Status::ALL[..place].iter().map(|other| (other.name(), status_words(*other)));
            assert!(others.into_iter().all(|(other, words)| other != name && words != status_words(status)), "{name}");
            let of_run =
                [Status::Done, Status::InvalidSample, Status::InternalError, Status::Inaccurate, Status::Diverged];
            assert_eq!(status.reason(1.0).is_none(), of_run.contains(&status), "{name}");
            let is_of_steps = remedy(&plan, status).is_some_and(|remedy| remedy.contains("max_steps"));
            assert_eq!(is_of_steps, status == Status::StepLimit, "{name}");
        }
    }

    /// Law: errors that certainly exceed sqrt(2) of the covariance are named by their root; uncertain ones are not.
    #[test]
    fn errors_beyond_the_covariance_are_named() {
        let meaning = "Normalised square of the estimation error of position and velocity at the last tick, over its \
                       degrees of freedom.";
        let said = |median, lower| overconfident(meaning, median, lower);
        let text = "median error of position and velocity 3 sigma, not 1";
        let text = Some(text.to_owned());
        assert_eq!([said(9.0, Some(2.1)), said(9.0, None)], [text.clone(), text]);
        assert_eq!([said(9.0, Some(1.9)), said(1.9, None), said(f64::NAN, None)], [None, None, None]);
    }

    /// Law: codes of rows index the list of failures; a launched mission did not fail.
    #[test]
    fn rows_say_how_their_mission_ended() {
        let of = |launched: f64, failure: f64, end: f64| {
            let row = [("launched", launched), ("failure", failure), ("end_time_s", end)];
            let row = row.map(|(name, value)| (name.to_owned(), value));
            [of_row(&row), of_run(&row)].map(Option::unwrap_or_default)
        };
        for (code, name) in Failure::NAMES.iter().enumerate().skip(1) {
            assert_eq!(of(0.0, code as f64, f64::NAN)[0], format!("mission {}", words(name)));
            assert!(words(name).starts_with("failed: "), "{name}");
        }
        let failed = "mission failed at 812.5 s: a phase took too long";
        assert_eq!(of(0.0, 1.0, 812.5), ["mission failed: a phase took too long", failed]);
        assert_eq!(of(1.0, 0.0, 900.0), ["mission launched", "mission launched at 900 s"]);
        assert_eq!([of(0.0, 0.0, f64::NAN), of(f64::NAN, f64::NAN, f64::NAN)], [[""; 2]; 2]);
    }
}
