//! [`Survey`]: what the page takes from the rows: counts, a thinned table, exceedance of the main outcomes, the worst runs.
//!
//! One pass over the parts, with memory that does not depend on their number. Rows of the thinned table are chosen by a hash of the
//! sample's number: neither a design's order nor the number of parts matters, and the same samples are chosen of the same campaign.

use std::num::NonZeroUsize;

use crate::analysis::observed::Observed;
use crate::campaign::Requirement;
use crate::ensemble::Ensemble;
use crate::ensemble::audit::AuditValue;
use crate::observables::Group;
use crate::observables::headlines::{STATE_ERROR_ESTIMATE, headlines};
use crate::report::page::shown_columns::{CONFIDENCE, interval, is_error};
use crate::run::{Quantity, Status};
use crate::sampling::SampleId;
use crate::statistics::sketch::Sketch;
use crate::storage::rows_reader::{PartReader, RowsError, RowsReader};

/// Most rows of the thinned table.
pub const THINNED: u64 = 16_384;
/// Most points of a scatter plot.
pub const SCATTER: usize = 2000;
/// How many of the worst runs are kept for each outcome, and how many that failed for each status.
const KEPT: usize = 10;
/// Most columns of outcomes in the thinned table: wheels have some each.
const MOST_OUTCOMES: usize = 32;

/// Quantiles of fewer runs are not shown.
const FIRST_GROWTH: u64 = 16;

/// An outcome that the page looks at.
#[derive(Clone, Debug)]
pub struct Outcome {
    /// Name, unit, meaning.
    pub quantity: Quantity,
    /// Whether a requirement names it.
    pub is_required: bool,
    /// Whether it is an error of the computation.
    pub is_error: bool,
    /// Its magnitudes if it is an error, else its values, about that of the nominal run; over the dispersed runs that are ok.
    pub sketch: Sketch,
    /// The runs with the largest magnitudes, in descending order.
    pub largest: Vec<(SampleId, f64)>,
    /// Its value in the nominal run; NaN where that has none.
    pub nominal: f64,
    /// Quantiles of the first runs: number of runs, median, 99%-quantile, and the ends of its interval.
    pub growth: Vec<[f64; 5]>,
    /// The number of runs at which quantiles are noted next.
    next_growth: u64,
}

/// Runs that ended with one status.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Ended {
    /// The status.
    pub status: Status,
    /// How many there are.
    pub count: u64,
    /// The first of them, with their reasons.
    pub first: Vec<(SampleId, String)>,
}

/// Rows of some samples.
#[derive(Clone, Debug, Default)]
pub struct Thinned {
    /// The samples, ascending.
    pub samples: Vec<u64>,
    /// How each ended.
    pub statuses: Vec<Status>,
    /// Inputs as applied, column by column.
    pub inputs: Vec<Vec<f64>>,
    /// Outcomes, column by column as [`Survey::outcomes`].
    pub outcomes: Vec<Vec<f64>>,
}

/// What the page takes from the rows.
#[derive(Clone, Debug)]
pub struct Survey {
    /// Number of samples.
    pub samples: u64,
    /// How the runs ended; those that occur, and `ok`.
    pub ended: Vec<Ended>,
    /// The outcomes.
    pub outcomes: Vec<Outcome>,
    /// Some rows.
    pub thinned: Thinned,
    /// Estimated and true error of audited runs, at most [`SCATTER`]: sample, estimate, truth.
    pub audits: Vec<[f64; 3]>,
    /// How many runs were audited.
    pub audited: u64,
}

