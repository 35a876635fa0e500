//! [`Survey`]: the data of the page: a thinned table, the worst runs, audits, and sketches of the main outcomes. Its
//! memory does not depend on the number of parts.
//!
//! The thinned rows are chosen by a hash of the sample number, reproducibly and independent of the order of a design
//! and of the parts.

use super::accumulator::Accumulator;
use super::observed::Observed;
use super::part_columns::PartColumns;
use super::population::Population;
use crate::analysis::first_rows::{RowTable, explained};
use crate::analysis::order_statistics::AskedQuantile;
use crate::analysis::outcomes::{is_worst_when_low, outcomes, unique};
use crate::analysis::statistics::Statistics;
use crate::analysis::statuses::Statuses;
use crate::analysis::worst_runs::{WorstRuns, shortfall};
use crate::campaign::{Plan, Requirement};
use crate::ensemble::Ensemble;
use crate::ensemble::audit::AuditValue;
use crate::observables::Group;
use crate::observables::headlines::{STATE_ERROR_ESTIMATE, headlines};
use crate::run::{Quantity, Status};
use crate::sampling::design::hash::{GOLDEN, mix};
use crate::sampling::{Column, SampleId};
use crate::statistics::quantile::interval_ranks;
use crate::statistics::sketch::{Ranks, Sketch, middle};
use crate::storage::rows_reader::Result;

/// Maximum rows of the thinned table.
pub const THINNED: u64 = 16_384;
/// Maximum points of a scatter plot.
pub const SCATTER: usize = 2000;
/// Worst runs kept per outcome.
const KEPT: usize = 10;
/// Maximum outcomes in the thinned table; each wheel has some.
const MOST_OUTCOMES: usize = 32;

/// Fewest runs with quantiles.
const FIRST_GROWTH: u64 = 16;

#[derive(Clone, Debug)]
pub struct SurveyedOutcome {
    pub quantity: Quantity,
    /// True if it is an outcome of the campaign.
    pub is_outcome: bool,
    pub is_error: bool,
    /// Values over the dispersed `ok` runs.
    pub sketch: Sketch,
    pub worst: WorstRuns,
    /// Value in the nominal run, or NaN.
    pub nominal: f64,
    pub confidence: f64,
    /// Quantiles of the first runs: number of runs, median, 99%-quantile with the ends of its interval, runs above a
    /// half, runs lost so far.
    pub growth: Vec<[f64; 7]>,
    /// Dispersed, physical runs that were not computed.
    pub lost: u64,
}

#[derive(Clone, Debug, Default)]
pub struct Thinned {
    pub samples: Vec<u64>,
    pub statuses: Vec<Status>,
    /// As applied, by column.
    pub inputs: Vec<Vec<f64>>,
    /// By column, as [`Survey::outcomes`].
    pub outcomes: Vec<Vec<f64>>,
}

#[derive(Clone, Debug)]
pub struct Survey {
    pub statuses: Statuses,
    pub outcomes: Vec<SurveyedOutcome>,
    pub thinned: Thinned,
    /// Sample, estimated and true error of audited runs, at most [`SCATTER`].
    pub audits: Vec<[f64; 3]>,
    pub audited: u64,
    /// Runs farthest from their requirements, by [`shortfall`]; empty without a requirement on single runs.
    pub against: WorstRuns,
}

/// Column with the failure code of a mission, or 0.
pub const FAILURE: &str = "failure";

fn is_error(name: &str) -> bool {
    let is_largest =
        name.contains("_max") && ["_error", "residual_", "orthonormality"].iter().any(|mark| name.contains(mark));
    is_largest || name.ends_with("error_estimate")
}

/// Distribution-free interval of the `p`-quantile of `count` numbers (order statistics), wherever `lost` others are;
/// NaN for an open end.
fn interval([count, lost]: [u64; 2], ranks: &Ranks, p: f64, confidence: f64) -> [f64; 2] {
    if count == 0 {
        return [f64::NAN; 2];
    }
    let asked = AskedQuantile::new(p, confidence, Some(interval_ranks(count + lost, p, confidence)));
    let places = asked.with_lost(count, lost).ranks;
    let ends = places.map_or([None; 2], |places| [places.lower, places.upper]);
    ends.map(|rank| rank.and_then(|rank| ranks.bounds(rank)).map_or(f64::NAN, middle))
}

