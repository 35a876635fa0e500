//! [`Supervision`]: stops and progress of a campaign; [`Report`]: progress within a batch; [`Crew`]: the work of a
//! thread.

use std::sync::atomic::AtomicBool;

#[derive(Clone, Copy)]
pub struct Supervision<'a> {
    /// Receives the number of samples completed since the thread's last call.
    pub progress: &'a (dyn Fn(u64) + Sync),
    pub stop: &'a AtomicBool,
    pub abandon: &'a AtomicBool,
    pub crew: &'a dyn Crew,
}

/// Evaluations between reports, some 10 ms: a report of each run would slow a fast campaign.
const REPORTED_AFTER: u64 = 4096;

pub struct Report<'a> {
    supervision: Supervision<'a>,
    left: u64,
    done: u64,
    work: u64,
}

impl<'a> Report<'a> {
    pub fn new(supervision: Supervision<'a>, samples: usize) -> Self {
        Report { supervision, left: samples as u64, done: 0, work: 0 }
    }

    pub fn add(&mut self, evaluations: u64) {
        self.done += 1;
        self.work = self.work.saturating_add(evaluations);
        if self.work >= REPORTED_AFTER {
            self.send(self.done.min(self.left));
        }
    }

    pub fn finish(mut self) {
        self.send(self.left);
    }

    fn send(&mut self, samples: u64) {
        if samples > 0 {
            (self.supervision.progress)(samples);
        }
        self.left -= samples;
        (self.done, self.work) = (0, 0);
    }
}

/// Does the work of a thread, possibly several times side by side.
pub trait Crew: Sync {
    /// Calls `work`, which flies parts until none is left, at least once on this thread, and returns after all calls.
    /// Calls may take turns: a run only yields while it waits for its law.
    fn work(&self, work: &(dyn Fn() + Sync));
}

#[derive(Clone, Copy, Debug)]
pub struct Alone;

impl Crew for Alone {
    fn work(&self, work: &(dyn Fn() + Sync)) {
        work();
    }
}

static NEVER: AtomicBool = AtomicBool::new(false);

impl<'a> Supervision<'a> {
    /// A campaign that is never stopped.
    pub fn progress(progress: &'a (dyn Fn(u64) + Sync)) -> Self {
        Supervision { progress, stop: &NEVER, abandon: &NEVER, crew: &Alone }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::Mutex;

    fn reports(samples: usize, evaluations: &[u64]) -> Vec<u64> {
        let reports = Mutex::new(Vec::new());
        let progress = |samples| reports.lock().unwrap().push(samples);
        let mut report = Report::new(Supervision::progress(&progress), samples);
        evaluations.iter().for_each(|evaluations| report.add(*evaluations));
        report.finish();
        reports.into_inner().unwrap()
    }

    /// Law: every sample is reported once: long runs one by one, short ones together, others at the end.
    #[test]
    fn progress_follows_the_work() {
        assert_eq!(reports(3, &[u64::MAX, REPORTED_AFTER, REPORTED_AFTER + 1]), [1, 1, 1]);
        assert_eq!(reports(100, &[1; 90]), [100]);
        assert_eq!(reports(6, &[REPORTED_AFTER / 2; 4]), [2, 2, 2]);
        assert_eq!(reports(0, &[]), [0; 0]);
        assert_eq!(reports(2, &[u64::MAX; 3]), [1, 1]);
    }
}
