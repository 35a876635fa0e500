//! [`LoopSpec`]: the structure of a control loop in a campaign file. Its dispersible numbers are parameters of the
//! scene.

use super::attitude_law::LawKind;
use super::condition::Condition;
use super::flight_code::{DeclaredTelemetry, FlightCode};
use super::kinds::EstimatorKind;
use super::observes::Observes;
use super::phase::{Maneuver, Next};
use super::rod_law::RodLaw;
use super::sensor_spec::SensorSpec;
use super::target::Target;
use crate::observables::{LawSeries, Series};
use crate::sampling::Written;
use crate::scene::{Name, Scene};

/// Standard gravity, which turns a specific impulse into an exhaust velocity, m/s^2 (ISO 80000-3).
pub const STANDARD_GRAVITY: f64 = 9.806_65;

#[derive(Clone, Debug, PartialEq)]
pub struct LoopSpec {
    pub period: f64,
    pub estimator: &'static EstimatorKind,
    /// Index of the estimator in the list of makers.
    pub estimator_maker: usize,
    /// Indices of the driven wheels among those that turn.
    pub wheels: Vec<usize>,
    pub thrusters: Vec<usize>,
    pub rods: Vec<usize>,
    pub modulation: usize,
    /// True if thrusters keep the net force at zero outside maneuvers.
    pub holds_force: bool,
    pub sensors: Vec<SensorSpec>,
    /// The WebAssembly module that phases can name as their law.
    pub module: Option<ModuleSpec>,
    pub phases: Vec<PhaseSpec>,
    /// Flight software's beliefs that replace the nominal scene: mass, centre of mass from p in F_s, and inertia about
    /// it with wheels locked.
    pub model: Written,
    /// Keys of `[control]` other than parameters, in canonical form.
    pub written: Written,
    pub has_debris: bool,
    pub wheel_names: Vec<Name>,
    pub thruster_names: Vec<Name>,
    pub rod_names: Vec<Name>,
}

#[derive(Clone, Debug, PartialEq)]
pub struct ModuleSpec {
    pub file: String,
    pub code: &'static FlightCode,
}

/// Limit on the ticks in a control period, and on the control periods in a latency.
pub const MOST_TICKS: f64 = 1000.0;

/// The number of ticks in a control period of `period` seconds at which sensors with these periods measure (each a
/// multiple or a whole fraction of the control period): the least common multiple of the fractions. `None` above
/// [`MOST_TICKS`].
pub fn ticks_per_period(period: f64, sensors: impl Iterator<Item = f64>) -> Option<u64> {
    let common = |a: u64, b: u64| {
        let (mut x, mut y) = (a, b);
        while y > 0 {
            (x, y) = (y, x % y);
        }
        a / x * b
    };
    let mut ticks = 1;
    for own in sensors.filter(|own| *own < period) {
        ticks = common(ticks, (period / own).round() as u64);
        if ticks as f64 > MOST_TICKS {
            return None;
        }
    }
    Some(ticks)
}

#[derive(Clone, Debug, PartialEq)]
pub struct PhaseSpec {
    pub name: Name,
    pub law: Option<LawKind>,
    /// True if `mrp_feedback` includes the term omega x H.
    pub gyroscopic: bool,
    /// Target attitude; an inertial target's quaternion is a parameter.
    pub target: Target,
    pub thrust: Maneuver,
    pub rods: RodLaw,
    pub until: Option<Condition>,
    pub next: Next,
    /// Phase that begins at once if the condition is not met.
    pub otherwise: Option<usize>,
    /// Keys of its table other than parameters, in canonical form.
    pub written: Written,
}

impl LoopSpec {
    pub fn ticks_per_period(&self) -> u64 {
        ticks_per_period(self.period, self.sensors.iter().map(|sensor| sensor.period)).unwrap_or(1)
    }

    /// The laws that phases name.
    pub fn laws(&self) -> impl Iterator<Item = &LawKind> {
        self.phases.iter().filter_map(|phase| phase.law.as_ref())
    }

    pub fn code(&self) -> Option<&'static FlightCode> {
        self.module.as_ref().map(|module| module.code)
    }

    /// Telemetry of the module, if any.
    pub fn telemetry(&self) -> &'static [DeclaredTelemetry] {
        self.code().map_or(&[], |code| code.telemetry)
    }

    /// Quantities that the loop records over time.
    pub fn over_time(&self) -> LawSeries {
        let mut series = LawSeries::NONE;
        if self.points() {
            series = series.with(Series::PointingError);
        }
        if !self.knows_the_truth() {
            series = series.with(Series::AttitudeEstimateError).with(Series::RateEstimateError);
            if self.approaches() {
                series = series.with(Series::PositionEstimateError).with(Series::VelocityEstimateError);
            }
        }
        if self.approaches() {
            series = series.with(Series::DebrisDistance).with(Series::DebrisSpeed);
        }
        if !self.thrusters.is_empty() {
            series = series.with(Series::Impulse);
        }
        self.wheels.iter().fold(series, |series, wheel| series.with(Series::MotorTorque.of_wheel(*wheel)))
    }

    pub fn launches(&self) -> bool {
        self.phases.iter().any(|phase| phase.next == Next::Launch)
    }

    pub fn points(&self) -> bool {
        self.phases.iter().any(|phase| phase.target != Target::None)
    }

    pub fn has_filter(&self) -> bool {
        self.estimator.has_filter
    }

    pub fn knows_the_truth(&self) -> bool {
        self.estimator.knows_the_truth
    }

    /// True if a camera observes the debris.
    pub fn has_camera(&self) -> bool {
        self.sensors.iter().any(|sensor| matches!(sensor.kind.observes, Observes::DebrisAttitude(_)))
    }

    pub fn needs_axis(&self) -> bool {
        let needs = |phase: &PhaseSpec| {
            matches!(phase.target, Target::LaunchAxis | Target::Transfer) || phase.thrust == Maneuver::Transfer
        };
        self.launches() || self.phases.iter().any(needs)
    }

    /// True if a phase points or moves relative to the debris.
    pub fn approaches(&self) -> bool {
        self.has_debris && self.phases.iter().any(|phase| phase.target.needs_debris() || phase.thrust != Maneuver::None)
    }

    /// The nominal scene as flight software believes it.
    pub fn believed(&self, nominal: &Scene) -> Scene {
        let mut scene = nominal.clone();
        let mass = &mut scene.mass;
        mass.total = self.model.number("mass_kg").unwrap_or(mass.total);
        mass.center = self.model.vector("center_of_mass_m").unwrap_or(mass.center);
        if let Some(inertia) = self.model.matrix("inertia_kg_m2") {
            *mass = mass.with_inertia(inertia);
        }
        scene
    }
}
