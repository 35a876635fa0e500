//! [`ControlLoop`]: plant and flight software of one run, tick by tick.
//!
//! At a tick, due sensors measure the true state, the estimator updates, guidance may change the phase, the law
//! computes a torque and the maneuver a force, and allocation turns them into commands. A command acts `delay_s` later,
//! until the next one (zero-order hold) or as pulses. Actuator output is constant over an arc, with friction and limits
//! by its initial state. A tick at the end of a run is the last: the run can launch or fail there, but its commands do
//! not act.
//!
//! Measurements pass from [`super::plant`], the truth, to [`super::flight_software`] and commands back; only this
//! module knows both. `mission` judges the run by the truth.

mod mission;

use std::sync::Arc;

use self::mission::{Mission, consistency};
use super::flight_software::FlightSoftware;
use super::guidance::Progress;
use super::net_launch::AtLaunch;
use super::outcome::columns::OutcomeColumns;
use super::plant::{Applied, Plant};
use super::sensors::failing::FailingSensor;
use super::sensors::{KINDS as SENSORS, SampledSensor, SensorContext};
use super::stability::beyond_limit;
use super::tick_times::SAME_TIME;
use super::truth::Truth;
use crate::dynamics::actuation::{Actuation, ActuationLaw, BodyState, WheelState};
use crate::loops::attitude_law::digits;
use crate::loops::context::LawContext;
use crate::loops::failure::Failure;
use crate::loops::sensor_spec::SensorSpec;
use crate::loops::spec::LoopSpec;
use crate::loops::vector::{cross, difference, inverse, norm, product, scaled, sum};
use crate::run::Telemetry;
use crate::scene::{DeclaredTable, Device, Scene};

pub struct ControlLoop {
    columns: Arc<OutcomeColumns>,
    plant: Plant,
    flight_software: FlightSoftware,
    mission: Mission,
    /// Number and time of the next tick.
    tick: u64,
    next: f64,
    /// Sensor ticks in a control period.
    ticks_per_period: u64,
    /// Ticks between the instants at which each sensor measures, and flight software commands.
    schedules: Vec<u64>,
    tick_period: f64,
    /// End of the run.
    end: f64,
    has_ended: bool,
    growth: Growth,
    /// Reason of a divergence, if any.
    divergence: Option<String>,
}

/// The first tick after `tick` at which one of `schedules` is due. Latencies are whole control periods, so that
/// measurements are delivered at such ticks, too.
fn next_due(tick: u64, schedules: &[u64]) -> u64 {
    schedules.iter().map(|every| (tick / every + 1) * every).min().unwrap_or(tick + 1)
}

fn sensors(spec: &LoopSpec, context: &LawContext<'_>, tick_period: f64) -> Vec<SampledSensor> {
    let sampled = |(place, (sensor, parameters)): (usize, (&SensorSpec, &DeclaredTable))| {
        let LawContext { drawn, sample, seed, .. } = *context;
        let of_run = SensorContext { parameters, drawn, period: sensor.period, sample, seed };
        let ticks = |time: f64| (time / tick_period).round() as u64;
        let maker = &SENSORS[sensor.maker];
        let made = match drawn.failures.iter().find(|failure| failure.device == Device::Sensor(place)) {
            Some(failure) => Box::new(FailingSensor::new(maker, &of_run, failure)),
            None => (maker.make)(&of_run),
        };
        SampledSensor::new(made, ticks(sensor.period).max(1), ticks(sensor.latency), tick_period)
    };
    spec.sensors.iter().zip(&context.parameters.sensors).enumerate().map(sampled).collect()
}

impl ControlLoop {
    /// The loop of a run, from its specification and drawn numbers.
    pub fn new(spec: &Arc<LoopSpec>, columns: &Arc<OutcomeColumns>, context: &LawContext<'_>) -> Self {
        let ticks_per_period = spec.ticks_per_period();
        let tick_period = spec.period / ticks_per_period as f64;
        let sensors = sensors(spec, context, tick_period);
        let schedules = sensors.iter().map(|sensor| sensor.every).chain([ticks_per_period]).collect();
        ControlLoop {
            schedules,
            plant: Plant::new(spec, context.drawn.clone(), sensors, [context.duration, context.end]),
            flight_software: FlightSoftware::new(spec, context, tick_period),
            mission: Mission::new(spec, context),
            tick: 0,
            next: 0.0,
            ticks_per_period,
            tick_period,
            end: context.end,
            columns: columns.clone(),
            has_ended: false,
            growth: Growth::new(context.drawn, spec.period),
            divergence: None,
        }
    }

