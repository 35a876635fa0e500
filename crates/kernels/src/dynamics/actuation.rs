//! Actuation of a spacecraft, arc by arc.
//!
//! At the end of an *arc* of constant actuation the engine passes the state of the run to its [`ActuationLaw`], which
//! returns the next actuation and its end. Values are *applied* ones: a law models scales, delays and limits itself.

use crate::run::Telemetry;
pub use crate::scene::schedule::actuation_at;
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

/// Decides the actuation of one run, arc by arc; any closure `|time, body, wheels| -> Actuation` does.
pub trait ActuationLaw {
    /// Actuation from `time`, s, on: at time zero and at the end of every arc; `until` must exceed `time`. Another
    /// source or the end of the run may cut the arc short.
    fn arc(&mut self, time: f64, body: &BodyState, wheels: &WheelState) -> Actuation;

    /// Called once with the final state, after the last arc.
    fn end(&mut self, _time: f64, _body: &BodyState, _wheels: &WheelState) {}

    /// Writes the columns that the law declares, in order; they are NaN before.
    fn report(&self, _values: &mut [f64]) {}

    /// Why the law ended its run as [`crate::run::Status::Diverged`], if it did.
    fn divergence(&self) -> Option<String> {
        None
    }

    /// The telemetry of the run, if recorded.
    fn telemetry(&self) -> Option<&Telemetry> {
        None
    }
}

impl<F: FnMut(f64, &BodyState, &WheelState) -> Actuation> ActuationLaw for F {
    fn arc(&mut self, time: f64, body: &BodyState, wheels: &WheelState) -> Actuation {
        self(time, body, wheels)
    }
}

/// Samples a law at times 0, T, 2T, ... and holds each actuation for a period.
#[derive(Clone, Debug)]
pub struct ZeroOrderHold<L> {
    period: f64,
    law: L,
    /// Number of the next sample.
    next: u64,
    held: Actuation,
}

impl<L: ActuationLaw> ZeroOrderHold<L> {
    /// `law` at a control period of `period` > 0, s.
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

    /// The same laws for a shorter time.
    pub fn reborrow(&mut self) -> Laws<'_> {
        match self {
            Laws::OpenLoop => Laws::OpenLoop,
            Laws::Feedback(source) => Laws::Feedback(&mut **source),
        }
    }
}
