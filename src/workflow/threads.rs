//! How many threads a command may ask for.

use std::num::NonZeroUsize;

/// Most threads for each core. More only wait for each other, and each has its own memory.
const MOST_OF_A_CORE: usize = 4;

/// So many threads, where this machine can use them.
///
/// # Errors
/// The allowed range, where it cannot.
pub fn usable(number: usize) -> Result<NonZeroUsize, String> {
    let cores = std::thread::available_parallelism().map_or(1, NonZeroUsize::get);
    let most = MOST_OF_A_CORE * cores;
    NonZeroUsize::new(number).filter(|_| number <= most).ok_or_else(|| {
        format!(
            "must be a whole number from 1 to {most}: {MOST_OF_A_CORE} for each core that this process has ({cores})"
        )
    })
}
