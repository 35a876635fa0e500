//! [`in_parallel`]: independent items on several threads; [`in_order`]: merged in their order. Threads that cannot
//! start are done without.

use super::store::Result;
use crate::ensemble::threads::{Threads, unpoisoned};
use std::convert::Infallible;
use std::num::NonZeroUsize;
use std::sync::{Condvar, Mutex, MutexGuard};
use std::thread::Builder;

/// Applies `each` to the items on `threads` threads, in their order.
pub fn in_parallel<T: Send, U: Send>(items: Vec<T>, threads: Threads, each: impl Fn(T) -> U + Sync) -> Vec<U> {
    let waiting: Vec<Mutex<Option<T>>> = items.into_iter().map(|item| Mutex::new(Some(item))).collect();
    let read = |index: usize| {
        let item = unpoisoned(waiting[index].lock()).take();
        Ok::<_, Infallible>(item.map(&each))
    };
    let mut done = Vec::with_capacity(waiting.len());
    let merge = |found: Option<U>| {
        done.extend(found);
        Ok(())
    };
    match in_order(waiting.len(), threads, read, merge) {
        Ok(()) => done,
    }
}

/// Does shareable `work` on up to `threads` threads, this one included.
pub fn on_threads(threads: usize, work: &(dyn Fn() + Sync)) {
    std::thread::scope(|scope| {
        let is_started = |_: &usize| Builder::new().spawn_scoped(scope, work).is_ok();
        (1..threads).take_while(is_started).count();
        work();
    });
}

/// Items per thread that may wait for an earlier one.
const AHEAD: usize = 2;

/// Reads the items 0 to `items` - 1 on `threads` threads: `read` makes a result on any thread,
/// `merge` receives results in order. Few are held at a time.
///
/// # Errors
/// The first item, in order, for which `read` or `merge` fails.
pub fn in_order<T: Send, E: Send>(
    items: usize,
    threads: Threads,
    read: impl Fn(usize) -> Result<T, E> + Sync,
    merge: impl FnMut(T) -> Result<(), E> + Send,
) -> Result<(), E> {
    let cores = || std::thread::available_parallelism().map_or(1, NonZeroUsize::get);
    let threads = threads.map_or_else(cores, NonZeroUsize::get).min(items);
    let state = QueueState { next: 0, merged: 0, waiting: Vec::new(), merge, error: None };
    let queue = Queue { state: Mutex::new(state), moved: Condvar::new() };
    if threads <= 1 {
        queue.work(items, usize::MAX, &read);
    } else {
        on_threads(threads, &|| queue.work(items, threads * AHEAD, &read));
    }
    match unpoisoned(queue.state.into_inner()).error {
        Some((_, error)) => Err(error),
        None => Ok(()),
    }
}

/// State shared by the threads of [`in_order`].
struct Queue<T, E, M> {
    state: Mutex<QueueState<T, E, M>>,
    /// An item was merged or failed.
    moved: Condvar,
}

struct QueueState<T, E, M> {
    next: usize,
    merged: usize,
    /// Items read before an earlier one.
    waiting: Vec<(usize, T)>,
    merge: M,
    error: Option<(usize, E)>,
}

impl<T, E, M: FnMut(T) -> Result<(), E>> Queue<T, E, M> {
    fn lock(&self) -> MutexGuard<'_, QueueState<T, E, M>> {
        unpoisoned(self.state.lock())
    }

    /// Reads items until none is left, at most `ahead` beyond the merged ones.
    fn work(&self, items: usize, ahead: usize, read: &impl Fn(usize) -> Result<T, E>) {
        let _guard = Guard { queue: self, items };
        loop {
            let mut state = self.lock();
            while state.error.is_none() && state.next < items && state.next - state.merged >= ahead {
                state = unpoisoned(self.moved.wait(state));
            }
            if state.error.is_some() || state.next >= items {
                return;
            }
            let index = state.next;
            state.next += 1;
            drop(state);
            let found = read(index);
            let mut state = self.lock();
            match found {
                Ok(found) => state.waiting.push((index, found)),
                Err(error) => state.fail(index, error),
            }
            state.merge_ready();
            self.moved.notify_all();
        }
    }
}

/// Ends all threads after a panic in one, since they would wait for its item.
struct Guard<'q, T, E, M: FnMut(T) -> Result<(), E>> {
    queue: &'q Queue<T, E, M>,
    items: usize,
}

impl<T, E, M: FnMut(T) -> Result<(), E>> Drop for Guard<'_, T, E, M> {
    fn drop(&mut self) {
        if std::thread::panicking() {
            self.queue.lock().next = self.items;
            self.queue.moved.notify_all();
        }
    }
}

impl<T, E, M: FnMut(T) -> Result<(), E>> QueueState<T, E, M> {
    fn fail(&mut self, index: usize, error: E) {
        if self.error.as_ref().is_none_or(|(first, _)| index < *first) {
            self.error = Some((index, error));
        }
    }

    fn merge_ready(&mut self) {
        while let Some(at) = self.waiting.iter().position(|(index, _)| *index == self.merged) {
            let (index, found) = self.waiting.swap_remove(at);
            if let Err(error) = (self.merge)(found) {
                self.fail(index, error);
                return;
            }
            self.merged += 1;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Law: a panic in one item ends the work of all threads.
    #[test]
    fn a_panic_does_not_hang() {
        let work = || {
            let read = |item: usize| if item == 1 { panic!("item 1") } else { Ok::<usize, ()>(item) };
            in_order(1000, NonZeroUsize::new(3), read, |_| Ok(()))
        };
        assert!(std::panic::catch_unwind(work).is_err());
    }

    /// Law: the error is that of the first failing item; earlier items are still merged.
    #[test]
    fn the_first_error_counts() {
        for threads in [1, 2, 3] {
            let has_failed = std::sync::atomic::AtomicBool::new(false);
            let read = |item: usize| match item {
                // item 2 fails while item 1 is still read
                1 => {
                    while threads > 1 && !has_failed.load(std::sync::atomic::Ordering::SeqCst) {
                        std::thread::yield_now();
                    }
                    std::thread::sleep(std::time::Duration::from_millis(20));
                    Ok(item)
                }
                2 => {
                    has_failed.store(true, std::sync::atomic::Ordering::SeqCst);
                    Err("read 2")
                }
                _ => Ok(item),
            };
            let mut merged = Vec::new();
            let merge = |item: usize| {
                merged.push(item);
                if item == 1 { Err("merge 1") } else { Ok(()) }
            };
            assert_eq!(in_order(10, NonZeroUsize::new(threads), read, merge), Err("merge 1"));
            assert_eq!(merged, [0, 1], "{threads} threads");
        }
    }

    #[test]
    fn results_keep_their_order() {
        for threads in [1, 2, 7] {
            let found = in_parallel((0..100).collect(), NonZeroUsize::new(threads), |item: u64| item * item);
            assert_eq!(found, (0..100).map(|item| item * item).collect::<Vec<u64>>());
        }
    }
}
