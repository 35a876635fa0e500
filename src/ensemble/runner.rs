//! [`run`]: the parts of a campaign over threads.
//!
//! Threads take the next part in order as they become free; each works in memory of its own. Nothing about a row depends on
//! which thread made it. Stealing halves of ranges, as rayon's parallel iterators do, was rejected: the parts done at any
//! moment would lie scattered, where a campaign that is resumed one day wants them to be a beginning.

use std::num::NonZeroUsize;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Mutex, PoisonError};

use rayon::{ThreadPoolBuildError, ThreadPoolBuilder};
use thiserror::Error;

use crate::ensemble::parts::{PartId, Parts};
use crate::ensemble::rows::Rows;
use crate::ensemble::sink::Sink;
use crate::ensemble::worker::Ensemble;

/// Why a campaign did not end.
#[derive(Debug, Error)]
pub enum RunError<E> {
    /// The system gave no threads.
    #[error("cannot start the threads: {0}")]
    Threads(#[from] ThreadPoolBuildError),
    /// The sink did not take rows.
    #[error("{0}")]
    Sink(E),
}

/// Runs every part of `campaign` and gives the rows to `sink`. `threads` of `None` means one for each core.
///
/// `progress` hears, from any thread, of every few samples how many they were.
///
/// # Errors
/// Where no threads could be had, or the first error of the sink; no part is started after it.
pub fn run<S: Sink>(
    campaign: &Ensemble<'_>,
    parts: Parts,
    threads: Option<NonZeroUsize>,
    sink: &S,
    progress: &(dyn Fn(u64) + Sync),
) -> Result<(), RunError<S::Error>> {
    let pool = ThreadPoolBuilder::new().num_threads(threads.map_or(0, NonZeroUsize::get)).build()?;
    let next = AtomicU64::new(0);
    let failure: Mutex<Option<S::Error>> = Mutex::new(None);
    pool.broadcast(|_| {
        // Memory is made on the thread that uses it, and only by threads that get a part.
        let mut memory = None;
        while let Some(part) = parts.part(PartId(next.fetch_add(1, Ordering::Relaxed))) {
            let (worker, rows) =
                memory.get_or_insert_with(|| (campaign.worker(), Rows::new(campaign.shape(), parts.size())));
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
