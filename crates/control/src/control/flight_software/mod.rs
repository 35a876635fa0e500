//! [`FlightSoftware`]: estimator, guidance, law and allocation of one run. It knows the believed nominal scene
//! ([`LoopSpec::believed`]), its own drawn numbers, measurements and its own commands; neither fields nor arguments
//! hold the truth.

mod commands;
mod maneuver;

use std::sync::Arc;

use super::actuators::{DelayQueue, PulseState, ThrustMode, modulation};
use super::allocation::rods::{NO_DIPOLES, RodAllocation, RodCommand};
use super::allocation::{ThrustAllocation, WheelTorque};
use super::bus::{Commanded, Measurements, MotorCommand, Pulses};
use super::estimators::estimator::{Estimator, Update};
use super::estimators::{EstimatorContext, KINDS as ESTIMATORS, KnownSensor};
use super::guidance::phase::Phase;
use super::guidance::target::OrbitMotion;
use super::guidance::{Guidance, Progress};
use super::laws::momentum_unloading::UnloadingNumbers;
use super::laws::rod_law::MeasuredField;
use super::laws::{AttitudeLaw, KnownBody, LawSettings};
use super::parameters::{AttitudeNumbers, ConditionNumbers, LoopNumbers, PhaseNumbers};
use super::tick_times::TickTimes;
use crate::dynamics::orbit_path::OrbitPath;
use crate::dynamics::orbit_state::OrbitState;
use crate::loops::attitude_law::{Constant, stored_momentum};
use crate::loops::condition::GuidanceInput;
use crate::loops::context::LawContext;
use crate::loops::declared::limit;
use crate::loops::estimate::Estimate;
use crate::loops::failure::Failure;
use crate::loops::launch_geometry::{LaunchGeometry, LaunchState};
use crate::loops::launch_numbers::TransferNumbers;
use crate::loops::measurement::{Measurement, PointMotion, Reading, part};
use crate::loops::observes::Observes;
use crate::loops::sensor_spec::SensorSpec;
use crate::loops::spec::{LoopSpec, PhaseSpec};
use crate::loops::target::{AttitudeError, Target};
use crate::loops::vector::{dcm_from_quaternion, norm, product, scaled};
use crate::scene::{DeclaredTable, MAX_THRUSTERS, MAX_WHEELS, Scene};

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
#[derive(Default)]
struct CommandedImpulse {
    force_s: [f64; 3],
    /// On the body.
    torque_s: [f64; 3],
    /// By wheel.
    motors: [f64; MAX_WHEELS],
}

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
    is_recorded: bool,
    pub delay: f64,
    /// Commands from their tick until they cease to act; empty without such actuators.
    motors_under_way: DelayQueue<MotorCommand>,
    thrust_under_way: DelayQueue<Pulses>,
    rods_under_way: DelayQueue<RodCommand>,
    /// Commands of the last control tick in a recorded run.
    pub latest: Commanded,
    commanded: CommandedImpulse,
    /// Time of the last measurement of the debris.
    debris_seen: f64,
    started: bool,
    last_update: f64,
}

fn phase((phase, table): (&PhaseSpec, &DeclaredTable)) -> Phase {
    Phase {
        until: phase.until.clone(),
        next: phase.next,
        otherwise: phase.otherwise,
        hold: ConditionNumbers::of(table).hold,
        timeout: limit(PhaseNumbers::of(table).timeout),
        target: match phase.target {
            Target::Attitude(_) => Target::Attitude(AttitudeNumbers::of(table).attitude),
            Target::Orbital(_) => Target::Orbital(AttitudeNumbers::of(table).attitude),
            target => target,
        },
        thrust: phase.thrust,
        transfer_time: TransferNumbers::of(table).time,
        rods: phase.rods.with(table),
        unloading: Some(UnloadingNumbers::of(table)).filter(|numbers| numbers.time > 0.0),
    }
}

