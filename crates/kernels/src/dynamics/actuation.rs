//! Actuation of a spacecraft, arc by arc.
//!
//! At the end of an *arc* of constant actuation the engine passes the state to the run's [`ActuationLaw`], which
//! returns the next actuation and its end. A law sees its own run only, although engines propagate several runs
//! together. Any closure `|time, body, wheels| -> Actuation` is a law.
//!
//! Values are *applied* values: a law models the scales, delays and limits of its actuators itself.

use crate::run::Telemetry;
use crate::scene::schedule::actuation_at;
pub use crate::scene::{Actuation, Arc, MAX_THRUSTERS, MAX_WHEELS};

/// Motion of the spacecraft's body at one time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BodyState {
    /// Angular velocity of F_s relative to F_e, in F_s, rad/s.
    pub omega_se_s: [f64; 3],
    /// Attitude quaternion, F_s -> F_e, scalar first; of unit norm up to integration error.
    pub q_es: [f64; 4],
    /// Position of the spacecraft's centre of mass c in F_e, m.
    pub r_co_e: [f64; 3],
    /// Velocity of c relative to F_e, in F_e, m/s.
    pub v_co_e: [f64; 3],
}

/// Motion of the wheels at one time, in order; zero beyond the spacecraft's wheels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WheelState {
    /// Rates relative to the body, rad/s.
    pub rates: [f64; MAX_WHEELS],
    /// Angular momenta about their axes relative to F_e, J_i (Omega_i + a_i . omega), N m s.
    pub momenta: [f64; MAX_WHEELS],
    /// Angles relative to the body, rad, not wrapped.
    pub angles: [f64; MAX_WHEELS],
}

impl WheelState {
    /// No wheel turns.
    pub const AT_REST: WheelState =
        WheelState { rates: [0.0; MAX_WHEELS], momenta: [0.0; MAX_WHEELS], angles: [0.0; MAX_WHEELS] };
}

/// Decides the actuation of one run, arc by arc, from its present and earlier arguments only.
pub trait ActuationLaw {
    /// Actuation from `time` (s since the start of the run) on. Called at time zero and at the end of every arc;
    /// `until` must exceed `time`, and another source or the end of the run may cut the arc short.
    fn arc(&mut self, time: f64, body: &BodyState, wheels: &WheelState) -> Actuation;

    /// Called once with the final state, after the last arc.
    fn end(&mut self, _time: f64, _body: &BodyState, _wheels: &WheelState) {}

    /// Writes the columns that the law declares, in order; they are NaN before.
    fn report(&self, _values: &mut [f64]) {}

    /// Why the law ended its run as [`crate::run::Status::Diverged`], if it did.
    fn divergence(&self) -> Option<String> {
        None
    }

    /// The telemetry of the run, if the law records it.
    fn telemetry(&self) -> Option<&Telemetry> {
        None
    }
}

impl<F: FnMut(f64, &BodyState, &WheelState) -> Actuation> ActuationLaw for F {
    fn arc(&mut self, time: f64, body: &BodyState, wheels: &WheelState) -> Actuation {
        self(time, body, wheels)
    }
}

/// A schedule fixed before the run; nothing acts outside its arcs.
#[derive(Clone, Copy, Debug)]
pub struct OpenLoop<'a> {
    /// The arcs, in order, not overlapping.
    pub schedule: &'a [Arc],
}

impl OpenLoop<'_> {
    /// Actuation at `time`.
    #[inline]
    pub fn at(&self, time: f64) -> Actuation {
        actuation_at(self.schedule, time)
    }
}

impl ActuationLaw for OpenLoop<'_> {
    fn arc(&mut self, time: f64, _body: &BodyState, _wheels: &WheelState) -> Actuation {
        self.at(time)
    }
}

/// Samples a law at times 0, T, 2T, ... and holds each actuation for a whole period, whatever its `until`.
#[derive(Clone, Debug)]
pub struct ZeroOrderHold<L> {
    period: f64,
    law: L,
    /// Number of the next sample.
    next: u64,
    held: Actuation,
}

impl<L: ActuationLaw> ZeroOrderHold<L> {
    /// `law` at a control period of `period` > 0 seconds.
    pub fn new(period: f64, law: L) -> Self {
        ZeroOrderHold { period, law, next: 0, held: Actuation::none(0.0) }
    }

    /// The sampled law.
    pub fn law(&self) -> &L {
        &self.law
    }
}

impl<L: ActuationLaw> ActuationLaw for ZeroOrderHold<L> {
    fn arc(&mut self, time: f64, body: &BodyState, wheels: &WheelState) -> Actuation {
        if time >= self.held.until {
            // a product, so that rounding errors do not accumulate
            while self.next as f64 * self.period <= time {
                self.next += 1;
            }
            self.held = self.law.arc(time, body, wheels);
            self.held.until = self.next as f64 * self.period;
        }
        self.held
    }

