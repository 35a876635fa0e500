//! [`FlightSoftware`]: estimator, guidance, law and allocation of one run. What it knows is the nominal scene as it is
//! believed ([`LoopSpec::believed`]), its own drawn numbers, what its sensors deliver, and what it has commanded: no
//! field of it and no argument of its tick is the truth.
//!
//! - `commands`: from a wanted torque and force to commands.
//! - [`under_way`]: commands until they act no more.
//! - `maneuver`: the impulse that is left of a maneuver, and the attitude that it wants.

mod commands;
mod maneuver;
pub mod under_way;

use std::sync::Arc;

use self::under_way::CommandsUnderWay;
use super::actuators::{PulseState, ThrusterDrive};
use super::allocation::rods::RodAllocation;
use super::allocation::thrust::ThrustAllocation;
use super::allocation::wheel_torque::WheelTorque;
use super::bus::{Commanded, Measurements};
use super::estimate::Estimate;
use super::failure::Failure;
use super::guidance::condition::GuidanceInput;
use super::guidance::phase::Phase;
use super::guidance::target::{AttitudeError, OrbitMotion};
use super::guidance::{Guidance, Progress};
use super::laws::callback::is_law_of;
use super::laws::rod_law::MeasuredField;
use super::net_launch::geometry::{Centers, LaunchGeometry, LaunchState};
use super::spec::LoopSpec;
use super::tick_times::TickTimes;
use crate::control::estimators::estimator::{Estimator, Filters, Update};
use crate::control::laws::AttitudeLaw;
use crate::control::laws::interface::KnownBody;
use crate::control::measurement::{Measurement, PointMotion, Reading, part};
use crate::control::observes::Observes;
use crate::control::vector::{dcm_from_quaternion, norm, product, scaled, sum};
use crate::dynamics::orbit_path::OrbitPath;
use crate::dynamics::orbit_state::OrbitState;
use crate::scene::{MAX_THRUSTERS, MAX_WHEELS, Scene};

/// The momentum of the wheels of `scene` relative to the body at the estimated rates, in F_s, N m s.
fn stored_momentum(scene: &Scene, estimate: &Estimate) -> [f64; 3] {
    let wheels = scene.mass.wheels.iter().zip(estimate.wheel_rates);
    wheels.fold([0.0; 3], |total, (wheel, rate)| sum(total, scaled(wheel.axial * rate, wheel.axis)))
}

/// The geometry of the launch from the state `launch` as estimated; `None` without debris.
fn geometry_of(launch: &LaunchState, estimate: &Estimate) -> Option<LaunchGeometry> {
    let debris = estimate.debris.as_ref()?;
    let centers =
        Centers { r_co_e: estimate.r_co_e, v_co_e: estimate.v_co_e, r_gdo_e: debris.r_gdo_e, v_gdo_e: debris.v_gdo_e };
    Some(launch.geometry(&centers))
}

/// The decision of guidance at a control tick.
#[derive(Clone, Copy, Debug)]
pub struct Guided {
    pub progress: Progress,
    /// True if a phase begins with this tick.
    pub begins: bool,
    /// The estimated attitude relative to the target.
    pub error: AttitudeError,
    /// The velocity that the maneuver still has to change, in F_e, m/s.
    pub velocity_to_go: [f64; 3],
}

/// Impulses commanded since the last tick.
#[derive(Clone, Copy, Debug)]
struct CommandedImpulse {
    /// N s, in F_s.
    force_s: [f64; 3],
    /// On the body, in F_s, N m s.
    torque_s: [f64; 3],
    /// N m s, by wheel.
    motors: [f64; MAX_WHEELS],
}

const NO_IMPULSE: CommandedImpulse =
    CommandedImpulse { force_s: [0.0; 3], torque_s: [0.0; 3], motors: [0.0; MAX_WHEELS] };