fn hash(sample: u64) -> u64 {
    mix(sample.wrapping_add(GOLDEN))
}

/// The `most` indices whose samples have the smallest hashes, ascending.
pub fn chosen(samples: &[u64], most: usize) -> Vec<usize> {
    let mut order: Vec<usize> = (0..samples.len()).collect();
    if order.len() > most {
        order.sort_by_key(|index| hash(samples[*index]));
        order.truncate(most);
        order.sort_unstable();
    }
    order
}

/// Names of the outcomes: of the campaign, with sensitivities, of the summary, of the motion; and the number of the
/// first two kinds.
fn wanted(ensemble: &Ensemble<'_>) -> (Vec<String>, usize) {
    let plan = ensemble.plan();
    let columns = ensemble.request().columns();
    let main = headlines(ensemble.request()).into_iter().map(|index| columns[index].quantity.name().to_owned());
    let motion = columns.iter().filter(|column| column.group == Group::Motion).map(|column| column.quantity.name());
    let motion = motion.filter(|name| name.contains("_max_")).map(str::to_owned);
    // marks failed missions on the page
    let failure = columns.iter().map(|column| column.quantity.name()).find(|name| *name == FAILURE).map(str::to_owned);
    let asked = unique(outcomes(plan).into_iter().chain(explained(plan)).chain(failure));
    let count = asked.len();
    (unique(asked.into_iter().chain(main).chain(motion)), count)
}

#[derive(Clone, Debug)]
pub struct Surveyor {
    observed: Vec<Observed>,
    /// Requirements on single runs, with the place of their observable.
    judged: Vec<(Requirement, usize)>,
    /// Columns of all dispersed values.
    inputs: Vec<String>,
    nothing: Survey,
    /// Largest hash of a sample in the thinned table.
    most_hash: u64,
    /// Columns of the estimated and the true state error, if audited.
    audited: Option<[&'static str; 2]>,
    has_dispersed: bool,
}

#[derive(Clone, Debug)]
pub struct SurveyedPart {
    counted: Vec<SampleId>,
    outcomes: Vec<Vec<f64>>,
    nominal: Option<Vec<f64>>,
    thinned: Thinned,
    audits: Vec<[f64; 3]>,
}

impl Surveyor {
    pub fn new(ensemble: &Ensemble<'_>) -> Self {
        let plan = ensemble.plan();
        let (names, asked) = wanted(ensemble);
        let mut observed = Observed::named(plan, names.iter().map(String::as_str));
        observed.sort_by_key(|one| names.iter().position(|name| name == one.name()));
        observed.truncate(MOST_OUTCOMES.max(asked));
        let outcomes = outcomes(plan);
        let inputs: Vec<String> = plan.dispersions.columns().iter().map(Column::name).collect();
        let outcome = |column: &Observed| SurveyedOutcome {
            quantity: column.quantity.clone(),
            is_outcome: outcomes.iter().any(|name| name == column.name()),
            is_error: !column.is_count && is_error(column.name()),
            sketch: Sketch::default(),
            worst: WorstRuns::new(KEPT, is_worst_when_low(plan, column.name())),
            nominal: f64::NAN,
            confidence: plan.analysis.confidence,
            growth: Vec::new(),
            lost: 0,
        };
        let estimate = STATE_ERROR_ESTIMATE.name();
        let place = |name: &str| observed.iter().position(|one| one.name() == name);
        let judged = |one: &Requirement| Some((one.clone(), place(one.of_runs()?)?));
        let has_estimate = observed.iter().any(|column| column.name() == estimate);
        Surveyor {
            nothing: Survey {
                statuses: Statuses::none(Population::of(plan)),
                outcomes: observed.iter().map(outcome).collect(),
                thinned: Thinned {
                    inputs: vec![Vec::new(); inputs.len()],
                    outcomes: vec![Vec::new(); observed.len()],
                    ..Thinned::default()
                },
                audits: Vec::new(),
                audited: 0,
                against: WorstRuns::new(KEPT, false),
            },
            judged: plan.analysis.requirements.iter().filter_map(judged).collect(),
            audited: (plan.audit_fraction > 0.0 && has_estimate)
                .then(|| [estimate, AuditValue::State.quantity().name()]),
            observed,
            inputs,
            most_hash: most_hash(plan.rows()),
            has_dispersed: plan.samples > 1,
        }
    }
}

impl Accumulator for Surveyor {
    type Whole = Survey;
    type OfPart = SurveyedPart;

