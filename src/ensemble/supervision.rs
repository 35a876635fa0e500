//! [`Supervision`]: what a campaign is told while it runs, and what it tells; [`Report`]: how far a batch is.

use std::sync::atomic::AtomicBool;

use crate::ensemble::crew::{Alone, Crew};

/// What a campaign is told while it runs, and what it tells.
#[derive(Clone, Copy)]
pub struct Supervision<'a> {
    /// Called from any thread with the number of samples completed since its last call there.
    pub progress: &'a (dyn Fn(u64) + Sync),
    /// No further part is started once this is set.
    pub stop: &'a AtomicBool,
    /// Parts under way are given up once this is set.
    pub abandon: &'a AtomicBool,
    /// How each thread does its share.
    pub crew: &'a dyn Crew,
}

/// Evaluations of equations of motion after which the runs that have ended are told: some 10 ms. Telling each run of a
/// fast campaign would cost more than it is worth.
const TOLD_AFTER: u64 = 4096;

/// The samples of a batch as they are completed.
pub struct Report<'a> {
    supervision: Supervision<'a>,
    /// Samples of the batch that are not told yet.
    left: u64,
    /// Samples that are completed and not told.
    done: u64,
    /// Evaluations since the last call.
    work: u64,
}

impl<'a> Report<'a> {
    /// Nothing is completed of a batch of `samples` samples.
    pub fn new(supervision: Supervision<'a>, samples: usize) -> Self {
        Report { supervision, left: samples as u64, done: 0, work: 0 }
    }

    /// A sample is completed, after so many evaluations.
    pub fn add(&mut self, evaluations: u64) {
        self.done += 1;
        self.work = self.work.saturating_add(evaluations);
        if self.work >= TOLD_AFTER {
            self.tell(self.done.min(self.left));
        }
    }

    /// The whole batch is completed.
    pub fn finish(mut self) {
        self.tell(self.left);
    }

    fn tell(&mut self, samples: u64) {
        if samples > 0 {
            (self.supervision.progress)(samples);
        }
        self.left -= samples;
        (self.done, self.work) = (0, 0);
    }
}

/// A flag that nobody sets.
static NEVER: AtomicBool = AtomicBool::new(false);

impl<'a> Supervision<'a> {
    /// A campaign that nobody stops.
    pub fn progress(progress: &'a (dyn Fn(u64) + Sync)) -> Self {
        Supervision { progress, stop: &NEVER, abandon: &NEVER, crew: &Alone }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::Mutex;

    fn told(samples: usize, evaluations: &[u64]) -> Vec<u64> {
        let told = Mutex::new(Vec::new());
        let progress = |samples| told.lock().unwrap().push(samples);
        let mut report = Report::new(Supervision::progress(&progress), samples);
        evaluations.iter().for_each(|evaluations| report.add(*evaluations));
        report.finish();
        told.into_inner().unwrap()
    }

    /// Law: every sample is told once; long runs one by one, short ones together, and samples without a run with the
    /// last.
    #[test]
    fn progress_follows_the_work() {
        assert_eq!(told(3, &[u64::MAX, TOLD_AFTER, TOLD_AFTER + 1]), [1, 1, 1]);
        assert_eq!(told(100, &[1; 90]), [100]);
        assert_eq!(told(6, &[TOLD_AFTER / 2; 4]), [2, 2, 2]);
        assert_eq!(told(0, &[]), [0; 0]);
        // a run that panics and is run again is not told twice
        assert_eq!(told(2, &[u64::MAX; 3]), [1, 1]);
    }
}
