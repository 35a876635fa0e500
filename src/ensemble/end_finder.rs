//! [`EndFinder`]: the event that ends a run, one run at a time.

use crate::campaign::Plan;
use crate::ensemble::event_finder::EventFinder;
use crate::ensemble::flights::{LawDraw, Runs};
use crate::ensemble::observed_runs::{Means, ObservedRuns};
use crate::ensemble::run_end::RunEnd;
use crate::ensemble::settings::Engines;
use crate::scene::Scene;

/// Finds the ends of runs of a plan, from its observation points, as its campaign does.
pub struct EndFinder<'p> {
    runs: ObservedRuns<'p>,
    events: EventFinder<'p>,
}

impl<'p> EndFinder<'p> {
    /// For runs of `plan`; `None` if no event ends them.
    pub fn new(plan: &'p Plan, engines: Engines) -> Option<Self> {
        if !plan.events.iter().any(|event| event.ends_run) {
            return None;
        }
        let runs = Means::new(plan, engines).runs(&plan.grid);
        Some(EndFinder { runs, events: EventFinder::new(plan, &plan.grid, engines)? })
    }

    /// The end of the run of `scene` under the law of `draw`; `None` if no event ends it.
    pub fn end(&mut self, scene: &Scene, draw: &[LawDraw]) -> Option<RunEnd> {
        let EndFinder { runs, events } = self;
        let one = Runs::one(scene, draw);
        events.restart(1);
        let mut is_ended = false;
        runs.fly(one, &mut |seen| is_ended = events.look(&seen.run, seen.observer, seen.status));
        if !is_ended {
            return None;
        }
        events.locate(one);
        events.end(0)
    }
}