impl FlightSoftware {
    /// Flight software of the run of `context`, on a loop with ticks of `tick` seconds.
    pub fn new(spec: &Arc<LoopSpec>, context: &LawContext<'_>, tick: f64) -> Self {
        let numbers = &context.parameters.law;
        let believed = spec.believed(context.nominal);
        let known = |(sensor, parameters): (&SensorSpec, _)| KnownSensor {
            observes: sensor.kind.observes,
            period: sensor.period,
            latency: sensor.latency,
            parameters,
        };
        let sensors: Vec<_> = spec.sensors.iter().zip(&context.nominal_parameters.sensors).map(known).collect();
        let parameters = &context.nominal_parameters.law;
        let of_run = EstimatorContext { nominal: &believed, parameters, sensors: &sensors, tick };
        let (estimator, estimate) = ((ESTIMATORS[spec.estimator_maker].make)(&of_run), of_run.start());
        let (period, delay) = (spec.period, LoopNumbers::of(numbers).delay);
        let tables = || spec.phases.iter().zip(&context.parameters.guidance);
        let law = |(phase, table): (&PhaseSpec, _)| {
            let settings = LawSettings { table, gyroscopic: phase.gyroscopic, period, delay, sample: context.sample };
            phase.law.as_ref().map_or_else(|| AttitudeLaw::new(Constant([0.0; 3])), |law| law.make(&settings))
        };
        let (laws, phases): (Vec<_>, Vec<_>) = (tables().map(law).collect(), tables().map(phase).collect());
        let wheels = (!spec.wheels.is_empty()).then(|| WheelTorque::of_loop(&believed, &spec.wheels));
        let by_wheels = wheels.map_or([[0.0; 3]; 3], |wheels| wheels.reachable);
        let thrusters =
            (!spec.thrusters.is_empty()).then(|| ThrustAllocation::of_loop(&believed, &spec.thrusters, by_wheels));
        let reads_sensors = spec.laws().any(|law| law.reads_sensors);
        FlightSoftware {
            body: KnownBody::of(&believed.mass),
            estimator,
            estimate,
            guidance: Guidance::new(&phases),
            law: AttitudeLaw::clone(&laws[0]),
            laws,
            phases,
            wheels,
            two_sided: thrusters.as_ref().map_or([[0.0; 3]; 3], |all| all.two_sided_torques(spec.holds_force)),
            thrusters,
            rods: (!spec.rods.is_empty()).then(|| RodAllocation::of_loop(&believed, &spec.rods)),
            field: MeasuredField::NONE,
            readings: if reads_sensors { vec![Reading::NONE; spec.sensors.len()] } else { Vec::new() },
            thrust_mode: modulation::mode(spec.modulation, numbers),
            pulses: [PulseState::default(); MAX_THRUSTERS],
            launch: LaunchState::of(numbers, believed.orbit.as_ref()),
            orbit: believed.orbit.as_ref().map(OrbitPath::new),
            geometry: None,
            is_recorded: context.records,
            delay,
            motors_under_way: DelayQueue::new([0.0; MAX_WHEELS], delay, period),
            thrust_under_way: DelayQueue::new(Pulses::default(), delay, period),
            rods_under_way: DelayQueue::new(NO_DIPOLES, delay, period),
            latest: Commanded::default(),
            commanded: CommandedImpulse::default(),
            debris_seen: 0.0,
            started: false,
            last_update: 0.0,
            believed,
            ticks: TickTimes::new(period, spec.ticks_per_period()),
            spec: spec.clone(),
        }
    }

    /// Updates the estimate by the measurements of a tick and the commands since the last.
    pub fn tick(&mut self, measurements: &Measurements<'_>) {
        self.note(measurements);
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
            self.commanded = CommandedImpulse::default();
        }
    }

    /// Notes the field, the readings of laws, and when the debris was seen: by the camera if there is one, else by the
    /// radar.
    fn note(&mut self, measurements: &Measurements<'_>) {
        if measurements.state.is_some() {
            self.debris_seen = measurements.time;
        }
        for Measurement { sensor, values, age } in measurements.delivered {
            let time = measurements.time - age;
            match self.spec.sensors[*sensor].kind.observes {
                Observes::Field(_) => self.field.take(time, part(values, 0)),
                Observes::DebrisAttitude(_) => self.debris_seen = time,
                Observes::Motion(_) if !self.spec.has_camera() && PointMotion::of(values, 6).is_some() => {
                    self.debris_seen = time;
                }
                _ => {}
            }
            if let Some(reading) = self.readings.get_mut(*sensor) {
                *reading = Reading { values: *values, time };
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
            self.latest = Commanded::default();
        }
        Guided { progress, begins, error, velocity_to_go }
    }

    /// The failure that flight software detects at a control tick; call before [`FlightSoftware::guide`].
    pub fn failure(&mut self, time: f64) -> Option<Failure> {
        if self.spec.has_debris {
            self.geometry = self.estimate.centers().map(|centers| self.launch.geometry(centers));
        }
        if !self.estimate.is_finite() {
            return Some(Failure::Diverged);
        }
        if self.spec.needs_axis() && !self.geometry.is_some_and(|geometry| geometry.has_axis()) {
            return Some(Failure::NoAxis);
        }
        let is_lost = time - self.debris_seen > limit(self.launch.numbers.lost_target_timeout) + self.ticks.same();
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
            wheel_momentum: norm(stored_momentum(&self.believed.mass, &estimate.wheel_rates)),
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
        let place = if self.spec.knows_the_truth() {
            [self.estimate.r_co_e, self.estimate.v_co_e]
        } else {
            let OrbitState { position, velocity, .. } = orbit.state(time);
            [position, velocity]
        };
        Some(OrbitMotion::of(nominal, self.phase().target, time, place))
    }

    pub fn phase(&self) -> &Phase {
        &self.phases[self.guidance.phase]
    }
}
