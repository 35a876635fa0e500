//! What is lost, and how runs ended: reasons of failures, missions of control loops, what numbers leave
//! unsaid, and whether `[stop]` ended the campaign.

use crate::analysis::analysed::Analysed;
use crate::analysis::missions::MissionShare;
use crate::analysis::observed::Observed;
use crate::analysis::statistics::ColumnStatistics;
use crate::analysis::statuses::Ended;
use crate::analysis::stopping::{LookFound, Stopping};
use crate::campaign::Plan;
use crate::campaign::stop::When;
use crate::control::failure::Failure;
use crate::ensemble::failure_reasons::with_numbers;
use crate::ensemble::{FailureReason, FailureReasons};
use crate::findings::finding::{Finding, Kind, Number};
use crate::findings::names;
use crate::findings::number::{brief, share, trimmed};
use crate::run::Status;
use crate::statistics::quantile::percent as exactly;

/// Most samples that are named where no reason is known.
const LISTED: usize = 3;

/// What can be done about runs that end with a status; `None` where the reason says it.
pub fn remedy(status: Status) -> Option<&'static str> {
    match status {
        Status::StepLimit => Some("to fix: increase integrator.max_steps or integrator.tolerance"),
        Status::StepFloor => Some("to fix: increase integrator.tolerance"),
        Status::Inaccurate => Some("to fix: decrease integrator.tolerance or integrator.step_s"),
        Status::Surface => {
            Some("to fix: raise the orbit, or end such runs before by an [[event]] with ends_run = true")
        }
        _ => None,
    }
}

/// A reason as people read it: its numbers, which are those of the run bit for bit, in six digits, and errors in words.
pub fn readable(reason: &str) -> String {
    let is_error = |word: &str| word.ends_with("_error_max") || word.ends_with("_error_estimate");
    let said = |word: &str| if is_error(word) { names::of_column(word, "") } else { word.to_owned() };
    let reason = reason.split(' ').map(said).collect::<Vec<_>>().join(" ");
    with_numbers(&reason, |number| {
        // a sentence may end with it
        let digits = number.trim_end_matches('.');
        match digits.parse::<f64>() {
            Ok(value) if digits.contains('.') && digits.len() > 8 => trimmed(value, 6) + &number[digits.len()..],
            _ => number.to_owned(),
        }
    })
}

/// What each status is called, in words.
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

/// A finding for each reason for which some of `runs` runs have no numbers.
pub fn reasons(all: &FailureReasons, runs: u64) -> Vec<Finding> {
    let of = |one: &&FailureReason| {
        let which = if one.count == 1 { "" } else { "first " };
        let sentence = format!("{} ({which}sample {})", readable(&one.text).trim_end_matches('.'), one.first);
        let found = Finding::new(Kind::Loss, "reason", format!("{} {}", one.count, one.status.name()), sentence);
        let share = one.count as f64 / runs.max(1) as f64;
        let numbers = vec![Number::share("share of the runs", share, [f64::NAN; 2], runs)];
        let notes = remedy(one.status).map(str::to_owned).into_iter().collect();
        Finding { numbers, notes, sample: Some(one.first), ..found }
    };
    all.groups().iter().map(of).collect()
}

/// How many runs were computed, and below it why the others were not.
pub(super) fn losses(analysed: &Analysed) -> Vec<Finding> {
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
    let mut children = reasons(statuses.reasons(), runs);
    if children.is_empty() {
        children = statuses.failed().map(by_status).collect();
    }
    vec![Finding { children, numbers: vec![of(ok)], ..Finding::new(Kind::Loss, "computed", "runs", said) }]
}

/// How missions ended: a finding for each way; nothing without a loop.
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
        let said =
            format!("{missing} of {runs} dispersed runs were not computed: each share is between none and all of them");
        Finding { rank: 1, ..Finding::new(Kind::Mission, "missing", "", said) }
    });
    all.into_iter().chain(missions.iter().map(of)).chain(lost).collect()
}

