//! [`ControlLoop`]: sensors, estimator, guidance, law, allocation and actuators of one run, tick by tick.
//!
//! At a tick the sensors that are due measure the true state, the estimator updates, guidance may change the phase, the law wants a torque and the
//! maneuver a force, and allocation makes commands of them. A command acts `delay_s` later, until the next one (zero-order hold), or as pulses; what the
//! actuators make of it is held over an arc, with friction and limits by the state at its start.
//!
//! Flight software knows the nominal scene as it is believed ([`LoopSpec::believed`]) and its own drawn numbers; the truth reaches it through sensors.

use std::sync::Arc;

use super::actuators::wheel_drive::relative_inertia;
use super::actuators::{DelayQueue, PulseState, ThrusterDrive, WheelDrive, modulation};
use super::allocation::thrust::ThrustAllocation;
use super::allocation::wheel_torque::WheelTorque;
use super::context::LawContext;
use super::estimate::{Estimate, EstimateErrors};
use super::estimators::{Consistency, Estimator, EstimatorContext, KnownSensor, Update};
use super::guidance::geometry::{Centers, LaunchGeometry, LaunchState, transfer};
use super::guidance::phase::{Maneuver, Phase};
use super::guidance::situation::{Situation, s3_of};
use super::guidance::target::{AttitudeError, Target, VelocityToGo};
use super::guidance::{Failure, Guidance, Progress};
use super::laws::{AttitudeLaw, KnownBody, LawInput, MomentumUnloading};
use super::measurement::Measurement;
use super::outcome::{ArcApplied, Judgement, MissionOutcome, OutcomeColumns, centers_of};
use super::recorder::{Recorder, Tick};
use super::sensors::{Instrument, SensorContext};
use super::small_matrix::inverse;
use super::spec::LoopSpec;
use super::truth::{DebrisMotion, Truth};
use crate::control::vector::{dcm_from_quaternion, difference, dot, norm, product, scaled, sum};
use crate::dynamics::actuation::{Actuation, ActuationLaw, BodyState, WheelState};
use crate::run::Telemetry;
use crate::scene::{DeclaredTable, MAX_THRUSTERS, MAX_WHEELS, Scene, WheelMode};

/// What the motors are commanded, N m, by wheel.
type MotorCommand = [f64; MAX_WHEELS];

/// What the thrusters are commanded.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Pulses {
    /// When they begin, s.
    begin: f64,
    /// Thrusts while they last, N, by thruster.
    thrust: [f64; MAX_THRUSTERS],
    /// How long each lasts, s.
    on_time: [f64; MAX_THRUSTERS],
}

/// No thruster fires.
const NO_PULSES: Pulses = Pulses { begin: 0.0, thrust: [0.0; MAX_THRUSTERS], on_time: [0.0; MAX_THRUSTERS] };

/// Times that differ by less than this share of a period are one: rounding of the products that they are.
const SAME_TIME: f64 = 1e-9;

