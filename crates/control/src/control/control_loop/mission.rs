//! [`Mission`]: judges a run by its truth: outcome, failures and quantities over time. None of it reaches flight
//! software.

use std::sync::Arc;

use crate::control::flight_software::{FlightSoftware, Guided};
use crate::control::guidance::Progress;
use crate::control::guidance::target::{OrbitMotion, TargetInput};
use crate::control::net_launch::plume_hits;
use crate::control::outcome::estimation::{Consistency, EstimateErrors};
use crate::control::outcome::{MissionCriteria, MissionOutcome};
use crate::control::parameters::{LoopNumbers, ThrusterNumbers};
use crate::control::plant::{Applied, Plant};
use crate::control::recorder::{Recorder, Tick};
use crate::control::tick_times::SAME_TIME;
use crate::control::truth::Truth;
use crate::dynamics::actuation::{Actuation, BodyState, WheelState};
use crate::loops::context::LawContext;
use crate::loops::declared::limit;
use crate::loops::failure::Failure;
use crate::loops::launch_geometry::LaunchState;
use crate::loops::loop_record::{KnownOverTime, NOTHING_KNOWN, SharedRecord, place};
use crate::loops::spec::LoopSpec;
use crate::loops::target::Target;
use crate::loops::vector::{difference, norm};
use crate::observables::Series;
use crate::scene::{MAX_WHEELS, WheelMode};

pub struct Mission {
    spec: Arc<LoopSpec>,
    pub(super) outcome: MissionOutcome,
    pub(super) recorder: Option<Recorder>,
    /// Quantities over time, and their record.
    over_time: KnownOverTime,
    record: Option<SharedRecord>,
    /// Indices of motor torques among them.
    motor_places: [usize; MAX_WHEELS],
    saturated_since: f64,
}

impl Mission {
    pub fn new(spec: &Arc<LoopSpec>, context: &LawContext<'_>) -> Self {
        let numbers = &context.parameters.law;
        Mission {
            spec: spec.clone(),
            outcome: MissionOutcome::new(MissionCriteria {
                launch: LaunchState::of(numbers, context.drawn.orbit.as_ref()),
                of_loop: LoopNumbers::of(numbers),
                period: spec.period,
                isp: ThrusterNumbers::of(numbers).isp,
            }),
            recorder: context.records.then(|| Recorder::new(spec)),
            over_time: NOTHING_KNOWN,
            record: context.record.cloned().inspect(|record| record.lock().restart()),
            motor_places: std::array::from_fn(|wheel| place(Series::MotorTorque.of_wheel(wheel))),
            saturated_since: f64::NAN,
        }
    }

    /// Failure by an approach below the keep-out distance.
    pub fn keep_out(&self, truth: &Truth) -> Option<Failure> {
        let debris = truth.debris.as_ref()?;
        let distance = norm(difference(debris.r_gdo_e, truth.body.r_co_e));
        (distance < self.outcome.criteria.launch.numbers.keep_out).then_some(Failure::KeepOut)
    }

    /// Failure by a wheel at its speed limit for too long.
    pub fn saturation(&self, time: f64) -> Option<Failure> {
        let MissionCriteria { of_loop, period, .. } = &self.outcome.criteria;
        let longest = limit(of_loop.saturation_timeout) + SAME_TIME * period;
        (time - self.saturated_since > longest).then_some(Failure::WheelSaturated)
    }

    /// Adds the truth of a control tick to the quantities over time and, if `is_judged`, to the outcome.
    pub fn judge(
        &mut self,
        (plant, truth): (&Plant, &Truth),
        software: &FlightSoftware,
        guided: &Guided,
        is_judged: bool,
    ) {
        let target = software.phase().target;
        // with perfect knowledge the estimated error is the true one
        let knows = self.spec.knows_the_truth();
        let error = (target != Target::None).then(|| {
            if knows {
                return guided.error;
            }
            let geometry = truth.state().centers().map(|centers| self.outcome.criteria.launch.geometry(centers));
            let to_go = software.velocity_to_go(geometry.as_ref(), truth.time);
            let place = [truth.body.r_co_e, truth.body.v_co_e];
            let orbit = plant.drawn.orbit.as_ref().map(|orbit| OrbitMotion::of(orbit, target, truth.time, place));
            TargetInput { geometry: geometry.as_ref(), to_go: &to_go, orbit }.error(target, truth.body.q_es)
        });
        let errors = if knows { EstimateErrors::NONE } else { EstimateErrors::of(&software.estimate, truth) };
        self.over_time.error = error;
        for (series, value) in [
            (Series::AttitudeEstimateError, errors.attitude),
            (Series::RateEstimateError, errors.rate),
            (Series::PositionEstimateError, errors.relative_position),
            (Series::VelocityEstimateError, errors.relative_velocity),
        ] {
            self.over_time.values[place(series)] = value;
        }
        if let Some(debris) = &truth.debris {
            let distance = norm(difference(debris.r_gdo_e, truth.body.r_co_e));
            let speed = norm(difference(debris.v_gdo_e, truth.body.v_co_e));
            self.over_time.values[place(Series::DebrisDistance)] = distance;
            self.over_time.values[place(Series::DebrisSpeed)] = speed;
        }
        self.over_time.values[place(Series::Impulse)] = self.outcome.impulse_total();
        if is_judged {
            self.outcome.tick(&plant.drawn, truth, (error.as_ref(), guided.begins), &errors);
        }
    }

    pub fn record(&mut self, (plant, truth): (&Plant, &Truth), software: &FlightSoftware, guided: &Guided) {
        if let Some(recorder) = &mut self.recorder {
            recorder.tick(&Tick {
                spec: &self.spec,
                time: truth.time,
                phase: software.guidance.phase,
                pointing_error: guided.error.angle(),
                estimate: &software.estimate,
                consistency: &consistency(plant, truth, software),
                commanded: software.latest,
                // no law steps at the end of the mission
                telemetry: if guided.progress == Progress::Flies { software.law.telemetry() } else { &[] },
                measurements: plant.measurements(truth.time).delivered,
            });
        }
    }

    /// Adds the actuators' response over an arc from `time` on; `body` and `wheels` are its initial state.
    pub fn arc(
        &mut self,
        time: f64,
        plant: &mut Plant,
        (actuation, applied): (&Actuation, &Applied),
        (body, wheels): (&BodyState, &WheelState),
    ) {
        for (i, wheel) in plant.drawn.mass.wheels.iter().enumerate() {
            if wheel.mode == WheelMode::Free {
                self.over_time.values[self.motor_places[i]] = actuation.motor_torque[i];
            }
        }
        if !applied.saturated[1] {
            self.saturated_since = f64::NAN;
        } else if self.saturated_since.is_nan() {
            self.saturated_since = time;
        }
        self.outcome.arc(actuation, applied);
        if applied.fires {
            let thrust = plant.thrust(time, actuation);
            let hits = self.spec.approaches() && {
                let truth = plant.truth(time, body, wheels);
                plume_hits(&self.outcome.criteria.launch.numbers, &plant.drawn, &truth, &thrust)
            };
            self.outcome.fires(&plant.drawn, applied.length, thrust, hits);
        }
    }

    /// Records the quantities over time from `time` on.
    pub fn record_over_time(&self, time: f64) {
        if let Some(record) = &self.record {
            record.lock().take(time, &self.over_time);
        }
    }
}

pub(super) fn consistency(plant: &Plant, truth: &Truth, software: &FlightSoftware) -> Consistency {
    Consistency::of(&software.estimator.filters(), &software.estimate, truth, plant.gyro_bias_s())
}
