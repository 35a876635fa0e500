//! [`ControlLoop`]: sensors, estimator, guidance, law, allocation and actuators of one run, tick by tick.
//!
//! At a tick the sensors that are due measure the true state, the estimator updates, guidance may change the phase, the law wants a torque and the
//! maneuver a force, and allocation makes commands of them. A command acts `delay_s` later, until the next one (zero-order hold), or as pulses; what the
//! actuators make of it is held over an arc, with friction and limits by the state at its start. Where the end of a run is a tick, that tick is the last
//! one: the run can launch or fail there, and nothing that it commands acts.
//!
//! Flight software knows the nominal scene as it is believed ([`LoopSpec::believed`]) and its own drawn numbers; the truth reaches it through sensors.

mod construction;
mod effectors;
mod maneuver;

use std::sync::Arc;

use self::effectors::{MotorCommand, Pulses};
use super::actuators::{DelayQueue, PulseState, ThrusterDrive, WheelDrive};
use super::allocation::thrust::ThrustAllocation;
use super::allocation::wheel_torque::WheelTorque;
use super::estimate::{Estimate, EstimateErrors};
use super::estimators::{Consistency, Estimator, Update};
use super::guidance::geometry::LaunchState;
use super::guidance::phase::Phase;
use super::guidance::target::{AttitudeError, Target};
use super::guidance::{Failure, Guidance, Progress};
use super::laws::{AttitudeLaw, KnownBody};
use super::loop_record::{KnownOverTime, SharedRecord, set};
use super::measurement::Measurement;
use super::outcome::columns::OutcomeColumns;
use super::outcome::{Judgement, MissionOutcome, centers_of};
use super::recorder::{Recorder, Tick};
use super::sensors::Instrument;
use super::spec::LoopSpec;
use super::truth::{DebrisMotion, Truth};
use crate::control::vector::{difference, norm, scaled};
use crate::dynamics::actuation::{Actuation, ActuationLaw, BodyState, WheelState};
use crate::observables::Series;
use crate::run::Telemetry;
use crate::scene::{MAX_THRUSTERS, MAX_WHEELS, Scene};

/// Times that differ by less than this share of a period are one: rounding of the products that they are.
pub const SAME_TIME: f64 = 1e-9;

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
    /// What is known of the quantities over time, and where it is recorded.
    over_time: KnownOverTime,
    record: Option<SharedRecord>,
    has_ended: bool,
}

impl ControlLoop {
    /// Whether a tick is due at `time`, s.
    fn is_due(&self, time: f64) -> bool {
        !self.has_ended && time >= self.next_tick - SAME_TIME * self.tick_period
    }

    /// Tick number [`ControlLoop::tick`] at the true state `truth`; `is_last`: at the end of the run.
    fn at_tick(&mut self, truth: &Truth, is_last: bool) {
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
            self.control(truth, &estimate, is_last);
        }
        self.tick += 1;
        self.next_tick = self.tick as f64 * self.tick_period;
    }

    /// A control tick: guidance, law, allocation.
    fn control(&mut self, truth: &Truth, estimate: &Estimate, is_last: bool) {
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
            self.law = self.laws[self.guidance.phase].clone();
            (error, velocity_to_go) = self.wanted(estimate, geometry.as_ref(), truth.time);
        }
        // columns are about the ticks whose commands act, and about the one at which the mission ends
        let is_judged = !is_last || progress != Progress::Flies;
        self.judge(truth, estimate, (begins, is_judged), &error);
        // nothing is commanded where the mission ends
        self.latest = ([0.0; MAX_WHEELS], [0.0; MAX_THRUSTERS]);
        match progress {
            Progress::Flies => self.command(truth.time, estimate, &error, velocity_to_go, situation.s3_e),
            Progress::Launches => self.end_mission(truth, Failure::None),
            Progress::Fails(failure) => self.end_mission(truth, failure),
        }
        if self.recorder.is_some() {
            self.record(truth, estimate, &error);
        }
        // rows have it of the last tick alone
        let is_final = self.has_ended || truth.time + (1.0 + SAME_TIME) * self.spec.period >= self.duration;
        if is_judged && is_final {
            self.outcome.consistency = self.consistency(truth);
        }
    }

    /// Records the tick, where this run is to be recorded.
    fn record(&mut self, truth: &Truth, estimate: &Estimate, error: &AttitudeError) {
        let consistency = self.consistency(truth);
        if let Some(recorder) = &mut self.recorder {
            recorder.tick(&Tick {
                time: truth.time,
                phase: self.guidance.phase,
                pointing_error: error.angle(),
                estimate,
                consistency: &consistency,
                commanded: self.latest,
                measurements: &self.measurements,
            });
        }
    }

    /// Records the quantities over time as they are known from `time` on, s.
    fn record_over_time(&self, time: f64) {
        if let Some(record) = &self.record {
            record.lock().take(time - SAME_TIME * self.tick_period, &self.over_time);
        }
    }

    /// The mission has launched, or failed.
    fn end_mission(&mut self, truth: &Truth, failure: Failure) {
        self.outcome.ends(&self.drawn, truth, failure, &self.launch);
        self.has_ended = true;
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

    /// Takes the truth of a tick into the quantities over time, and into the outcome where the tick is judged; `begins`: with it a phase does.
    fn judge(
        &mut self,
        truth: &Truth,
        estimate: &Estimate,
        (begins, is_judged): (bool, bool),
        believed: &AttitudeError,
    ) {
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
        let errors = if knows { EstimateErrors::NONE } else { estimate.errors(truth) };
        for (series, value) in [
            (Series::PointingError, error.map_or(f64::NAN, |error| error.angle())),
            (Series::AttitudeEstimateError, errors.attitude),
            (Series::RateEstimateError, errors.rate),
            (Series::PositionEstimateError, errors.relative_position),
            (Series::VelocityEstimateError, errors.relative_velocity),
        ] {
            set(&mut self.over_time, series, value);
        }
        if is_judged {
            self.outcome.tick(&self.drawn, truth, (error.as_ref(), begins), &errors, &self.judgement);
        }
    }

    /// How the errors of the filters at this tick compare with their covariances.
    fn consistency(&self, truth: &Truth) -> Consistency {
        let bias = self.instruments.iter().find_map(|instrument| instrument.sensor().bias_s());
        self.estimator.consistency(truth, bias)
    }
}

impl ActuationLaw for ControlLoop {
    fn arc(&mut self, time: f64, body: &BodyState, wheels: &WheelState) -> Actuation {
        if self.is_due(time) {
            let truth = Truth::new(&self.drawn, time, body, wheels, self.debris.as_mut());
            self.at_tick(&truth, false);
        }
        let actuation = if self.has_ended { Actuation::end_of_run() } else { self.applied(time, body, wheels) };
        self.record_over_time(time);
        actuation
    }

    fn end(&mut self, time: f64, body: &BodyState, wheels: &WheelState) {
        if self.is_due(time) {
            let truth = Truth::new(&self.drawn, time, body, wheels, self.debris.as_mut());
            self.at_tick(&truth, true);
            self.record_over_time(time);
        }
    }

    fn report(&self, values: &mut [f64]) {
        self.columns.report(&self.outcome, &self.guidance, &self.judgement, values);
    }

    fn telemetry(&self) -> Option<&Telemetry> {
        self.recorder.as_ref().map(Recorder::telemetry)
    }
}