/// The loop of one run.
pub struct ControlLoop {
    spec: Arc<LoopSpec>,
    columns: Arc<OutcomeColumns>,
    // the truth
    drawn: Scene,
    debris: Option<DebrisMotion>,
    instruments: Vec<Instrument>,
    wheel_drives: [WheelDrive; MAX_WHEELS],
    // flight software
    believed: Scene,
    known: KnownBody,
    estimator: Box<dyn Estimator>,
    phases: Vec<Phase>,
    /// The law of the phase, and those of all phases as they begin.
    law: AttitudeLaw,
    laws: Vec<AttitudeLaw>,
    guidance: Guidance,
    wheels: Option<WheelTorque>,
    thrusters: Option<ThrustAllocation>,
    /// The projection onto the torques that the thrusters give in both directions.
    two_sided: [[f64; 3]; 3],
    thruster_drives: [ThrusterDrive; MAX_THRUSTERS],
    pulses: [PulseState; MAX_THRUSTERS],
    is_on_off: bool,
    launch: LaunchState,
    /// Limits of time at the limit of speed and without the target, s; infinite where there is none.
    timeouts: [f64; 2],
    delay: f64,
    duration: f64,
    // time
    tick: u64,
    /// Ticks of sensors in a control period, and in a second.
    ticks_per_period: u64,
    tick_period: f64,
    next_tick: f64,
    // memory
    measurements: Vec<(usize, Measurement)>,
    motor_commands: DelayQueue<MotorCommand>,
    /// Nothing is pushed in a loop without thrusters.
    thrust_commands: DelayQueue<Pulses>,
    /// What was commanded at the last control tick: motor torques, N m, and mean thrusts, N; where this run is recorded.
    latest: (MotorCommand, [f64; MAX_THRUSTERS]),
    /// Impulses of force and torque commanded since the last tick, in F_s, N s and N m s.
    commanded: [[f64; 3]; 2],
    /// The same of the motors, N m s.
    commanded_motors: [f64; MAX_WHEELS],
    /// When the debris was last measured, s.
    debris_seen: f64,
    has_camera: bool,
    saturated_since: f64,
    last_update: f64,
    // what comes of it
    judgement: Judgement,
    outcome: MissionOutcome,
    recorder: Option<Recorder>,
    has_ended: bool,
}

/// The number called `key` of `table`; `otherwise` where it has none.
fn number_or(table: &DeclaredTable, key: &str, otherwise: f64) -> f64 {
    table.named(key).map_or(otherwise, |numbers| numbers[0])
}

/// The same, where zero stands for no limit.
fn limit(table: &DeclaredTable, key: &str) -> f64 {
    let number = number_or(table, key, 0.0);
    if number > 0.0 { number } else { f64::INFINITY }
}

/// The motors and bearings of the wheels of `scene`.
fn wheel_drives(scene: &Scene) -> [WheelDrive; MAX_WHEELS] {
    let inverse = inverse(scene.mass.inertia_rotating());
    std::array::from_fn(|i| {
        let Some(wheel) = scene.mass.wheels.get(i) else { return WheelDrive::ideal(1.0) };
        let model = &scene.actuators.wheels[i];
        WheelDrive {
            inertia: relative_inertia(wheel.axial, wheel.axis, inverse),
            torque_limit: model.torque_limit,
            speed_limit: model.speed_limit,
            coulomb: model.coulomb_friction,
            viscous: model.viscous_friction,
            torque_scale: model.torque_scale,
            torque_bias: model.torque_bias,
        }
    })
}

/// The momentum of the wheels of `scene` relative to the body at the estimated rates, in F_s, N m s.
fn stored_momentum(scene: &Scene, estimate: &Estimate) -> [f64; 3] {
    let wheels = scene.mass.wheels.iter().zip(estimate.wheel_rates);
    wheels.fold([0.0; 3], |total, (wheel, rate)| sum(total, scaled(wheel.axial * rate, wheel.axis)))
}

/// The launch state of the numbers of `[control]`.
fn launch_state(table: &DeclaredTable) -> LaunchState {
    let axis = match table.named("approach_axis") {
        Some(&[x, y, z]) => [x, y, z],
        _ => [0.0; 3],
    };
    let length = norm(axis);
    LaunchState {
        distance: number_or(table, "launch_distance_m", 0.0),
        least_speed: number_or(table, "least_debris_speed_m_s", 0.0),
        approach_axis: if length > 0.0 { scaled(1.0 / length, axis) } else { axis },
    }
}

