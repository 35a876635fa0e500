//! Full time series of the runs that `[retain]` asks for: `trajectories/sample-000012.parquet`.
//!
//! A row is a pure function of plan and sample, so the runs are chosen when the rows are there, and made once more: bit
//! for bit the run behind the row, in the file that `simulate --sample 12 --out` writes. Runs that nobody asked for
//! cost nothing.

use std::collections::BTreeSet;
use std::num::NonZeroUsize;
use std::path::PathBuf;

use thiserror::Error;

use crate::analysis::accumulator::Accumulator;
use crate::analysis::observed::Observed;
use crate::analysis::part_columns::PartColumns;
use crate::campaign::{Plan, Retention};
use crate::ensemble::RunError;
use crate::ensemble::single::run_each;
use crate::math::Isa;
use crate::run::Status;
use crate::sampling::design::latin::Permutation;
use crate::sampling::{SampleId, Stream};
use crate::storage::columnar::{EncodingError, Packing, encoded};
use crate::storage::disk::StorageError;
use crate::storage::identity::provenance;
use crate::storage::names::TRAJECTORIES;
use crate::storage::rows_reader::RowsError;
use crate::storage::timeseries::time_series;

/// The stream that chooses the runs of `sample:N`: no other draw depends on it.
const STREAM: &str = "retain";

/// Why trajectories could not be written.
#[derive(Debug, Error)]
pub enum TrajectoryError {
    /// The rows could not be read.
    #[error(transparent)]
    Rows(#[from] RowsError),
    /// Threads could not be started.
    #[error("cannot start the threads: {0}")]
    Threads(String),
    /// A time series could not be encoded.
    #[error("{}: {source}", path.display())]
    Encoding { path: PathBuf, source: EncodingError },
    /// A file could not be written.
    #[error(transparent)]
    File(#[from] StorageError),
}

/// The name of the file of `sample`.
pub fn file_name(sample: SampleId) -> String {
    format!("sample-{:06}.parquet", sample.0)
}

/// Chooses the samples whose runs are retained: a function of the plan and its rows. Samples whose scene is not
/// physical have no run and are left out.
#[derive(Clone, Debug)]
pub struct Retained {
    retention: Retention,
    /// Of `worst:N`: the observable.
    observed: Vec<Observed>,
    /// Of `sample:N`.
    at_random: BTreeSet<SampleId>,
}

impl Retained {
    /// Those of `plan`.
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

    /// The samples, ascending.
    pub fn chosen(&self, found: Vec<(f64, SampleId)>) -> Vec<SampleId> {
        let mut samples: Vec<SampleId> = found.into_iter().map(|(_, sample)| sample).collect();
        samples.sort_unstable();
        samples
    }

    /// Keeps those with the largest magnitudes, of equal ones the first.
    fn keep(&self, list: &mut Vec<(f64, SampleId)>) {
        if let Retention::Worst { count, .. } = &self.retention {
            list.sort_unstable_by(|(a, first), (b, second)| b.total_cmp(a).then(first.cmp(second)));
            list.truncate(usize::try_from(*count).unwrap_or(usize::MAX));
        }
    }
}

impl Accumulator for Retained {
    /// Samples with the magnitudes of the observable; zero where there is none.
    type Whole = Vec<(f64, SampleId)>;
    type OfPart = Vec<(f64, SampleId)>;

    fn nothing(&self) -> Self::Whole {
        Vec::new()
    }

    fn count(&self, part: &impl PartColumns) -> Result<Self::OfPart, RowsError> {
        if self.retention == Retention::None {
            return Ok(Vec::new());
        }
        let (samples, statuses) = (part.samples()?, part.statuses()?);
        let magnitudes = match self.observed.first() {
            Some(observed) => observed.column(part)?.iter().map(|value| value.abs()).collect(),
            None => vec![0.0; samples.len()],
        };
        let is_meant = |(magnitude, sample, status): &(f64, SampleId, Status)| match self.retention {
            Retention::None => false,
            Retention::All => *status != Status::InvalidSample,
            Retention::Failed => ![Status::Done, Status::InvalidSample].contains(status),
            Retention::Worst { .. } => !magnitude.is_nan() && sample.0 > 0,
            Retention::Sample(_) => *status != Status::InvalidSample && self.at_random.contains(sample),
        };
        let rows = magnitudes.into_iter().zip(samples).zip(statuses.iter());
        let rows = rows.map(|((magnitude, sample), status)| (magnitude, sample, *status)).filter(is_meant);
        let mut found = rows.map(|(magnitude, sample, _)| (magnitude, sample)).collect();
        self.keep(&mut found);
        Ok(found)
    }

    fn merge(&self, whole: &mut Self::Whole, part: Self::OfPart) {
        whole.extend(part);
        self.keep(whole);
    }
}

/// `count` dispersed samples of `plan`, all where there are no more: the first of a random permutation of them.
fn chosen(plan: &Plan, count: u64) -> BTreeSet<SampleId> {
    let dispersed = plan.dispersed_rows();
    let first = plan.rows() - dispersed;
    let permutation = Permutation::new(dispersed, Stream::new(plan.seed, STREAM).bits(SampleId(0)));
    (0..count.min(dispersed)).map(|place| plan.sample(first + permutation.image(place))).collect()
}

/// Takes a file of a dataset: its name and its bytes.
pub type TakeFile<'a> = dyn Fn(&str, &[u8]) -> Result<(), StorageError> + Sync + 'a;

/// Makes the time series of `samples` of `plan`, and gives each to `take` as a file of a dataset. The bytes are those
/// of `simulate --sample K --out`.
///
/// # Errors
/// The first file that could not be taken; no run is started after it.
pub fn save(
    plan: &Plan,
    samples: &[SampleId],
    machine: (Isa, Option<NonZeroUsize>),
    take: &TakeFile<'_>,
) -> Result<(), TrajectoryError> {
    run_each(plan, samples, machine, &|runs, sample| {
        // a sample without a run has no file
        let Ok(run) = runs.run(sample) else { return Ok(()) };
        let name = format!("{TRAJECTORIES}/{}", file_name(sample));
        let encoded = encoded(&time_series(sample, &run, |_| true), provenance(plan), Packing::Lz4);
        let bytes = encoded.map_err(|source| TrajectoryError::Encoding { path: PathBuf::from(&name), source })?;
        Ok(take(&name, &bytes)?)
    })
    .map(|_| ())
    .map_err(|error| match error {
        RunError::Threads(error) => TrajectoryError::Threads(error.to_string()),
        RunError::Sink(error) => error,
    })
}
