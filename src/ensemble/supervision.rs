//! [`Supervision`]: what a campaign is told while it runs, and what it tells.

use std::sync::atomic::AtomicBool;

/// What a campaign is told while it runs, and what it tells.
#[derive(Clone, Copy)]
pub struct Supervision<'a> {
    /// Called from any thread with the number of samples completed since its last call there.
    pub progress: &'a (dyn Fn(u64) + Sync),
    /// No further part is started once this is set.
    pub stop: &'a AtomicBool,
    /// Parts under way are given up once this is set.
    pub abandon: &'a AtomicBool,
}

/// A flag that nobody sets.
static NEVER: AtomicBool = AtomicBool::new(false);

impl<'a> Supervision<'a> {
    /// A campaign that nobody stops.
    pub fn progress(progress: &'a (dyn Fn(u64) + Sync)) -> Self {
        Supervision { progress, stop: &NEVER, abandon: &NEVER }
    }
}