/// The phases of `spec` with the numbers of `tables`.
fn phases(spec: &LoopSpec, tables: &[DeclaredTable]) -> Vec<Phase> {
    let phase = |(phase, table): (&super::spec::PhaseSpec, &DeclaredTable)| Phase {
        until: phase.until.clone(),
        next: phase.next,
        otherwise: phase.otherwise,
        hold: number_or(table, "hold_s", 0.0),
        timeout: limit(table, "timeout_s"),
        target: match (phase.target, table.named("attitude")) {
            (Target::Attitude(_), Some(&[w, x, y, z])) => Target::Attitude([w, x, y, z]),
            (target, _) => target,
        },
        thrust: phase.thrust,
        transfer_time: number_or(table, "transfer_time_s", 0.0),
        unloading: Some(MomentumUnloading {
            dead_band: number_or(table, "unloading_dead_band_n_m_s", 0.0),
            time_constant: number_or(table, "unloading_time_s", 0.0),
        })
        .filter(|unloading| unloading.time_constant > 0.0),
    };
    spec.phases.iter().zip(tables).map(phase).collect()
}

impl ControlLoop {
    /// The loop of the run of `context`, which reports `columns`.
    pub fn new(spec: &Arc<LoopSpec>, columns: &Arc<OutcomeColumns>, context: &LawContext<'_>) -> Self {
        let (drawn, numbers) = (context.drawn.clone(), &context.parameters.law);
        let believed = spec.believed(context.nominal);
        let fastest = spec.sensors.iter().map(|sensor| sensor.period).fold(spec.period, f64::min);
        let ticks_per_period = (spec.period / fastest).round() as u64;
        let tick_period = spec.period / ticks_per_period as f64;
        let instrument = |(sensor, parameters): (&super::spec::SensorSpec, &DeclaredTable)| {
            let of_run = SensorContext {
                parameters,
                drawn: &drawn,
                period: sensor.period,
                sample: context.sample,
                seed: context.seed,
            };
            let ticks = |time: f64| (time / tick_period).round() as u64;
            let made = (super::sensors::KINDS[sensor.kind].make)(&of_run);
            Instrument::new(made, ticks(sensor.period).max(1), ticks(sensor.latency), tick_period)
        };
        let instruments = spec.sensors.iter().zip(&context.parameters.sensors).map(instrument).collect();
        let tables = spec.sensors.iter().zip(&context.nominal_parameters.sensors);
        let known = |(sensor, parameters): (&super::spec::SensorSpec, _)| KnownSensor {
            kind: super::sensors::KINDS[sensor.kind].name,
            period: sensor.period,
            latency: sensor.latency,
            parameters,
        };
        let sensors: Vec<KnownSensor<'_>> = tables.map(known).collect();
        let estimator = (super::estimators::KINDS[spec.estimator].make)(&EstimatorContext {
            nominal: &believed,
            parameters: &context.nominal_parameters.law,
            sensors: &sensors,
            tick: tick_period,
        });
        let phases = phases(spec, &context.parameters.guidance);
        let law = |(phase, table): (&super::spec::PhaseSpec, &DeclaredTable)| {
            phase.law.map_or(AttitudeLaw::None, |law| (super::laws::KINDS[law].make)(table))
        };
        let laws: Vec<AttitudeLaw> = spec.phases.iter().zip(&context.parameters.guidance).map(law).collect();
        let launch = launch_state(numbers);
        let thrusters = (!spec.thrusters.is_empty()).then(|| ThrustAllocation::of_loop(&believed, &spec.thrusters));
        let delay = number_or(numbers, "delay_s", 0.0);
        ControlLoop {
            debris: DebrisMotion::of(&drawn),
            instruments,
            wheel_drives: wheel_drives(&drawn),
            known: KnownBody::of(&believed.mass),
            estimator,
            guidance: Guidance::new(&phases),
            law: laws[0],
            laws,
            phases,
            wheels: (!spec.wheels.is_empty()).then(|| {
                let axes: Vec<[f64; 3]> = spec.wheels.iter().map(|place| believed.mass.wheels[*place].axis).collect();
                WheelTorque::new(&axes)
            }),
            two_sided: thrusters.as_ref().map_or([[0.0; 3]; 3], ThrustAllocation::two_sided_torques),
            thrusters,
            thruster_drives: believed.actuators.thrusters.map(|model| ThrusterDrive {
                mode: modulation::mode(spec.modulation, numbers),
                most: model.max_thrust,
                least_on: model.min_on_time,
            }),
            pulses: [PulseState::default(); MAX_THRUSTERS],
            is_on_off: modulation::is_on_off(spec.modulation),
            timeouts: [limit(numbers, "saturation_timeout_s"), limit(numbers, "lost_target_timeout_s")],
            delay,
            duration: context.duration,
            tick: 0,
            ticks_per_period,
            tick_period,
            next_tick: 0.0,
            measurements: Vec::with_capacity(spec.sensors.len()),
            motor_commands: DelayQueue::new([0.0; MAX_WHEELS], delay, spec.period),
            thrust_commands: DelayQueue::new(NO_PULSES, delay, spec.period),
            latest: ([0.0; MAX_WHEELS], [0.0; MAX_THRUSTERS]),
            commanded: [[0.0; 3]; 2],
            commanded_motors: [0.0; MAX_WHEELS],
            debris_seen: 0.0,
            has_camera: spec.has_camera(),
            saturated_since: f64::NAN,
            last_update: 0.0,
            judgement: Judgement {
                launch,
                keep_out: number_or(numbers, "keep_out_m", 0.0),
                plume: [number_or(numbers, "plume_range_m", 0.0), number_or(numbers, "plume_half_angle_rad", 0.0)],
                settling_band: number_or(numbers, "settling_band_rad", 0.0),
                isp: number_or(numbers, "isp_s", 0.0),
            },
            launch,
            outcome: MissionOutcome::new(),
            recorder: context.records.then(|| Recorder::new(spec)),
            has_ended: false,
            believed,
            drawn,
            spec: spec.clone(),
            columns: columns.clone(),
        }
    }

