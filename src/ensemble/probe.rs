//! [`RunProbe`], [`AuditProbe`]: the time of a run and of an audit, measured on the first samples of a campaign.

use std::time::Instant;

use crate::campaign::SceneDraws;
use crate::ensemble::audit::Auditor;
use crate::ensemble::failure_reasons::FailureReasons;
use crate::ensemble::parts::{Part, PartId};
use crate::ensemble::rows::Rows;
use crate::ensemble::supervision::Supervision;
use crate::ensemble::worker::Ensemble;
use crate::run::Status;
use crate::sampling::SampleId;

/// A probe takes about this long, s.
const DURATION_S: f64 = 0.5;

/// A probe runs at most this many samples.
const MOST_SAMPLES: usize = 512;

/// The first runs of a campaign.
#[derive(Clone, Debug)]
pub struct RunProbe {
    /// Time of a run on one core, s.
    pub seconds: f64,
    /// Their rows.
    pub rows: Rows,
}

impl RunProbe {
    /// Runs the first samples of `ensemble` for about half a second.
    pub fn new(ensemble: &Ensemble<'_>) -> Self {
        let most = usize::try_from(ensemble.plan().samples).unwrap_or(usize::MAX).min(MOST_SAMPLES);
        let mut rows = ensemble.rows(most);
        let mut worker = ensemble.worker();
        let mut timed = |count: usize| {
            let start = Instant::now();
            worker.run(Part { id: PartId(0), first: SampleId(0), count }, &mut rows, Supervision::progress(&|_| {}));
            start.elapsed().as_secs_f64()
        };
        timed(1); // allocates and fills the caches
        let one = timed(1).max(1e-7);
        let count = ((DURATION_S / one) as usize).clamp(1, most);
        let seconds = timed(count) / count as f64;
        RunProbe { seconds, rows }
    }

    /// Number of runs.
    pub fn count(&self) -> usize {
        self.rows.part().count
    }

    /// How many of them failed.
    pub fn failed(&self) -> usize {
        self.rows.statuses().iter().filter(|status| **status != Status::Done).count()
    }

    /// Whether no run is `ok` that statistics would be about: every one failed, or every one but the nominal.
    pub fn is_hopeless(&self) -> bool {
        self.failed() == self.count()
            || self.count() > 1 && self.rows.statuses()[1..].iter().all(|status| *status != Status::Done)
    }

    /// Why they failed.
    pub fn reasons(&self) -> FailureReasons {
        let mut reasons = FailureReasons::default();
        reasons.add(&self.rows);
        reasons
    }
}

/// The first audits of a campaign.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AuditProbe {
    /// Time of an audit on one core, s.
    pub seconds: f64,
    /// Number of audits.
    pub count: u32,
}

impl AuditProbe {
    /// Audits the first samples of `ensemble` for about half a second.
    pub fn new(ensemble: &Ensemble<'_>) -> Self {
        let plan = ensemble.plan();
        let mut auditor = Auditor::new(plan, ensemble.isa(), &plan.grid);
        let mut draws = SceneDraws::new(plan);
        let start = Instant::now();
        let (mut count, mut sample) = (0_u32, 0);
        while sample < plan.samples && start.elapsed().as_secs_f64() < DURATION_S {
            if let Ok(scene) = draws.scene(SampleId(sample)) {
                let _ = auditor.audit(&scene); // its time counts, whatever it found
                count += 1;
            }
            sample += 1;
        }
        AuditProbe { seconds: start.elapsed().as_secs_f64() / f64::from(count.max(1)), count }
    }
}
