//! [`Crew`]: the work of one thread on a campaign.

/// Does the work of a thread, possibly several times side by side.
pub trait Crew: Sync {
    /// Calls `work`, which flies parts until none is left, at least once on this thread, and returns after all calls.
    /// Calls may take turns: a run yields the thread only while it waits for its law.
    fn work(&self, work: &(dyn Fn() + Sync));
}

/// One call.
#[derive(Clone, Copy, Debug)]
pub struct Alone;

impl Crew for Alone {
    fn work(&self, work: &(dyn Fn() + Sync)) {
        work();
    }
}
