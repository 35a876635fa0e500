//! [`Tally`]: statistics of a campaign, counted part by part.
//!
//! Only counts, extremes and the numbers of samples are kept and no floating-point sums, so that the statistics do not depend on
//! the order of the parts. Sample 0 is the nominal scene: where there are others, the statistics are those of the others.

use std::collections::BTreeMap;
use std::sync::{Mutex, PoisonError};

use crate::analysis::accumulator::Accumulator;
use crate::analysis::audit_tally::AuditTally;
use crate::analysis::part_columns::PartColumns;
use crate::ensemble::audit::{AuditValue, Selection};
use crate::ensemble::{Audit, Ensemble, FailureReasons};
use crate::observables::accuracy::{BALANCES, STATE_ERRORS};
use crate::observables::headlines::headlines;
use crate::observables::{ColumnId, ColumnKind};
use crate::run::{Quantity, Status};
use crate::sampling::SampleId;
use crate::statistics::spread::Spread;
use crate::storage::rows_file::{audit_error_name, audited_observables};
use crate::storage::rows_reader::RowsError;

/// An observable whose numerical errors the audits measure, with the spread of its values.
#[derive(Clone, Debug)]
pub struct Headline {
    /// Index among the observables of a row.
    index: usize,
    /// Name, unit and meaning.
    pub quantity: Quantity,
    kind: ColumnKind,
    /// Its values over the runs that are `ok`.
    pub spread: Spread,
}

impl Headline {
    /// The `p`-quantile, of type 7. A count is rounded to a whole number, which the middle of a bucket need not be.
    pub fn quantile(&self, p: f64) -> Option<f64> {
        let value = self.spread.quantile(p)?;
        Some(if self.kind == ColumnKind::Count { libm::round(value) } else { value })
    }
}

/// How many samples of each group are listed by number.
const LISTED: usize = 3;

/// The samples that ended with one status.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Ended {
    /// How many there are.
    pub count: u64,
    /// The first of them, ascending.
    pub first: Vec<SampleId>,
}

impl Ended {
    fn add(&mut self, sample: SampleId) {
        self.count += 1;
        let at = self.first.partition_point(|other| *other < sample);
        if at < LISTED {
            self.first.insert(at, sample);
            self.first.truncate(LISTED);
        }
    }
}

/// The runs with the greatest values of an error, in descending order; equal values by ascending number.
#[derive(Clone, Debug, PartialEq)]
pub struct Worst {
    /// The error.
    pub name: &'static str,
    /// Indices among the observables of a row; the error is the maximum of their magnitudes.
    indices: Vec<usize>,
    /// Samples with their errors.
    pub runs: Vec<(SampleId, f64)>,
}

impl Worst {
    fn add(&mut self, sample: SampleId, error: f64) {
        let is_before = |(other, greater): &(SampleId, f64)| *greater > error || *greater == error && *other < sample;
        let at = self.runs.partition_point(is_before);
        if at < LISTED && !error.is_nan() {
            self.runs.insert(at, (sample, error));
            self.runs.truncate(LISTED);
        }
    }
}

/// Counts of statuses, the worst runs, and the audits with the spread of what they are about.
#[derive(Clone, Debug)]
pub struct Tally {
    /// Whether the statistics are those of the dispersed samples, without the nominal one.
    without_nominal: bool,
    statuses: [Ended; Status::ALL.len()],
    reasons: FailureReasons,
    /// None where the campaign has no audits.
    headlines: Vec<Headline>,
    worst: Vec<Worst>,
    /// `None` where the campaign has no audits.
    audits: Option<AuditTally>,
}

/// Counts a [`Tally`].
#[derive(Debug)]
pub struct TallyColumns {
    nothing: Tally,
    selection: Mutex<Selection>,
    /// The names of the observables.
    names: Vec<String>,
    /// Indices of the observables that are counted, ascending.
    wanted: Vec<usize>,
    /// Indices of those whose errors audits have.
    audited: Vec<usize>,
    has_debris: bool,
}

