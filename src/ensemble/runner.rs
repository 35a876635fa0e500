//! [`run`]: the parts of a campaign over threads.
//!
//! A free thread takes the next part in order, and works in memory of its own. Nothing in a row depends on the thread.
//! Rayon's parallel iterators, which split ranges in halves, were rejected: the parts completed at any moment would be scattered
//! over the campaign instead of being its first ones, apart from those under way.

use std::num::NonZeroUsize;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Mutex, PoisonError};

use rayon::{ThreadPoolBuildError, ThreadPoolBuilder};
use thiserror::Error;

use crate::ensemble::parts::{PartId, Parts};
use crate::ensemble::sink::Sink;
use crate::ensemble::worker::Ensemble;

/// Why a campaign was not completed.
#[derive(Debug, Error)]
pub enum RunError<E> {
    /// Threads could not be started.
    #[error("cannot start the threads: {0}")]
    Threads(#[from] ThreadPoolBuildError),
    /// The sink refused rows.
    #[error("{0}")]
    Sink(E),
}

/// Runs every part of `ensemble` and passes the rows to `sink`. `threads` of `None` means one per core.
///
/// `progress` is called from any thread with the number of samples completed since its last call there.
///
/// # Errors
/// Where threads could not be started, or the first error of the sink; no part is started after it.
pub fn run<S: Sink>(
    ensemble: &Ensemble<'_>,
    parts: Parts,
    threads: Option<NonZeroUsize>,
    sink: &S,
    progress: &(dyn Fn(u64) + Sync),
) -> Result<(), RunError<S::Error>> {
    let pool = ThreadPoolBuilder::new().num_threads(threads.map_or(0, NonZeroUsize::get)).build()?;
    let next = AtomicU64::new(0);
    let failure: Mutex<Option<S::Error>> = Mutex::new(None);
    pool.broadcast(|_| {
        // Memory is allocated on the thread that uses it, and only where it gets a part.
        let mut memory = None;
        while let Some(part) = parts.part(PartId(next.fetch_add(1, Ordering::Relaxed))) {
            let (worker, rows) =
                memory.get_or_insert_with(|| (ensemble.worker(), ensemble.rows(parts.size())));
            worker.run(part, rows, &|samples| progress(samples));
            if let Err(error) = sink.take(rows) {
                next.store(parts.count(), Ordering::Relaxed);
                failure.lock().unwrap_or_else(PoisonError::into_inner).get_or_insert(error);
            }
        }
    });
    match failure.into_inner().unwrap_or_else(PoisonError::into_inner) {
        Some(error) => Err(RunError::Sink(error)),
        None => Ok(()),
    }
}