    /// Tick number [`ControlLoop::tick`] at the true state `truth`.
    fn at_tick(&mut self, truth: &Truth) {
        self.measurements.clear();
        for (sensor, instrument) in self.instruments.iter_mut().enumerate() {
            self.measurements.extend(instrument.deliver(self.tick, truth).map(|measurement| (sensor, measurement)));
        }
        if self.spec.knows_the_truth() {
            self.debris_seen = truth.time;
        }
        for (_, measurement) in &self.measurements {
            // where there is a camera, it has to see the debris; elsewhere the radar
            match measurement {
                Measurement::Camera { age, .. } => self.debris_seen = truth.time - age,
                Measurement::Radar { debris: Some(_), age, .. } if !self.has_camera => {
                    self.debris_seen = truth.time - age;
                }
                _ => {}
            }
        }
        let interval = truth.time - self.last_update;
        let mean = |impulse: [f64; 3]| if interval > 0.0 { scaled(1.0 / interval, impulse) } else { [0.0; 3] };
        let motor_torques = self.commanded_motors.map(|impulse| if interval > 0.0 { impulse / interval } else { 0.0 });
        let estimate = self.estimator.update(&Update {
            interval,
            measurements: &self.measurements,
            acceleration_s: scaled(1.0 / self.believed.mass.total, mean(self.commanded[0])),
            torque_s: mean(self.commanded[1]),
            motor_torques,
            truth,
        });
        (self.last_update, self.commanded, self.commanded_motors) = (truth.time, [[0.0; 3]; 2], [0.0; MAX_WHEELS]);
        if self.tick.is_multiple_of(self.ticks_per_period) {
            self.control(truth, &estimate);
        }
        self.tick += 1;
        self.next_tick = self.tick as f64 * self.tick_period;
    }

