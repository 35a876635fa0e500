//! The interface between a loop and its attitude laws.

use std::fmt;
use std::ops::{Deref, DerefMut};
use std::sync::Arc;

use super::estimate::Estimate;
use super::failure::Failure;
use super::sensor_spec::Readings;
use super::vector::{cross, difference, dot, product, scaled, sum};
use crate::sampling::SampleId;
use crate::scene::{DeclaredTable, LawParameter, MassProperties, WheelMode};

/// An attitude law in a run; each phase has its own, which restarts with the phase.
pub trait PhaseLaw {
    /// The wanted torque on the body, F_s, N m, `period` seconds after the last tick (zero at the first of the phase).
    fn torque(&mut self, body: &KnownBody, input: &LawInput<'_>, period: f64) -> [f64; 3];

    /// The law with `share` of its gains, and these as written in a campaign file; `None` if its gains are unknown.
    fn weaker(&self, _share: f64) -> Option<(AttitudeLaw, String)> {
        None
    }

    /// The reason for a torque that is not finite, if it is not simply divergence.
    fn failure(&self) -> Option<Failure> {
        None
    }

    /// Telemetry of its last tick ([`super::flight_code::FlightCode::telemetry`]); NaN for a non-finite value.
    fn telemetry(&self) -> &[f64] {
        &[]
    }
}

/// A [`PhaseLaw`] that can be cloned as an object.
trait ClonedLaw: PhaseLaw + Send {
    fn cloned(&self) -> Box<dyn ClonedLaw>;
}

impl<L: PhaseLaw + Clone + Send + 'static> ClonedLaw for L {
    fn cloned(&self) -> Box<dyn ClonedLaw> {
        Box::new(self.clone())
    }
}

/// Any attitude law in a run, with its state.
pub struct AttitudeLaw(Box<dyn ClonedLaw>);

impl AttitudeLaw {
    pub fn new(law: impl PhaseLaw + Clone + Send + 'static) -> Self {
        AttitudeLaw(Box::new(law))
    }
}

impl Clone for AttitudeLaw {
    fn clone(&self) -> Self {
        AttitudeLaw(self.0.cloned())
    }
}

impl Deref for AttitudeLaw {
    type Target = dyn PhaseLaw;

    fn deref(&self) -> &(dyn PhaseLaw + 'static) {
        &*self.0
    }
}

impl DerefMut for AttitudeLaw {
    fn deref_mut(&mut self) -> &mut (dyn PhaseLaw + 'static) {
        &mut *self.0
    }
}

type Make = dyn Fn(&LawSettings<'_>) -> AttitudeLaw + Send + Sync;

/// An attitude law that phases of `[[guidance]]` can name: built in, a WebAssembly module, or the calling program's
/// ([`super::OwnLaw`]).
///
/// ```
/// # extern crate spindrift_plan as spindrift;
/// use spindrift::loops::OwnLaw;
/// use spindrift::loops::attitude_law::{KnownBody, LawInput, LawKind, PhaseLaw};
/// use spindrift::scene::LawParameter;
/// use spindrift::scene::schema::Limit;
///
/// /// u = -c omega.
/// #[derive(Clone, Debug)]
/// struct Brake {
///     gain: f64,
/// }
///
/// impl PhaseLaw for Brake {
///     fn torque(&mut self, _body: &KnownBody, input: &LawInput<'_>, _period: f64) -> [f64; 3] {
///         input.omega_se_s.map(|rate| -self.gain * rate)
///     }
/// }
///
/// static PARAMETERS: [LawParameter; 1] =
///     [LawParameter::number("brake_n_m_s", "N m s", "Torque over rate", Limit::Positive)];
/// let brake = LawKind::new("brake", &PARAMETERS, |settings| {
///     Brake { gain: settings.table.named("brake_n_m_s").map_or(0.0, |numbers| numbers[0]) }
/// });
/// let law = OwnLaw::Phase(brake); // for `Session::under`
/// # let _ = law;
/// ```
#[derive(Clone)]
pub struct LawKind {
    /// Its name in a campaign file.
    pub name: &'static str,
    /// The keys of its table.
    pub parameters: &'static [LawParameter],
    /// True if it reads measurements ([`LawInput::readings`]).
    pub reads_sensors: bool,
    make: Option<Arc<Make>>,
}

impl LawKind {
    /// The law `name`; `make` makes it for a phase in a run.
    pub fn new<L: PhaseLaw + Clone + Send + 'static>(
        name: &'static str,
        parameters: &'static [LawParameter],
        make: impl Fn(&LawSettings<'_>) -> L + Send + Sync + 'static,
    ) -> Self {
        let make = move |settings: &LawSettings<'_>| AttitudeLaw::new(make(settings));
        LawKind { name, parameters, reads_sensors: false, make: Some(Arc::new(make)) }
    }

    /// Reads measurements if `reads_sensors`.
    #[must_use]
    pub fn reading(self, reads_sensors: bool) -> Self {
        LawKind { reads_sensors, ..self }
    }

    /// The law `name` of another program, which files may name.
    pub const fn missing(name: &'static str) -> Self {
        LawKind { name, parameters: &[], reads_sensors: true, make: None }
    }

    /// True if another program has it.
    pub fn is_missing(&self) -> bool {
        self.make.is_none()
    }

    /// The law of a phase in a run, which diverges under a missing one.
    pub fn make(&self, settings: &LawSettings<'_>) -> AttitudeLaw {
        self.make.as_ref().map_or_else(|| AttitudeLaw::new(Constant([f64::NAN; 3])), |make| make(settings))
    }
}

impl fmt::Debug for LawKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("LawKind").field("name", &self.name).finish_non_exhaustive()
    }
}

