//! [`ControlLaw`]: a control law of a plan. [`OwnLaw`]: the calling program's.

use std::fmt;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use super::attitude_law::LawKind;
use super::capacity::Capacity;
use super::context::LawContext;
use super::spec::LoopSpec;
use crate::dynamics::actuation::{Actuation, ActuationLaw, BodyState, LawSource, WheelState, actuation_at, sum};
use crate::observables::LawColumns;
use crate::run::Telemetry;
use crate::scene::{Actuated, ControlInput, LawParameter, Scene};

/// A control law of the calling program, for `Session::under`.
///
/// Its name and parameters are part of the plan, hence of the identity of the rows: change the name when you change the
/// law. The law of a run is made at its start and must depend on nothing but its settings and its input in that run.
#[derive(Clone, Debug, PartialEq)]
pub enum OwnLaw {
    /// In place of a loop; `[control]` sets its parameters.
    Loop(ControlLaw),
    /// An attitude law that phases name.
    Phase(LawKind),
}

/// A control law that a campaign flies.
#[derive(Clone)]
pub struct ControlLaw {
    /// Its name, as in `control.law` of a plan.
    pub name: &'static str,
    /// The actuators that it commands, which have columns of work and impulse.
    pub commands: Actuated,
    /// Its parameters, keys of `[control]`.
    pub parameters: &'static [LawParameter],
    /// The columns that it reports at the end of a run ([`ActuationLaw::report`]).
    pub columns: LawColumns,
    make: Arc<dyn LawMaker>,
}

impl ControlLaw {
    /// The law called `name`, which commands `commands`, with the parameters `parameters`; `make` makes the law of a
    /// run, as in `examples/control_campaign.rs`.
    pub fn new<L: ActuationLaw + Send + 'static>(
        name: &'static str,
        commands: Actuated,
        parameters: &'static [LawParameter],
        make: impl Fn(&LawContext<'_>) -> L + Send + Sync + 'static,
    ) -> Self {
        let make = move |context: &LawContext<'_>| -> Box<dyn ActuationLaw + Send> { Box::new(make(context)) };
        ControlLaw { name, commands, parameters, columns: LawColumns::NONE, make: Arc::new(make) }
    }

    /// The loop of a campaign file, made by `maker`, which reports `columns` at the end of a run. Its parameters are
    /// tables of the scene.
    pub fn closed_loop(spec: &LoopSpec, columns: LawColumns, maker: impl LawMaker + 'static) -> Self {
        let commands =
            Actuated { thrusters: !spec.thrusters.is_empty(), motors: !spec.wheels.is_empty(), body_torque: false };
        let columns = LawColumns { over_time: spec.over_time(), ..columns };
        ControlLaw { name: "closed_loop", commands, parameters: &[], columns, make: Arc::new(maker) }
    }

    /// The loop of a campaign file; `None` for a program's own law.
    pub fn spec(&self) -> Option<&LoopSpec> {
        self.make.spec()
    }

    pub fn maker(&self) -> &dyn LawMaker {
        &*self.make
    }

    /// Memory for the laws of one worker's runs.
    pub fn runs(&self) -> LawRuns {
        LawRuns { make: self.make.clone(), laws: Vec::new() }
    }
}

impl fmt::Debug for ControlLaw {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("ControlLaw").field("name", &self.name).finish_non_exhaustive()
    }
}

/// Laws are equal by name, loops of campaign files also by content.
impl PartialEq for ControlLaw {
    fn eq(&self, other: &Self) -> bool {
        self.name == other.name && self.spec() == other.spec()
    }
}

/// Makes the laws of runs.
pub trait LawMaker: Send + Sync {
    /// The law of a run.
    fn law(&self, context: &LawContext<'_>) -> Box<dyn ActuationLaw + Send>;

    /// The loop of a campaign file, if it makes one.
    fn spec(&self) -> Option<&LoopSpec> {
        None
    }

    /// Likely mistakes in the loop, one sentence each, with its nominal numbers `numbers` in the nominal scene `scene`
    /// over `duration` seconds.
    fn notes(&self, _numbers: &ControlInput, _scene: &Scene, _duration: f64) -> Vec<String> {
        Vec::new()
    }

    /// The capacity of the loop in the nominal scene `scene`.
    fn capacity(&self, _scene: &Scene) -> Option<Capacity> {
        None
    }
}

impl<F: Fn(&LawContext<'_>) -> Box<dyn ActuationLaw + Send> + Send + Sync> LawMaker for F {
    fn law(&self, context: &LawContext<'_>) -> Box<dyn ActuationLaw + Send> {
        self(context)
    }
}

/// The laws of a worker's runs, by index; a new run replaces the last one at its index.
pub struct LawRuns {
    make: Arc<dyn LawMaker>,
    laws: Vec<SharedLaw>,
}

/// The law of a run, shared by the engine that propagates it and the code that ends it.
#[derive(Clone)]
pub struct SharedLaw(Arc<Mutex<BesideSchedule>>);

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
    /// Makes the law of run `run`; new indices follow without a gap.
    pub fn begin(&mut self, run: usize, context: &LawContext<'_>) {
        let law = self.make.law(context);
        // both answer at the first arc
        let answers = [Actuation::none(f64::NEG_INFINITY); 2];
        let schedule = if self.make.spec().is_some() { Vec::new() } else { context.drawn.schedule.clone() };
        let divided = (context.parts > 1).then_some((context.parts, context.end));
        let begun = BesideSchedule { schedule, law, answers, divided, held: (answers[0], 0.0) };
        match self.laws.get(run) {
            Some(place) => *place.lock() = begun,
            None => self.laws.push(SharedLaw(Arc::new(Mutex::new(begun)))),
        }
    }

    pub fn shared(&self) -> Vec<SharedLaw> {
        self.laws.clone()
    }

    /// Writes the columns that the law of the completed run `run` reports ([`ControlLaw::columns`]), NaN by
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
    schedule: Vec<crate::scene::Arc>,
    law: Box<dyn ActuationLaw + Send>,
    /// Last arcs of schedule and law.
    answers: [Actuation; 2],
    /// Number of parts of each arc, and the end of the run, s.
    divided: Option<(u32, f64)>,
    /// The arc that is divided, and the length of a part, s.
    held: (Actuation, f64),
}

impl BesideSchedule {
    fn arc(&mut self, time: f64, body: &BodyState, wheels: &WheelState) -> Actuation {
        let Some((parts, end)) = self.divided else { return self.whole_arc(time, body, wheels) };
        if time >= self.held.0.until {
            let arc = self.whole_arc(time, body, wheels);
            self.held = (arc, (arc.until.min(end) - time) / f64::from(parts));
        }
        let (arc, length) = self.held;
        // the last part ends as the arc does
        let is_last = arc.ends_run || time + 1.5 * length >= arc.until.min(end) || time + length <= time;
        Actuation { until: if is_last { arc.until } else { time + length }, ..arc }
    }

    fn whole_arc(&mut self, time: f64, body: &BodyState, wheels: &WheelState) -> Actuation {
        if self.schedule.is_empty() {
            return self.law.arc(time, body, wheels);
        }
        let [scheduled, of_law] = &mut self.answers;
        if time >= scheduled.until {
            *scheduled = actuation_at(&self.schedule, time);
        }
        if time >= of_law.until {
            *of_law = self.law.arc(time, body, wheels);
        }
        sum(scheduled, of_law)
    }
}
