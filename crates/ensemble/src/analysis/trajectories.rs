//! Time series of runs retained by `[retain]`: `trajectories/sample-000012.parquet`.
//!
//! A row is a function of plan and sample: runs are chosen from the finished rows and flown again, bit for bit as by
//! `simulate --sample 12 --out`.

use super::accumulator::Accumulator;
use super::observed::Observed;
use super::part_columns::PartColumns;
use crate::analysis::worst_runs::WorstRuns;
use crate::campaign::{Plan, Retention};
use crate::ensemble::single::run_each;
use crate::ensemble::threads::Threads;
use crate::math::Isa;
use crate::run::Status;
use crate::sampling::design::latin::Permutation;
use crate::sampling::{SampleId, Stream};
use crate::storage::columnar::{Packing, encoded};
use crate::storage::identity::provenance;
use crate::storage::names::TRAJECTORIES;
use crate::storage::rows_reader::Result;
use crate::storage::store::{Failure, StoreError};
use crate::storage::timeseries::time_series;
use std::collections::BTreeSet;

const STREAM: &str = "retain";

pub fn file_name(sample: SampleId) -> String {
    format!("sample-{:06}.parquet", sample.0)
}

/// Chooses the retained samples, except unphysical ones, from plan and rows.
#[derive(Clone, Debug)]
pub struct Retained {
    retention: Retention,
    observed: Vec<Observed>,
    at_random: BTreeSet<SampleId>,
}

impl Retained {
    pub fn new(plan: &Plan) -> Self {
        let observable = match &plan.retention {
            Retention::Worst { observable, .. } => Some(observable.as_str()),
            _ => None,
        };
        let at_random = match plan.retention {
            Retention::Sample(count) => chosen(plan, count),
            _ => BTreeSet::new(),
        };
        let observed = Observed::named(plan, observable.into_iter());
        Retained { retention: plan.retention.clone(), observed, at_random }
    }

    pub fn chosen(&self, worst: WorstRuns) -> Vec<SampleId> {
        let mut samples: Vec<SampleId> = worst.runs.into_iter().map(|(sample, _)| sample).collect();
        samples.sort_unstable();
        samples
    }
}

impl Accumulator for Retained {
    /// Samples with the values of the observable, or zero.
    type Whole = WorstRuns;
    type OfPart = WorstRuns;

    fn nothing(&self) -> WorstRuns {
        let most = match self.retention {
            Retention::Worst { count, .. } => usize::try_from(count).unwrap_or(usize::MAX),
            _ => usize::MAX,
        };
        WorstRuns::new(most, false)
    }

    fn count(&self, part: &impl PartColumns) -> Result<WorstRuns> {
        let mut found = self.nothing();
        if self.retention == Retention::None {
            return Ok(found);
        }
        let (samples, statuses) = (part.samples()?, part.statuses()?);
        let values = self.observed.first().map(|observed| observed.column(part)).transpose()?;
        for (row, (sample, status)) in samples.into_iter().zip(statuses.iter()).enumerate() {
            let is_retained = match self.retention {
                Retention::None => false,
                Retention::All => *status != Status::InvalidSample,
                Retention::Failed => ![Status::Done, Status::InvalidSample].contains(status),
                Retention::Worst { .. } => sample.0 > 0,
                Retention::Sample(_) => *status != Status::InvalidSample && self.at_random.contains(&sample),
            };
            if is_retained {
                found.add(sample, values.as_ref().map_or(0.0, |values| values[row]));
            }
        }
        Ok(found)
    }

    fn merge(&self, whole: &mut WorstRuns, part: WorstRuns) {
        part.runs.into_iter().for_each(|(sample, value)| whole.add(sample, value));
    }
}

/// At most `count` dispersed samples: the first of a random permutation.
fn chosen(plan: &Plan, count: u64) -> BTreeSet<SampleId> {
    let dispersed = plan.dispersed_rows();
    let first = plan.rows() - dispersed;
    let permutation = Permutation::new(dispersed, Stream::new(plan.seed, STREAM).bits(SampleId(0)));
    (0..count.min(dispersed)).map(|place| plan.sample(first + permutation.image(place))).collect()
}

/// Receives a file of a dataset: name and bytes.
pub type TakeFile<'a> = dyn Fn(&str, &[u8]) -> Result<(), StoreError> + Sync + 'a;

/// Passes the time series of `samples`, as files of `simulate --sample K --out`, to `take`.
///
/// # Errors The first that `take` or a run returns; no run starts after it.
pub fn save(plan: &Plan, samples: &[SampleId], machine: (Isa, Threads), take: &TakeFile<'_>) -> Result<(), Failure> {
    run_each(plan, samples, machine, &|runs, sample| {
        // unphysical samples have no file
        let Ok(run) = runs.run(sample) else { return Ok(()) };
        let name = format!("{TRAJECTORIES}/{}", file_name(sample));
        let encoded = encoded(&time_series(sample, &run, |_| true), provenance(plan), Packing::Lz4);
        let bytes = encoded.map_err(|error| format!("{name}: {error}"))?;
        Ok::<(), Failure>(take(&name, &bytes)?)
    })?;
    Ok(())
}
