//! [`FlightSoftware`]: estimator, guidance, law and allocation of one run. It knows the believed nominal scene
//! ([`LoopSpec::believed`]), its own drawn numbers, measurements and its own commands; neither fields nor arguments
//! hold the truth.

mod commands;
mod construction;
mod maneuver;
pub mod under_way;

use std::sync::Arc;

use self::under_way::CommandsUnderWay;
use super::actuators::{PulseState, ThrustMode};
use super::allocation::rods::RodAllocation;
use super::allocation::thrust::ThrustAllocation;
use super::allocation::wheel_torque::WheelTorque;
use super::bus::{Commanded, Measurements};
use super::estimate::Estimate;
use super::estimators::estimator::{Estimator, Update};
use super::failure::Failure;
use super::guidance::condition::GuidanceInput;
use super::guidance::phase::Phase;
use super::guidance::target::{AttitudeError, OrbitMotion};
use super::guidance::{Guidance, Progress};
use super::laws::AttitudeLaw;
use super::laws::interface::KnownBody;
use super::laws::rod_law::MeasuredField;
use super::measurement::{Measurement, PointMotion, Reading, part};
use super::net_launch::geometry::{Centers, LaunchGeometry, LaunchState};
use super::observes::Observes;
use super::spec::LoopSpec;
use super::tick_times::TickTimes;
use super::vector::{dcm_from_quaternion, norm, product, scaled, sum};
use crate::dynamics::orbit_path::OrbitPath;
use crate::dynamics::orbit_state::OrbitState;
use crate::scene::{MAX_THRUSTERS, MAX_WHEELS, Scene};

/// Momentum of the wheels relative to the body at the estimated rates, in F_s.
fn stored_momentum(scene: &Scene, estimate: &Estimate) -> [f64; 3] {
    let wheels = scene.mass.wheels.iter().zip(estimate.wheel_rates);
    wheels.fold([0.0; 3], |total, (wheel, rate)| sum(total, scaled(wheel.axial * rate, wheel.axis)))
}

/// The estimated launch geometry; `None` without debris.
fn geometry_of(launch: &LaunchState, estimate: &Estimate) -> Option<LaunchGeometry> {
    let debris = estimate.debris.as_ref()?;
    let centers =
        Centers { r_co_e: estimate.r_co_e, v_co_e: estimate.v_co_e, r_gdo_e: debris.r_gdo_e, v_gdo_e: debris.v_gdo_e };
    Some(launch.geometry(&centers))
}

/// Decision of guidance at a control tick.
#[derive(Clone, Copy, Debug)]
pub struct Guided {
    pub progress: Progress,
    /// True if a phase begins with this tick.
    pub begins: bool,
    /// Estimated attitude relative to the target.
    pub error: AttitudeError,
    /// Remaining velocity change of the maneuver, in F_e.
    pub velocity_to_go: [f64; 3],
}

/// Impulses commanded since the last tick.
#[derive(Clone, Copy, Debug)]
struct CommandedImpulse {
    force_s: [f64; 3],
    /// On the body.
    torque_s: [f64; 3],
    /// By wheel.
    motors: [f64; MAX_WHEELS],
}

const NO_IMPULSE: CommandedImpulse =
    CommandedImpulse { force_s: [0.0; 3], torque_s: [0.0; 3], motors: [0.0; MAX_WHEELS] };

pub struct FlightSoftware {
    pub spec: Arc<LoopSpec>,
    pub ticks: TickTimes,
    pub believed: Scene,
    body: KnownBody,
    pub estimator: Box<dyn Estimator>,
    pub estimate: Estimate,
    pub phases: Vec<Phase>,
    /// The phase's law, and those of all phases in their initial states.
    pub law: AttitudeLaw,
    pub laws: Vec<AttitudeLaw>,
    pub guidance: Guidance,
    wheels: Option<WheelTorque>,
    thrusters: Option<ThrustAllocation>,
    rods: Option<RodAllocation>,
    pub field: MeasuredField,
    /// Last measurement of each sensor; empty if no law reads them.
    readings: Vec<Reading>,
    /// Projection onto the torques that thrusters give in both directions.
    two_sided: [[f64; 3]; 3],
    thrust_mode: ThrustMode,
    pulses: [PulseState; MAX_THRUSTERS],
    launch: LaunchState,
    orbit: Option<OrbitPath>,
    /// Estimated launch geometry at the control tick; `None` without debris.
    geometry: Option<LaunchGeometry>,
    /// Time without the debris in sight after which it is lost; may be infinite.
    lost_target_timeout: f64,
    is_recorded: bool,
    pub delay: f64,
    pub under_way: CommandsUnderWay,
    /// Commands of the last control tick in a recorded run.
    pub latest: Commanded,
    commanded: CommandedImpulse,
    /// Time of the last measurement of the debris.
    debris_seen: f64,
    has_camera: bool,
    started: bool,
    last_update: f64,
}

