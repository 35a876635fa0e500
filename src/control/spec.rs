//! [`LoopSpec`]: the structure of a control loop in a campaign file. Its numbers, which can be dispersed, are
//! parameters of the scene.

use super::guidance::condition::Condition;
use super::guidance::phase::{Maneuver, Next};
use super::guidance::target::Target;
use super::laws::LawKind;
use super::laws::rod_law::RodUse;
use super::observes::Observes;
use super::sensor_spec::SensorSpec;
use crate::control::estimators::estimator::EstimatorKind;
use crate::control::flight_code::module::FlightCode;
use crate::observables::{LawSeries, Series};
use crate::sampling::Written;
use crate::scene::{Name, Scene};

/// A control loop.
#[derive(Clone, Debug, PartialEq)]
pub struct LoopSpec {
    /// Control period, s.
    pub period: f64,
    /// The estimator, by its place in the list of estimators.
    pub estimator: usize,
    /// The wheels that the loop drives, by their places among the wheels that turn.
    pub wheels: Vec<usize>,
    /// The thrusters that it fires, by their places.
    pub thrusters: Vec<usize>,
    /// The torque rods that it drives, by their places.
    pub rods: Vec<usize>,
    /// The modulation of thrusters, by its place in the list.
    pub modulation: usize,
    /// True if thrusters keep the force at zero outside of maneuvers.
    pub holds_force: bool,
    /// The sensors.
    pub sensors: Vec<SensorSpec>,
    /// The module that phases name as their law.
    pub module: Option<ModuleSpec>,
    /// The phases; there is at least one.
    pub phases: Vec<PhaseSpec>,
    /// What flight software believes instead of the nominal scene: mass and centre from p in F_s, and inertia about
    /// that centre with wheels locked.
    pub model: Written,
    /// The keys of `[control]` that are no parameters, as canonical text has them.
    pub written: Written,
    /// Whether the scene has debris.
    pub has_debris: bool,
    /// The names of the wheels that turn.
    pub wheel_names: Vec<Name>,
    /// The names of the thrusters.
    pub thruster_names: Vec<Name>,
    /// The names of the torque rods.
    pub rod_names: Vec<Name>,
}

/// A WebAssembly module as the file names it.
#[derive(Clone, Debug, PartialEq)]
pub struct ModuleSpec {
    /// The path of its file, as written.
    pub file: String,
    /// The module.
    pub code: &'static FlightCode,
}

/// Most ticks in a control period, and control periods in a latency.
pub const MOST_TICKS: f64 = 1000.0;

/// The number of ticks in a control period of `period` seconds, at some of which each sensor measures: sensors with
/// these periods, each a whole multiple of the control period or a whole fraction of it. One where no sensor is faster
/// than the loop; else the least common multiple of the fractions. `None` where that is more than [`MOST_TICKS`].
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

/// A phase of guidance.
#[derive(Clone, Debug, PartialEq)]
pub struct PhaseSpec {
    /// Its name.
    pub name: Name,
    /// Its control law; `None` for no torque.
    pub law: Option<&'static LawKind>,
    /// True if its law `mrp_feedback` has the term omega x H.
    pub gyroscopic: bool,
    /// The attitude that it wants; the quaternion of an attitude is a parameter.
    pub target: Target,
    /// The use of thrust.
    pub thrust: Maneuver,
    /// The use of torque rods.
    pub rods: RodUse,
    /// The condition that ends it.
    pub until: Option<Condition>,
    /// The next phase.
    pub next: Next,
    /// The phase that follows at once if the condition is not met.
    pub otherwise: Option<usize>,
    /// The keys of its table that are no parameters, as canonical text has them.
    pub written: Written,
}

impl LoopSpec {
    /// Ticks of sensors in a control period.
    pub fn ticks_per_period(&self) -> u64 {
        ticks_per_period(self.period, self.sensors.iter().map(|sensor| sensor.period)).unwrap_or(1)
    }

    /// The module that phases name as their law.
    pub fn code(&self) -> Option<&'static FlightCode> {
        self.module.as_ref().map(|module| module.code)
    }

    /// The quantities over time that the loop records.
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

    /// True if a phase leads to the launch of a net.
    pub fn launches(&self) -> bool {
        self.phases.iter().any(|phase| phase.next == Next::Launch)
    }

    /// True if a phase has a target.
    pub fn points(&self) -> bool {
        self.phases.iter().any(|phase| phase.target != Target::None)
    }

    /// The kind of the estimator.
    pub fn estimator_kind(&self) -> &'static EstimatorKind {
        &super::estimators::KINDS[self.estimator]
    }

    /// True if the estimator has filters.
    pub fn has_filter(&self) -> bool {
        self.estimator_kind().has_filter
    }

    /// True if an ideal sensor delivers the state.
    pub fn knows_the_truth(&self) -> bool {
        self.estimator_kind().knows_the_truth
    }

    /// True if a camera sees the debris.
    pub fn has_camera(&self) -> bool {
        self.sensors.iter().any(|sensor| matches!(sensor.observes(), Observes::DebrisAttitude(_)))
    }

    /// True if the launch axis is needed.
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