/// What a part adds.
#[derive(Clone, Debug)]
pub struct TallyPart {
    samples: Vec<SampleId>,
    statuses: Vec<Status>,
    reasons: Vec<(usize, String)>,
    /// Observables by their indices.
    values: BTreeMap<usize, Vec<f64>>,
    audits: Vec<(SampleId, Option<Audit>)>,
}

impl TallyColumns {
    /// Of the campaign `ensemble`.
    pub fn new(ensemble: &Ensemble<'_>) -> Self {
        let columns = ensemble.request().columns();
        let headline = |index: usize| {
            let column = &columns[index];
            Headline { index, quantity: column.quantity.clone(), kind: column.kind, spread: Spread::default() }
        };
        let is_audited = ensemble.plan().audit_fraction > 0.0;
        let headlines: Vec<Headline> =
            headlines(ensemble.request()).into_iter().filter(|_| is_audited).map(headline).collect();
        let index = |id: &ColumnId| ensemble.request().position(*id);
        let worst = [("conservation error", &BALANCES[..]), ("state error estimate", &STATE_ERRORS[..])].map(
            |(name, columns)| Worst { name, indices: columns.iter().filter_map(index).collect(), runs: Vec::new() },
        );
        let nothing = Tally {
            without_nominal: ensemble.plan().samples > 1,
            statuses: Default::default(),
            reasons: FailureReasons::default(),
            audits: is_audited.then(|| AuditTally::new(headlines.len())),
            headlines,
            worst: worst.into_iter().filter(|worst| !worst.indices.is_empty()).collect(),
        };
        let mut wanted: Vec<usize> = nothing.headlines.iter().map(|headline| headline.index).collect();
        wanted.extend(nothing.worst.iter().flat_map(|worst| &worst.indices));
        wanted.sort_unstable();
        wanted.dedup();
        TallyColumns {
            nothing,
            selection: Mutex::new(Selection::new(ensemble.plan())),
            names: columns.iter().map(|column| column.quantity.name().to_owned()).collect(),
            wanted,
            audited: audited_observables(ensemble),
            has_debris: ensemble.request().debris,
        }
    }

    /// The audits of a part. A sample that is to be audited and was not is an audit that failed.
    fn audits(
        &self,
        part: &impl PartColumns,
        samples: &[SampleId],
        statuses: &[Status],
    ) -> Result<Vec<(SampleId, Option<Audit>)>, RowsError> {
        if self.nothing.audits.is_none() {
            return Ok(Vec::new());
        }
        let read = |value: AuditValue| part.numbers(value.quantity().name());
        let (omega, attitude, estimate) =
            (read(AuditValue::Omega)?, read(AuditValue::Attitude)?, read(AuditValue::Estimate)?);
        let tolerance = read(AuditValue::Tolerance)?;
        let of_debris = |value| if self.has_debris { read(value) } else { Ok(vec![f64::NAN; omega.len()].into()) };
        let (debris, debris_estimate) = (of_debris(AuditValue::Debris)?, of_debris(AuditValue::DebrisEstimate)?);
        let error = |index: &usize| part.numbers(&audit_error_name(&self.names[*index]));
        let errors = self.audited.iter().map(error).collect::<Result<Vec<_>, RowsError>>()?;
        let mut selection = self.selection.lock().unwrap_or_else(PoisonError::into_inner);
        let rows = samples.iter().zip(statuses).enumerate();
        let selected = rows
            .filter(|(_, (sample, status))| **status != Status::InvalidSample && selection.contains(**sample))
            .map(|(row, (sample, _))| (row, *sample));
        let audit = |row: usize| {
            let mut observables = vec![f64::NAN; self.names.len()];
            self.audited.iter().zip(&errors).for_each(|(index, errors)| observables[*index] = errors[row]);
            Audit {
                omega: omega[row],
                attitude: attitude[row],
                debris: debris[row],
                estimate: estimate[row],
                debris_estimate: debris_estimate[row],
                reference_tolerance: tolerance[row],
                observables,
            }
        };
        Ok(selected.map(|(row, sample)| (sample, (!tolerance[row].is_nan()).then(|| audit(row)))).collect())
    }
}