    fn nothing(&self) -> Survey {
        self.nothing.clone()
    }

    fn count(&self, part: &impl PartColumns) -> Result<SurveyedPart> {
        let (samples, statuses) = (part.samples()?, part.statuses()?);
        let done = |row: &usize| statuses[*row] == Status::Done;
        let is_counted = |row: &usize| samples[*row].0 > 0 || !self.has_dispersed;
        let counted: Vec<usize> = (0..samples.len()).filter(done).filter(is_counted).collect();
        let kept: Vec<usize> = (0..samples.len()).filter(|row| is_kept(samples[*row], self.most_hash)).collect();
        let taken = |column: &[f64], rows: &[usize]| rows.iter().map(|row| column[*row]).collect::<Vec<f64>>();
        let columns = self.observed.iter().map(|one| one.column(part)).collect::<Result<Vec<_>>>()?;
        let nominal = (0..samples.len()).filter(done).find(|row| samples[*row].0 == 0);
        let inputs = self.inputs.iter().map(|name| Ok(taken(&part.numbers(name)?, &kept)));
        let audits = match self.audited {
            None => Vec::new(),
            Some(names) => {
                let [estimates, truths] = [part.numbers(names[0])?, part.numbers(names[1])?];
                let audited = (0..samples.len()).filter(|row| truths[*row].is_finite());
                audited.map(|row| [samples[row].0 as f64, estimates[row], truths[row]]).collect()
            }
        };
        Ok(SurveyedPart {
            outcomes: columns.iter().map(|column| taken(column, &counted)).collect(),
            counted: counted.iter().map(|row| samples[*row]).collect(),
            nominal: nominal.map(|row| columns.iter().map(|column| column[row]).collect()),
            thinned: Thinned {
                samples: kept.iter().map(|row| samples[*row].0).collect(),
                statuses: kept.iter().map(|row| statuses[*row]).collect(),
                inputs: inputs.collect::<Result<_>>()?,
                outcomes: columns.iter().map(|column| taken(column, &kept)).collect(),
            },
            audits,
        })
    }

    fn merge(&self, whole: &mut Survey, part: SurveyedPart) {
        for (outcome, value) in whole.outcomes.iter_mut().zip(part.nominal.unwrap_or_default()) {
            outcome.nominal = value;
        }
        for (outcome, values) in whole.outcomes.iter_mut().zip(&part.outcomes) {
            part.counted.iter().zip(values).for_each(|(sample, value)| outcome.worst.add(*sample, *value));
        }
        for (row, sample) in part.counted.iter().enumerate() {
            let values = self.judged.iter().map(|(requirement, place)| (requirement, part.outcomes[*place][row]));
            whole.against.add(*sample, shortfall(values));
        }
        whole.thinned.extend(part.thinned);
        whole.audited += part.audits.len() as u64;
        whole.audits.extend(part.audits);
        if whole.audits.len() > 2 * SCATTER {
            whole.thin_audits();
        }
    }
}

impl Thinned {
    fn extend(&mut self, more: Thinned) {
        self.samples.extend(more.samples);
        self.statuses.extend(more.statuses);
        let columns = self.inputs.iter_mut().chain(&mut self.outcomes);
        columns.zip(more.inputs.into_iter().chain(more.outcomes)).for_each(|(mine, theirs)| mine.extend(theirs));
    }
}

impl Survey {
    fn thin_audits(&mut self) {
        let samples: Vec<u64> = self.audits.iter().map(|audit| audit[0] as u64).collect();
        self.audits = chosen(&samples, SCATTER).into_iter().map(|index| self.audits[index]).collect();
    }

    #[must_use]
    pub fn finished(mut self, statuses: Statuses) -> Self {
        self.thin_audits();
        self.statuses = statuses;
        self
    }

    /// Adds the sketches of `statistics` to the outcomes, and quantiles over the `first` rows of `plan`.
    pub(super) fn describe(&mut self, plan: &Plan, statistics: &mut Statistics, first: &RowTable) {
        let lost = statistics.loss().missing;
        for outcome in &mut self.outcomes {
            let column = statistics.columns.iter_mut().find(|one| one.quantity.name() == outcome.quantity.name());
            outcome.sketch = column.and_then(|column| column.sketch.take()).unwrap_or_default();
            outcome.lost = lost;
            let values = first.column(plan, outcome.quantity.name()).filter(|_| outcome.is_outcome);
            outcome.growth = values.map_or_else(Vec::new, |values| outcome.grown(values, &first.is_ok));
        }
    }