/// The flight software of one run.
pub struct FlightSoftware {
    pub(in crate::control) spec: Arc<LoopSpec>,
    pub(in crate::control) ticks: TickTimes,
    pub(in crate::control) believed: Scene,
    body: KnownBody,
    estimator: Box<dyn Estimator>,
    pub(in crate::control) estimate: Estimate,
    pub(in crate::control) phases: Vec<Phase>,
    /// The law of the phase, and those of all phases as they begin.
    law: AttitudeLaw,
    pub(in crate::control) laws: Vec<AttitudeLaw>,
    pub(in crate::control) guidance: Guidance,
    wheels: Option<WheelTorque>,
    thrusters: Option<ThrustAllocation>,
    rods: Option<RodAllocation>,
    /// The magnetic field as measured.
    field: MeasuredField,
    /// The last measurement of each sensor; empty if no law reads them.
    readings: Vec<Reading>,
    /// The projection onto the torques that the thrusters give in both directions.
    two_sided: [[f64; 3]; 3],
    thruster_drives: [ThrusterDrive; MAX_THRUSTERS],
    pulses: [PulseState; MAX_THRUSTERS],
    launch: LaunchState,
    /// The nominal orbit.
    orbit: Option<OrbitPath>,
    /// The geometry of the launch as estimated at the control tick; `None` without debris.
    geometry: Option<LaunchGeometry>,
    /// Time without the target after which it is lost, s; infinite where there is no limit.
    lost_target_timeout: f64,
    is_recorded: bool,
    /// From a command to its action, s.
    pub(in crate::control) delay: f64,
    pub(in crate::control) under_way: CommandsUnderWay,
    /// The commands of the last control tick, of a run that is recorded.
    latest: Commanded,
    commanded: CommandedImpulse,
    /// When the debris was last measured, s.
    debris_seen: f64,
    has_camera: bool,
    started: bool,
    last_update: f64,
}

/// The parts of flight software, as a loop is made.
pub struct Parts {
    /// The nominal scene as it is believed.
    pub believed: Scene,
    /// The estimator.
    pub estimator: Box<dyn Estimator>,
    pub phases: Vec<(Phase, AttitudeLaw)>,
    /// The launch state.
    pub launch: LaunchState,
    /// By thruster.
    pub thruster_drives: [ThrusterDrive; MAX_THRUSTERS],
    /// Time without the target after which it is lost, s.
    pub lost_target_timeout: f64,
    /// From a command to its action, s.
    pub delay: f64,
    /// The nominal state at the start.
    pub start: Estimate,
    /// True if the run is recorded ([`FlightSoftware::latest_commands`]).
    pub is_recorded: bool,
}

impl FlightSoftware {
    /// Flight software of the loop `spec`.
    pub fn new(spec: &Arc<LoopSpec>, parts: Parts) -> Self {
        let Parts { believed, estimator, phases, launch, start, .. } = parts;
        let (phases, laws): (Vec<Phase>, Vec<AttitudeLaw>) = phases.into_iter().unzip();
        let wheels = (!spec.wheels.is_empty()).then(|| WheelTorque::of_loop(&believed, &spec.wheels));
        let by_wheels = wheels.map_or([[0.0; 3]; 3], |wheels| wheels.reachable);
        let thrusters =
            (!spec.thrusters.is_empty()).then(|| ThrustAllocation::of_loop(&believed, &spec.thrusters, by_wheels));
        FlightSoftware {
            body: KnownBody::of(&believed.mass),
            estimator,
            estimate: start,
            guidance: Guidance::new(&phases),
            law: laws[0].clone(),
            laws,
            phases,
            wheels,
            two_sided: thrusters.as_ref().map_or([[0.0; 3]; 3], |all| all.two_sided_torques(spec.holds_force)),
            thrusters,
            rods: (!spec.rods.is_empty()).then(|| RodAllocation::of_loop(&believed, &spec.rods)),
            field: MeasuredField::NONE,
            readings: if is_law_of(spec) || spec.code().is_some_and(|code| !code.sensors().is_empty()) {
                vec![Reading::NONE; spec.sensors.len()]
            } else {
                Vec::new()
            },
            thruster_drives: parts.thruster_drives,
            pulses: [PulseState::default(); MAX_THRUSTERS],
            launch,
            orbit: believed.orbit.as_ref().map(OrbitPath::new),
            geometry: None,
            lost_target_timeout: parts.lost_target_timeout,
            is_recorded: parts.is_recorded,
            delay: parts.delay,
            under_way: CommandsUnderWay::new(parts.delay, spec.period, !spec.rods.is_empty()),
            latest: Commanded::NOTHING,
            commanded: NO_IMPULSE,
            debris_seen: 0.0,
            has_camera: spec.has_camera(),
            started: false,
            last_update: 0.0,
            believed,
            ticks: TickTimes::new(spec.period, spec.ticks_per_period()),
            spec: spec.clone(),
        }
    }