impl FlightSoftware {
    /// Updates the estimate by the measurements of a tick and the commands since the last.
    pub fn tick(&mut self, measurements: &Measurements<'_>) {
        self.note_debris(measurements);
        self.note_field(measurements);
        if !self.readings.is_empty() {
            for Measurement { sensor, values, age } in measurements.delivered {
                self.readings[*sensor] = Reading { values: *values, time: measurements.time - age };
            }
        }
        let interval = measurements.time - self.last_update;
        let mean = |impulse: [f64; 3]| if interval > 0.0 { scaled(1.0 / interval, impulse) } else { [0.0; 3] };
        let motor_torques = self.commanded.motors.map(|impulse| if interval > 0.0 { impulse / interval } else { 0.0 });
        let update = Update {
            interval,
            measurements: measurements.delivered,
            acceleration_s: scaled(1.0 / self.believed.mass.total, mean(self.commanded.force_s)),
            torque_s: mean(self.commanded.torque_s),
            motor_torques,
            state: measurements.state,
        };
        self.estimator.update(&update, &mut self.estimate);
        self.last_update = measurements.time;
        if measurements.state.is_none() {
            self.commanded = NO_IMPULSE;
        }
    }

    fn note_field(&mut self, measurements: &Measurements<'_>) {
        for measurement in measurements.delivered {
            if matches!(self.spec.sensors[measurement.sensor].observes(), Observes::Field(_)) {
                self.field.take(measurements.time - measurement.age, part(&measurement.values, 0));
            }
        }
    }

    /// Notes when the debris was seen: by the camera if there is one, else by the radar.
    fn note_debris(&mut self, measurements: &Measurements<'_>) {
        if measurements.state.is_some() {
            self.debris_seen = measurements.time;
        }
        for measurement in measurements.delivered {
            let sees = match self.spec.sensors[measurement.sensor].observes() {
                Observes::DebrisAttitude(_) => true,
                Observes::Motion(_) => !self.has_camera && PointMotion::of(&measurement.values, 6).is_some(),
                _ => false,
            };
            if sees {
                self.debris_seen = measurements.time - measurement.age;
            }
        }
    }

    /// Advances guidance at a control tick; `failure` ends the mission in whatever phase.
    pub fn guide(&mut self, time: f64, failure: Option<Failure>) -> Guided {
        let (mut error, mut velocity_to_go) = self.wanted(self.geometry.as_ref(), time);
        let progress = match failure {
            Some(failure) => Progress::Fails(failure),
            None => {
                let asks = self.phase().until.is_some();
                let input = asks.then(|| self.guidance_input(time, error, velocity_to_go));
                self.guidance.decide(&self.phases, time, input.as_ref(), &self.ticks)
            }
        };
        // a phase begins with the run or by a change of guidance
        let begins = !std::mem::replace(&mut self.started, true) || std::mem::take(&mut self.guidance.has_changed);
        if begins {
            self.law = self.laws[self.guidance.phase].clone();
            (error, velocity_to_go) = self.wanted(self.geometry.as_ref(), time);
        }
        if self.is_recorded {
            // no commands at the end of the mission
            self.latest = Commanded::NOTHING;
        }
        Guided { progress, begins, error, velocity_to_go }
    }

    /// The failure that flight software detects at a control tick; call before [`FlightSoftware::guide`].
    pub fn failure(&mut self, time: f64) -> Option<Failure> {
        if self.spec.has_debris {
            self.geometry = geometry_of(&self.launch, &self.estimate);
        }
        if !self.estimate.is_finite() {
            return Some(Failure::Diverged);
        }
        if self.spec.needs_axis() && !self.geometry.is_some_and(|geometry| geometry.has_axis()) {
            return Some(Failure::NoAxis);
        }
        let is_lost = time - self.debris_seen > self.lost_target_timeout + self.ticks.same();
        (self.spec.has_debris && is_lost).then_some(Failure::LostTarget)
    }

    /// Quantities of conditions.
    fn guidance_input(&self, time: f64, error: AttitudeError, velocity_to_go: [f64; 3]) -> GuidanceInput {
        let (estimate, ticks) = (&self.estimate, &self.ticks);
        let rates = &estimate.wheel_rates[..self.believed.mass.wheels.len()];
        GuidanceInput {
            time: ticks.exact(time),
            time_in_phase: ticks.exact(time - self.guidance.since),
            body_rate: norm(estimate.omega_se_s),
            error,
            wheel_speed: rates.iter().fold(0.0, |most, rate| most.max(rate.abs())),
            wheel_momentum: norm(stored_momentum(&self.believed, estimate)),
            geometry: self.geometry,
            velocity_to_go,
            s3_e: product(dcm_from_quaternion(estimate.q_es), [0.0, 0.0, 1.0]),
            time_to_station: ticks.exact(self.guidance.arrival - time),
            debris_age: if self.spec.has_debris { ticks.exact(time - self.debris_seen) } else { f64::NAN },
            debris_rate: estimate.debris.map_or(f64::NAN, |debris| norm(debris.omega_de_d)),
        }
    }

    /// The orbit as flight software knows it: nominal, or with perfect knowledge the true one.
    pub fn orbit_motion(&self, time: f64) -> Option<OrbitMotion> {
        let (orbit, nominal) = self.orbit.as_ref().zip(self.believed.orbit.as_ref())?;
        if self.spec.knows_the_truth() {
            return Some(OrbitMotion::of(nominal, time, self.estimate.r_co_e, self.estimate.v_co_e));
        }
        let OrbitState { position, velocity, .. } = orbit.state(time);
        Some(OrbitMotion::of(nominal, time, position, velocity))
    }

    pub fn phase(&self) -> &Phase {
        &self.phases[self.guidance.phase]
    }
}
