//! Verdicts on requirements: as text for the screen, as values for `summary.json`, as JUnit XML for build servers.

use std::fmt::Write;

use serde_json::{Value, json};

use crate::analysis::assessment::{Assessment, RARE};
use crate::analysis::order_statistics::without_value;
use crate::analysis::tally::Tally;
use crate::analysis::verdicts::Verdicts;
use crate::campaign::{Plan, Statement};
use crate::findings::names;
use crate::findings::number::{brief, counted, outward, short, trimmed};
use crate::report::audit_summary::AuditSummary;
use crate::report::escaped::escaped;
use crate::report::share_text::with_interval;
use crate::statistics::binomial::{Decision, POWER};
use crate::statistics::gate::GateLimit;
use crate::statistics::quantile::percent;

/// One line for each requirement, and what was found; nothing where there are none.
pub fn text(verdicts: &Verdicts) -> String {
    let mut text = String::new();
    if verdicts.list.is_empty() {
        return text;
    }
    text += "\n  requirements\n";
    for one in &verdicts.list {
        text += &format!("  {:<10} {}\n             {}\n", one.word(), one.sentence(), finding(one));
    }
    together(verdicts).iter().for_each(|sentence| text += &format!("  {sentence}\n"));
    if verdicts.invalid > 0 {
        let share = 100.0 * verdicts.invalid as f64 / verdicts.samples as f64;
        text += &format!(
            "  {} of {} samples ({share:.2}%) are not physical and outside of the population\n",
            verdicts.invalid, verdicts.samples
        );
    }
    text
}

/// What the verdicts say together: how often one of them is wrong, and what to do about those that are undecided.
pub fn together(verdicts: &Verdicts) -> Vec<String> {
    let mut said = Vec::new();
    let least = verdicts.list.iter().map(|one| one.requirement.confidence).fold(1.0, f64::min);
    // without the rounding of the difference
    let error = percent(libm::round(1e12 * (1.0 - least)) / 1e12);
    if verdicts.list.len() > 1 {
        said.push(format!(
            "of the {} requirements together: the chance that one which is met FAILs is at most {error}% (Holm), and \
            so is the chance that all PASS while one is missed",
            verdicts.list.len()
        ));
    }
    if verdicts.list.iter().any(Assessment::has_interval) {
        said.push(
            "a verdict looks at one side only, with the confidence of its requirement: it may be decided while its \
            two-sided interval still has the limit in it"
                .to_owned(),
        );
    }
    if verdicts.looks > 1 {
        said.push(format!("the confidence is that of all {} looks of [stop] together", verdicts.looks));
    }
    let has_number = |one: &Assessment| matches!(one.gate.decision, Decision::Undecided(Some(_)));
    if verdicts.looks == 1 && verdicts.list.iter().any(has_number) {
        said.push(
            "to add runs until every requirement is decided, write [stop] when = \"decided\"; adding runs by hand and \
            testing again makes wrong verdicts more likely"
                .to_owned(),
        );
    }
    said
}

// what the documents say of that number
const _: () = assert!(POWER == 0.9);

/// What a decision on a mean assumes of events that the runs do not show; `None` where it assumes nothing.
pub fn assumed(one: &Assessment) -> Option<String> {
    let room = one.room_for_rare_events()?;
    let unit = if one.shown.unit.is_empty() { String::new() } else { format!(" {}", one.shown.unit) };
    Some(format!(
        "if events rarer than {RARE} in {} runs move the mean by less than {}{unit}; with bounded = [lowest, highest] \
        it would assume nothing",
        one.runs,
        short(one.shown.value(room)),
    ))
}

/// What decided, in a few words, where the interval in brackets seems to say otherwise: the bound of a verdict, which
/// looks at one side, where the interval has the limit in it; that nothing is decided, where it has not. `None` where
/// the interval shows it.
pub fn decided_by(one: &Assessment) -> Option<String> {
    if one.fails_alone() {
        return Some(missed_alone(one));
    }
    let ([bound, limit], is_lower) = one.hidden_bound()?;
    let is_mean = one.requirement.statement == Statement::Mean;
    let shown = |value: f64| if is_mean { one.shown.value(value) } else { 100.0 * value };
    let (bound, limit) = (shown(bound), shown(limit));
    // what is said holds, and decides: rounded away from what was found, in as many digits as that takes
    let rounded = |digits: i32| outward([bound; 2], digits)[usize::from(!is_lower)];
    let digits = (3..DIGITS)
        .find(|digits| if is_lower { rounded(*digits) > limit } else { rounded(*digits) < limit })
        .unwrap_or(DIGITS);
    let number = trimmed(rounded(digits), digits as usize);
    let number = if is_mean { format!("{number} {}", one.shown.unit) } else { format!("{number}%") };
    let side = if is_lower { "at least" } else { "at most" };
    Some(format!("{side} {}, one-sided at {}%", number.trim_end(), percent(one.confidences[0])))
}

