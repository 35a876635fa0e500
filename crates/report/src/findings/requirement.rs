//! Requirements with verdicts, the numbers behind them, and their qualifications.

use crate::analysis::assessment::{Assessment, RARE};
use crate::analysis::order_statistics::without_value;
use crate::analysis::outcomes::unique;
use crate::analysis::statistics::Statistics;
use crate::analysis::verdicts::Verdicts;
use crate::campaign::{Plan, ShownUnit, Statement};
use crate::findings::finding::{Finding, Kind, Number, Verdict};
use crate::findings::names;
use crate::findings::number::{self, counted, outward, share, short, time, trimmed, with_unit, written};
use crate::statistics::binomial::{Decision, POWER};
use crate::statistics::contingency::Occurrence;
use crate::statistics::gate::GateLimit;
use crate::statistics::quantile::percent;

const WITHIN: &str = "runs within the limit";
const DIGITS: i32 = 12;

// the documents quote this power
const _: () = assert!(POWER == 0.9);

#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct EndVerdict {
    pub requirement: String,
    /// `PASS`, `FAIL` or `UNDECIDED`.
    pub word: String,
    /// The requirement in a few words: "pointing error at launch <= 2 deg in 95%".
    pub statement: String,
    /// The estimate with its interval: "97.7% [95.3, 99.1]".
    pub found: String,
    pub observable: Option<String>,
    /// Violating runs; `None` for a mean.
    pub violations: Option<Occurrence>,
}

impl EndVerdict {
    /// Quantiles get intervals only from `statistics`.
    pub fn of(one: &Assessment, statistics: Option<&Statistics>) -> Self {
        EndVerdict {
            requirement: question(one),
            word: Verdict::of(one.gate.decision).word().to_owned(),
            statement: title(one),
            found: numbers(one, statistics).first().map(Number::text).unwrap_or_default(),
            observable: one.requirement.observable().map(str::to_owned),
            violations: (one.requirement.statement != Statement::Mean)
                .then_some(Occurrence { events: one.violations, runs: one.runs }),
        }
    }
}

/// A finding for each requirement: FAIL, UNDECIDED, PASS, nearest to the limit first; then the remarks on all.
pub fn findings(plan: &Plan, verdicts: &Verdicts, statistics: &Statistics) -> Vec<Finding> {
    let confidence = common_confidence(verdicts);
    let finding = |(place, one): (usize, &Assessment)| {
        let numbers = numbers(one, Some(statistics));
        let id = format!("requirement_{}", place + 1);
        let title = if confidence.is_some() { title(one) } else { question(one) };
        let found = Finding::new(Kind::Requirement, id, title, sentence(one, &numbers));
        let verdict = Some(Verdict::of(one.gate.decision));
        (Finding { verdict, notes: notes(one), numbers, ..found }, rank(one, statistics))
    };
    let mut found: Vec<(Finding, (u8, [f64; 2]))> = verdicts.list.iter().enumerate().map(finding).collect();
    let nearer = |a: [f64; 2], b: [f64; 2]| a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1]));
    found.sort_by(|(_, a), (_, b)| a.0.cmp(&b.0).then_with(|| nearer(a.1, b.1)));
    let about = |(place, said): (usize, String)| Finding {
        rank: u8::from(place > 0),
        ..Finding::new(Kind::Verdicts, "together", "", said)
    };
    let together = together(verdicts).into_iter().enumerate().map(|(place, said)| (place + 1, said));
    let needed = runs_needed(plan, verdicts).map(|said| (0, said));
    found.into_iter().map(|(finding, _)| finding).chain(needed.into_iter().chain(together).map(about)).collect()
}

/// Required observables and series, each once: `launched` first, then in the order of `found`, the findings on
/// requirements.
pub fn required<'f>(plan: &Plan, found: impl IntoIterator<Item = &'f Finding>) -> Vec<String> {
    let place = |one: &Finding| one.id.strip_prefix("requirement_")?.parse::<usize>().ok()?.checked_sub(1);
    let found = found.into_iter().filter_map(place).filter_map(|place| plan.analysis.requirements.get(place));
    let names = found.flat_map(|one| one.observable().into_iter().chain([one.name()])).map(str::to_owned);
    let mut names: Vec<String> = unique(names);
    names.sort_by_key(|name| name != LAUNCHED);
    names
}

