//! [`LawRuns`]: the laws of runs that an engine propagates together. Each law acts beside its scene's schedule, except
//! that a control loop applies the schedule itself.

use std::sync::{Arc as Shared, Mutex, MutexGuard, PoisonError};

use super::context::LawContext;
use crate::dynamics::actuation::{Actuation, ActuationLaw, BodyState, LawSource, OpenLoop, WheelState, sum};
use crate::run::Telemetry;
use crate::scene::Arc;

/// Makes the law of a run.
pub type LawMaker = dyn Fn(&LawContext<'_>) -> Box<dyn ActuationLaw + Send> + Send + Sync;

/// The laws of a worker's runs, by index; a new run replaces the last one at its index.
pub struct LawRuns {
    make: Shared<LawMaker>,
    take_schedule: bool,
    laws: Vec<SharedLaw>,
}

/// The law of a run, shared by the engine that propagates it and the code that ends it.
#[derive(Clone)]
pub struct SharedLaw(Shared<Mutex<BesideSchedule>>);

impl SharedLaw {
    fn lock(&self) -> MutexGuard<'_, BesideSchedule> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl ActuationLaw for SharedLaw {
    fn arc(&mut self, time: f64, body: &BodyState, wheels: &WheelState) -> Actuation {
        self.lock().arc(time, body, wheels)
    }

    fn end(&mut self, time: f64, body: &BodyState, wheels: &WheelState) {
        self.lock().law.end(time, body, wheels);
    }

    fn divergence(&self) -> Option<String> {
        self.lock().law.divergence()
    }
}

impl LawRuns {
    pub(super) fn new(make: Shared<LawMaker>, take_schedule: bool) -> Self {
        LawRuns { make, take_schedule, laws: Vec::new() }
    }

    /// Makes the law of run `run`; new indices follow without a gap.
    pub fn begin(&mut self, run: usize, context: &LawContext<'_>) {
        let law = (self.make)(context);
        // both answer at the first arc
        let answers = [Actuation::none(f64::NEG_INFINITY); 2];
        let schedule = if self.take_schedule { Vec::new() } else { context.drawn.schedule.clone() };
        let begun = BesideSchedule { schedule, law, answers };
        match self.laws.get(run) {
            Some(place) => *place.lock() = begun,
            None => self.laws.push(SharedLaw(Shared::new(Mutex::new(begun)))),
        }
    }

    pub fn shared(&self) -> Vec<SharedLaw> {
        self.laws.clone()
    }

    /// Writes the columns that the law of the completed run `run` reports ([`super::ControlLaw::columns`]), NaN by
    /// default.
    pub fn report(&self, run: usize, values: &mut [f64]) {
        values.fill(f64::NAN);
        self.laws[run].lock().law.report(values);
    }

    pub fn telemetry(&self, run: usize) -> Option<Telemetry> {
        self.laws[run].lock().law.telemetry().cloned()
    }
}

impl LawSource for LawRuns {
    fn law(&mut self, run: usize) -> &mut dyn ActuationLaw {
        &mut self.laws[run]
    }
}

/// A law beside the scene's schedule; their commands add.
struct BesideSchedule {
    schedule: Vec<Arc>,
    law: Box<dyn ActuationLaw + Send>,
    /// Last arcs of schedule and law.
    answers: [Actuation; 2],
}

impl BesideSchedule {
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
}