/// Why a requirement is not decided that would be missed, were it the only one.
fn missed_alone(one: &Assessment) -> String {
    let [alone, together] = one.confidences.map(|confidence| trimmed(100.0 * confidence, 6));
    format!("missed at {alone}%, not at the {together}% that all requirements together ask for")
}

/// Most digits of a bound.
const DIGITS: i32 = 12;

/// What the intervals in brackets are, in words.
pub fn intervals(confidence: f64) -> String {
    format!("two-sided {}% intervals (Clopper-Pearson for shares)", percent(confidence))
}

/// How many `runs` would decide, in words; `None`: no number of them.
pub fn runs_needed(runs: Option<&str>) -> String {
    match runs {
        Some(runs) => format!("about {runs} runs should decide what is undecided, if the truth is as observed"),
        None => "no number of runs would decide what is undecided, if the truth is as observed".to_owned(),
    }
}

/// The requirement in a few words: "pointing error at launch <= 2 deg in 95%".
pub fn statement(one: &Assessment) -> String {
    let requirement = &one.requirement;
    let name = names::of_column(requirement.name(), &one.unit);
    let unit = if one.shown.unit.is_empty() { String::new() } else { format!(" {}", one.shown.unit) };
    let limit = format!("{:?}", one.shown.written(requirement.limit.value()));
    let side = if matches!(requirement.limit, GateLimit::AtMost(_)) { "<=" } else { ">=" };
    let is = match (requirement.name(), requirement.limit) {
        // yes or no
        ("launched", GateLimit::AtLeast(limit)) if limit > 0.0 => name,
        _ => {
            format!("{name} {side} {}{unit}{}", limit.trim_end_matches(".0"), requirement.times())
        }
    };
    match requirement.statement {
        Statement::Quantile(p) if requirement.window().is_some() => {
            format!("{is} in {}%", percent(requirement.limit.fraction(p)))
        }
        Statement::Quantile(p) => format!("p{} of {is}", percent(p)),
        Statement::Fraction(fraction) => format!("{is} in {}%", percent(fraction)),
        Statement::Mean => format!("mean of {is}"),
    }
}

/// What a verdict is about, with its interval: the share of the runs within the limit, or the mean.
pub fn estimate(one: &Assessment) -> String {
    let estimate = one.gate.estimate;
    if !estimate.is_finite() {
        return "-".to_owned();
    }
    if one.requirement.statement != Statement::Mean {
        return with_interval([estimate; 2], one.interval);
    }
    let unit = if one.shown.unit.is_empty() { String::new() } else { format!(" {}", one.shown.unit) };
    let end = |end: f64| if end.is_finite() { brief(end) } else { "?".to_owned() };
    let [low, high] = outward(one.interval.map(|end| one.shown.value(end)), 3);
    let interval = match one.has_interval() {
        true => format!(" [{}, {}]", end(low), end(high)),
        false => String::new(),
    };
    format!("{}{interval}{unit}", end(one.shown.value(estimate)))
}

/// What was found, in words: the estimate with its bounds, and how many runs would decide.
fn finding(one: &Assessment) -> String {
    let [lower, upper] = one.interval;
    let unit = if one.shown.unit.is_empty() { String::new() } else { format!(" {}", one.shown.unit) };
    let shown = |value: f64| format!("{}{unit}", short(one.shown.value(value)));
    let found = match one.requirement.statement {
        Statement::Mean => {
            let end = |end: f64| if end.is_finite() { short(end) } else { "?".to_owned() };
            let [lower, upper] = outward([lower, upper].map(|end| one.shown.value(end)), 4);
            let interval = match lower.is_finite() || upper.is_finite() {
                false => String::new(),
                true => format!(" [{}, {}]", end(lower), end(upper)),
            };
            format!("mean {}{interval}", shown(one.gate.estimate))
        }
        statement => {
            let value = match (one.value, statement) {
                (Some(value), _) => format!("{}; ", shown(value)),
                (None, Statement::Quantile(p)) if one.missing > 0 => {
                    format!("p{} is among the runs without a value; ", percent(p))
                }
                _ => String::new(),
            };
            let within = one.runs - one.violations;
            let at = one.worst.map_or(String::new(), |worst| {
                let unresolved = match worst.unresolved {
                    0 => String::new(),
                    runs => format!(" ({runs} more are too near to it for the bands to tell)"),
                };
                format!("{unresolved} at {} s, the worst of {} points of time", short(worst.time_s), worst.points)
            });
            let missing = match one.missing {
                0 => String::new(),
                missing => format!(" ({})", without_value(&missing.to_string())),
            };
            let share = match one.gate.estimate {
                share if share.is_finite() => format!(": {}", with_interval([share; 2], one.interval)),
                _ => String::new(),
            };
            format!("{value}{within} of {} within the limit{at}{share}{missing}", counted(one.runs, "run"))
        }
    };
    let needed = match (&one.reason, one.gate.decision) {
        (Some(reason), _) => format!("; {reason}"),
        (None, Decision::Undecided(runs)) => {
            format!("; {}", runs_needed(runs.map(|runs| runs.to_string()).as_deref()))
        }
        _ => String::new(),
    };
    let alone = match one.fails_alone() {
        true => format!("; {}", missed_alone(one)),
        false => String::new(),
    };
    let notes = assumed(one).into_iter().chain(one.note.clone());
    let note: String = notes.map(|note| format!("; {note}")).collect();
    format!("{found}{alone}{needed}{note}")
}