/// A run with this [`shortfall`](crate::analysis::worst_runs::shortfall) in words that follow "the run".
pub fn against(plan: &Plan, shortfall: f64) -> String {
    let all = plan.analysis.requirements.iter().filter(|one| one.of_runs().is_some()).count();
    match (shortfall as usize, all) {
        (0, 1) => "nearest to the limit".to_owned(),
        (0, _) => "nearest to a limit".to_owned(),
        (_, 1) => "misses the requirement".to_owned(),
        (missed, all) => format!("misses {missed} of {all} requirements"),
    }
}

pub const LAUNCHED: &str = "launched";
pub const NOT_LAUNCHED: &str = "mission did not launch";

pub fn common_confidence(verdicts: &Verdicts) -> Option<f64> {
    let mut all = verdicts.list.iter().map(|one| one.requirement.confidence);
    let first = all.next()?;
    all.all(|other| other == first).then_some(first)
}

/// The number of runs that would decide all undecided requirements.
fn runs_needed(plan: &Plan, verdicts: &Verdicts) -> Option<String> {
    let needed = verdicts.list.iter().filter(|one| one.reason.is_none()).filter_map(|one| match one.gate.decision {
        Decision::Undecided(runs) => Some(runs.map(|runs| runs.max(one.runs + 1))),
        _ => None,
    });
    let needed: Vec<Option<u64>> = needed.collect();
    let with_nominal = |runs: u64| if plan.samples > 1 { format!(" (samples = {})", runs + 1) } else { String::new() };
    let runs = if plan.samples > 1 { "dispersed runs" } else { "runs" };
    Some(match needed.iter().flatten().max().filter(|_| !needed.is_empty()) {
        Some(most) => format!("about {most} {runs}{} should decide what is undecided, {IF}", with_nominal(*most)),
        None if needed.is_empty() => return None,
        None => format!("no number of runs would decide what is undecided, {IF}"),
    })
}

const IF: &str = "if the truth is as observed";

/// Sort key: verdict, then distance from the limit in half-widths of the interval, comparable across units. Ties go to
/// the extreme run nearest to the limit, relative to the limit.
fn rank(one: &Assessment, statistics: &Statistics) -> (u8, [f64; 2]) {
    let class = match one.gate.decision {
        Decision::Fail => 0,
        Decision::Undecided(_) => 1,
        Decision::Pass => 2,
    };
    let target = target(one);
    let distance = (one.gate.estimate - target).abs();
    let half = 0.5 * (one.interval[1] - one.interval[0]);
    let scale = if half > 0.0 { half } else { target.abs().max(one.gate.estimate.abs()).max(f64::MIN_POSITIVE) };
    let limit = one.requirement.limit;
    let moments = one.requirement.observable().and_then(|name| statistics.column(name)).map(|column| &column.moments);
    let extreme = moments.and_then(|all| if matches!(limit, GateLimit::AtMost(_)) { all.max() } else { all.min() });
    let margin = extreme.map(|extreme| (limit.value() - extreme).abs() / limit.value().abs());
    let finite = |distance: f64| if distance.is_finite() { distance } else { f64::MAX };
    (class, [finite(distance / scale), finite(margin.unwrap_or(f64::MAX))])
}

/// Required value of the estimate: a share of the runs, or the limit of the mean.
fn target(one: &Assessment) -> f64 {
    one.requirement.share().unwrap_or_else(|| one.requirement.limit.value())
}