impl Accumulator for TallyColumns {
    type Whole = Tally;
    type OfPart = TallyPart;

    fn nothing(&self) -> Tally {
        self.nothing.clone()
    }

    fn count(&self, part: &impl PartColumns) -> Result<TallyPart, RowsError> {
        let (samples, statuses) = (part.samples()?, part.statuses()?.into_owned());
        let has_failed = statuses.iter().any(|status| *status != Status::Done);
        let values = self.wanted.iter().map(|index| Ok((*index, part.numbers(&self.names[*index])?.into_owned())));
        Ok(TallyPart {
            reasons: if has_failed { part.reasons()?.into_owned() } else { Vec::new() },
            values: values.collect::<Result<_, RowsError>>()?,
            audits: self.audits(part, &samples, &statuses)?,
            samples,
            statuses,
        })
    }

    fn merge(&self, whole: &mut Tally, part: TallyPart) {
        whole.add(&part);
    }
}

impl Tally {
    /// Counts the rows of a part.
    fn add(&mut self, part: &TallyPart) {
        let rows = || part.samples.iter().copied().zip(part.statuses.iter().copied()).enumerate();
        rows().for_each(|(_, (sample, status))| self.statuses[status_index(status)].add(sample));
        for (row, text) in &part.reasons {
            self.reasons.add_run(part.samples[*row], part.statuses[*row], text);
        }
        let without_nominal = self.without_nominal;
        let is_nominal = |sample: SampleId| without_nominal && sample == SampleId(0);
        for headline in &mut self.headlines {
            let values = &part.values[&headline.index];
            rows()
                .filter(|(_, (sample, status))| *status == Status::Done && !is_nominal(*sample))
                .for_each(|(row, _)| headline.spread.add(values[row]));
        }
        for worst in &mut self.worst {
            let values: Vec<&Vec<f64>> = worst.indices.iter().map(|index| &part.values[index]).collect();
            for (row, (sample, status)) in rows() {
                // runs that are too inaccurate to count are the worst ones
                if [Status::Done, Status::Inaccurate].contains(&status) && !is_nominal(sample) {
                    let magnitudes = values.iter().map(|values| values[row].abs()).filter(|error| error.is_finite());
                    worst.add(sample, magnitudes.fold(f64::NAN, f64::max));
                }
            }
        }
        if let Some(audits) = &mut self.audits {
            audits.add(&part.audits, self.headlines.iter().map(|headline| headline.index), is_nominal);
        }
    }

    /// The observables whose numerical errors the audits measure, in the order of [`crate::observables::headlines`]; none without audits.
    pub fn headlines(&self) -> &[Headline] {
        &self.headlines
    }

    /// The statistics of the audits, where the campaign has audits.
    pub fn audits(&self) -> Option<&AuditTally> {
        self.audits.as_ref()
    }

    /// Whether the statistics are those of the dispersed samples, without the nominal one; otherwise the nominal sample is the
    /// only one.
    pub fn without_nominal(&self) -> bool {
        self.without_nominal
    }

    /// The runs with the greatest errors, where the campaign observes those errors.
    pub fn worst(&self) -> &[Worst] {
        &self.worst
    }

    /// The samples that ended with `status`.
    pub fn ended(&self, status: Status) -> &Ended {
        &self.statuses[status_index(status)]
    }

    /// Why runs failed.
    pub fn reasons(&self) -> &FailureReasons {
        &self.reasons
    }

    /// How many samples ended with `status`.
    pub fn count(&self, status: Status) -> u64 {
        self.ended(status).count
    }

    /// How many runs failed.
    pub fn failed(&self) -> u64 {
        Status::ALL.into_iter().filter(|status| *status != Status::Done).map(|status| self.count(status)).sum()
    }
}

