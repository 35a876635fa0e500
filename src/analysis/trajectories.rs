//! Full time series of the runs that `[retain]` asks for: `trajectories/sample-000012.parquet`.
//!
//! A row is a pure function of plan and sample, so the runs are chosen when the rows are there, and made once more: bit for bit the
//! run behind the row, in the file that `simulate --sample 12 --out` writes. Runs that nobody asked for cost nothing.

use std::cmp::Ordering;
use std::collections::BTreeSet;
use std::num::NonZeroUsize;
use std::path::PathBuf;

use crate::storage::columnar::EncodingError;
use thiserror::Error;

use crate::analysis::observed::Observed;
use crate::campaign::{Plan, Retention};
use crate::ensemble::RunError;
use crate::ensemble::single::run_each;
use crate::math::Isa;
use crate::run::Status;
use crate::sampling::design::latin::Permutation;
use crate::sampling::{SampleId, Stream};
use crate::storage::disk::StorageError;
use crate::storage::folder::Folder;
use crate::storage::names::TRAJECTORIES;
use crate::storage::rows_reader::{PartReader, RowsError, RowsReader};
use crate::storage::timeseries::TimeSeries;

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
    Encoding {
        /// Its file.
        path: PathBuf,
        /// Why.
        source: EncodingError,
    },
    /// A file could not be written.
    #[error(transparent)]
    File(#[from] StorageError),
}

/// The name of the file of `sample`.
pub fn file_name(sample: SampleId) -> String {
    format!("sample-{:06}.parquet", sample.0)
}

/// The samples of `plan` whose runs are retained, ascending: a function of the plan and its rows. Samples whose scene is not physical
/// have no run and are left out.
///
/// # Errors
/// Where the rows cannot be read.
pub fn retained(plan: &Plan, rows: &RowsReader, threads: Option<NonZeroUsize>) -> Result<Vec<SampleId>, RowsError> {
    let mut samples = match &plan.retention {
        Retention::None => Vec::new(),
        Retention::All => those(rows, threads, |status, _| status != Status::InvalidSample)?,
        Retention::Failed => {
            those(rows, threads, |status, _| ![Status::Done, Status::InvalidSample].contains(&status))?
        }
        Retention::Worst { count, observable } => worst(plan, rows, threads, (*count, observable))?,
        Retention::Sample(count) => {
            let chosen = chosen(plan, *count);
            those(rows, threads, |status, sample| status != Status::InvalidSample && chosen.contains(&sample))?
        }
    };
    samples.sort_unstable();
    Ok(samples)
}

/// The samples that `is_meant`.
fn those(
    rows: &RowsReader,
    threads: Option<NonZeroUsize>,
    is_meant: impl Fn(Status, SampleId) -> bool + Sync,
) -> Result<Vec<SampleId>, RowsError> {
    let mut all = Vec::new();
    let read = |part: &mut PartReader| -> Result<Vec<SampleId>, RowsError> {
        let rows = part.statuses()?.into_iter().zip(part.samples()?);
        Ok(rows.filter(|(status, sample)| is_meant(*status, *sample)).map(|(_, sample)| sample).collect())
    };
    rows.visit(threads, read, |part| {
        all.extend(part);
        Ok(())
    })?;
    Ok(all)
}

/// `count` dispersed samples of `plan`, all where there are no more: the first of a random permutation of them.
fn chosen(plan: &Plan, count: u64) -> BTreeSet<SampleId> {
    let dispersed = plan.dispersed_rows();
    let first = plan.rows() - dispersed;
    let permutation = Permutation::new(dispersed, Stream::new(plan.seed, STREAM).bits(SampleId(0)));
    (0..count.min(dispersed)).map(|place| plan.sample(first + permutation.image(place))).collect()
}

/// The `count` dispersed samples with the largest magnitudes of an observable, of equal ones the first; those that have it.
fn worst(
    plan: &Plan,
    rows: &RowsReader,
    threads: Option<NonZeroUsize>,
    (count, observable): (u64, &str),
) -> Result<Vec<SampleId>, RowsError> {
    let count = usize::try_from(count).unwrap_or(usize::MAX);
    let observed = Observed::named(plan, std::iter::once(observable));
    let [observed] = &observed[..] else { return Ok(Vec::new()) };
    let order = |(a, first): &(f64, SampleId), (b, second): &(f64, SampleId)| -> Ordering {
        b.total_cmp(a).then(first.cmp(second))
    };
    let keep = |list: &mut Vec<(f64, SampleId)>| {
        list.sort_unstable_by(order);
        list.truncate(count);
    };
    let read = |part: &mut PartReader| -> Result<Vec<(f64, SampleId)>, RowsError> {
        let values = observed.values(part)?.into_iter().map(f64::abs).zip(part.samples()?);
        let mut found: Vec<(f64, SampleId)> =
            values.filter(|(value, sample)| !value.is_nan() && sample.0 > 0).collect();
        keep(&mut found);
        Ok(found)
    };
    let mut all: Vec<(f64, SampleId)> = Vec::new();
    rows.visit(threads, read, |part| {
        all.extend(part);
        keep(&mut all);
        Ok(())
    })?;
    Ok(all.into_iter().map(|(_, sample)| sample).collect())
}

/// Writes the time series of `samples` of `plan` as files of the dataset `folder`. The bytes are those of `simulate --sample K --out`.
///
/// # Errors
/// The first file that could not be written; no run is started after it.
pub fn save(
    plan: &Plan,
    samples: &[SampleId],
    folder: &Folder,
    isa: Isa,
    threads: Option<NonZeroUsize>,
) -> Result<(), TrajectoryError> {
    run_each(plan, samples, (isa, threads), &|sample, run| {
        // a sample without a run has no file
        let Ok(run) = run else { return Ok(()) };
        let name = format!("{TRAJECTORIES}/{}", file_name(sample));
        let encoded = TimeSeries::new(plan, sample, &run, |_| true).encoded();
        let bytes = encoded.map_err(|source| TrajectoryError::Encoding { path: folder.path(&name), source })?;
        Ok(folder.write(&name, &bytes)?)
    })
    .map_err(|error| match error {
        RunError::Threads(error) => TrajectoryError::Threads(error.to_string()),
        RunError::Sink(error) => error,
    })
}
