//! [`Tally`]: statuses, worst runs and audits. It keeps counts, extremes and sample numbers, no floating-point sums:
//! the order of the parts does not matter. The nominal sample 0 is among the worst runs and audits only if it is alone.

use super::accumulator::Accumulator;
use super::part_columns::PartColumns;
use crate::analysis::audit_tally::AuditTally;
use crate::analysis::outcomes::{is_worst_when_low, outcomes};
use crate::analysis::statuses::{StatusCounter, StatusPart, Statuses};
use crate::analysis::worst_runs::WorstRuns;
use crate::ensemble::audit::{AuditValue, Selection};
use crate::ensemble::plausibility::ends_of_air;
use crate::ensemble::threads::unpoisoned;
use crate::ensemble::{Audit, Ensemble};
use crate::observables::ColumnId;
use crate::observables::accuracy::{BALANCES, STATE_ERRORS};
use crate::observables::headlines::headlines;
use crate::run::Status;
use crate::sampling::SampleId;
use crate::storage::rows_file::{audit_error_name, audited_observables};
use crate::storage::rows_reader::Result;
use std::collections::BTreeMap;
use std::sync::Mutex;

const LISTED: usize = 3;

/// Runs with the worst values of an error, or of a required observable.
#[derive(Clone, Debug, PartialEq)]
pub struct Worst {
    /// An error in words, or the name of the observable.
    pub name: String,
    pub is_error: bool,
    /// Indices in a row; an error is the maximum of their magnitudes.
    indices: Vec<usize>,
    pub list: WorstRuns,
}

#[derive(Clone, Debug)]
pub struct Tally {
    pub statuses: Statuses,
    /// True if statistics leave out the nominal sample; else it is the only one.
    pub without_nominal: bool,
    pub worst: Vec<Worst>,
    pub audits: Option<AuditTally>,
    /// Runs beyond the heights of the air table; `None` without a table or observed distances.
    pub beyond_air: Option<u64>,
    /// Observables with audited errors, in the order of [`crate::observables::headlines`].
    pub headlines: Vec<String>,
}

