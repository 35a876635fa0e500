//! Guidance: a state machine of phases, whose conditions stand in the campaign file.
//!
//! - [`phase`]: what a phase is. [`target`]: the attitude that it wants. [`condition`]: what ends it, and what
//!   conditions can ask for.
//! - Here: [`Guidance`], which phase a run is in.

pub mod condition;
pub mod phase;

pub mod target;

use condition::GuidanceInput;
use phase::{Maneuver, Next, Phase};

use super::failure::Failure;
use super::tick_times::TickTimes;

/// How a mission goes on after a tick.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Progress {
    /// It goes on.
    Flies,
    /// The net is launched: the run ends.
    Launches,
    /// The mission has failed: the run ends.
    Fails(Failure),
}

/// Which phase a run is in.
#[derive(Clone, Debug)]
pub struct Guidance {
    /// The phase, by its place in the list.
    pub phase: usize,
    /// When it began, s.
    pub since: f64,
    /// Since when its condition has been met, s; NaN while it is not.
    met_since: f64,
    /// When the station is reached by the transfer that is flown, s; NaN without one.
    pub arrival: f64,
    /// When each phase first began, s; NaN before.
    pub first_begun: Vec<f64>,
    /// Whether the phase has just begun: laws start anew.
    pub has_changed: bool,
}

impl Guidance {
    /// At the start of a run with `phases` phases.
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

    /// Decides at the tick at `time` (s), one of `ticks`, whether the phase goes on. `input` is what its condition
    /// asks, and may be `None` where it has none. At most one change a tick, so that a phase lasts at least one, and no
    /// list of phases makes a circle within a tick.
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

#[cfg(test)]
mod tests {
    use super::*;
    use condition::Condition;
    use target::Target;

    const TICKS: fn() -> TickTimes = || TickTimes::new(0.1, 1);

    fn input(time: f64, body_rate: f64) -> GuidanceInput {
        GuidanceInput {
            time,
            time_in_phase: 0.0,
            body_rate,
            error: target::AttitudeError::NONE,
            wheel_speed: 0.0,
            wheel_momentum: 0.0,
            geometry: None,
            velocity_to_go: [0.0; 3],
            s3_e: [0.0, 0.0, 1.0],
            time_to_station: f64::NAN,
            debris_age: f64::NAN,
            debris_rate: f64::NAN,
        }
    }

    fn phase(until: &str, next: Next) -> Phase {
        let until = (!until.is_empty()).then(|| Condition::parse(until, true).expect(until));
        Phase {
            until,
            next,
            otherwise: None,
            hold: 0.0,
            timeout: f64::INFINITY,
            target: Target::None,
            thrust: Maneuver::None,
            transfer_time: 0.0,
            unloading: None,
            rods: crate::control::laws::rod_law::RodLaw::None,
        }
    }

    /// Law: a phase ends where its condition has been met without a gap for `hold_s`, and not before; a gap starts the
    /// count anew.
    #[test]
    fn a_condition_must_hold() {
        let mut first = phase("body_rate_rad_s < 1", Next::Phase(1));
        first.hold = 0.3;
        let phases = [first, phase("", Next::Stay)];
        let mut guidance = Guidance::new(&phases);
        let rates = [2.0, 0.5, 0.5, 2.0, 0.5, 0.5, 0.5, 0.5, 0.5];
        for (tick, rate) in rates.into_iter().enumerate() {
            let time = 0.1 * tick as f64;
            assert_eq!(guidance.decide(&phases, time, Some(&input(time, rate)), &TICKS()), Progress::Flies);
            assert_eq!(guidance.phase, usize::from(tick >= 7), "tick {tick}");
            assert_eq!(guidance.has_changed, tick == 7);
        }
        assert_eq!(guidance.first_begun, [0.0, 0.1 * 7.0]);
        assert_eq!(guidance.since, 0.1 * 7.0);
    }

    /// Law: launch, timeout and repetition.
    #[test]
    fn missions_end_and_repeat() {
        let mut check = phase("body_rate_rad_s < 1", Next::Launch);
        check.otherwise = Some(1);
        let mut again = phase("time_s > 5", Next::Phase(0));
        again.timeout = 10.0;
        (again.thrust, again.transfer_time) = (Maneuver::Transfer, 30.0);
        let phases = [check, again];
        let mut guidance = Guidance::new(&phases);
        assert_eq!(guidance.decide(&phases, 0.0, Some(&input(0.0, 2.0)), &TICKS()), Progress::Flies);
        assert_eq!((guidance.phase, guidance.arrival), (1, 30.0));
        assert_eq!(guidance.decide(&phases, 1.0, Some(&input(1.0, 2.0)), &TICKS()), Progress::Flies);
        assert_eq!(guidance.phase, 1);
        assert_eq!(guidance.clone().decide(&phases, 6.0, Some(&input(6.0, 2.0)), &TICKS()), Progress::Flies);
        let mut late = guidance.clone();
        late.since = -5.0;
        assert_eq!(late.decide(&phases, 5.0, Some(&input(5.0, 2.0)), &TICKS()), Progress::Fails(Failure::Timeout));
        guidance.decide(&phases, 6.0, Some(&input(6.0, 2.0)), &TICKS());
        assert_eq!(guidance.decide(&phases, 6.1, Some(&input(6.1, 0.5)), &TICKS()), Progress::Launches);
        assert_eq!(Failure::NAMES[Failure::KeepOut as usize], "keep_out");
    }

    /// Law: what is not known meets no condition.
    #[test]
    fn unknown_values_meet_no_condition() {
        for text in ["debris_age_s < 5", "debris_age_s > 5", "time_to_station_s <= 1 and time_s >= 0"] {
            assert!(!Condition::parse(text, true).expect(text).is_met(&input(1.0, 0.0)), "{text}");
        }
        assert!(Condition::parse("debris_age_s < 5", false).is_err_and(|error| error.contains("not \"debris_age_s\"")));
        assert!(Condition::parse("body_rate < 5", true).is_err_and(|error| error.contains("body_rate_rad_s")));
    }
}
