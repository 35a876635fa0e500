//! The allowed number of threads.

use std::num::NonZeroUsize;

/// Most threads per core; more wait for each other and take memory.
const MOST_OF_A_CORE: usize = 4;

/// `number` threads, if this machine can use them.
///
/// # Errors
/// The allowed range.
pub fn usable(number: usize) -> Result<NonZeroUsize, String> {
    let cores = std::thread::available_parallelism().map_or(1, NonZeroUsize::get);
    let most = MOST_OF_A_CORE * cores;
    NonZeroUsize::new(number).filter(|_| number <= most).ok_or_else(|| {
        format!(
            "must be a whole number from 1 to {most}: {MOST_OF_A_CORE} for each core that this process has ({cores})"
        )
    })
}
