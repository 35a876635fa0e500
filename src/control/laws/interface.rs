//! Between a loop and its laws: a kind of law ([`LawKind`]), a law ([`PhaseLaw`], [`AttitudeLaw`]), its settings
//! ([`LawSettings`]), the spacecraft that it knows ([`KnownBody`]) and its input at a tick ([`LawInput`]).

use std::fmt;
use std::ops::{Deref, DerefMut};

use crate::control::estimate::Estimate;
use crate::control::failure::Failure;
use crate::control::sensor_spec::Readings;
use crate::control::vector::{cross, difference, dot, product, scaled, sum};
use crate::sampling::SampleId;
use crate::scene::{DeclaredTable, LawParameter, MassProperties, WheelMode};

/// A law of attitude in a run. Each phase that names it has one, which begins anew with the phase.
pub trait PhaseLaw {
    /// The wanted torque on the body, F_s, N m, at a tick `period` seconds after the last one (zero at the first of the
    /// phase).
    fn torque(&mut self, body: &KnownBody, input: &LawInput<'_>, period: f64) -> [f64; 3];

    /// The law with `share` of its gains, and these as a campaign file has them; `None` of a law that keeps its gains
    /// to itself.
    fn weaker(&self, _share: f64) -> Option<(AttitudeLaw, String)> {
        None
    }

    /// Why it cannot go on, if its torque is no finite number; `None`: that itself is the reason.
    fn failure(&self) -> Option<Failure> {
        None
    }

    /// The numbers of its last tick for the columns of the loop
    /// ([`crate::control::flight_code::FlightCode::telemetry`]); NaN for a value that is no finite number.
    fn telemetry(&self) -> &[f64] {
        &[]
    }
}

/// A [`PhaseLaw`] that can be copied without knowing its type.
trait ClonedLaw: PhaseLaw + fmt::Debug + Send {
    fn cloned(&self) -> Box<dyn ClonedLaw>;
    fn as_law(&self) -> &(dyn PhaseLaw + 'static);
    fn as_law_mut(&mut self) -> &mut (dyn PhaseLaw + 'static);
}

impl<L: PhaseLaw + Clone + fmt::Debug + Send + 'static> ClonedLaw for L {
    fn cloned(&self) -> Box<dyn ClonedLaw> {
        Box::new(self.clone())
    }

    fn as_law(&self) -> &(dyn PhaseLaw + 'static) {
        self
    }

    fn as_law_mut(&mut self) -> &mut (dyn PhaseLaw + 'static) {
        self
    }
}

/// Any law of attitude in a run, with its memory.
#[derive(Debug)]
pub struct AttitudeLaw(Box<dyn ClonedLaw>);

impl AttitudeLaw {
    /// The law `law`.
    pub fn new(law: impl PhaseLaw + Clone + fmt::Debug + Send + 'static) -> Self {
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
        self.0.as_law()
    }
}

impl DerefMut for AttitudeLaw {
    fn deref_mut(&mut self) -> &mut (dyn PhaseLaw + 'static) {
        self.0.as_law_mut()
    }
}

/// A law of attitude that a campaign can name: built in, a WebAssembly module, a function of Python
/// ([`super::callback`]), or a static of your program, which its session brings
/// ([`crate::workflow::session::Session::with_attitude_law`]). Phases of `[[guidance]]` name all of them alike.
///
/// ```
/// use spindrift::control::laws::{AttitudeLaw, KnownBody, LawInput, LawKind, LawSettings, PhaseLaw};
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
/// static BRAKE: LawKind = LawKind {
///     name: "brake",
///     parameters: &PARAMETERS,
///     make: &|settings: &LawSettings<'_>| {
///         let gain = settings.table.named("brake_n_m_s").map_or(0.0, |numbers| numbers[0]);
///         AttitudeLaw::new(Brake { gain })
///     },
/// };
/// assert_eq!(BRAKE.name, "brake");
/// ```
#[derive(Clone, Copy)]
pub struct LawKind {
    /// Its name, as in `kind` of a campaign file.
    pub name: &'static str,
    /// The keys of its table.
    pub parameters: &'static [LawParameter],
    /// Makes the law of a run.
    pub make: &'static (dyn Fn(&LawSettings<'_>) -> AttitudeLaw + Send + Sync),
}

impl fmt::Debug for LawKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("LawKind").field("name", &self.name).finish_non_exhaustive()
    }
}

/// Laws of one name are one law.
impl PartialEq for LawKind {
    fn eq(&self, other: &Self) -> bool {
        self.name == other.name
    }
}

/// No torque: the law of a phase that names none.
#[derive(Clone, Copy, Debug)]
pub struct NoTorque;

impl PhaseLaw for NoTorque {
    fn torque(&mut self, _body: &KnownBody, _input: &LawInput<'_>, _period: f64) -> [f64; 3] {
        [0.0; 3]
    }
}

/// The settings of the law of a phase.
#[derive(Clone, Copy, Debug)]
pub struct LawSettings<'a> {
    /// Its numbers.
    pub table: &'a DeclaredTable,
    /// True if `mrp_feedback` has omega x H.
    pub gyroscopic: bool,
    /// The control period, s.
    pub period: f64,
    /// The time from a tick to the effect of its command, s.
    pub delay: f64,
    /// The run.
    pub sample: SampleId,
}

/// A number with four significant digits.
pub(in crate::control) fn digits(value: f64) -> f64 {
    format!("{value:.3e}").parse().unwrap_or(value)
}

/// The input of a law of attitude at a tick. F_t is the frame of the target.
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
    /// All that is estimated; `None` without a loop.
    pub estimate: Option<&'a Estimate>,
    /// The last measurement of each sensor, in a loop whose law reads them ([`super::callback`],
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
    pub fn of(mass: &MassProperties) -> Self {
        KnownBody { inertia: mass.inertia_rotating() }
    }

    /// H = K omega + sum h_i a_i, in F_s, N m s: of the body at the rate `omega` (rad/s), with the wheels of `mass` at
    /// the rates `rates` (rad/s).
    pub fn momentum(&self, mass: &MassProperties, omega: [f64; 3], rates: &[f64]) -> [f64; 3] {
        wheel_momenta(mass, omega, rates).fold(product(self.inertia, omega), sum)
    }
}

/// The momenta that the wheels of `mass` add to K omega, h_i a_i by wheel, in F_s, N m s, at the rate `omega` of the
/// body and the rates `rates` of the wheels, rad/s: h_i = J_i (a_i . omega + Omega_i) of a free wheel, and J_i Omega_i
/// of one whose speed is held, because K has the rest of it.
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