/// The values of `summary.json`.
pub fn json(verdicts: &Verdicts) -> Value {
    let finite = |value: f64| value.is_finite().then_some(value);
    let one = |one: &Assessment| {
        let requirement = &one.requirement;
        let (statement, target) = match requirement.statement {
            Statement::Quantile(p) => ("quantile", Some(p)),
            Statement::Fraction(fraction) => ("fraction", Some(fraction)),
            Statement::Mean => ("mean", None),
        };
        let (side, limit) = match requirement.limit {
            GateLimit::AtMost(limit) => ("at_most", limit),
            GateLimit::AtLeast(limit) => ("at_least", limit),
        };
        let needed = match one.gate.decision {
            Decision::Undecided(runs) => runs,
            _ => None,
        };
        json!({
            "requirement": one.sentence(),
            "verdict": one.word(),
            "in_short": self::statement(one),
            "found": self::estimate(one),
            "observable": requirement.observable(),
            "band": requirement.band().map(|band| json!({
                "quantity": band.series,
                "from_s": band.from_s,
                "to_s": band.to_s,
                "at_all_times": requirement.window().is_some(),
                "worst_at_s": one.worst.map(|worst| worst.time_s),
                "points": one.worst.map(|worst| worst.points),
                "unresolved": one.worst.map(|worst| worst.unresolved),
            })),
            "unit": one.unit,
            "statement": statement,
            "target": target,
            side: limit,
            "confidence": requirement.confidence,
            "confidence_of_pass_and_bounds": one.confidences[0],
            "confidence_of_fail": one.confidences[1],
            "estimate": finite(one.gate.estimate),
            "bounds": one.gate.bounds.map(finite),
            "interval": one.interval.map(finite),
            "bounded": requirement.bounded,
            "assumes": assumed(one),
            "value": one.value.and_then(finite),
            "runs": one.runs,
            "violations": one.violations,
            "runs_without_a_value": one.missing,
            "failed_runs": one.failed,
            "runs_that_would_decide": needed,
            "reason": one.reason,
            "note": one.note,
        })
    };
    json!({
        "list": verdicts.list.iter().map(one).collect::<Vec<_>>(),
        "looks": verdicts.looks,
        "confidence_of_intervals": verdicts.confidence,
        "together": together(verdicts),
        "samples": verdicts.samples,
        "samples_that_are_not_physical": verdicts.invalid,
    })
}

