//! [`LaneSlots`]: assignment of runs to lanes.

use super::runs::{EndedRun, Recorder, Runs};
use crate::math::prelude::*;

pub struct LaneSlots {
    /// The run in each lane.
    lanes: [Option<usize>; WIDEST],
    next_run: usize,
    occupied: usize,
}

/// A run just loaded into a lane.
pub struct LoadedRun<const N: usize> {
    /// State at time zero.
    pub state: [f64; N],
    /// End of its first arc, s.
    pub end: f64,
}

impl LaneSlots {
    pub fn new() -> Self {
        LaneSlots { lanes: [None; WIDEST], next_run: 0, occupied: 0 }
    }

    #[inline(always)]
    pub fn any_occupied(&self) -> bool {
        self.occupied > 0
    }

    #[inline(always)]
    pub fn run(&self, lane: usize) -> Option<usize> {
        self.lanes[lane]
    }

    /// Loads the next run into lane `lane` and records its initial state; `None` without further runs. A run without
    /// arcs ends at once.
    #[inline(always)]
    pub fn load_lane<R, Q, O, const N: usize>(
        &mut self,
        lane: usize,
        runs: &mut Q,
        recorder: &mut O,
    ) -> Option<LoadedRun<N>>
    where
        R: Real,
        Q: Runs<R, N>,
        O: Recorder<Q, N>,
    {
        while self.next_run < runs.count() {
            let run = self.next_run;
            self.next_run += 1;
            let state = runs.load(lane, run);
            recorder.begin(lane, run);
            while recorder.next_time(lane) <= 0.0 {
                recorder.record(lane, &state);
            }
            if let Some(end) = runs.next_arc(lane, 0.0, &state) {
                self.lanes[lane] = Some(run);
                self.occupied += 1;
                return Some(LoadedRun { state, end });
            }
            recorder.finish(runs, lane, run, &EndedRun::default());
        }
        None
    }

    #[inline(always)]
    pub fn clear(&mut self, lane: usize) {
        self.lanes[lane] = None;
        self.occupied -= 1;
    }
}