/// Why no input decides which missions fail: all do. `None` where one mission did not fail.
pub(super) fn all_fail(missions: &[MissionShare]) -> Option<String> {
    let is_failed = |one: &MissionShare| words(one.end).starts_with("failed") && one.missing == 0;
    let runs = missions.first()?.runs;
    let all_do = missions.iter().filter(|one| one.count > 0).all(is_failed);
    (runs > 1 && all_do).then(|| format!("all {runs} missions fail, so no input decides which do"))
}

/// Normalised squares of estimation errors per degree of freedom have a median a little below 1 where the covariance of
/// a filter is right (that of chi-square
/// with 6 degrees is 0.89). Above this one, errors are typically half as large again as the filter says, or more.
const MOST_NEES: f64 = 2.0;

/// Filters whose errors are larger than their covariance says (Y. Bar-Shalom, X. R. Li & T. Kirubarajan, Estimation
/// with Applications to Tracking and
/// Navigation, 2001, section 5.4).
pub(super) fn notes(analysed: &Analysed) -> Vec<Finding> {
    let of_column = |column: &ColumnStatistics| {
        column.quantity.name().strip_suffix("_nees_final")?;
        let median = column.quantiles.iter().find(|quantile| quantile.p == 0.5)?;
        overconfident(column.quantity.meaning(), median.value?, median.interval[0])
    };
    let found = analysed.statistics.columns.iter().filter_map(of_column);
    found.map(|said| Finding::new(Kind::Note, "filter", "filter overconfident", said)).collect()
}

/// What a column with this `meaning` says by its `median`, whose interval begins at `lower`.
fn overconfident(meaning: &str, median: f64, lower: Option<f64>) -> Option<String> {
    let (_, rest) = meaning.split_once("estimation error of ").unwrap_or(("", meaning));
    let of = rest.split_once(" at the last tick").map_or(rest, |(of, _)| of);
    let estimate = of.split_once(" (or").map_or(of, |(of, _)| of);
    (median.is_finite() && lower.unwrap_or(median) > MOST_NEES)
        .then(|| format!("{estimate} typically end {} sigma off", brief(libm::sqrt(median))))
}

/// What the last look of a campaign with `[stop]` found.
pub(super) fn stop(plan: &Plan, analysed: &Analysed) -> Option<Finding> {
    let said = stop_text(plan, analysed.stopping.as_ref()?);
    Some(Finding::new(Kind::Stop, "stop", "stop", said))
}