/// The hash of a sample's number (the finaliser of SplitMix64, G. L. Steele, D. Lea & C. H. Flood, OOPSLA 2014).
fn hash(sample: u64) -> u64 {
    let mut z = sample.wrapping_add(0x9e37_79b9_7f4a_7c15);
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
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

/// The outcomes: those that are asked for, those of a summary, and the motion's.
fn observed(ensemble: &Ensemble<'_>, asked: &[String]) -> Vec<Observed> {
    let columns = ensemble.request().columns();
    let main = headlines(ensemble.request()).into_iter().map(|index| columns[index].quantity.name().to_owned());
    let motion = columns.iter().filter(|column| column.group == Group::Motion).map(|column| column.quantity.name());
    let motion = motion.filter(|name| name.contains("_max_")).map(str::to_owned);
    let wanted: Vec<String> = asked.iter().cloned().chain(main).chain(motion).collect();
    let mut found = Observed::named(ensemble.plan(), wanted.iter().map(String::as_str));
    found.sort_by_key(|one| wanted.iter().position(|name| name == one.quantity.name()));
    found.truncate(MOST_OUTCOMES.max(asked.len()));
    found
}

/// What is read from one part.
struct Read {
    samples: Vec<SampleId>,
    statuses: Vec<Status>,
    reasons: Vec<Option<String>>,
    inputs: Vec<Vec<f64>>,
    outcomes: Vec<Vec<f64>>,
    audits: Option<[Vec<f64>; 2]>,
}

impl Survey {
    /// Reads the parts of a result. Outcomes named in `asked` come first.
    ///
    /// # Errors
    /// Where a part cannot be read.
    pub fn new(
        ensemble: &Ensemble<'_>,
        rows: &RowsReader,
        asked: &[String],
        threads: Option<NonZeroUsize>,
    ) -> Result<Self, RowsError> {
        let plan = ensemble.plan();
        let columns = observed(ensemble, asked);
        let required: Vec<&str> = plan.analysis.requirements.iter().filter_map(Requirement::observable).collect();
        let inputs: Vec<String> =
            plan.dispersions.columns().iter().map(|column| column.parameter.column_name(column.component)).collect();
        let outcome = |column: &Observed| Outcome {
            quantity: column.quantity.clone(),
            is_required: required.contains(&column.quantity.name()),
            is_error: !column.is_count && is_error(column.quantity.name()),
            sketch: Sketch::default(),
            largest: Vec::new(),
            nominal: f64::NAN,
            growth: Vec::new(),
            next_growth: FIRST_GROWTH,
        };
        let mut survey = Survey {
            samples: 0,
            ended: Status::ALL.map(|status| Ended { status, count: 0, first: Vec::new() }).to_vec(),
            outcomes: columns.iter().map(outcome).collect(),
            thinned: Thinned {
                inputs: vec![Vec::new(); inputs.len()],
                outcomes: vec![Vec::new(); columns.len()],
                ..Thinned::default()
            },
            audits: Vec::new(),
            audited: 0,
        };
        let is_audited = plan.audit_fraction > 0.0;
        let estimate = STATE_ERROR_ESTIMATE.name();
        let has_estimate = columns.iter().any(|column| column.quantity.name() == estimate);
        let thin = Thinning::of(plan.rows());
        let read = |part: &mut PartReader| -> Result<Read, RowsError> {
            let numbers = |name: &str| part.numbers(name);
            let samples = part.samples()?;
            let kept: Vec<usize> = (0..samples.len()).filter(|row| thin.keeps(samples[*row])).collect();
            let thinned = |name: &String| -> Result<Vec<f64>, RowsError> {
                let values = part.numbers(name)?;
                Ok(kept.iter().map(|row| values[*row]).collect())
            };
            let audits = if is_audited && has_estimate {
                Some([numbers(estimate)?, numbers(AuditValue::State.quantity().name())?])
            } else {
                None
            };
            Ok(Read {
                statuses: part.statuses()?,
                reasons: part.reasons()?,
                inputs: inputs.iter().map(thinned).collect::<Result<_, _>>()?,
                outcomes: columns.iter().map(|column| column.values(part)).collect::<Result<_, _>>()?,
                audits,
                samples,
            })
        };
        rows.visit(threads, read, |part| {
            survey.add(part, &thin, plan.samples > 1);
            Ok(())
        })?;
        survey.finish();
        Ok(survey)
    }

    fn add(&mut self, part: Read, thin: &Thinning, has_dispersed: bool) {
        for row in 0..part.samples.len() {
            let (sample, status) = (part.samples[row], part.statuses[row]);
            self.samples += 1;
            if let Some(ended) = self.ended.iter_mut().find(|ended| ended.status == status) {
                ended.count += 1;
                if status != Status::Done && ended.first.len() < KEPT {
                    ended.first.push((sample, part.reasons[row].clone().unwrap_or_default()));
                }
            }
            let is_nominal = sample == SampleId(0);
            for (outcome, values) in self.outcomes.iter_mut().zip(&part.outcomes) {
                if is_nominal && status == Status::Done {
                    outcome.nominal = values[row];
                    // the first row of all
                    if !outcome.is_error && outcome.nominal.is_finite() {
                        outcome.sketch = Sketch::about(outcome.nominal);
                    }
                }
                if status == Status::Done && !(is_nominal && has_dispersed) {
                    outcome.add(sample, values[row]);
                }
            }
            if thin.keeps(sample) {
                self.thinned.samples.push(sample.0);
                self.thinned.statuses.push(status);
                self.thinned.outcomes.iter_mut().zip(&part.outcomes).for_each(|(kept, values)| kept.push(values[row]));
            }
            if let Some([estimates, truths]) = &part.audits
                && truths[row].is_finite()
            {
                self.audited += 1;
                self.audits.push([sample.0 as f64, estimates[row], truths[row]]);
            }
        }
        self.thinned.inputs.iter_mut().zip(part.inputs).for_each(|(kept, values)| kept.extend(values));
        if self.audits.len() > 2 * SCATTER {
            self.thin_audits();
        }
    }

    fn thin_audits(&mut self) {
        let samples: Vec<u64> = self.audits.iter().map(|audit| audit[0] as u64).collect();
        self.audits = chosen(&samples, SCATTER).into_iter().map(|index| self.audits[index]).collect();
    }

    fn finish(&mut self) {
        self.thin_audits();
        self.ended.retain(|ended| ended.count > 0 || ended.status == Status::Done);
        self.outcomes.iter_mut().for_each(Outcome::finish);
    }

    /// How many runs are ok.
    pub fn ok(&self) -> u64 {
        self.ended.iter().find(|ended| ended.status == Status::Done).map_or(0, |ended| ended.count)
    }

    /// The outcome called `name`.
    pub fn outcome(&self, name: &str) -> Option<(usize, &Outcome)> {
        self.outcomes.iter().enumerate().find(|(_, outcome)| outcome.quantity.name() == name)
    }
}

impl Outcome {
    fn add(&mut self, sample: SampleId, value: f64) {
        let size = value.abs();
        if value.is_nan() {
            return;
        }
        self.sketch.add(if self.is_error { size } else { value });
        if self.largest.len() < KEPT || self.largest.last().is_some_and(|(_, least)| size > *least) {
            let at = self.largest.partition_point(|(_, other)| *other >= size);
            self.largest.insert(at, (sample, size));
            self.largest.truncate(KEPT);
        }
        if self.sketch.count() == self.next_growth {
            self.grow();
        }
    }

    fn finish(&mut self) {
        let is_new = self.growth.last().is_none_or(|last| last[0] < self.sketch.count() as f64);
        if is_new && self.sketch.count() >= FIRST_GROWTH {
            self.grow();
        }
    }

    /// Notes the quantiles of the runs so far.
    fn grow(&mut self) {
        const HIGH: f64 = 0.99;
        let count = self.sketch.count();
        let [low, high] = interval(&self.sketch, HIGH, CONFIDENCE);
        let of = |p: f64| self.sketch.quantile(p).unwrap_or(f64::NAN);
        self.growth.push([count as f64, of(0.5), of(HIGH), low, high]);
        // four steps to a doubling
        self.next_growth = (count as f64 * libm::pow(2.0, 0.25)) as u64 + 1;
    }
}

/// Which samples are kept in the thinned table.
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

    /// Law: a chosen subset does not follow the order of a low-discrepancy design: the chosen numbers have no common low bits.
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
