//! [`in_parallel`]: independent items on several threads.

use std::num::NonZeroUsize;
use std::sync::{Mutex, PoisonError};

/// `each` of the items, on `threads` threads, in their order.
pub fn in_parallel<T: Send, U: Send>(
    items: Vec<T>,
    threads: Option<NonZeroUsize>,
    each: impl Fn(T) -> U + Sync,
) -> Vec<U> {
    let cores = || std::thread::available_parallelism().map_or(1, NonZeroUsize::get);
    let threads = threads.map_or_else(cores, NonZeroUsize::get).min(items.len());
    if threads <= 1 {
        return items.into_iter().map(each).collect();
    }
    let waiting = Mutex::new(items.into_iter().enumerate());
    let done = Mutex::new(Vec::new());
    std::thread::scope(|scope| {
        for _ in 0..threads {
            scope.spawn(|| {
                loop {
                    let next = waiting.lock().unwrap_or_else(PoisonError::into_inner).next();
                    let Some((index, item)) = next else { return };
                    let found = each(item);
                    done.lock().unwrap_or_else(PoisonError::into_inner).push((index, found));
                }
            });
        }
    });
    let mut done = done.into_inner().unwrap_or_else(PoisonError::into_inner);
    done.sort_by_key(|(index, _)| *index);
    done.into_iter().map(|(_, found)| found).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Law: results are in the order of the items, for any number of threads.
    #[test]
    fn results_keep_their_order() {
        for threads in [1, 2, 7] {
            let found = in_parallel((0..100).collect(), NonZeroUsize::new(threads), |item: u64| item * item);
            assert_eq!(found, (0..100).map(|item| item * item).collect::<Vec<u64>>());
        }
    }
}
