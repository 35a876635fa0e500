//! [`Survey`]: what the page takes from the rows: a thinned table, the worst runs, audits; with the sketches that the
//! statistics have of the main outcomes.
//!
//! Its memory does not depend on the number of parts. Rows of the thinned table are chosen by a hash of the sample's
//! number: neither a design's order nor the number of parts matters, and the same samples are chosen of the same
//! campaign.

use crate::analysis::accumulator::Accumulator;
use crate::analysis::first_rows::{RowTable, explained};
use crate::analysis::observed::Observed;
use crate::analysis::order_statistics::AskedQuantile;
use crate::analysis::outcomes::{is_worst_when_low, outcomes};
use crate::analysis::part_columns::PartColumns;
use crate::analysis::population::Population;
use crate::analysis::statistics::Statistics;
use crate::analysis::statuses::Statuses;
use crate::analysis::worst_runs::WorstRuns;
use crate::campaign::Plan;
use crate::ensemble::Ensemble;
use crate::ensemble::audit::AuditValue;
use crate::observables::Group;
use crate::observables::headlines::{STATE_ERROR_ESTIMATE, headlines};
use crate::run::{Quantity, Status};
use crate::sampling::SampleId;
use crate::sampling::design::hash::{GOLDEN, mix};
use crate::statistics::quantile::interval_ranks;
use crate::statistics::sketch::{Ranks, Sketch, middle};
use crate::storage::rows_reader::RowsError;

/// Most rows of the thinned table.
pub const THINNED: u64 = 16_384;
/// Most points of a scatter plot.
pub const SCATTER: usize = 2000;
/// How many of the worst runs are kept for each outcome.
const KEPT: usize = 10;
/// Most columns of outcomes in the thinned table: wheels have some each.
const MOST_OUTCOMES: usize = 32;

/// Quantiles of fewer runs are not shown.
const FIRST_GROWTH: u64 = 16;

/// An outcome that the page looks at.
#[derive(Clone, Debug)]
pub struct SurveyedOutcome {
    /// Name, unit, meaning.
    pub quantity: Quantity,
    /// Whether the campaign is about it.
    pub is_outcome: bool,
    pub is_error: bool,
    /// Its values over the dispersed runs that are ok.
    pub sketch: Sketch,
    pub worst: WorstRuns,
    /// Its value in the nominal run; NaN where that has none.
    pub nominal: f64,
    /// The confidence of its intervals, that of the statistics.
    pub confidence: f64,
    /// Quantiles of the first runs: number of runs, median, 99%-quantile, and the ends of its interval; how many of the
    /// runs are above a half, and how many others were lost so far.
    pub growth: Vec<[f64; 7]>,
    /// Dispersed runs that are physical and were not computed.
    pub lost: u64,
}

#[derive(Clone, Debug, Default)]
pub struct Thinned {
    pub samples: Vec<u64>,
    pub statuses: Vec<Status>,
    /// Inputs as applied, column by column.
    pub inputs: Vec<Vec<f64>>,
    /// Outcomes, column by column as [`Survey::outcomes`].
    pub outcomes: Vec<Vec<f64>>,
}

/// What the page takes from the rows.
#[derive(Clone, Debug)]
pub struct Survey {
    pub statuses: Statuses,
    pub outcomes: Vec<SurveyedOutcome>,
    pub thinned: Thinned,
    /// Estimated and true error of audited runs, at most [`SCATTER`]: sample, estimate, truth.
    pub audits: Vec<[f64; 3]>,
    /// How many runs were audited.
    pub audited: u64,
}

/// The column with the code of how a mission failed; 0 where it did not.
pub const FAILURE: &str = "failure";

/// Whether the column `name` is an error of the computation, which should be small and is never negative.
fn is_error(name: &str) -> bool {
    let is_largest =
        name.contains("_max") && ["_error", "residual_", "orthonormality"].iter().any(|mark| name.contains(mark));
    is_largest || name.ends_with("error_estimate")
}

/// The distribution-free interval of the `p`-quantile of `count` numbers (order statistics), wherever `lost` others
/// are; NaN where there are too few for an end.
fn interval([count, lost]: [u64; 2], ranks: &Ranks, p: f64, confidence: f64) -> [f64; 2] {
    if count == 0 {
        return [f64::NAN; 2];
    }
    let asked = AskedQuantile::new(p, confidence, Some(interval_ranks(count + lost, p, confidence)));
    let places = asked.with_lost(count, lost).ranks;
    let ends = places.map_or([None; 2], |places| [places.lower, places.upper]);
    ends.map(|rank| rank.and_then(|rank| ranks.bounds(rank)).map_or(f64::NAN, middle))
}