    /// A tick: the estimate from what is measured and from what was commanded.
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

    /// Notes the magnetic field, where it was measured.
    fn note_field(&mut self, measurements: &Measurements<'_>) {
        for measurement in measurements.delivered {
            if matches!(self.spec.sensors[measurement.sensor].observes(), Observes::Field(_)) {
                self.field.take(measurements.time - measurement.age, part(&measurement.values, 0));
            }
        }
    }

    /// Notes when the debris was seen: where there is a camera, it has to see it; elsewhere the radar.
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

    /// Decides at a control tick how the mission goes on, and begins a phase where one follows; `failure`: what ends it
    /// whatever the phase.
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
        // a phase begins with the run, or where guidance has changed it
        let begins = !std::mem::replace(&mut self.started, true) || std::mem::take(&mut self.guidance.has_changed);
        if begins {
            self.law = self.laws[self.guidance.phase].clone();
            (error, velocity_to_go) = self.wanted(self.geometry.as_ref(), time);
        }
        if self.is_recorded {
            // nothing is commanded where the mission ends
            self.latest = Commanded::NOTHING;
        }
        Guided { progress, begins, error, velocity_to_go }
    }

    /// The failure that flight software detects at a control tick; before [`FlightSoftware::guide`].
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

    /// The quantities of conditions, with this attitude relative to the target and this velocity to go.
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

    /// The orbit as flight software knows it: that of the nominal scene at `time`, s; with perfect knowledge the true
    /// one. `None` without an orbit.
    pub(in crate::control) fn orbit_motion(&self, time: f64) -> Option<OrbitMotion> {
        let (orbit, nominal) = self.orbit.as_ref().zip(self.believed.orbit.as_ref())?;
        if self.spec.knows_the_truth() {
            return Some(OrbitMotion::of(nominal, time, self.estimate.r_co_e, self.estimate.v_co_e));
        }
        let OrbitState { position, velocity, .. } = orbit.state(time);
        Some(OrbitMotion::of(nominal, time, position, velocity))
    }

    /// The estimate of this tick.
    pub fn estimate(&self) -> &Estimate {
        &self.estimate
    }

    /// The state of guidance.
    pub fn guidance(&self) -> &Guidance {
        &self.guidance
    }

    /// The phase that the run is in.
    pub fn phase(&self) -> &Phase {
        &self.phases[self.guidance.phase]
    }

    /// The magnetic field as measured last, F_s, T.
    pub fn field_s(&self) -> [f64; 3] {
        self.field.field_s
    }

    /// The commands of the last control tick, of a run that is recorded.
    pub fn latest_commands(&self) -> Commanded {
        self.latest
    }

    /// Telemetry of the law of the phase at its last tick.
    pub fn telemetry(&self) -> &[f64] {
        self.law.telemetry()
    }

    /// The confidence of the filters.
    pub fn filters(&self) -> Filters {
        self.estimator.filters()
    }
}
