//! Guidance: a state machine of [`phase`]s with a [`target`] attitude each, left by a condition of the campaign
//! file.

pub mod phase;

pub mod target;

use crate::loops::condition::GuidanceInput;
use crate::loops::phase::{Maneuver, Next};
use phase::Phase;

use super::tick_times::TickTimes;
use crate::loops::failure::Failure;

/// Progress of a mission after a tick.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Progress {
    Flies,
    Launches,
    Fails(Failure),
}

/// The current phase of a run.
#[derive(Clone, Debug)]
pub struct Guidance {
    /// Index of the phase.
    pub phase: usize,
    /// When it began.
    pub since: f64,
    /// Time since which its condition has been met; NaN if it is not.
    met_since: f64,
    /// Arrival of the current transfer at the station; NaN without one.
    pub arrival: f64,
    /// When each phase first began; NaN before.
    pub first_begun: Vec<f64>,
    /// True if the phase has just begun, so that laws restart.
    pub has_changed: bool,
}

impl Guidance {
    pub fn new(phases: &[Phase]) -> Self {
        let mut guidance = Guidance {
            phase: 0,
            since: 0.0,
            met_since: f64::NAN,
            arrival: f64::NAN,
            first_begun: vec![f64::NAN; phases.len()],
            has_changed: true,
        };
        guidance.begin(phases, 0, 0.0);
        guidance
    }

    fn begin(&mut self, phases: &[Phase], phase: usize, time: f64) {
        self.phase = phase;
        self.since = time;
        self.met_since = f64::NAN;
        self.has_changed = true;
        let first = &mut self.first_begun[phase];
        if first.is_nan() {
            *first = time;
        }
        if phases[phase].thrust == Maneuver::Transfer {
            self.arrival = time + phases[phase].transfer_time;
        }
    }

    /// Decides at the tick at `time` whether the phase goes on; `input` is needed by its condition. At most one change
    /// per tick, so that each phase lasts at least one and cycles take time.
    pub fn decide(
        &mut self,
        phases: &[Phase],
        time: f64,
        input: Option<&GuidanceInput>,
        ticks: &TickTimes,
    ) -> Progress {
        self.has_changed = false;
        let phase = &phases[self.phase];
        let is_met = phase.until.as_ref().zip(input).is_some_and(|(condition, input)| condition.is_met(input));
        if is_met && self.met_since.is_nan() {
            self.met_since = time;
        } else if !is_met {
            self.met_since = f64::NAN;
        }
        // a hold that ends at a tick ends there in spite of rounding
        let has_lasted = |since: f64, long: f64| ticks.exact(time - since) >= long - ticks.same();
        if is_met && has_lasted(self.met_since, phase.hold) {
            return match phase.next {
                Next::Launch => Progress::Launches,
                Next::Phase(next) => {
                    self.begin(phases, next, time);
                    Progress::Flies
                }
                Next::Stay => Progress::Flies,
            };
        }
        if let (false, Some(other)) = (is_met, phase.otherwise) {
            self.begin(phases, other, time);
            return Progress::Flies;
        }
        if has_lasted(self.since, phase.timeout) {
            return Progress::Fails(Failure::Timeout);
        }
        Progress::Flies
    }
}