/// Laws are equal by name.
impl PartialEq for LawKind {
    fn eq(&self, other: &Self) -> bool {
        self.name == other.name
    }
}

/// A constant torque, F_s, N m: zero in a phase that names no law.
#[derive(Clone, Copy, Debug)]
pub struct Constant(pub [f64; 3]);

impl PhaseLaw for Constant {
    fn torque(&mut self, _body: &KnownBody, _input: &LawInput<'_>, _period: f64) -> [f64; 3] {
        self.0
    }
}

/// Settings of the law of a phase.
#[derive(Clone, Copy, Debug)]
pub struct LawSettings<'a> {
    /// Numbers of its keys.
    pub table: &'a DeclaredTable,
    /// True if `mrp_feedback` includes omega x H.
    pub gyroscopic: bool,
    /// Control period, s.
    pub period: f64,
    /// Delay from a tick to the effect of its command, s.
    pub delay: f64,
    /// The run; 0 is nominal.
    pub sample: SampleId,
}

/// Rounds to four significant digits.
pub fn digits(value: f64) -> f64 {
    format!("{value:.3e}").parse().unwrap_or(value)
}

/// Input of an attitude law at a tick. F_t is the target's frame.
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
    /// H, wheels included, in F_s, N m s: [`KnownBody::momentum`].
    pub momentum_s: [f64; 3],
    /// Time since the start of the run, s.
    pub time: f64,
    /// The whole estimate; `None` outside a loop.
    pub estimate: Option<&'a Estimate>,
    /// Last measurement of each sensor, if a law of the loop reads them ([`LawKind::reads_sensors`]).
    pub readings: Readings<'a>,
}

impl LawInput<'_> {
    /// On target at rest, without momentum.
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

    /// Vector part of the shorter rotation: q_v sign(q_0).
    pub fn error_vector(&self) -> [f64; 3] {
        let [w, x, y, z] = self.q_ts;
        if w < 0.0 { [-x, -y, -z] } else { [x, y, z] }
    }

    /// omega x H + K (omega_te' - omega x omega_te), the torque that keeps the rate relative to the target, F_s, N m.
    pub fn feedforward(&self, body: &KnownBody) -> [f64; 3] {
        let carried = difference(self.acceleration_te_s, cross(self.omega_se_s, self.omega_te_s));
        sum(product(body.inertia, carried), cross(self.omega_se_s, self.momentum_s))
    }
}

/// Constants of the nominal spacecraft.
#[derive(Clone, Copy, Debug)]
pub struct KnownBody {
    /// K = J*, the inertia without the axial ones of free wheels, in F_s, kg m^2.
    pub inertia: [[f64; 3]; 3],
}

impl KnownBody {
    pub fn of(mass: &MassProperties) -> Self {
        KnownBody { inertia: mass.inertia_rotating() }
    }

    /// H = K omega + sum h_i a_i in F_s, N m s, at the body rate `omega` and wheel rates `rates`.
    pub fn momentum(&self, mass: &MassProperties, omega: [f64; 3], rates: &[f64]) -> [f64; 3] {
        wheel_momenta(mass, omega, rates).fold(product(self.inertia, omega), sum)
    }
}

/// Momentum sum J_i Omega_i a_i of wheels relative to the body at the rates `rates`, in F_s, N m s.
pub fn stored_momentum(mass: &MassProperties, rates: &[f64]) -> [f64; 3] {
    let wheels = mass.wheels.iter().zip(rates);
    wheels.fold([0.0; 3], |total, (wheel, rate)| sum(total, scaled(wheel.axial * rate, wheel.axis)))
}

/// The momenta h_i a_i that wheels add to K omega, in F_s, N m s, at the body rate `omega` and wheel rates `rates`: h_i
/// = J_i (a_i . omega + Omega_i) for a free wheel, J_i Omega_i for one held at its speed, since K includes its inertia.
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