/// The hash of a sample's number.
fn hash(sample: u64) -> u64 {
    mix(sample.wrapping_add(GOLDEN))
}

/// Keeps the `most` indices whose samples have the smallest hashes, in ascending order.
pub fn chosen(samples: &[u64], most: usize) -> Vec<usize> {
    let mut order: Vec<usize> = (0..samples.len()).collect();
    if order.len() > most {
        order.sort_by_key(|index| hash(samples[*index]));
        order.truncate(most);
        order.sort_unstable();
    }
    order
}

/// The names of the outcomes: those that the campaign is about, those whose inputs are estimated, those of a summary,
/// and the motion's; and how many of them the first ones are.
fn wanted(ensemble: &Ensemble<'_>) -> (Vec<String>, usize) {
    let plan = ensemble.plan();
    let columns = ensemble.request().columns();
    let main = headlines(ensemble.request()).into_iter().map(|index| columns[index].quantity.name().to_owned());
    let motion = columns.iter().filter(|column| column.group == Group::Motion).map(|column| column.quantity.name());
    let motion = motion.filter(|name| name.contains("_max_")).map(str::to_owned);
    let mut names: Vec<String> = Vec::new();
    let mut add = |some: &mut dyn Iterator<Item = String>| {
        for name in some {
            if !names.contains(&name) {
                names.push(name);
            }
        }
        names.len()
    };
    // how a mission failed says which runs the page marks
    let failure = columns.iter().map(|column| column.quantity.name()).find(|name| *name == FAILURE).map(str::to_owned);
    let asked = add(&mut outcomes(plan).into_iter().chain(explained(plan)).chain(failure));
    add(&mut main.chain(motion));
    (names, asked)
}

/// Takes what the page shows from the rows.
#[derive(Clone, Debug)]
pub struct Surveyor {
    observed: Vec<Observed>,
    /// Names of the columns of all dispersed values.
    inputs: Vec<String>,
    nothing: Survey,
    thinning: Thinning,
    /// Names of the estimated and the true error of the state, where runs are audited.
    audited: Option<[&'static str; 2]>,
    has_dispersed: bool,
}

#[derive(Clone, Debug)]
pub struct SurveyedPart {
    counted: Vec<SampleId>,
    outcomes: Vec<Vec<f64>>,
    /// Those of the nominal run.
    nominal: Option<Vec<f64>>,
    thinned: Thinned,
    audits: Vec<[f64; 3]>,
}

impl Surveyor {
    pub fn new(ensemble: &Ensemble<'_>) -> Self {
        let plan = ensemble.plan();
        let (names, asked) = wanted(ensemble);
        let mut observed = Observed::named(plan, names.iter().map(String::as_str));
        observed.sort_by_key(|one| names.iter().position(|name| name == one.quantity.name()));
        observed.truncate(MOST_OUTCOMES.max(asked));
        let outcomes = outcomes(plan);
        let inputs: Vec<String> =
            plan.dispersions.columns().iter().map(|column| column.parameter.column_name(column.component)).collect();
        let outcome = |column: &Observed| SurveyedOutcome {
            quantity: column.quantity.clone(),
            is_outcome: outcomes.iter().any(|name| name == column.quantity.name()),
            is_error: !column.is_count && is_error(column.quantity.name()),
            sketch: Sketch::default(),
            worst: WorstRuns::new(KEPT, is_worst_when_low(plan, column.quantity.name())),
            nominal: f64::NAN,
            confidence: plan.analysis.confidence,
            growth: Vec::new(),
            lost: 0,
        };
        let estimate = STATE_ERROR_ESTIMATE.name();
        let has_estimate = observed.iter().any(|column| column.quantity.name() == estimate);
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
            },
            audited: (plan.audit_fraction > 0.0 && has_estimate)
                .then(|| [estimate, AuditValue::State.quantity().name()]),
            observed,
            inputs,
            thinning: Thinning::of(plan.rows()),
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

