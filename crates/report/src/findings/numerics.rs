//! Accuracy of the runs: largest errors, audits ([`AuditSummary`]) and the runs worth a look.

use serde::Serialize;

use crate::analysis::analysed::Analysed;
use crate::analysis::audit_tally::{AuditTally, Coverage, PROMISED_COVERAGE};
use crate::analysis::outcomes::outcomes;
use crate::analysis::tally::{Tally, Worst};
use crate::campaign::{Plan, ShownUnit};
use crate::ensemble::audit::AuditValue;
use crate::findings::finding::{Finding, Kind, Number};
use crate::findings::names;
use crate::findings::number::{self, counted, short};
use crate::findings::outcome::shown;
use crate::findings::requirement::{LAUNCHED, NOT_LAUNCHED, against};
use crate::observables::accuracy::INACCURATE_STATE;
use crate::observables::headlines::{DEBRIS_STATE_ERROR_ESTIMATE, STATE_ERROR_ESTIMATE};
use crate::statistics::quantile::percent;
use crate::statistics::spread::Spread;

/// Numerical errors of an observable over the audited runs, compared with its spread.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Numerics {
    /// Number of audited runs that have it.
    pub count: u64,
    #[serde(flatten)]
    pub error: Quantiles,
    /// Difference of the 95% and 5% quantiles of the observable.
    pub spread: f64,
    /// `p95` over `spread`; absent without a spread.
    pub share_of_spread: Option<f64>,
}

/// Order statistics of an error, type 7.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Quantiles {
    pub median: Option<f64>,
    pub p95: Option<f64>,
    pub p99: Option<f64>,
    pub max: Option<f64>,
}

impl Quantiles {
    fn of(spread: &Spread) -> Self {
        let [median, p95, p99] = [0.5, 0.95, 0.99].map(|p| spread.quantile(p));
        Quantiles { median, p95, p99, max: spread.max() }
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Estimate {
    pub audited: u64,
    /// Runs whose estimate covers the true error.
    pub covered: u64,
    pub coverage: Option<f64>,
    pub median_ratio: Option<f64>,
    pub promised: f64,
    /// Probability of at most this coverage if the promise holds.
    pub chance: f64,
    /// Uncovered runs beyond chance; else 0.
    pub excess: u64,
}

#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct AuditSummary {
    /// Fraction of samples selected for audits.
    pub fraction: f64,
    pub audited: u64,
    /// Selected runs without an end, or whose reference solution has none.
    pub failed: u64,
    /// Audited against double-double; the others against doubles with tolerance 1e-16.
    pub in_double_double: u64,
    /// Maximum of the next two.
    pub state_error: Quantiles,
    /// Relative to the run's maximum |omega|.
    pub omega_error: Quantiles,
    /// Error of the attitude, rad.
    pub attitude_error_rad: Quantiles,
    /// Error of the rotation of the debris.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub debris_error: Option<Quantiles>,
    /// Coverage of `state_error_estimate`.
    pub estimate: Estimate,
    /// Coverage of `debris_state_error_estimate`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub debris_estimate: Option<Estimate>,
}

impl Estimate {
    fn new(coverage: &Coverage) -> Self {
        Estimate {
            audited: coverage.audited,
            covered: coverage.covered,
            coverage: (coverage.audited > 0).then(|| coverage.covered as f64 / coverage.audited as f64),
            median_ratio: coverage.ratio.quantile(0.5),
            promised: PROMISED_COVERAGE,
            chance: coverage.chance(),
            excess: coverage.excess(),
        }
    }
}

impl Numerics {
    /// Errors of the observable `name`; `None` if no audit has it.
    pub fn of(analysed: &Analysed, name: &str) -> Option<Self> {
        let index = analysed.tally.headlines.iter().position(|headline| headline == name)?;
        Numerics::new(analysed.tally.audits.as_ref()?, index, analysed.statistics.column(name)?.spread?)
    }

    fn new(audits: &AuditTally, index: usize, spread: f64) -> Option<Self> {
        let errors = &audits.observables[index];
        let (count, p95) = (errors.count(), errors.quantile(0.95)?);
        let share_of_spread = (spread > 0.0).then_some(p95 / spread);
        Some(Numerics { count, error: Quantiles::of(errors), spread, share_of_spread })
    }
}

impl AuditSummary {
    pub fn of(plan: &Plan, tally: &Tally) -> Option<Self> {
        tally.audits.as_ref().map(|audits| AuditSummary::new(audits, plan.audit_fraction))
    }