    /// A control tick: guidance, law, allocation.
    fn control(&mut self, truth: &Truth, estimate: &Estimate) {
        let geometry = self.geometry_of(estimate);
        let mut situation = self.situation(truth.time, estimate, geometry);
        // a phase begins with the run, or where guidance has changed it
        let starts = self.tick == 0;
        let (mut error, mut velocity_to_go) = self.wanted(estimate, geometry.as_ref(), truth.time);
        (situation.error, situation.velocity_to_go) = (error, velocity_to_go);
        let has_axis = geometry.is_some_and(|geometry| geometry.has_axis());
        let progress = match self.failure(truth, estimate, has_axis) {
            Some(failure) => Progress::Fails(failure),
            None => self.guidance.decide(&self.phases, &situation, SAME_TIME * self.spec.period),
        };
        let begins = starts || std::mem::take(&mut self.guidance.has_changed);
        if begins {
            self.law = self.laws[self.guidance.phase];
            (error, velocity_to_go) = self.wanted(estimate, geometry.as_ref(), truth.time);
        }
        self.judge(truth, estimate, begins, &error);
        match progress {
            Progress::Flies => {
                self.command(truth.time, estimate, &error, velocity_to_go, situation.s3_e);
                self.record(truth, estimate, &error);
            }
            Progress::Launches => self.end(truth, Failure::None),
            Progress::Fails(failure) => self.end(truth, failure),
        }
    }

    /// Records the tick, where this run is to be recorded.
    fn record(&mut self, truth: &Truth, estimate: &Estimate, error: &AttitudeError) {
        if let Some(recorder) = &mut self.recorder {
            let bias = self.instruments.iter().find_map(|instrument| instrument.sensor().bias_s());
            recorder.tick(&Tick {
                time: truth.time,
                phase: self.guidance.phase,
                pointing_error: error.angle(),
                estimate,
                consistency: &self.estimator.consistency(truth, bias),
                commanded: self.latest,
                measurements: &self.measurements,
            });
        }
    }

    /// The run has launched, or failed.
    fn end(&mut self, truth: &Truth, failure: Failure) {
        self.outcome.ends(&self.drawn, truth, failure, &self.launch);
        self.has_ended = true;
    }

    fn geometry_of(&self, estimate: &Estimate) -> Option<LaunchGeometry> {
        let debris = estimate.debris.as_ref()?;
        let centers = Centers {
            r_co_e: estimate.r_co_e,
            v_co_e: estimate.v_co_e,
            r_gdo_e: debris.r_gdo_e,
            v_gdo_e: debris.v_gdo_e,
        };
        Some(self.launch.geometry(&centers))
    }

    /// The impulse per mass that is left of the maneuver of the phase.
    fn velocity_to_go(&self, geometry: Option<&LaunchGeometry>, time: f64) -> VelocityToGo {
        let Some(geometry) = geometry else { return VelocityToGo::default() };
        let phase = &self.phases[self.guidance.phase];
        match phase.maneuver() {
            Maneuver::None => VelocityToGo::default(),
            Maneuver::Stop => {
                VelocityToGo { velocity_e: scaled(-1.0, geometry.relative_velocity), ..VelocityToGo::default() }
            }
            // within the burn what is left of the time of the transfer is ahead, and the impulse keeps its direction
            Maneuver::Transfer if phase.thrust == Maneuver::Transfer => {
                let left = self.guidance.arrival - time;
                if left < self.spec.period {
                    // the time of the transfer is over: what is left is for the stop
                    return VelocityToGo::default();
                }
                let velocity_e = transfer(geometry.from_station, geometry.relative_velocity, left);
                VelocityToGo { velocity_e, ..VelocityToGo::default() }
            }
            // before it, all of it
            Maneuver::Transfer => VelocityToGo {
                velocity_e: transfer(geometry.from_station, geometry.relative_velocity, phase.transfer_time),
                change_e: scaled(-1.0 / phase.transfer_time, geometry.relative_velocity),
            },
        }
    }

    /// The impulse per mass, in F_e, m/s, of thrust that is commanded and has not acted yet at `time`, at the attitude `q_es`.
    fn on_its_way(&self, q_es: [f64; 4], time: f64) -> [f64; 3] {
        let (acting, waiting) = self.thrust_commands.all();
        let mut impulse = [0.0; MAX_THRUSTERS];
        for &i in &self.spec.thrusters {
            let left = (acting.begin + acting.on_time[i] - time).clamp(0.0, acting.on_time[i]);
            impulse[i] = acting.thrust[i] * left;
        }
        for pulses in waiting {
            self.spec.thrusters.iter().for_each(|i| impulse[*i] += pulses.thrust[*i] * pulses.on_time[*i]);
        }
        let impulse_s = self.believed.thruster_force_s(impulse);
        scaled(1.0 / self.believed.mass.total, product(dcm_from_quaternion(q_es), impulse_s))
    }

