//! [`Threads`]: their number; [`unpoisoned`]: the content of a lock.

use std::num::NonZeroUsize;
use std::sync::{LockResult, PoisonError};

/// `None`: one per core.
pub(crate) type Threads = Option<NonZeroUsize>;

/// The content, also after a panic of another thread.
pub(crate) fn unpoisoned<T>(lock: LockResult<T>) -> T {
    lock.unwrap_or_else(PoisonError::into_inner)
}