    pub fn new(audits: &AuditTally, fraction: f64) -> Self {
        AuditSummary {
            fraction,
            audited: audits.audited,
            failed: audits.failed,
            in_double_double: audits.in_double_double,
            state_error: Quantiles::of(&audits.state),
            omega_error: Quantiles::of(&audits.omega),
            attitude_error_rad: Quantiles::of(&audits.attitude),
            debris_error: (audits.debris.count() > 0).then(|| Quantiles::of(&audits.debris)),
            estimate: Estimate::new(&audits.coverage),
            debris_estimate: (audits.debris.count() > 0).then(|| Estimate::new(&audits.debris_coverage)),
        }
    }

    /// Each estimate with the name of its column.
    fn estimates(&self) -> impl Iterator<Item = (String, Estimate)> {
        let debris = self.debris_estimate.map(|estimate| (DEBRIS_STATE_ERROR_ESTIMATE, estimate));
        let all = std::iter::once((STATE_ERROR_ESTIMATE, self.estimate)).chain(debris);
        all.map(|(column, estimate)| (names::of_column(column.name(), ""), estimate))
    }

    /// One sentence for each estimate whose coverage is below its promise beyond chance.
    pub(super) fn broken_promises(&self) -> Vec<String> {
        let broken = self.estimates().filter(|(_, estimate)| estimate.excess > 0);
        let sentence = |(name, one): (String, Estimate)| {
            format!(
                "{name} covers the true error in {} of {} audited runs, at least {}% are promised; with that \
                 promise kept, so few or fewer would have the probability {}. The numerical errors of these runs are \
                 larger than their estimates",
                one.covered,
                one.audited,
                percent(one.promised),
                short(one.chance),
            )
        };
        broken.map(sentence).collect()
    }
}

/// CPU time of the audits, s, and its share of the total, from the CPU times of runs and audits.
pub fn cost([runs, audits]: [f64; 2]) -> String {
    format!("{} s of CPU time, {:.1}% of the total", short(audits), 100.0 * audits / (runs + audits).max(1e-9))
}

const ERRORS: [(&str, &str); 5] = [
    ("energy_error_max", "energy"),
    ("angular_momentum_error_max", "angular momentum"),
    ("linear_momentum_error_max", "linear momentum"),
    ("state_error_estimate", "estimated state error"),
    ("debris_state_error_estimate", "estimated state error of the debris"),
];

/// Only loops whose outcomes are proved have computed runs with such an error.
const PARTING: &str = "where states of two runs that differ by rounding part for good (a pulse that fires or not), \
    while their outcomes agree: runs are judged by outcomes";

/// Largest errors, audits and runs to look at: the worst against the requirements, the worst of each observable, those
/// in `required` first, those with the largest errors, and the first with each failure.
pub(super) fn findings(plan: &Plan, analysed: &Analysed, required: &[String]) -> Vec<Finding> {
    let statistics = &analysed.statistics;
    let largest = |(name, of): &(&str, &str)| {
        let column = statistics.column(name)?;
        Some(number(of, Some(column.moments.max()?), column.moments.count(), ""))
    };
    let errors: Vec<Number> = ERRORS.iter().filter_map(largest).collect();
    let mut found = Vec::new();
    if !errors.is_empty() {
        let mut said: Vec<String> = errors.iter().map(|one| format!("{} {}", one.name, one.text())).collect();
        let state = statistics.column(STATE_ERROR_ESTIMATE.name()).and_then(|column| column.moments.max());
        if state.is_some_and(|error| error >= INACCURATE_STATE) {
            said.push(PARTING.to_owned());
        }
        let said = Finding::new(Kind::Numerics, "errors", "largest numerical errors, relative", said.join(", "));
        found.push(Finding { numbers: errors, rank: 1, ..said });
    }
    if let Some(audit) = AuditSummary::of(plan, &analysed.tally) {
        found.extend(audit.estimates().map(|(name, one)| coverage(&name, &one)));
        found.push(audit.finding(plan.law.is_some()));
        found.extend(observed(plan, analysed));
    }
    let worst = analysed.survey.against.runs.first();
    found.extend(worst.map(|(sample, shortfall)| {
        let title = format!("worst run ({})", against(plan, *shortfall));
        Finding { sample: Some(*sample), ..Finding::new(Kind::Runs, WORST_RUN, title, "") }
    }));
    let (mut is_first, outcomes) = (worst.is_none(), outcomes(plan));
    let named: Vec<&String> = required.iter().chain(&outcomes).collect();
    let order = |worst: &&Worst| named.iter().position(|name| **name == worst.name).unwrap_or(usize::MAX);
    let mut all: Vec<&Worst> = analysed.tally.worst.iter().collect();
    all.sort_by_key(order);
    for worst in all {
        let Some((sample, value)) = worst.list.runs.first() else { continue };
        let column = statistics.column(&worst.name).filter(|_| !worst.is_error);
        let unit = column.map_or("", |column| column.quantity.unit());
        let title = match column {
            None => format!("worst {} {}", worst.name, short(*value)),
            Some(_) if worst.name == LAUNCHED && *value != 0.0 => continue,
            Some(_) if worst.name == LAUNCHED => NOT_LAUNCHED.to_owned(),
            Some(column) => {
                let shown = plan.analysis.display.of(&worst.name, unit).of_time(value.abs(), None);
                let name = names::of_extreme(&names::of_quantity(&column.quantity), worst.list.is_low);
                format!("{name} ({})", number::with_unit(short(shown.value(*value)), &shown.unit))
            }
        };
        let numbers = vec![number(&worst.name, Some(*value), 1, unit)];
        let run = Finding::new(Kind::Runs, WORST_RUN, title, "");
        let rank = u8::from(column.is_none() || !core::mem::take(&mut is_first));
        found.push(Finding { rank, numbers, sample: Some(*sample), ..run });
    }
    for ended in analysed.tally.statuses.failed() {
        let sample = ended.first.first().map(|(sample, _)| *sample);
        let run = Finding::new(Kind::Runs, "first", format!("the first {}", ended.status.name()), "");
        found.push(Finding { sample, ..run });
    }
    found
}

/// Id of the runs with the worst values; the first is the run to look at.
pub const WORST_RUN: &str = "worst";
/// Id of the note on errors beyond the tolerance.
pub const BEYOND_TOLERANCE: &str = "beyond_tolerance";

/// The error that exceeds most what the tolerance promises, if any does.
pub(super) fn beyond_tolerance(plan: &Plan, analysed: &Analysed) -> Option<Finding> {
    /// Visible error of a state: a thousandth of a degree.
    const SEEN: f64 = 2e-5;
    /// The tolerance bounds one step, a balance accumulates all. The worst of 1,000 runs of `assets/start.toml`, of
    /// five steps each, reaches 1.2 to 2.7 times the tolerance, for tolerances of 1e-15 to 1e-12.
    const STEPS: f64 = 10.0;
    /// Rounding of N steps leaves about 3e-16 sqrt(N) (`tests/accuracy/round_off.rs`): of 1,000 steps.
    const ROUNDING: f64 = 1e-14;
    let tolerance = if plan.method.has_fixed_step() { SEEN } else { (STEPS * plan.tolerance.relative).max(ROUNDING) };
    let errors = analysed.survey.outcomes.iter().filter(|outcome| outcome.is_error);
    let excesses = errors.filter_map(|outcome| {
        let limit = if outcome.quantity.name().ends_with("estimate") { SEEN } else { tolerance };
        Some((outcome.sketch.max()? / limit, limit, outcome))
    });
    let (ratio, limit, outcome) = excesses.max_by(|a, b| a.0.total_cmp(&b.0))?;
    (ratio > 1.0).then(|| {
        let name = names::of_quantity(&outcome.quantity);
        let reached = short(ratio * limit);
        let promised = if limit == SEEN {
            format!("a thousandth of a degree is {}", number::written(SEEN))
        } else {
            format!("tolerance {} allows about {}", number::written(plan.tolerance.relative), number::trimmed(limit, 3))
        };
        let is_parting = outcome.quantity.name() == STATE_ERROR_ESTIMATE.name() && ratio * limit >= INACCURATE_STATE;
        let parting = if is_parting { format!(", {PARTING}") } else { String::new() };
        Finding::new(Kind::Note, BEYOND_TOLERANCE, "numerical errors", format!("{name} {reached}{parting}; {promised}"))
    })
}

fn coverage(name: &str, one: &Estimate) -> Finding {
    let share = one.coverage.unwrap_or(0.0);
    let said = format!(
        "{name} covers {} of {} true errors ({}%), {} times the error in the median",
        one.covered,
        one.audited,
        number::percent(share),
        one.median_ratio.map_or("-".to_owned(), short),
    );
    let covered = Number::share("covered", share, [f64::NAN; 2], one.audited);
    Finding { numbers: vec![covered], ..Finding::new(Kind::Numerics, "coverage", "audited errors", said) }
}

fn observed(plan: &Plan, analysed: &Analysed) -> Option<Finding> {
    let of = |name: &String| {
        let column = analysed.statistics.column(name)?;
        let numerics = Numerics::of(analysed, name)?;
        let unit = column.quantity.unit();
        let number = |what: &str, value| number(what, value, numerics.count, unit);
        let share = Number { unit: String::new(), ..number("share", numerics.share_of_spread) };
        let Quantiles { median, p95, max, .. } = numerics.error;
        let numbers = vec![number("median", median), number("p95", p95), number("max", max), share];
        let title = names::of_quantity(&column.quantity);
        Some(Finding { numbers, ..Finding::new(Kind::Numerics, name, title, "") })
    };
    let children: Vec<Finding> = shown(plan).iter().filter_map(of).collect();
    let title = "numerical error, and how much of the spread (p95 - p5) it is";
    let found = Finding::new(Kind::Numerics, "numerical_errors", title, "");
    (!children.is_empty()).then_some(Finding { children, rank: 1, ..found })
}

/// A number with four digits and without an interval; NaN for `None`.
fn number(name: &str, value: Option<f64>, runs: u64, unit: &str) -> Number {
    let value = (value.unwrap_or(f64::NAN), [f64::NAN; 2]);
    Number { digits: 4, ..Number::new(name, value, runs, unit, &ShownUnit::own(unit)) }
}
impl AuditSummary {
    fn finding(&self, has_law: bool) -> Finding {
        let (audited, plain) = (self.audited, self.audited - self.in_double_double);
        let runs = counted(audited, "run");
        let mut said = match has_law {
            true => format!("{runs} compared with the same loops at a tighter tolerance"),
            false => {
                format!("{runs} compared with reference solutions, {} of them in double-double", self.in_double_double)
            }
        };
        if plain > 0 && !has_law {
            said += &format!(", {plain} too long for that, in plain doubles with tolerance 1e-16");
        }
        if self.failed > 0 {
            said += &format!("; {} more did not reach their end", self.failed);
        }
        let errors = [
            (AuditValue::State, Some(self.state_error)),
            (AuditValue::Omega, Some(self.omega_error)),
            (AuditValue::Attitude, Some(self.attitude_error_rad)),
            (AuditValue::Debris, self.debris_error),
        ];
        let of = |(value, errors): (AuditValue, Option<Quantiles>)| {
            let (errors, quantity) = (errors?, value.quantity());
            let all = [("median", errors.median), ("p95", errors.p95), ("p99", errors.p99), ("max", errors.max)];
            let numbers = all.map(|(name, value)| number(name, value, audited, quantity.unit())).to_vec();
            let found = Finding::new(Kind::Numerics, quantity.name(), names::of_quantity(quantity), "");
            Some(Finding { numbers, ..found })
        };
        let children = if audited > 0 { errors.into_iter().filter_map(of).collect() } else { Vec::new() };
        Finding { children, rank: 1, ..Finding::new(Kind::Numerics, "audit", "audit", said) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::statistics::sketch::RELATIVE_ERROR;

    /// Law: quantiles are of type 7; ratios refer to the audited runs.
    #[test]
    fn quantiles_and_shares_are_those_stated() {
        let mut audits = AuditTally {
            audited: 4,
            coverage: Coverage { audited: 4, covered: 3, ..Coverage::default() },
            ..AuditTally::new(1)
        };
        (1..=1000).for_each(|k| audits.state.add(f64::from(k)));
        (1..=1000).for_each(|k| audits.observables[0].add(f64::from(k)));
        let found = AuditSummary::new(&audits, 0.5);
        let near = |found: Option<f64>, expected: f64| {
            let found = found.expect("a value");
            assert!((found / expected - 1.0).abs() <= RELATIVE_ERROR, "{found} for {expected}");
        };
        near(found.state_error.median, 500.5);
        near(found.state_error.p95, 950.05);
        near(found.state_error.p99, 990.01);
        assert_eq!((found.state_error.max, found.estimate.coverage), (Some(1000.0), Some(0.75)));
        let numerics = Numerics::new(&audits, 0, 89.1).expect("errors");
        near(numerics.share_of_spread, 950.05 / 89.1);
        assert_eq!(Numerics::new(&audits, 0, 0.0).and_then(|of| of.share_of_spread), None, "of no spread");
        assert_eq!(cost([3.0, 1.0]), format!("{} s of CPU time, 25.0% of the total", short(1.0)));
    }
}