    /// The truth at `time` if a tick is due.
    fn due(&mut self, time: f64, body: &BodyState, wheels: &WheelState) -> Option<Truth> {
        let is_due = !self.has_ended && time >= self.next - SAME_TIME * self.tick_period;
        is_due.then(|| self.plant.truth(time, body, wheels))
    }

    fn at_tick(&mut self, truth: &Truth, is_last: bool) {
        self.flight_software.tick(&self.plant.measure(self.tick, truth));
        if self.tick.is_multiple_of(self.ticks_per_period) {
            self.control(truth, is_last);
        }
        self.tick = next_due(self.tick, &self.schedules);
        self.next = self.tick as f64 * self.tick_period;
    }

    fn control(&mut self, truth: &Truth, is_last: bool) {
        let failure = match self.flight_software.failure(truth.time) {
            Some(Failure::Diverged) => Some(Failure::Diverged),
            of_software => self.mission.keep_out(truth).or(of_software).or(self.mission.saturation(truth.time)),
        };
        let guided = self.flight_software.guide(truth.time, failure);
        // columns cover ticks whose commands act, and the one that ends the mission
        let is_judged = !is_last || guided.progress != Progress::Flies;
        self.mission.judge((&self.plant, truth), &self.flight_software, &guided, is_judged);
        let ends = match guided.progress {
            Progress::Flies => self.flight_software.command(truth.time, &guided).err(),
            Progress::Launches => Some(Failure::None),
            Progress::Fails(failure) => Some(failure),
        };
        self.has_ended = ends.is_some();
        let outcome = &mut self.mission.outcome;
        if let Some(failure) = ends {
            (outcome.end, outcome.failure) = (truth.time, failure);
        }
        if guided.progress == Progress::Launches {
            outcome.at_launch = AtLaunch::of(&self.plant.drawn, truth, &outcome.criteria.launch);
        }
        if is_judged && guided.progress == Progress::Flies {
            outcome.take_telemetry(self.flight_software.law.telemetry());
        }
        self.mission.record((&self.plant, truth), &self.flight_software, &guided);
        // rows have the last tick's value only
        let is_final = truth.time + (1.0 + SAME_TIME) * self.flight_software.spec.period >= self.end;
        if is_judged && (self.has_ended || is_final) {
            self.mission.outcome.consistency = consistency(&self.plant, truth, &self.flight_software);
        }
    }

    fn arc_from(&mut self, time: f64, body: &BodyState, wheels: &WheelState) -> Actuation {
        let mut commands = self.flight_software.acting(time);
        commands.until = commands.until.min(self.next);
        let mut actuation = Actuation::none(commands.until);
        let applied = self.plant.apply(time, &commands, wheels, &mut actuation);
        if let Some(change) =
            self.growth.beyond(&self.plant, (&actuation, &applied), self.flight_software.field.field_s)
        {
            self.has_ended = true;
            self.divergence = Some(self.diverged(time, change));
            // poisons the state at once, since no arc follows
            return Actuation { body_torque: [f64::NAN; 3], ..Actuation::end_of_run() };
        }
        self.flight_software.count(time, applied.length);
        self.mission.arc(time, &mut self.plant, (&actuation, &applied), (body, wheels));
        // scheduled thrust is not counted as the loop's
        for (thrust, scheduled) in actuation.thrust.iter_mut().zip(applied.scheduled_thrust) {
            *thrust += scheduled;
        }
        actuation
    }

    /// The reason of a divergence in which commands at `time` change the rate by `change` rad/s in a control period.
    fn diverged(&self, time: f64, change: f64) -> String {
        let FlightSoftware { spec, believed, guidance, laws, delay, .. } = &self.flight_software;
        let place = guidance.phase;
        let known = beyond_limit((spec, place), (believed, &self.plant.drawn), &laws[place], *delay);
        let why = known.unwrap_or_else(|| {
            "no limit of its gains is known to be exceeded: check their signs, and the noise and the lag of what \
             its input"
                .to_owned()
        });
        let (name, change) = (spec.phases[place].name, digits(change));
        format!(
            "guidance.{name}: the loop diverges; at {time:?} s its commands change the rate by {change} rad/s in a \
             control period; {why}"
        )
    }
}