    fn count(&self, part: &impl PartColumns) -> Result<SurveyedPart, RowsError> {
        let (samples, statuses) = (part.samples()?, part.statuses()?);
        let done = |row: &usize| statuses[*row] == Status::Done;
        let is_counted = |row: &usize| samples[*row].0 > 0 || !self.has_dispersed;
        let counted: Vec<usize> = (0..samples.len()).filter(done).filter(is_counted).collect();
        let kept: Vec<usize> = (0..samples.len()).filter(|row| self.thinning.keeps(samples[*row])).collect();
        let taken = |column: &[f64], rows: &[usize]| rows.iter().map(|row| column[*row]).collect::<Vec<f64>>();
        let columns = self.observed.iter().map(|one| one.column(part)).collect::<Result<Vec<_>, RowsError>>()?;
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
                inputs: inputs.collect::<Result<_, RowsError>>()?,
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

    /// The same after the last part, with how all runs ended.
    #[must_use]
    pub fn finished(mut self, statuses: Statuses) -> Self {
        self.thin_audits();
        self.statuses = statuses;
        self
    }

    /// The outcomes, each with the sketch that `statistics` have of it, and with its quantiles in the `first` rows of
    /// `plan`, where it is one of these.
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
    /// Whether it answers yes or no: every value is 1 or 0.
    pub fn is_yes_or_no(&self, values: &[f64]) -> bool {
        let are_ends =
            self.sketch.min().is_some_and(|min| min >= 0.0) && self.sketch.max().is_some_and(|max| max <= 1.0);
        are_ends && values.iter().all(|value| value.is_nan() || *value == 0.0 || *value == 1.0)
    }

    /// Its quantiles in the first of the runs with `values`, NaN where one has none, four steps to a doubling; and in
    /// all runs.
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

    /// The quantiles of the runs in `sketch`, without those that are `lost`.
    fn quantiles(&self, sketch: &Sketch, lost: u64) -> [f64; 7] {
        const HIGH: f64 = 0.99;
        let (count, ranks) = (sketch.count(), sketch.ranks());
        let [low, high] = interval([count, lost], &ranks, HIGH, self.confidence);
        let of = |p: f64| ranks.quantile(p).unwrap_or(f64::NAN);
        let above = count - ranks.at_most(0.5)[1];
        [count as f64, of(0.5), of(HIGH), low, high, above as f64, lost as f64]
    }
}

/// Which samples are kept in the thinned table.
#[derive(Clone, Copy, Debug)]
struct Thinning {
    /// Samples whose hash is at most this.
    most: u64,
}

impl Thinning {
    fn of(samples: u64) -> Self {
        let most = if samples <= THINNED {
            u64::MAX
        } else {
            // a little fewer than allowed: the number is random with the standard deviation of its square root
            let aim = THINNED as f64 - 4.0 * libm::sqrt(THINNED as f64);
            (aim / samples as f64 * 2f64.powi(64)) as u64
        };
        Thinning { most }
    }

    fn keeps(&self, sample: SampleId) -> bool {
        sample == SampleId(0) || hash(sample.0) <= self.most
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Law: about as many samples are kept as are allowed, never more; all of a small campaign; the nominal one always.
    #[test]
    fn thinning_keeps_what_fits() {
        let kept = |samples: u64| (0..samples).filter(|id| Thinning::of(samples).keeps(SampleId(*id))).count() as u64;
        assert_eq!(kept(1000), 1000);
        let many = kept(1_000_000);
        assert!((THINNED - 1200..=THINNED).contains(&many), "{many} of {THINNED}");
        assert!(Thinning::of(1 << 40).keeps(SampleId(0)));
    }

    /// Law: a chosen subset does not follow the order of a low-discrepancy design: the chosen numbers have no common
    /// low bits.
    #[test]
    fn chosen_samples_have_no_period() {
        let samples: Vec<u64> = (0..65_536).collect();
        let kept = chosen(&samples, SCATTER);
        assert_eq!(kept.len(), SCATTER);
        assert!(kept.is_sorted());
        for bit in 0..8 {
            let ones = kept.iter().filter(|index| **index >> bit & 1 == 1).count();
            // five standard deviations of a fair coin
            assert!(ones.abs_diff(SCATTER / 2) < 112, "bit {bit}: {ones} of {SCATTER}");
        }
        assert_eq!(chosen(&samples[..10], SCATTER), (0..10).collect::<Vec<_>>());
    }
}