    /// The attitude relative to the target of the phase, and the velocity to go (m/s, F_e).
    fn wanted(&self, estimate: &Estimate, geometry: Option<&LaunchGeometry>, time: f64) -> (AttitudeError, [f64; 3]) {
        let mut to_go = self.velocity_to_go(geometry, time);
        let Phase { target, thrust, .. } = self.phases[self.guidance.phase];
        if thrust != Maneuver::None {
            to_go.velocity_e = difference(to_go.velocity_e, self.on_its_way(estimate.q_es, time));
        }
        (target.error(estimate.q_es, geometry, &to_go), to_go.velocity_e)
    }

    fn situation(&self, time: f64, estimate: &Estimate, geometry: Option<LaunchGeometry>) -> Situation {
        let rates = &estimate.wheel_rates[..self.believed.mass.wheels.len()];
        Situation {
            time,
            time_in_phase: time - self.guidance.since,
            body_rate: norm(estimate.omega_se_s),
            error: AttitudeError::NONE,
            wheel_speed: rates.iter().fold(0.0, |most, rate| most.max(rate.abs())),
            wheel_momentum: norm(stored_momentum(&self.believed, estimate)),
            geometry,
            velocity_to_go: [0.0; 3],
            s3_e: s3_of(dcm_from_quaternion(estimate.q_es)),
            time_to_station: self.guidance.arrival - time,
            debris_age: if self.spec.has_debris { time - self.debris_seen } else { f64::NAN },
            debris_rate: estimate.debris.map_or(f64::NAN, |debris| norm(debris.omega_de_d)),
        }
    }

    /// What ends the mission whatever the phase.
    fn failure(&self, truth: &Truth, estimate: &Estimate, has_axis: bool) -> Option<Failure> {
        let own =
            estimate.q_es.iter().chain(&estimate.omega_se_s).chain(&estimate.gyro_bias_s).chain(&estimate.wheel_rates);
        let own: f64 = own.chain(&estimate.r_co_e).chain(&estimate.v_co_e).sum();
        let of_debris: f64 = estimate.debris.as_ref().map_or(0.0, |debris| {
            let motion = debris.r_gdo_e.iter().chain(&debris.v_gdo_e);
            motion.chain(&debris.q_ed).chain(&debris.omega_de_d).sum()
        });
        if !(own + of_debris).is_finite() {
            return Some(Failure::Diverged);
        }
        if let Some(debris) = &truth.debris
            && norm(difference(debris.r_gdo_e, truth.body.r_co_e)) < self.judgement.keep_out
        {
            return Some(Failure::KeepOut);
        }
        if self.spec.needs_axis() && !has_axis {
            return Some(Failure::NoAxis);
        }
        if self.spec.has_debris && truth.time - self.debris_seen > self.timeouts[1] {
            return Some(Failure::LostTarget);
        }
        (truth.time - self.saturated_since > self.timeouts[0]).then_some(Failure::WheelSaturated)
    }

    /// Takes the truth of a tick into the outcome.
    fn judge(&mut self, truth: &Truth, estimate: &Estimate, begins: bool, believed: &AttitudeError) {
        let target = self.phases[self.guidance.phase].target;
        // of perfect knowledge the believed error is the true one
        let knows = self.spec.knows_the_truth();
        let geometry = if knows { None } else { centers_of(truth).map(|centers| self.launch.geometry(&centers)) };
        let error = (target != Target::None).then(|| {
            if knows {
                return *believed;
            }
            let to_go = self.velocity_to_go(geometry.as_ref(), truth.time);
            target.error(truth.body.q_es, geometry.as_ref(), &to_go)
        });
        let consistency = if self.spec.has_filter() {
            let bias = self.instruments.iter().find_map(|instrument| instrument.sensor().bias_s());
            self.estimator.consistency(truth, bias)
        } else {
            Consistency::default()
        };
        let errors = if knows { EstimateErrors::NONE } else { estimate.errors(truth) };
        self.outcome.tick(&self.drawn, truth, (error.as_ref(), begins), (&errors, &consistency), &self.judgement);
    }