fn status_index(status: Status) -> usize {
    Status::ALL.iter().position(|known| *known == status).expect("every status is in the list of all")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::analysis::part_columns::RowNames;
    use crate::campaign::{Overrides, Plan};
    use crate::ensemble::{Part, PartId, Rows};
    use crate::math::Isa;
    use crate::propagation::Method;

    /// The tally of parts whose rows are (status, error of energy), of a campaign of `samples` samples.
    fn tally(samples: u64, parts: &[&[(Status, f64)]]) -> Tally {
        tally_of(BALANCES[0], samples, parts)
    }

    /// The same of the error of another balance.
    fn tally_of(balance: ColumnId, samples: u64, parts: &[&[(Status, f64)]]) -> Tally {
        let text = include_str!("../../campaigns/spin_sweep.toml");
        let overrides = Overrides { samples: Some(samples), audit_fraction: Some(0.5), ..Overrides::default() };
        let plan = Plan::from_text("spin_sweep", text, overrides).unwrap();
        // a method whose rows have all balances
        let plan = Plan { method: Method::NullSpace, ..plan };
        let ensemble = Ensemble::new(&plan, Isa::best());
        let (columns, names) = (TallyColumns::new(&ensemble), RowNames::new(&ensemble));
        let (mut tally, mut first) = (columns.nothing(), 0);
        let error = ensemble.request().position(balance).unwrap();
        for (id, part) in parts.iter().enumerate() {
            let mut rows = Rows::new(ensemble.shape(), part.len());
            rows.start(Part { id: PartId(id as u64), first: SampleId(first), count: part.len() });
            for (row, (status, value)) in part.iter().enumerate() {
                let mut observed = vec![0.0; ensemble.shape().observables];
                observed[error] = *value;
                rows.set_result(row, *status, &observed);
            }
            columns.merge(&mut tally, columns.count(&names.of(&rows)).unwrap());
            first += part.len() as u64;
        }
        tally
    }

    /// Law: the statistics are those of the dispersed samples that are ok; without any, those of the nominal one.
    #[test]
    fn the_nominal_sample_is_not_counted() {
        let ok = Status::Done;
        let found = tally(4, &[&[(ok, 9.0), (ok, 1.0)], &[(Status::StepLimit, 8.0), (ok, 2.0)]]);
        let headline =
            found.headlines().iter().find(|headline| headline.quantity.name() == "energy_error_max").unwrap();
        assert_eq!((headline.spread.count(), headline.spread.max()), (2, Some(2.0)));
        assert!(found.without_nominal());
        assert_eq!((found.count(ok), found.failed()), (3, 1));
        let alone = tally(1, &[&[(ok, 9.0)]]);
        assert_eq!((alone.headlines()[0].spread.max(), alone.without_nominal()), (Some(9.0), false));
    }

    /// Law: the worst runs, inaccurate ones too, and the first failed ones are listed by number, whatever the order of the rows is.
    #[test]
    fn worst_and_failed_runs_are_listed() {
        let ok = Status::Done;
        let rows = [
            (ok, 99.0),
            (ok, 2.0),
            (Status::NonFinite, 98.0),
            (ok, 7.0),
            (ok, 7.0),
            (ok, 1.0),
            (ok, f64::NAN),
            (Status::Inaccurate, 8.0),
        ];
        for balance in BALANCES {
            let found = tally_of(balance, 8, &[&rows]);
            let worst = found.worst().iter().find(|worst| worst.name == "conservation error").unwrap();
            assert_eq!(worst.runs, [(SampleId(7), 8.0), (SampleId(3), 7.0), (SampleId(4), 7.0)], "{}", balance.name());
        }
        let found = tally(8, &[&rows]);
        assert_eq!(found.ended(Status::NonFinite), &Ended { count: 1, first: vec![SampleId(2)] });
        let mut ended = Ended::default();
        [5, 1, 9, 3].into_iter().for_each(|sample| ended.add(SampleId(sample)));
        assert_eq!(ended, Ended { count: 4, first: vec![SampleId(1), SampleId(3), SampleId(5)] });
    }
}
