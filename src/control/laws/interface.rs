//! Between a loop and its laws: what a law is made from ([`LawSettings`]), what it knows ([`KnownBody`]) and is told at
//! a tick ([`LawInput`]), and what the law of a program is ([`PhaseLaw`]).

use std::fmt;

use crate::control::estimate::Estimate;
use crate::control::failure::Failure;
use crate::control::sensor_spec::Readings;
use crate::control::vector::{cross, difference, dot, product, scaled, sum};
use crate::sampling::SampleId;
use crate::scene::{DeclaredTable, MassProperties, WheelMode};

/// A law of attitude that a program brings, in a run. It is made for each phase that names it, and begins anew with the
/// phase.
pub trait PhaseLaw {
    /// The wanted torque on the body, F_s, N m, at a tick `period` seconds after the last one (zero at the first of the
    /// phase).
    fn torque(&mut self, body: &KnownBody, input: &LawInput<'_>, period: f64) -> [f64; 3];

    /// Why it cannot go on, where its torque is no finite number; `None`: that itself is the reason.
    fn failure(&self) -> Option<Failure> {
        None
    }

    /// What it has reported at its last tick, by the columns of the loop
    /// ([`crate::control::flight_code::FlightCode::telemetry`]); NaN where a value is no finite number.
    fn telemetry(&self) -> &[f64] {
        &[]
    }
}

/// A [`PhaseLaw`] that can be copied without knowing its type.
trait ClonedLaw: PhaseLaw + fmt::Debug + Send {
    fn cloned(&self) -> Box<dyn ClonedLaw>;
}

impl<L: PhaseLaw + Clone + fmt::Debug + Send + 'static> ClonedLaw for L {
    fn cloned(&self) -> Box<dyn ClonedLaw> {
        Box::new(self.clone())
    }
}

/// The law of a program in a run.
#[derive(Debug)]
pub struct OwnLaw(Box<dyn ClonedLaw>);

impl OwnLaw {
    /// The law `law`.
    pub fn new(law: impl PhaseLaw + Clone + fmt::Debug + Send + 'static) -> Self {
        OwnLaw(Box::new(law))
    }

    /// The law itself.
    pub(super) fn law(&self) -> &dyn PhaseLaw {
        &*self.0
    }

    /// The same, to ask it.
    pub(super) fn law_mut(&mut self) -> &mut dyn PhaseLaw {
        &mut *self.0
    }
}

impl Clone for OwnLaw {
    fn clone(&self) -> Self {
        OwnLaw(self.0.cloned())
    }
}

/// A module that is the law of the phases that name it.
pub trait LawModule: fmt::Debug + Sync {
    /// The law of a phase.
    fn law(&'static self, settings: &LawSettings<'_>) -> OwnLaw;
}

/// What the law of a phase is made from.
#[derive(Clone, Copy, Debug)]
pub struct LawSettings<'a> {
    /// Its numbers.
    pub table: &'a DeclaredTable,
    /// Whether `mrp_feedback` has omega x H.
    pub gyroscopic: bool,
    /// The control period, s.
    pub period: f64,
    /// The time from a tick to the effect of its command, s.
    pub delay: f64,
    /// The run.
    pub sample: SampleId,
    /// The module of the loop, if it has one.
    pub code: Option<&'static dyn LawModule>,
}

/// A number with four significant digits.
pub(in crate::control) fn digits(value: f64) -> f64 {
    format!("{value:.3e}").parse().unwrap_or(value)
}

/// What a law of attitude knows at a tick. F_t is the target's frame: the attitude that F_s is to have.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LawInput<'a> {
    /// Attitude quaternion F_s -> F_t, scalar first, of either sign.
    pub q_ts: [f64; 4],
    /// Rate of F_s relative to F_e, in F_s, rad/s.
    pub omega_se_s: [f64; 3],
    /// Rate of F_t relative to F_e, in F_s, rad/s.
    pub omega_te_s: [f64; 3],
    /// Derivative of that rate in F_e, in F_s, rad/s^2.
    pub acceleration_te_s: [f64; 3],
    /// H, with the wheels, in F_s, N m s: [`KnownBody::momentum`].
    pub momentum_s: [f64; 3],
    /// Time since the start of the run, s.
    pub time: f64,
    /// All that is estimated; `None` where a law is tried without a loop.
    pub estimate: Option<&'a Estimate>,
    /// What the sensors have delivered last; none where no law of the loop asks for it ([`super::asked`],
    /// [`crate::control::flight_code`]).
    pub readings: Readings<'a>,
}

impl LawInput<'_> {
    /// At rest at a target at rest, without momentum.
    pub const AT_TARGET: LawInput<'static> = LawInput {
        q_ts: [1.0, 0.0, 0.0, 0.0],
        omega_se_s: [0.0; 3],
        omega_te_s: [0.0; 3],
        acceleration_te_s: [0.0; 3],
        momentum_s: [0.0; 3],
        time: 0.0,
        estimate: None,
        readings: Readings::NONE,
    };

    /// Rate of F_s relative to F_t, in F_s, rad/s.
    pub fn omega_st_s(&self) -> [f64; 3] {
        difference(self.omega_se_s, self.omega_te_s)
    }

    /// The vector part of the attitude, of the shorter rotation: q_v sign(q_0).
    pub fn error_vector(&self) -> [f64; 3] {
        let [w, x, y, z] = self.q_ts;
        if w < 0.0 { [-x, -y, -z] } else { [x, y, z] }
    }

    /// omega x H + K (omega_te' - omega x omega_te): the torque that keeps the rate relative to the target, F_s, N m.
    pub fn feedforward(&self, body: &KnownBody) -> [f64; 3] {
        let carried = difference(self.acceleration_te_s, cross(self.omega_se_s, self.omega_te_s));
        sum(product(body.inertia, carried), cross(self.omega_se_s, self.momentum_s))
    }
}

/// The constants of the spacecraft that a law knows: of the nominal scene.
#[derive(Clone, Copy, Debug)]
pub struct KnownBody {
    /// K = J*: the inertia without the axial ones of free wheels, in F_s, kg m^2.
    pub inertia: [[f64; 3]; 3],
}

impl KnownBody {
    /// Those of `mass`.
    pub fn of(mass: &MassProperties) -> Self {
        KnownBody { inertia: mass.inertia_rotating() }
    }

    /// H = K omega + sum h_i a_i, in F_s, N m s: of the body at the rate `omega` (rad/s), with the wheels of `mass` at
    /// the rates `rates` (rad/s).
    pub fn momentum(&self, mass: &MassProperties, omega: [f64; 3], rates: &[f64]) -> [f64; 3] {
        wheel_momenta(mass, omega, rates).fold(product(self.inertia, omega), sum)
    }
}

/// What the wheels of `mass` add to K omega, h_i a_i by wheel, in F_s, N m s, at the rate `omega` of the body and the
/// rates `rates` of the wheels, rad/s: h_i = J_i (a_i . omega + Omega_i) of a free wheel, and J_i Omega_i of one whose
/// speed is held, because K has the rest of it.
pub fn wheel_momenta<'a>(
    mass: &'a MassProperties,
    omega: [f64; 3],
    rates: &'a [f64],
) -> impl Iterator<Item = [f64; 3]> + 'a {
    mass.wheels.iter().zip(rates).map(move |(wheel, rate)| {
        let carried = if wheel.mode == WheelMode::SpeedHeld { 0.0 } else { dot(wheel.axis, omega) };
        scaled(wheel.axial * (carried + rate), wheel.axis)
    })
}