    /// Commands what the law and the maneuver want.
    fn command(
        &mut self,
        time: f64,
        estimate: &Estimate,
        error: &AttitudeError,
        velocity_to_go: [f64; 3],
        s3_e: [f64; 3],
    ) {
        let mass = &self.believed.mass;
        let mut momenta = [0.0; MAX_WHEELS];
        for (i, wheel) in mass.wheels.iter().enumerate() {
            momenta[i] = wheel.axial * (dot(wheel.axis, estimate.omega_se_s) + estimate.wheel_rates[i]);
        }
        let input = LawInput {
            q_ts: error.q_ts,
            omega_se_s: estimate.omega_se_s,
            omega_te_s: error.omega_te_s,
            acceleration_te_s: [0.0; 3],
            momentum_s: self.known.momentum(mass, estimate.omega_se_s, &momenta[..mass.wheels.len()]),
        };
        let phase = &self.phases[self.guidance.phase];
        // zero at the first tick of a phase
        let since = if self.guidance.since == time { 0.0 } else { self.spec.period };
        let torque = self.law.torque(&self.known, &input, since);
        let begin = time + self.delay;
        let (mut by_thrusters, mut mean) = ([0.0; 3], [0.0; MAX_THRUSTERS]);
        if let Some(allocation) = &self.thrusters {
            let by_wheels = self.wheels.as_ref().map_or([0.0; 3], |wheels| product(wheels.reachable, torque));
            let mut wanted = difference(torque, by_wheels);
            if let Some(unloading) = &phase.unloading {
                let stored = stored_momentum(&self.believed, estimate);
                wanted = sum(wanted, unloading.torque(stored, self.two_sided));
            }
            let mut along = match phase.thrust {
                Maneuver::None => 0.0,
                _ => mass.total * dot(velocity_to_go, s3_e) / self.spec.period,
            };
            if matches!(phase.target, Target::Transfer | Target::Stop) {
                // s3 is turned there for the thruster that pushes along it
                along = along.max(0.0);
            }
            let allocated = allocation.allocate([0.0, 0.0, along], wanted);
            let mut pulses = Pulses { begin, ..NO_PULSES };
            for &i in &self.spec.thrusters {
                let period = self.spec.period;
                let pulse = self.thruster_drives[i].over(allocated.thrust[i], period, &mut self.pulses[i]);
                (pulses.thrust[i], pulses.on_time[i]) = (pulse.thrust, pulse.on_time);
                mean[i] = pulse.thrust * pulse.on_time / period;
            }
            by_thrusters = self.believed.thruster_torque_s(mean);
            self.thrust_commands.push(begin, pulses);
        }
        let mut motor_torque = [0.0; MAX_WHEELS];
        if let Some(allocation) = &self.wheels {
            let motors = allocation.motors(difference(torque, by_thrusters));
            self.spec.wheels.iter().zip(motors).for_each(|(place, motor)| motor_torque[*place] = motor);
        }
        let total =
            motor_torque.iter().sum::<f64>() + self.spec.thrusters.iter().map(|place| mean[*place]).sum::<f64>();
        if !total.is_finite() {
            self.has_ended = true;
            self.outcome.diverges(time);
            return;
        }
        self.motor_commands.push(begin, motor_torque);
        if self.recorder.is_some() {
            self.latest = (motor_torque, mean);
        }
    }

