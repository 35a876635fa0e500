//! [`ControlLoop`]: plant and flight software of one run, tick by tick.
//!
//! At a tick, due sensors measure the true state, the estimator updates, guidance may change the phase, the law
//! computes a torque and the maneuver a force, and allocation turns them into commands. A command acts `delay_s` later,
//! until the next one (zero-order hold) or as pulses. Actuator output is constant over an arc, with friction and limits
//! by its initial state. A tick at the end of a run is the last: the run can launch or fail there, but its commands do
//! not act.
//!
//! Measurements pass from [`super::plant`], the truth, to [`super::flight_software`] and commands back; only this
//! module knows both. `mission` judges the run by the truth, and `growth` its commands.

mod construction;
mod growth;
mod mission;

use std::sync::Arc;

use self::growth::Growth;
use self::mission::{Mission, consistency};
use super::failure::Failure;
use super::flight_software::FlightSoftware;
use super::guidance::Progress;
use super::laws::interface::digits;
use super::outcome::columns::OutcomeColumns;
use super::plant::Plant;
use super::stability::beyond_limit;
use super::tick_times::SAME_TIME;
use super::truth::Truth;
use crate::dynamics::actuation::{Actuation, ActuationLaw, BodyState, WheelState};
use crate::run::Telemetry;

/// Ticks of a loop.
#[derive(Clone, Copy, Debug)]
struct Clock {
    /// Number of the next tick.
    tick: u64,
    /// Sensor ticks in a control period.
    ticks_per_period: u64,
    tick_period: f64,
    next: f64,
    /// Control period and end of the run.
    period: f64,
    end: f64,
}

pub struct ControlLoop {
    columns: Arc<OutcomeColumns>,
    plant: Plant,
    flight_software: FlightSoftware,
    mission: Mission,
    clock: Clock,
    has_ended: bool,
    growth: Growth,
    /// Reason of a divergence, if any.
    divergence: Option<String>,
}

impl ControlLoop {
    fn is_due(&self, time: f64) -> bool {
        !self.has_ended && time >= self.clock.next - SAME_TIME * self.clock.tick_period
    }

    fn at_tick(&mut self, truth: &Truth, is_last: bool) {
        self.flight_software.tick(&self.plant.measure(self.clock.tick, truth));
        if self.clock.tick.is_multiple_of(self.clock.ticks_per_period) {
            self.control(truth, is_last);
        }
        self.clock.tick += 1;
        self.clock.next = self.clock.tick as f64 * self.clock.tick_period;
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
            Progress::Flies => {
                let failure = self.flight_software.command(truth.time, &guided).err();
                failure.inspect(|failure| self.mission.outcome.cannot_go_on(truth.time, *failure))
            }
            Progress::Launches => Some(Failure::None),
            Progress::Fails(failure) => Some(failure),
        };
        self.has_ended = ends.is_some();
        if guided.progress != Progress::Flies
            && let Some(failure) = ends
        {
            let Mission { outcome, criteria, .. } = &mut self.mission;
            outcome.ends(&self.plant.drawn, truth, failure, &criteria.launch);
        }
        if is_judged && guided.progress == Progress::Flies {
            self.mission.outcome.take_telemetry(self.flight_software.law.telemetry());
        }
        self.mission.record((&self.plant, truth), &self.flight_software, &guided);
        // rows have the last tick's value only
        let is_final = truth.time + (1.0 + SAME_TIME) * self.clock.period >= self.clock.end;
        if is_judged && (self.has_ended || is_final) {
            self.mission.outcome.consistency = consistency(&self.plant, truth, &self.flight_software);
        }
    }

    fn arc_from(&mut self, time: f64, body: &BodyState, wheels: &WheelState) -> Actuation {
        let mut commands = self.flight_software.acting(time);
        commands.until = commands.until.min(self.clock.next);
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
        if self.is_due(time) {
            let truth = self.plant.truth(time, body, wheels);
            self.at_tick(&truth, false);
        }
        let actuation = if self.has_ended { Actuation::end_of_run() } else { self.arc_from(time, body, wheels) };
        self.mission.record_over_time(time - SAME_TIME * self.clock.tick_period);
        actuation
    }

    fn end(&mut self, time: f64, body: &BodyState, wheels: &WheelState) {
        if self.is_due(time) {
            let truth = self.plant.truth(time, body, wheels);
            self.at_tick(&truth, true);
            self.mission.record_over_time(time - SAME_TIME * self.clock.tick_period);
        }
    }

    fn report(&self, values: &mut [f64]) {
        let Mission { outcome, criteria, .. } = &self.mission;
        self.columns.report(outcome, &self.flight_software.guidance, criteria, values);
    }

    fn divergence(&self) -> Option<String> {
        self.divergence.clone()
    }

    fn telemetry(&self) -> Option<&Telemetry> {
        self.mission.recorder.as_ref().map(|recorder| &recorder.telemetry)
    }
}
