//! [`run`]: parts of a campaign over threads.
//!
//! A free thread takes the next part in order and works in memory of its own; no row depends on the thread. Rayon's
//! parallel iterators split ranges in halves and were rejected: completed parts would be scattered over the campaign.

use rayon::{ThreadPoolBuildError, ThreadPoolBuilder};
use std::num::NonZeroUsize;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};
use thiserror::Error;

use crate::ensemble::parts::Part;
use crate::ensemble::rows::Rows;
use crate::ensemble::supervision::Supervision;
use crate::ensemble::worker::Ensemble;

#[derive(Debug, Error)]
pub enum RunError<E> {
    #[error("cannot start the threads: {0}")]
    Threads(#[from] ThreadPoolBuildError),
    #[error("{0}")]
    Sink(E),
}

/// Number of threads with work of the `wanted` ones (`None`: one per core) for so many parts.
pub fn threads(wanted: Option<NonZeroUsize>, parts: usize) -> usize {
    let cores = || std::thread::available_parallelism().map_or(1, NonZeroUsize::get);
    wanted.map_or_else(cores, NonZeroUsize::get).min(parts.max(1))
}

/// Starts rayon's shared threads, one for each core.
///
/// # Errors
/// They could not be started, or had been before.
pub fn start_threads() -> Result<(), ThreadPoolBuildError> {
    ThreadPoolBuilder::new().build_global()
}

/// Runs `parts` of `ensemble` and passes the rows to `sink`, each part once, on the `wanted` [`threads`].
///
/// # Errors
/// Threads could not be started, or the first error of the sink; no part is started after it.
pub fn run<S: Sink>(
    ensemble: &Ensemble<'_>,
    parts: impl IntoIterator<Item = Part>,
    wanted: Option<NonZeroUsize>,
    sink: &S,
    supervision: Supervision<'_>,
) -> Result<(), RunError<S::Error>> {
    let parts: Vec<Part> = parts.into_iter().collect();
    let largest = parts.iter().map(|part| part.count).max().unwrap_or(0);
    let pool = ThreadPoolBuilder::new().num_threads(threads(wanted, parts.len())).build()?;
    let (next, is_failed) = (AtomicUsize::new(0), AtomicBool::new(false));
    let failure: Mutex<Option<S::Error>> = Mutex::new(None);
    let is_on = || !supervision.stop.load(Ordering::Relaxed) && !is_failed.load(Ordering::Relaxed);
    let share = || {
        // allocated on the thread that uses it, once it has a part
        let mut memory = None;
        while is_on()
            && let Some(part) = parts.get(next.fetch_add(1, Ordering::Relaxed))
        {
            let (worker, rows) = memory.get_or_insert_with(|| (ensemble.worker(), ensemble.rows(largest)));
            if !worker.run(*part, rows, supervision) {
                break;
            }
            if let Err(error) = sink.take(rows) {
                is_failed.store(true, Ordering::Relaxed);
                failure.lock().unwrap_or_else(PoisonError::into_inner).get_or_insert(error);
            }
        }
    };
    pool.broadcast(|_| {
        if !parts.is_empty() {
            // the bands need the nominal run: made before the worker's memory, where runs take no turns
            ensemble.bands();
        }
        supervision.crew.work(&share);
    });
    match failure.into_inner().unwrap_or_else(PoisonError::into_inner) {
        Some(error) => Err(RunError::Sink(error)),
        None => Ok(()),
    }
}

/// Takes the rows of finished parts.
///
/// Called from several threads, once for each part, in any order; the result must not depend on earlier parts.
pub trait Sink: Sync {
    type Error: Send;

    /// Takes the rows of one part. An error starts no further part.
    ///
    /// # Errors
    /// The rows could not be stored.
    fn take(&self, rows: &Rows) -> Result<(), Self::Error>;
}