#[derive(Debug)]
pub struct TallyColumns {
    statuses: StatusCounter,
    nothing: Tally,
    selection: Mutex<Selection>,
    names: Vec<String>,
    /// Indices of the counted observables, ascending.
    wanted: Vec<usize>,
    /// Indices of the observables with audited errors.
    audited: Vec<usize>,
    headlines: Vec<usize>,
    has_debris: bool,
    /// Columns of the minimum and maximum distance from the centre, with the ends of the air table, m.
    air: Option<[(&'static str, f64); 2]>,
}

const DISTANCES: [&str; 2] = ["orbit_distance_min_m", "orbit_distance_max_m"];

#[derive(Clone, Debug)]
pub struct TallyPart {
    ended: StatusPart,
    values: BTreeMap<usize, Vec<f64>>,
    beyond_air: u64,
    audits: Vec<(SampleId, Option<Audit>)>,
}

impl TallyColumns {
    pub fn new(ensemble: &Ensemble<'_>) -> Self {
        let columns = ensemble.request().columns();
        let is_audited = ensemble.plan().audit_fraction > 0.0;
        let headlines: Vec<usize> = headlines(ensemble.request()).into_iter().filter(|_| is_audited).collect();
        let names: Vec<String> = columns.iter().map(|column| column.quantity.name().to_owned()).collect();
        let index = |id: &ColumnId| ensemble.request().position(*id);
        let errors = [("conservation error", &BALANCES[..]), ("state error estimate", &STATE_ERRORS[..])].map(
            |(name, columns)| {
                let indices = columns.iter().filter_map(index).collect();
                Worst { name: name.to_owned(), is_error: true, indices, list: WorstRuns::new(LISTED, false) }
            },
        );
        let plan = ensemble.plan();
        let outcomes = outcomes(plan);
        let of_outcomes = columns.iter().enumerate().filter_map(|(index, column)| {
            let name = column.quantity.name();
            let is_outcome = outcomes.iter().any(|one| one == name);
            let list = WorstRuns::new(LISTED, is_worst_when_low(plan, name));
            is_outcome.then(|| Worst { name: name.to_owned(), is_error: false, indices: vec![index], list })
        });
        let worst = errors.into_iter().chain(of_outcomes);
        let statuses = StatusCounter::new(ensemble.plan());
        let air = ends_of_air(ensemble.plan()).map(|[low, high]| [(DISTANCES[0], low), (DISTANCES[1], high)]);
        let air = air.filter(|ends| ends.iter().all(|(name, _)| names.iter().any(|known| known == name)));
        let nothing = Tally {
            without_nominal: ensemble.plan().samples > 1,
            statuses: statuses.nothing(),
            audits: is_audited.then(|| AuditTally::new(headlines.len())),
            beyond_air: air.map(|_| 0),
            headlines: headlines.iter().map(|index| names[*index].clone()).collect(),
            worst: worst.filter(|worst| !worst.indices.is_empty()).collect(),
        };
        let mut wanted: Vec<usize> = nothing.worst.iter().flat_map(|worst| worst.indices.clone()).collect();
        wanted.sort_unstable();
        wanted.dedup();
        TallyColumns {
            statuses,
            nothing,
            headlines,
            selection: Mutex::new(Selection::new(ensemble.plan())),
            names,
            wanted,
            audited: audited_observables(ensemble),
            has_debris: ensemble.request().debris,
            air,
        }
    }

    /// The audits of a part; a selected sample without one has failed.
    fn audits(
        &self,
        part: &impl PartColumns,
        samples: &[SampleId],
        statuses: &[Status],
    ) -> Result<Vec<(SampleId, Option<Audit>)>> {
        if self.nothing.audits.is_none() {
            return Ok(Vec::new());
        }
        let read = |value: &AuditValue| match value.is_of_debris() && !self.has_debris {
            true => Ok(vec![f64::NAN; samples.len()].into()),
            false => part.numbers(value.quantity().name()),
        };
        let values = AuditValue::ALL.iter().map(read).collect::<Result<Vec<_>>>()?;
        let error = |index: &usize| part.numbers(&audit_error_name(&self.names[*index]));
        let errors = self.audited.iter().map(error).collect::<Result<Vec<_>>>()?;
        let mut selection = unpoisoned(self.selection.lock());
        let rows = samples.iter().zip(statuses).enumerate();
        let selected = rows
            .filter(|(_, (sample, status))| **status != Status::InvalidSample && selection.contains(**sample))
            .map(|(row, (sample, _))| (row, *sample));
        let audit = |row: usize| {
            let mut observables = vec![f64::NAN; self.names.len()];
            self.audited.iter().zip(&errors).for_each(|(index, errors)| observables[*index] = errors[row]);
            Audit { values: values.iter().map(|values| values[row]).collect(), observables }
        };
        let is_complete = |row: usize| !values[AuditValue::Tolerance as usize][row].is_nan();
        Ok(selected.map(|(row, sample)| (sample, is_complete(row).then(|| audit(row)))).collect())
    }
}

impl Accumulator for TallyColumns {
    type Whole = Tally;
    type OfPart = TallyPart;

    fn nothing(&self) -> Tally {
        self.nothing.clone()
    }

    fn count(&self, part: &impl PartColumns) -> Result<TallyPart> {
        let ended = self.statuses.count(part)?;
        let values = self.wanted.iter().map(|index| Ok((*index, part.numbers(&self.names[*index])?.into_owned())));
        let beyond_air = match self.air {
            None => 0,
            Some([(least, low), (greatest, high)]) => {
                let (least, greatest) = (part.numbers(least)?, part.numbers(greatest)?);
                least.iter().zip(greatest.iter()).filter(|(least, greatest)| **least < low || **greatest > high).count()
            }
        };
        Ok(TallyPart {
            beyond_air: beyond_air as u64,
            values: values.collect::<Result<_>>()?,
            audits: self.audits(part, &ended.0, &ended.1)?,
            ended,
        })
    }

    fn merge(&self, whole: &mut Tally, part: TallyPart) {
        let is_nominal = |sample: SampleId| whole.without_nominal && sample == SampleId(0);
        for worst in &mut whole.worst {
            let values: Vec<&Vec<f64>> = worst.indices.iter().map(|index| &part.values[index]).collect();
            for (row, (sample, status)) in part.ended.0.iter().zip(&part.ended.1).enumerate() {
                // runs too inaccurate to count have the largest errors
                let counts = *status == Status::Done || worst.is_error && *status == Status::Inaccurate;
                if counts && !is_nominal(*sample) {
                    let values = values.iter().map(|values| values[row]).filter(|value| value.is_finite());
                    let magnitude = |value: f64| if worst.is_error { value.abs() } else { value };
                    worst.list.add(*sample, values.map(magnitude).fold(f64::NAN, f64::max));
                }
            }
        }
        if let Some(audits) = &mut whole.audits {
            audits.add(&part.audits, self.headlines.iter().copied(), is_nominal);
        }
        whole.beyond_air.iter_mut().for_each(|count| *count += part.beyond_air);
        self.statuses.merge(&mut whole.statuses, part.ended);
    }
}