/// One sentence on `stopping`, a look at the campaign of `plan`; a second one where it ended the campaign.
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
            let wanted = format!("{} {}", trimmed(shown.value(goal.half_width), 4), shown.unit);
            let found = format!(
                "p{} of {} = {} at {}% confidence, wanted half width {}",
                exactly(goal.quantile),
                names::of_column(observable, unit),
                number.text(),
                trimmed(100.0 * look.confidence, 6),
                wanted.trim_end(),
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

/// How a mission ended, in words that follow "mission".
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

/// How missions ended, in words that follow "mission", with the phases that took too long.
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

/// How the mission of a run ended, by the columns of its row; `None` where the row has none, or the mission did neither
/// fail nor launch.
pub fn of_row(row: &[(String, f64)]) -> Option<String> {
    let value = |name: &str| row.iter().find(|(column, _)| column == name).map(|(_, value)| *value);
    if value("launched") == Some(1.0) {
        return Some("mission launched".to_owned());
    }
    let failure = value("failure").filter(|code| *code >= 1.0)?;
    Some(format!("mission {}", words(Failure::NAMES.get(failure as usize)?)))
}

/// The same with the time at which it ended: "mission failed at 812 s: a phase took too long".
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

    /// Known: long numbers are rounded; names, counts, short numbers and points at the end of a sentence stay.
    #[test]
    fn long_numbers_are_rounded() {
        for (reason, said) in [
            ("the run reached 0.6315175779453478 s", "the run reached 0.631518 s"),
            ("at -1.2345678901234567e-7.", "at -1.23457e-7."),
            ("wheels.w1.mass_kg is 12.5; 1000000000 steps. 2.", "wheels.w1.mass_kg is 12.5; 1000000000 steps. 2."),
            ("sha 0123456789abc.5", "sha 0123456789abc.5"),
        ] {
            assert_eq!(readable(reason), said);
        }
    }

    /// Law: every status has words of its own, a reason or a remedy that does not send a reader to the wrong key and a
    /// line
    /// in the documents.
    #[test]
    fn every_status_is_explained() {
        let keys = include_str!("../../docs/campaign-files.md");
        let columns = include_str!("../../docs/columns.md");
        for (place, status) in Status::ALL.into_iter().enumerate() {
            let name = status.name();
            assert!(keys.contains(&format!("\n| `{name}` |")), "{name} is not in campaign-files.md");
            assert!(columns.contains(&format!(" {name},")) || columns.contains(&format!(" {name}. |")), "{name}");
            let others = Status::ALL[..place].iter().map(|other| (other.name(), status_words(*other)));
            assert!(others.into_iter().all(|(other, words)| other != name && words != status_words(status)), "{name}");
            let of_run =
                [Status::Done, Status::InvalidSample, Status::InternalError, Status::Inaccurate, Status::Diverged];
            assert_eq!(status.reason(1.0).is_none(), of_run.contains(&status), "{name}");
            let is_of_steps = remedy(status).is_some_and(|remedy| remedy.contains("max_steps"));
            assert_eq!(is_of_steps, status == Status::StepLimit, "{name}");
        }
    }

    /// Law: errors that are typically more than 1.4 times what the covariance says are named, with their root; what
    /// these runs leave open is not.
    #[test]
    fn errors_beyond_the_covariance_are_named() {
        let meaning = "Normalised square of the estimation error of position and velocity at the last tick, over its \
                       degrees of freedom.";
        let said = |median, lower| overconfident(meaning, median, lower);
        let text = Some("position and velocity typically end 3 sigma off".to_owned());
        assert_eq!([said(9.0, Some(2.1)), said(9.0, None)], [text.clone(), text]);
        assert_eq!([said(9.0, Some(1.9)), said(1.9, None), said(f64::NAN, None)], [None, None, None]);
    }

    /// Law: no input decides which missions fail where all do, and only there.
    #[test]
    fn all_fail_where_none_does_not() {
        let of =
            |end, count| MissionShare { end, phases: Vec::new(), count, runs: 200, missing: 0, interval: [0.0; 2] };
        let failed = vec![of("timeout", 150), of("keep_out", 50)];
        assert!(all_fail(&failed).is_some());
        for other in ["launched", "flying", "not_failed"] {
            assert!(all_fail(&[failed.clone(), vec![of(other, 1)]].concat()).is_none());
            assert!(all_fail(&[failed.clone(), vec![of(other, 0)]].concat()).is_some());
        }
        assert!(all_fail(&[MissionShare { missing: 1, ..of("timeout", 199) }]).is_none());
    }

    /// Law: the code of a row is that of the list of failures, and a launched mission did not fail.
    #[test]
    fn rows_say_how_their_mission_ended() {
        let row =
            |launched: f64, failure: f64| of_row(&[("launched".to_owned(), launched), ("failure".to_owned(), failure)]);
        for (code, name) in Failure::NAMES.iter().enumerate().skip(1) {
            assert_eq!(row(0.0, code as f64), Some(format!("mission {}", words(name))));
            assert!(words(name).starts_with("failed: "), "{name}");
        }
        assert_eq!(row(1.0, 0.0).as_deref(), Some("mission launched"));
        assert_eq!([row(0.0, 0.0), of_row(&[])], [None, None]);
        // of one run also when
        let at = |launched: f64, failure: f64, end: f64| {
            of_run(
                &[("launched", launched), ("failure", failure), ("end_time_s", end)]
                    .map(|(name, value)| (name.to_owned(), value)),
            )
        };
        assert_eq!(at(0.0, 1.0, 812.5).as_deref(), Some("mission failed at 812.5 s: a phase took too long"));
        assert_eq!(at(1.0, 0.0, 900.0).as_deref(), Some("mission launched at 900 s"));
        assert_eq!([at(0.0, 0.0, f64::NAN), at(f64::NAN, f64::NAN, f64::NAN)], [None, None]);
    }
}