    pub fn outcome(&self, name: &str) -> Option<(usize, &SurveyedOutcome)> {
        self.outcomes.iter().enumerate().find(|(_, outcome)| outcome.quantity.name() == name)
    }
}

impl SurveyedOutcome {
    /// True if every value is 1 or 0.
    pub fn is_yes_or_no(&self, values: &[f64]) -> bool {
        let are_ends =
            self.sketch.min().is_some_and(|min| min >= 0.0) && self.sketch.max().is_some_and(|max| max <= 1.0);
        are_ends && values.iter().all(|value| value.is_nan() || *value == 0.0 || *value == 1.0)
    }

    /// Quantiles over the first of `values`, NaN for none, four steps per doubling, and over all runs.
    fn grown(&self, values: &[f64], is_ok: &[bool]) -> Vec<[f64; 7]> {
        let mut sketch = Sketch::about(Some(self.nominal).filter(|value| value.is_finite()).unwrap_or(0.0));
        let (mut rows, mut lost, mut next) = (Vec::new(), 0, FIRST_GROWTH);
        for (value, is_ok) in values.iter().zip(is_ok) {
            lost += u64::from(!is_ok);
            if value.is_nan() {
                continue;
            }
            sketch.add(*value);
            if sketch.count() == next {
                rows.push(self.quantiles(&sketch, lost));
                next = (next as f64 * libm::pow(2.0, 0.25)) as u64 + 1;
            }
        }
        let is_new = rows.last().is_none_or(|last: &[f64; 7]| last[0] < self.sketch.count() as f64);
        if is_new && self.sketch.count() >= FIRST_GROWTH {
            rows.push(self.quantiles(&self.sketch, self.lost));
        }
        rows
    }

    fn quantiles(&self, sketch: &Sketch, lost: u64) -> [f64; 7] {
        const HIGH: f64 = 0.99;
        let (count, ranks) = (sketch.count(), sketch.ranks());
        let [low, high] = interval([count, lost], &ranks, HIGH, self.confidence);
        let of = |p: f64| ranks.quantile(p).unwrap_or(f64::NAN);
        let above = count - ranks.at_most(0.5)[1];
        [count as f64, of(0.5), of(HIGH), low, high, above as f64, lost as f64]
    }
}

fn most_hash(samples: u64) -> u64 {
    if samples <= THINNED {
        return u64::MAX;
    }
    // four standard deviations below the maximum, since the number is random
    let aim = THINNED as f64 - 4.0 * libm::sqrt(THINNED as f64);
    (aim / samples as f64 * 2f64.powi(64)) as u64
}

fn is_kept(sample: SampleId, most_hash: u64) -> bool {
    sample == SampleId(0) || hash(sample.0) <= most_hash
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Law: nearly the maximum number of samples is kept, never more; all of a small campaign; always the nominal one.
    #[test]
    fn thinning_keeps_what_fits() {
        let kept = |samples: u64| (0..samples).filter(|id| is_kept(SampleId(*id), most_hash(samples))).count() as u64;
        assert_eq!(kept(1000), 1000);
        let many = kept(1_000_000);
        assert!((THINNED - 1200..=THINNED).contains(&many), "{many} of {THINNED}");
        assert!(is_kept(SampleId(0), most_hash(1 << 40)));
    }

    /// Law: a chosen subset is not periodic in a low-discrepancy design: chosen numbers share no low bits.
    #[test]
    fn chosen_samples_have_no_period() {
        let samples: Vec<u64> = (0..65_536).collect();
        let kept = chosen(&samples, SCATTER);
        assert_eq!(kept.len(), SCATTER);
        assert!(kept.is_sorted());
        for bit in 0..8 {
            let ones = kept.iter().filter(|index| **index >> bit & 1 == 1).count();
            assert!(ones.abs_diff(SCATTER / 2) < 112, "bit {bit}: {ones} of {SCATTER}");
        }
        assert_eq!(chosen(&samples[..10], SCATTER), (0..10).collect::<Vec<_>>());
    }
}
