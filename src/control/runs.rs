//! [`LawRuns`]: the laws of the runs that an engine propagates together, each beside the schedule of its scene.

use std::sync::Arc as Shared;

use super::context::LawContext;
use crate::dynamics::actuation::{Actuation, ActuationLaw, BodyState, LawSource, OpenLoop, WheelState, sum};
use crate::run::Telemetry;
use crate::scene::Arc;

/// The laws of the runs of a worker, by the index of the run.
pub trait LawRuns: LawSource + Send {
    /// Makes the law of run `run`, which starts. Indices are given from zero on, without a gap.
    fn begin(&mut self, run: usize, context: &LawContext<'_>);

    /// Writes what the law of run `run`, which has ended, reports: the values of [`super::ControlLaw::columns`], NaN where it has none.
    fn report(&mut self, run: usize, values: &mut [f64]) {
        values.fill(f64::NAN);
        self.law(run).report(values);
    }

    /// What the law of run `run` has recorded.
    fn telemetry(&mut self, run: usize) -> Option<&Telemetry> {
        self.law(run).telemetry()
    }
}

/// Laws made by `make`; what an earlier run has left in a place is replaced.
pub(super) struct Runs<F, L> {
    make: Shared<F>,
    laws: Vec<BesideSchedule<L>>,
}

impl<F, L> Runs<F, L> {
    pub(super) fn new(make: Shared<F>) -> Self {
        Runs { make, laws: Vec::new() }
    }
}

impl<F, L: ActuationLaw> LawSource for Runs<F, L> {
    fn law(&mut self, run: usize) -> &mut dyn ActuationLaw {
        &mut self.laws[run]
    }
}

impl<F: Fn(&LawContext<'_>) -> L + Send + Sync, L: ActuationLaw + Send> LawRuns for Runs<F, L> {
    fn begin(&mut self, run: usize, context: &LawContext<'_>) {
        let law = (self.make)(context);
        // both are asked at the first arc
        let answers = [Actuation::none(f64::NEG_INFINITY); 2];
        match self.laws.get_mut(run) {
            Some(place) => {
                place.schedule.clone_from(&context.drawn.schedule);
                (place.law, place.answers) = (law, answers);
            }
            None => self.laws.push(BesideSchedule { schedule: context.drawn.schedule.clone(), law, answers }),
        }
    }
}

/// A law, and the schedule of the scene, whose commands add to those of the law.
struct BesideSchedule<L> {
    schedule: Vec<Arc>,
    law: L,
    /// The last answers of schedule and law.
    answers: [Actuation; 2],
}

impl<L: ActuationLaw> ActuationLaw for BesideSchedule<L> {
    fn arc(&mut self, time: f64, body: &BodyState, wheels: &WheelState) -> Actuation {
        if self.schedule.is_empty() {
            return self.law.arc(time, body, wheels);
        }
        let [scheduled, of_law] = &mut self.answers;
        if time >= scheduled.until {
            *scheduled = OpenLoop { schedule: &self.schedule }.at(time);
        }
        if time >= of_law.until {
            *of_law = self.law.arc(time, body, wheels);
        }
        sum(scheduled, of_law)
    }

    fn end(&mut self, time: f64, body: &BodyState, wheels: &WheelState) {
        self.law.end(time, body, wheels);
    }

    fn report(&self, values: &mut [f64]) {
        self.law.report(values);
    }

    fn telemetry(&self) -> Option<&Telemetry> {
        self.law.telemetry()
    }
}