/// The verdicts as JUnit XML: one test case for each requirement, an undecided one is an error; and one that every run
/// is `ok`: of those that `tally` has; and one that every estimate of an error covers as many errors as promised, where
/// runs were audited; and one that `[stop]` reached its goal, where there is one: whether it did, and in words. No
/// clock time: the same campaign gives the same bytes.
pub fn junit(plan: &Plan, verdicts: &Verdicts, tally: &Tally, stop: Option<(bool, String)>) -> String {
    let name = escaped(&plan.name);
    let failed = tally.statuses.runs() - tally.statuses.ok();
    let audit = tally.audits.as_ref().map(|audits| AuditSummary::new(audits, plan.audit_fraction).broken_promises());
    let is_broken = audit.as_ref().is_some_and(|broken| !broken.is_empty());
    let is_missed = stop.as_ref().is_some_and(|(is_reached, _)| !is_reached);
    let (failures, errors) = (
        verdicts.failed() + usize::from(failed > 0) + usize::from(is_broken),
        verdicts.undecided() + usize::from(is_missed),
    );
    let tests = verdicts.list.len() + 1 + usize::from(stop.is_some()) + usize::from(audit.is_some());
    let counts = format!("tests=\"{tests}\" failures=\"{failures}\" errors=\"{errors}\"");
    let mut xml = String::from("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n");
    xml += &format!("<testsuites name=\"spindrift\" {counts}>\n  <testsuite name=\"{name}\" {counts}>\n");
    if verdicts.list.iter().any(Assessment::has_interval) {
        let intervals = escaped(&intervals(verdicts.confidence));
        xml += &format!(
            "    <properties>\n      <property name=\"in brackets\" value=\"{intervals}\"/>\n    </properties>\n"
        );
    }
    let mut case = |title: &str, problem: Option<(&str, &str, &str)>| {
        let title = escaped(title);
        let _ = match problem {
            None => writeln!(xml, "    <testcase classname=\"{name}\" name=\"{title}\"/>"),
            Some((element, kind, message)) => writeln!(
                xml,
                "    <testcase classname=\"{name}\" name=\"{title}\">\n      <{element} type=\"{kind}\" \
                message=\"{}\"/>\n    </testcase>",
                escaped(message)
            ),
        };
    };
    let message = format!("{failed} runs are not ok");
    case("every run is ok", (failed > 0).then_some(("failure", "failed runs", message.as_str())));
    if let Some(broken) = audit {
        let message = broken.join("; ");
        let problem = is_broken.then_some(("failure", "audit", message.as_str()));
        case("audited errors are within their estimates", problem);
    }
    for one in &verdicts.list {
        let finding = finding(one);
        let problem = match one.gate.decision {
            Decision::Pass => None,
            Decision::Fail => Some(("failure", "requirement", finding.as_str())),
            Decision::Undecided(_) => Some(("error", "undecided", finding.as_str())),
        };
        case(&one.sentence(), problem);
    }
    if let Some((is_reached, text)) = &stop {
        case("[stop] reaches its goal", (!is_reached).then_some(("error", "stop", text.as_str())));
    }
    xml + "  </testsuite>\n</testsuites>\n"
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::campaign::requirement::Subject;
    use crate::campaign::{Requirement, ShownUnit};
    use crate::statistics::gate::Gate;

    /// Law: a bound that is named decides as it is written: rounded away from what was found, it is on the side of the
    /// limit on which the exact one is.
    #[test]
    fn a_named_bound_decides() {
        let said = |statement, limit, decision, bounds: [f64; 2]| {
            let subject = Subject::Observable("x".to_owned());
            let requirement =
                Requirement { subject, statement, limit, bounded: None, never_meets: false, confidence: 0.95 };
            decided_by(&Assessment {
                requirement,
                confidences: [0.95, 0.9875],
                unit: "m".to_owned(),
                shown: ShownUnit::own("m"),
                gate: Gate { decision, estimate: 0.5, bounds },
                interval: [0.0, 100.0],
                value: None,
                runs: 300,
                violations: 10,
                missing: 0,
                failed: 0,
                worst: None,
                reason: None,
                note: None,
            })
        };
        let (most, pass, fail) = (GateLimit::AtMost(23.15), Decision::Pass, Decision::Fail);
        for (statement, decision, bounds, text) in [
            (Statement::Fraction(0.9), pass, [0.922_36, 1.0], "at least 92.2%"),
            (Statement::Fraction(0.9223), pass, [0.922_36, 1.0], "at least 92.236%"),
            (Statement::Quantile(0.99991), pass, [0.999_927, 1.0], "at least 99.992%"),
            (Statement::Fraction(0.9223), fail, [0.5, 0.922_26], "at most 92.226%"),
            (Statement::Mean, pass, [22.0, 23.126], "at most 23.13 m"),
            (Statement::Mean, fail, [23.154, 24.0], "at least 23.154 m"),
        ] {
            let found = said(statement, most, decision, bounds);
            assert_eq!(found.as_deref(), Some(format!("{text}, one-sided at 95%").as_str()), "{bounds:?}");
        }
        assert_eq!(said(Statement::Mean, most, Decision::Undecided(None), [22.0, 23.5]), None);
        // not decided, though the interval has not the limit in it: the others ask for more
        for (statement, bounds) in [(Statement::Fraction(0.9), [0.5, 0.89]), (Statement::Mean, [23.2, 24.0])] {
            let found = said(statement, most, Decision::Undecided(None), bounds);
            let expected = "missed at 95%, not at the 98.75% that all requirements together ask for";
            assert_eq!(found.as_deref(), Some(expected), "{bounds:?}");
        }
    }
}