/// "pointing error at launch <= 2 deg in 95%".
pub fn title(one: &Assessment) -> String {
    let requirement = &one.requirement;
    let name = names::of_column(requirement.name(), &one.unit);
    let side = if matches!(requirement.limit, GateLimit::AtMost(_)) { "<=" } else { ">=" };
    let shown = shown(one);
    let unit = shown.unit.as_str();
    let limit = with_unit(written(shown.written(requirement.limit.value())), unit);
    let is = match (requirement.name(), requirement.limit) {
        // yes or no
        ("launched", GateLimit::AtLeast(limit)) if limit > 0.0 => name,
        _ => format!("{name} {side} {limit}{}", times(one)),
    };
    match requirement.statement {
        Statement::Quantile(p) if requirement.window().is_some() => {
            format!("{is} in {}%", percent(requirement.limit.fraction(p)))
        }
        Statement::Quantile(p) => format!("p{} of {is}", percent(p)),
        Statement::Fraction(fraction) => {
            let never = if requirement.never_meets { ", or never," } else { "" };
            format!("{is}{never} in {}%", percent(fraction))
        }
        Statement::Mean => {
            let range = requirement.bounded.map(|ends| ends.map(|end| written(shown.written(end))));
            let range = range.map(|[low, high]| format!(" (bounded = [{low}, {high}] {unit}"));
            format!("mean of {is}{}", range.map_or(String::new(), |text| text.trim_end().to_owned() + ")"))
        }
    }
}

/// The limit as written, in the unit `shown`: "at most 2 deg".
pub fn limit_text(limit: GateLimit, shown: &ShownUnit) -> String {
    let word = if matches!(limit, GateLimit::AtMost(_)) { "at most" } else { "at least" };
    format!("{word} {}", with_unit(written(shown.written(limit.value())), &shown.unit))
}

fn times(one: &Assessment) -> String {
    let Some(band) = one.requirement.band() else { return String::new() };
    let which = if one.requirement.window().is_some() { "at all times" } else { "at each time" };
    let end = |word: &str, end: Option<f64>| end.map_or(String::new(), |end| format!(" {word} {}", time(end)));
    format!(" {which}{}{}", end("from", band.from_s), end("to", band.to_s))
}

/// The title with its confidence, as the name of a test.
pub fn question(one: &Assessment) -> String {
    format!("{}, with {}% confidence", title(one), percent(one.requirement.confidence))
}

/// The deciding number first: the quantile if known, the mean, or the share within the limit.
pub fn numbers(one: &Assessment, statistics: Option<&Statistics>) -> Vec<Number> {
    let limit = one.requirement.limit;
    let value = |name: &str, value: f64, interval: [f64; 2]| {
        let shown = shown(one);
        Number { limit: Some(limit), ..Number::new(name, (value, interval), one.runs, &one.unit, &shown) }
    };
    let target = GateLimit::AtLeast(target(one));
    let within = Number { limit: Some(target), ..Number::share(WITHIN, one.gate.estimate, one.interval, one.runs) };
    match one.requirement.statement {
        Statement::Mean => vec![value("mean", one.gate.estimate, one.interval)],
        Statement::Fraction(_) => vec![within],
        Statement::Quantile(p) => {
            let found = statistics.and_then(|statistics| statistics.required(&one.requirement));
            let interval = found.filter(|_| one.has_interval()).map_or([None; 2], |quantile| quantile.interval);
            let ends = interval.map(|end| end.unwrap_or(f64::NAN));
            let quantile = one.value.map(|found| value(&format!("p{}", percent(p)), found, ends));
            quantile.into_iter().chain([within]).collect()
        }
    }
}

fn shown(one: &Assessment) -> ShownUnit {
    let limit = one.requirement.limit.value();
    one.shown.clone().of_time(limit.abs(), Some(limit))
}

fn sentence(one: &Assessment, numbers: &[Number]) -> String {
    let runs = counted(one.runs, "run");
    let values = numbers.iter().filter(|number| number.name != WITHIN && number.value.is_finite());
    let mut said: Vec<String> = values.map(|number| format!("{} {}", number.name, number.text())).collect();
    if let (Statement::Quantile(p), None, true) = (one.requirement.statement, one.value, one.missing > 0) {
        said.push(format!("p{} is among the runs without a value", percent(p)));
    }
    if one.requirement.statement == Statement::Mean {
        return if said.is_empty() { format!("no mean of {runs}") } else { format!("{} of {runs}", said.join("; ")) };
    }
    let at = one.worst.map_or(String::new(), |worst| {
        format!(" at {}, where the fewest are of {} points of time", time(worst.time_s), worst.points)
    });
    let share = match one.gate.estimate {
        estimate if estimate.is_finite() => format!(": {}", share([estimate; 2], one.interval)),
        _ => String::new(),
    };
    said.push(format!("{} of {runs} within the limit{at}{share}", one.runs - one.violations));
    said.extend((one.missing > 0).then(|| without_value(&one.missing.to_string())));
    said.join("; ")
}