impl ActuationLaw for ControlLoop {
    fn arc(&mut self, time: f64, body: &BodyState, wheels: &WheelState) -> Actuation {
        if let Some(truth) = self.due(time, body, wheels) {
            self.at_tick(&truth, false);
        }
        let actuation = if self.has_ended { Actuation::end_of_run() } else { self.arc_from(time, body, wheels) };
        self.mission.record_over_time(time - SAME_TIME * self.tick_period);
        actuation
    }

    fn end(&mut self, time: f64, body: &BodyState, wheels: &WheelState) {
        if let Some(truth) = self.due(time, body, wheels) {
            self.at_tick(&truth, true);
            self.mission.record_over_time(time - SAME_TIME * self.tick_period);
        }
    }

    fn report(&self, values: &mut [f64]) {
        self.columns.report(&self.mission.outcome, &self.flight_software.guidance, values);
    }

    fn divergence(&self) -> Option<String> {
        self.divergence.clone()
    }

    fn telemetry(&self) -> Option<&Telemetry> {
        self.mission.recorder.as_ref().map(|recorder| &recorder.telemetry)
    }
}

/// Change of the rate in a period, times the period, rad.
const TURN: f64 = 100.0;
/// Change of the rate in a period over the initial rate.
const RISE: f64 = 1e3;

/// Bounds on the commands of a run, beyond which a loop has diverged.
///
/// Under a stable loop k T^2 < 4 and c T < 2 ([`super::stability`]), so that in a period T it changes the rate by at
/// most 4 pi/T + 2 |omega|. Divergence is a change above both [`TURN`]/T, a dozen revolutions until the next tick, and
/// [`RISE`] times the initial rate. Disturbances and stuck thrusters do not count.
struct Growth {
    /// Inverse of K, 1/(kg m^2), F_s.
    inverse: [[f64; 3]; 3],
    /// Largest change of the rate in a control period.
    most: f64,
    period: f64,
}

impl Growth {
    /// Bounds for a run of `scene` under a loop of period `period`.
    fn new(scene: &Scene, period: f64) -> Self {
        let start = norm(scene.initial.omega_se_s);
        let most = (TURN / period).max(RISE * start);
        Growth { inverse: inverse(scene.mass.inertia_rotating()), most, period }
    }

    /// The change of the rate in a control period by the commands of an arc, if beyond the bounds; `field_s` is the
    /// measured field.
    fn beyond(&self, plant: &Plant, (actuation, applied): (&Actuation, &Applied), field_s: [f64; 3]) -> Option<f64> {
        let scene = &plant.drawn;
        let mut torque = cross(actuation.dipole, field_s);
        for (wheel, motor) in scene.mass.wheels.iter().zip(actuation.motor_torque) {
            torque = difference(torque, scaled(motor, wheel.axis));
        }
        // a pulse ends before the period does
        let pulse = if plant.is_on_off { applied.length.min(self.period) } else { self.period };
        let impulse = scaled(pulse, scene.thruster_torque_s(actuation.thrust));
        let change = norm(product(self.inverse, sum(scaled(self.period, torque), impulse)));
        (change > self.most).then_some(change)
    }
}

#[cfg(test)]
mod tests {
    use super::next_due;

    /// Law: a loop of 0.25 s with a gyro each 0.01 s and a magnetometer each 0.03125 s, on ticks of 0.00125 s, is due
    /// at the 25 instants of the one and the 8 of the other, the start of the period in common, and at no other tick.
    #[test]
    fn instants_are_those_of_the_schedules() {
        let schedules = [8, 25, 200];
        let mut due = vec![0];
        while due.last() < Some(&200) {
            due.push(next_due(due[due.len() - 1], &schedules));
        }
        let expected: Vec<u64> = (0..=200).filter(|tick| tick % 8 == 0 || tick % 25 == 0).collect();
        assert_eq!(due, expected);
        assert_eq!(due.len() - 1, 25 + 8 - 1);
    }
}
