//! [`unpoisoned`]: the content of a lock.

use std::sync::{LockResult, PoisonError};

/// The content, also after a panic of another thread.
pub(crate) fn unpoisoned<T>(lock: LockResult<T>) -> T {
    lock.unwrap_or_else(PoisonError::into_inner)
}