    /// What the actuators make of the command from `time` on, and until when.
    fn applied(&mut self, time: f64, body: &BodyState, wheels: &WheelState) -> Actuation {
        let same = SAME_TIME * self.spec.period;
        let (motor_torque, next_motors) = self.motor_commands.at(time + same);
        let motor_torque = *motor_torque;
        let mut until = self.next_tick.min(next_motors);
        let (mut thrust, mut commanded) = ([0.0; MAX_THRUSTERS], [0.0; MAX_THRUSTERS]);
        if !self.spec.thrusters.is_empty() {
            let (pulses, next_pulses) = self.thrust_commands.at(time + same);
            until = until.min(next_pulses);
            for &i in &self.spec.thrusters {
                let valve = &self.drawn.actuators.thrusters[i];
                let (level, least) = if self.is_on_off {
                    (valve.max_thrust, valve.min_on_time)
                } else {
                    (pulses.thrust[i].min(valve.max_thrust), 0.0)
                };
                let end = pulses.begin + pulses.on_time[i].max(least);
                if pulses.thrust[i] > 0.0 && end > time + same {
                    (thrust[i], commanded[i]) = (level, pulses.thrust[i]);
                    until = until.min(end);
                }
            }
        }
        // the run ends an arc too
        let length = until.min(self.duration) - time;
        let mut actuation = Actuation::none(until);
        let (mut saturated, mut excess) = ([false; 2], 0.0_f64);
        // a wheel whose speed is held has a motor of its own
        for (i, drive) in self.wheel_drives[..self.drawn.mass.wheels.len()].iter().enumerate() {
            if self.drawn.mass.wheels[i].mode != WheelMode::Free {
                continue;
            }
            let driven = drive.over(motor_torque[i], wheels.rates[i], length);
            actuation.motor_torque[i] = driven.torque;
            saturated[0] |= driven.is_torque_limited;
            saturated[1] |= driven.is_speed_limited;
            excess = excess.max(driven.excess);
        }
        if !saturated[1] {
            self.saturated_since = f64::NAN;
        } else if self.saturated_since.is_nan() {
            self.saturated_since = time;
        }
        let mut hits = false;
        if thrust != [0.0; MAX_THRUSTERS] {
            for &i in &self.spec.thrusters {
                actuation.thrust[i] = self.drawn.actuators.thrusters[i].thrust_scale * thrust[i];
            }
            self.commanded[0] = sum(self.commanded[0], scaled(length, self.believed.thruster_force_s(commanded)));
            self.commanded[1] = sum(self.commanded[1], scaled(length, self.believed.thruster_torque_s(commanded)));
            if self.spec.approaches() {
                let truth = Truth::new(&self.drawn, time, body, wheels, self.debris.as_mut());
                hits = self.outcome.plume_hits(&self.drawn, &truth, &actuation.thrust, &self.judgement);
            }
        }
        let applied = ArcApplied { length, thrust: actuation.thrust, hits, saturated, torque_excess: excess };
        self.outcome.arc(&self.drawn, &applied);
        if self.spec.knows_the_truth() {
            // only filters ask what was commanded
            return actuation;
        }
        for (i, wheel) in self.believed.mass.wheels.iter().enumerate() {
            let most = self.believed.actuators.wheels[i].torque_limit;
            let impulse = length * motor_torque[i].clamp(-most, most);
            self.commanded[1] = difference(self.commanded[1], scaled(impulse, wheel.axis));
            self.commanded_motors[i] += impulse;
        }
        actuation
    }
}

impl ActuationLaw for ControlLoop {
    fn arc(&mut self, time: f64, body: &BodyState, wheels: &WheelState) -> Actuation {
        if !self.has_ended && time >= self.next_tick - SAME_TIME * self.tick_period {
            let truth = Truth::new(&self.drawn, time, body, wheels, self.debris.as_mut());
            self.at_tick(&truth);
        }
        if self.has_ended {
            return Actuation::end_of_run();
        }
        self.applied(time, body, wheels)
    }

    fn report(&self, values: &mut [f64]) {
        self.columns.report(&self.outcome, &self.guidance, &self.judgement, values);
    }

    fn telemetry(&self) -> Option<&Telemetry> {
        self.recorder.as_ref().map(Recorder::telemetry)
    }
}
