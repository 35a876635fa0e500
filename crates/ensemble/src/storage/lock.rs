//! [`lock`]: keeps other processes away from a result, for people; results are right without it.

use super::store::{Result, Store};
use crate::storage::folder_error::FolderError;
use std::fs::{File, TryLockError};
use std::thread::sleep;
use std::time::{Duration, Instant};

/// Longest wait for a lock: a killed process keeps its lock until its files are closed, and a child shares it for a
/// moment.
const PATIENCE: Duration = Duration::from_millis(300);
/// Between two attempts.
const PAUSE: Duration = Duration::from_millis(10);

/// Keeps other processes away until dropped; empty without locks.
#[derive(Debug, Default)]
pub struct Lock(#[expect(dead_code, reason = "is closed when it is dropped")] Option<File>);

/// Locks `store`, possibly shared with other shards and readers.
///
/// # Errors
/// A lock of another process, or one that cannot be opened.
pub fn lock(store: &dyn Store, is_shared: bool) -> Result<Lock, FolderError> {
    let start = Instant::now();
    loop {
        match store.lock(is_shared) {
            Ok(lock) => return Ok(Lock(lock)),
            Err(TryLockError::WouldBlock) if start.elapsed() < PATIENCE => sleep(PAUSE),
            Err(TryLockError::WouldBlock) => {
                return Err(FolderError::Busy { folder: store.root().display().to_string() });
            }
            // another process may be writing
            Err(TryLockError::Error(error)) => return Err(store.at("")(error).into()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::storage::disk::folder;

    /// Law: a lock that ends within a moment is awaited; a held one is refused within a second.
    #[test]
    fn a_lock_that_ends_is_waited_for() {
        let root = crate::storage::scratch::Scratch::new("lock");
        let store = folder(&root);
        let held = store.lock(false).expect("the first lock");
        let start = Instant::now();
        let refused = lock(&*store, false);
        assert!(matches!(refused, Err(FolderError::Busy { .. })), "{refused:?}");
        assert!(start.elapsed() >= PATIENCE);
        std::thread::scope(|scope| {
            scope.spawn(|| {
                sleep(PAUSE * 2);
                drop(held);
            });
            lock(&*store, false).expect("a lock after the other has ended");
        });
        std::fs::remove_dir(&*root).expect("no file of the test");
    }
}
