//! [`run`]: parts of a campaign over threads.
//!
//! A free thread takes the next part and works in its own memory; no row depends on the thread. Rayon's parallel
//! iterators halve ranges, which would scatter completed parts over the campaign.

use super::threads::{Threads, unpoisoned};
use crate::ensemble::parts::Part;
use crate::ensemble::rows::Rows;
use crate::ensemble::supervision::Supervision;
use crate::ensemble::worker::Ensemble;
use rayon::{ThreadPoolBuildError, ThreadPoolBuilder};
use std::num::NonZeroUsize;
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use thiserror::Error;

#[derive(Debug, Error)]
pub enum RunError<E> {
    #[error("cannot start the threads: {0}")]
    Threads(#[from] ThreadPoolBuildError),
    #[error("{0}")]
    Sink(E),
}

/// Number of `wanted` threads with work for so many parts.
pub fn threads(wanted: Threads, parts: usize) -> usize {
    let cores = || std::thread::available_parallelism().map_or(1, NonZeroUsize::get);
    wanted.map_or_else(cores, NonZeroUsize::get).min(parts.max(1))
}

/// Starts rayon's shared threads, one for each core.
///
/// # Errors
/// A failure, or threads started before.
pub fn start_threads() -> Result<(), ThreadPoolBuildError> {
    ThreadPoolBuilder::new().build_global()
}

/// Passes the rows of each of `parts` to `sink`, on the `wanted` [`threads`]: once each and in any order, on which the
/// result must not depend.
///
/// # Errors
/// A failure to start threads, or the first error of the sink, after which no part starts.
pub fn run<E: Send>(
    ensemble: &Ensemble<'_>,
    parts: impl IntoIterator<Item = Part>,
    wanted: Threads,
    sink: &(impl Fn(&Rows) -> Result<(), E> + Sync),
    supervision: Supervision<'_>,
) -> Result<(), RunError<E>> {
    let parts: Vec<Part> = parts.into_iter().collect();
    let largest = parts.iter().map(|part| part.count).max().unwrap_or(0);
    let pool = ThreadPoolBuilder::new().num_threads(threads(wanted, parts.len())).build()?;
    let (next, is_failed) = (AtomicUsize::new(0), AtomicBool::new(false));
    let failure: Mutex<Option<E>> = Mutex::new(None);
    let is_on = || !supervision.stop.load(Ordering::Relaxed) && !is_failed.load(Ordering::Relaxed);
    let share = || {
        // allocated by its thread, once it has a part
        let mut memory = None;
        while is_on()
            && let Some(part) = parts.get(next.fetch_add(1, Ordering::Relaxed))
        {
            let (worker, rows) = memory.get_or_insert_with(|| (ensemble.worker(), ensemble.rows(largest)));
            if !worker.run(*part, rows, supervision) {
                break;
            }
            if let Err(error) = sink(rows) {
                is_failed.store(true, Ordering::Relaxed);
                unpoisoned(failure.lock()).get_or_insert(error);
            }
        }
    };
    pool.broadcast(|_| {
        if !parts.is_empty() {
            // made before the worker's memory, as runs take no turns here: one would wait for another of its thread
            ensemble.prepare(&is_on, supervision.crew);
        }
        supervision.crew.work(&share);
    });
    match unpoisoned(failure.into_inner()) {
        Some(error) => Err(RunError::Sink(error)),
        None => Ok(()),
    }
}