    fn end(&mut self, time: f64, body: &BodyState, wheels: &WheelState) {
        self.law.end(time, body, wheels);
    }

    fn report(&self, values: &mut [f64]) {
        self.law.report(values);
    }
}

/// Two sources together: thrusts and torques add, and the earlier `until` ends the arc. A source is sampled when its
/// own actuation ends.
#[derive(Clone, Debug)]
pub struct Sum<A, B> {
    first: (A, Actuation),
    second: (B, Actuation),
}

impl<A: ActuationLaw, B: ActuationLaw> Sum<A, B> {
    /// `first` and `second`.
    pub fn new(first: A, second: B) -> Self {
        let never = Actuation::none(f64::NEG_INFINITY);
        Sum { first: (first, never), second: (second, never) }
    }
}

impl<A: ActuationLaw, B: ActuationLaw> ActuationLaw for Sum<A, B> {
    fn arc(&mut self, time: f64, body: &BodyState, wheels: &WheelState) -> Actuation {
        if time >= self.first.1.until {
            self.first.1 = self.first.0.arc(time, body, wheels);
        }
        if time >= self.second.1.until {
            self.second.1 = self.second.0.arc(time, body, wheels);
        }
        sum(&self.first.1, &self.second.1)
    }

    fn end(&mut self, time: f64, body: &BodyState, wheels: &WheelState) {
        self.first.0.end(time, body, wheels);
        self.second.0.end(time, body, wheels);
    }
}

/// Sum of two actuations, until either changes.
pub fn sum(first: &Actuation, second: &Actuation) -> Actuation {
    Actuation {
        until: first.until.min(second.until),
        thrust: std::array::from_fn(|i| first.thrust[i] + second.thrust[i]),
        motor_torque: std::array::from_fn(|i| first.motor_torque[i] + second.motor_torque[i]),
        body_torque: std::array::from_fn(|i| first.body_torque[i] + second.body_torque[i]),
        dipole: std::array::from_fn(|i| first.dipole[i] + second.dipole[i]),
        ends_run: first.ends_run || second.ends_run,
    }
}

/// The laws of a batch, by index of the run.
pub trait LawSource {
    /// The law of run `run`.
    fn law(&mut self, run: usize) -> &mut dyn ActuationLaw;
}

impl<L: ActuationLaw> LawSource for Vec<L> {
    fn law(&mut self, run: usize) -> &mut dyn ActuationLaw {
        &mut self[run]
    }
}

/// Actuation of the runs of a batch.
pub enum Laws<'a> {
    /// Each run follows the schedule of its scene.
    OpenLoop,
    /// Each run follows its own law instead of its schedule.
    Feedback(&'a mut dyn LawSource),
}

impl Laws<'_> {
    /// The law of run `run`; `None` if the run follows its schedule.
    pub fn of(&mut self, run: usize) -> Option<&mut dyn ActuationLaw> {
        match self {
            Laws::OpenLoop => None,
            Laws::Feedback(source) => Some(source.law(run)),
        }
    }

    /// Reborrows the laws for a shorter time.
    pub fn reborrow(&mut self) -> Laws<'_> {
        match self {
            Laws::OpenLoop => Laws::OpenLoop,
            Laws::Feedback(source) => Laws::Feedback(&mut **source),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const BODY: BodyState =
        BodyState { omega_se_s: [0.0; 3], q_es: [1.0, 0.0, 0.0, 0.0], r_co_e: [0.0; 3], v_co_e: [0.0; 3] };

    fn thrust(until: f64, thrust: f64) -> Actuation {
        Actuation::none(until).with_thrust(&[thrust])
    }

    fn arcs(law: &mut dyn ActuationLaw, duration: f64) -> Vec<(f64, f64, f64)> {
        let (mut time, mut list) = (0.0, Vec::new());
        while time < duration {
            assert!(list.len() < 100, "100 arcs, the last at {time} s");
            let mut arc = Arc { start: time, applied: law.arc(time, &BODY, &WheelState::AT_REST) };
            arc.applied.until = arc.applied.until.min(duration);
            time = arc.end();
            list.push((arc.start, arc.end(), arc.applied.thrust[0]));
        }
        list
    }

    #[test]
    fn sources_add_and_the_earlier_end_wins() {
        let schedule = [Arc { start: 0.25, applied: thrust(0.6, 2.0) }];
        let mut calls = 0;
        let sampled = ZeroOrderHold::new(0.5, |_: f64, _: &BodyState, _: &WheelState| {
            calls += 1;
            thrust(f64::INFINITY, 10.0 * f64::from(calls))
        });
        let mut law = Sum::new(OpenLoop { schedule: &schedule }, sampled);
        let flown = [(0.0, 0.25, 10.0), (0.25, 0.5, 12.0), (0.5, 0.6, 22.0), (0.6, 1.0, 20.0)];
        assert_eq!(arcs(&mut law, 1.0), flown);
    }
}
