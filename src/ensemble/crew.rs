//! [`Crew`]: how a thread does its share of a campaign.

/// Does the work of a thread, for instance several times side by side.
pub trait Crew: Sync {
    /// Calls `work`, which flies parts until none is left, at least once, on this thread; returns when all calls have.
    /// Calls may take turns: a run leaves the thread to the others only where it asks its law.
    fn work(&self, work: &(dyn Fn() + Sync));
}

/// Once.
#[derive(Clone, Copy, Debug)]
pub struct Alone;

impl Crew for Alone {
    fn work(&self, work: &(dyn Fn() + Sync)) {
        work();
    }
}