/// Qualifications of a verdict: the assumption of a mean, then the deciding one.
fn notes(one: &Assessment) -> Vec<String> {
    let assumed =
        assumed(one).map(|assumed| [assumed, "with bounded = [lowest, highest] nothing is assumed".to_owned()]);
    let mut notes: Vec<String> = assumed.into_iter().flatten().chain(decided_by(one)).collect();
    notes.extend(one.reason.clone());
    if let Some(worst) = one.worst {
        if worst.unresolved > 0 {
            let runs = counted(worst.unresolved, "more run");
            notes.push(format!("{runs} too near to the limit for the bands to tell, counted as violations"));
        }
        notes.push(format!(
            "it passes if every point does at {}%, and fails if one does at {}%, the correction over {} points",
            trimmed(100.0 * one.confidences[0], 6),
            trimmed(100.0 * one.fails_at(), 6),
            worst.points
        ));
    }
    notes.extend(one.note.clone());
    notes
}

/// The assumption of a decision on a mean about unseen rare events.
pub fn assumed(one: &Assessment) -> Option<String> {
    let room = with_unit(short(one.shown.value(one.room_for_rare_events()?)), &one.shown.unit);
    Some(format!("provided that events rarer than {RARE} in {} runs move the mean by less than {room}", one.runs,))
}

/// The deciding bound, if the two-sided interval suggests another verdict: it contains the limit although the one-sided
/// bound decides, or excludes it although nothing is decided. Else `None`.
fn decided_by(one: &Assessment) -> Option<String> {
    if one.fails_alone() {
        let [alone, together] = [one.fails_alone_at(), one.fails_at()].map(|confidence| trimmed(100.0 * confidence, 6));
        return Some(format!("missed at {alone}%, not at the {together}% that all requirements together ask for"));
    }
    let ([bound, limit], is_lower) = one.hidden_bound()?;
    let is_mean = one.requirement.statement == Statement::Mean;
    let shown = |value: f64| if is_mean { one.shown.value(value) } else { 100.0 * value };
    let (bound, limit) = (shown(bound), shown(limit));
    // round towards the estimate's far side with enough digits to stay beyond the limit
    let rounded = |digits: i32| outward([bound; 2], digits)[usize::from(!is_lower)];
    let digits = (3..DIGITS)
        .find(|digits| if is_lower { rounded(*digits) > limit } else { rounded(*digits) < limit })
        .unwrap_or(DIGITS);
    let number = trimmed(rounded(digits), digits as usize);
    let number = if is_mean { with_unit(number, &one.shown.unit) } else { format!("{number}% of runs") };
    let side = if is_lower { "at least" } else { "at most" };
    Some(format!("{side} {number}, one-sided at {}%", percent(one.confidences[0])))
}

/// Error rates of the verdicts together, and the remedy for undecided ones.
fn together(verdicts: &Verdicts) -> Vec<String> {
    let mut said = Vec::new();
    let least = verdicts.list.iter().map(|one| one.requirement.confidence).fold(1.0, f64::min);
    if verdicts.list.len() > 1 {
        said.push(format!(
            "of the {} requirements together: the chance that one which is met FAILs is at most {}% (Holm), and so is \
             the chance that all PASS while one is missed",
            verdicts.list.len(),
            trimmed(100.0 * (1.0 - least), 6)
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
    if verdicts.invalid > 0 {
        let share = verdicts.invalid as f64 / verdicts.samples as f64;
        said.push(format!(
            "{} of {} samples ({}%) are not physical and outside of the population",
            verdicts.invalid,
            verdicts.samples,
            number::percent(share)
        ));
    }
    said
}
