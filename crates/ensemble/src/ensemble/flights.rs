//! [`Flights`], [`ObservedRuns`]: propagate the runs of a plan, under its control law if any.

use crate::campaign::{Plan, event_columns};
use crate::dynamics::actuation::{ActuationLaw, BodyState, Laws, WheelState};
use crate::dynamics::orbit_path::OrbitPath;
use crate::ensemble::loop_errors::LoopErrors;
use crate::ensemble::settings::{Engines, nominal, propagator};
use crate::ensemble::surface;
use crate::loops::loop_record::SharedRecord;
use crate::loops::{LawContext, LawRuns};
use crate::math::Isa;
use crate::math::vector::dot;
use crate::observables::nominal_attitude::NominalAttitude;
use crate::observables::{FlownRun, Group, LawSeries, LoopError, Observer, Request};
use crate::propagation::{CompletedRun, Engine, PropagationSettings};
use crate::run::{Grid, Outcome, StateField, StateFields, StateTable, Status, Telemetry};
use crate::sampling::SampleId;
use crate::scene::{ControlInput, Scene, SceneInput};
use std::slice::from_ref;

/// The draws of a run's law, besides its scene.
#[derive(Clone, Debug)]
pub struct LawDraw {
    pub sample: SampleId,
    pub parameters: ControlInput,
}

impl LawDraw {
    /// For the nominal run; `None` without a law.
    pub fn nominal(plan: &Plan) -> Option<Self> {
        Self::of(plan, SampleId(0), &plan.nominal)
    }

    /// Noise of `sample`, parameters of the `drawn` scene; `None` without a law.
    pub fn of(plan: &Plan, sample: SampleId, drawn: &SceneInput) -> Option<Self> {
        plan.law.as_ref().map(|_| LawDraw { sample, parameters: drawn.control.clone() })
    }
}

#[derive(Clone, Copy)]
pub struct Runs<'a> {
    pub scenes: &'a [Scene],
    /// One for each scene; none without a law.
    pub draws: &'a [LawDraw],
}

impl<'a> Runs<'a> {
    pub fn one(scene: &'a Scene, draw: &'a [LawDraw]) -> Self {
        Runs { scenes: from_ref(scene), draws: draw }
    }
}

pub struct Flights<'p> {
    plan: &'p Plan,
    engine: Box<dyn Engine>,
    /// The laws, and the nominal scene that they know.
    laws: Option<(LawRuns, Scene)>,
    over_time: Vec<SharedRecord>,
    times: Vec<f64>,
    end: f64,
    records: bool,
    parts: u32,
    engines: Engines,
    ends_at_surface: bool,
}

/// Receives a finished run and its law's record at the observation points ([`crate::observables::LawSeries`]).
pub type FlightCallback<'a> = dyn FnMut(CompletedRun<'_>, &[f64]) + 'a;

impl<'p> Flights<'p> {
    pub fn new(plan: &'p Plan, settings: &PropagationSettings, engines: Engines) -> Self {
        Flights {
            plan,
            engine: engines.engine(settings),
            times: settings.grid.times().to_vec(),
            end: settings.grid.duration(),
            laws: plan.law.as_ref().map(|law| (law.runs(), nominal(plan))),
            over_time: Vec::new(),
            records: false,
            parts: 1,
            engines,
            ends_at_surface: plan.nominal.orbit.is_some(),
        }
    }

    pub fn recording(self) -> Self {
        Flights { records: true, ..self }
    }

    /// With each arc of the laws in `parts` parts.
    pub fn divided(self, parts: u32) -> Self {
        Flights { parts, ..self }
    }

    /// The record of the law of run `run` of the last flight.
    pub fn telemetry(&self, run: usize) -> Option<Telemetry> {
        self.laws.as_ref()?.0.telemetry(run)
    }

    pub fn fly(&mut self, runs: Runs<'_>, finish: &mut FlightCallback<'_>) {
        let Runs { scenes, draws } = runs;
        let (plan, times, engines, ends_at_surface) = (self.plan, &self.times, self.engines, self.ends_at_surface);
        let at_surface = |run: &CompletedRun<'_>| {
            let one = Runs::one(&scenes[run.index], draws.get(run.index).map_or(&[][..], from_ref));
            let outcome = ends_at_surface.then(|| at_surface(plan, one, run, times, engines));
            outcome.flatten().unwrap_or(*run.outcome)
        };
        let Some((laws, nominal)) = &mut self.laws else {
            return self.engine.propagate(scenes, &mut |run| {
                finish(CompletedRun { outcome: &at_surface(&run), ..run }, &[]);
            });
        };
        assert_eq!(scenes.len(), draws.len(), "each run has a law");
        let is_recorded = self.plan.law.as_ref().is_some_and(|law| law.columns.over_time != LawSeries::NONE);
        while is_recorded && self.over_time.len() < scenes.len() {
            self.over_time.push(SharedRecord::new(&self.times));
        }
        for (run, (drawn, LawDraw { sample, parameters })) in scenes.iter().zip(draws).enumerate() {
            let nominal_parameters = &self.plan.nominal.control;
            let (sample, seed, records, parts) = (*sample, self.plan.seed, self.records, self.parts);
            let (duration, end) = (self.plan.grid.duration(), self.end);
            laws.begin(
                run,
                &LawContext {
                    nominal,
                    drawn,
                    parameters,
                    nominal_parameters,
                    sample,
                    seed,
                    duration,
                    end,
                    record: self.over_time.get(run),
                    records,
                    parts,
                },
            );
        }
        let over_time = &self.over_time;
        let mut flown = laws.shared();
        self.engine.propagate_under(Laws::Feedback(laws), scenes, &mut |run| {
            let mut outcome = at_surface(&run);
            if outcome.status == Status::NonFinite && flown[run.index].divergence().is_some() {
                outcome.status = Status::Diverged;
            }
            let run = CompletedRun { outcome: &outcome, ..run };
            // observation includes the loop's state at the end
            if run.outcome.status == Status::Done {
                let (body, wheels) = state_at_end(&scenes[run.index], run.table);
                flown[run.index].end(run.outcome.time, &body, &wheels);
            }
            match over_time.get(run.index) {
                Some(record) => finish(run, record.lock().values()),
                None => finish(run, &[]),
            }
        });
    }

    /// Writes the law's report on run `run` of the last flight.
    pub fn report(&self, run: usize, values: &mut [f64]) {
        if let Some((laws, _)) = &self.laws {
            laws.report(run, values);
        }
    }

    /// Why the law ended run `run` of the last flight as [`Status::Diverged`].
    pub fn divergence(&self, run: usize) -> String {
        self.laws.as_ref().and_then(|(laws, _)| laws.shared().get(run)?.divergence()).unwrap_or_default()
    }

    pub fn fly_nominal(&mut self, finish: &mut FlightCallback<'_>) {
        let draw = LawDraw::nominal(self.plan);
        self.fly(Runs::one(&nominal(self.plan), draw.as_slice()), finish);
    }
}

/// The outcome of `run` if it reaches the surface of the central body.
fn at_surface(plan: &Plan, one: Runs<'_>, run: &CompletedRun<'_>, times: &[f64], engines: Engines) -> Option<Outcome> {
    let scene = &one.scenes[0];
    let last = times[times.len() - 1];
    let fields = [StateField::ComPosition, StateField::ComVelocity];
    let mut positions = |asked: &[f64]| -> Vec<[[f64; 3]; 2]> {
        if let (Some(orbit), None) = (&scene.orbit, &scene.offsets) {
            let path = OrbitPath::new(orbit);
            return asked.iter().map(|time| path.state(*time)).map(|at| [at.position, at.velocity]).collect();
        }
        let mut all = [&[0.0], asked, &[last]].concat();
        all.sort_unstable_by(f64::total_cmp);
        all.dedup();
        let observed = fields.into_iter().fold(StateFields::NONE, StateFields::with);
        let settings = propagator(plan, Grid::at(all.clone()), observed);
        let again = Flights::new(plan, &settings, engines);
        let mut found = Vec::new();
        Flights { ends_at_surface: false, ..again }.fly(one, &mut |run, _| {
            let at = |time: &f64| all.partition_point(|other| other < time);
            let state = |point: usize| fields.map(|field| run.table.at(field, point));
            let known = |point: usize| if point < run.outcome.points { state(point) } else { [[f64::NAN; 3]; 2] };
            found.extend(asked.iter().map(|time| known(at(time))));
        });
        found
    };
    let time = surface::contact(scene, run, (times, end_of(run)), &mut positions)?;
    // an event that ends the run earlier shows at the next point
    let after = usize::from(plan.events.iter().any(|event| event.ends_run));
    let points = run.outcome.points.min(times.partition_point(|other| *other < time) + after);
    Some(Outcome { status: Status::Surface, time, points, ..*run.outcome })
}

fn state_at_end(scene: &Scene, table: &StateTable) -> (BodyState, WheelState) {
    let last = table.points() - 1;
    let body = BodyState {
        omega_se_s: table.at(StateField::Rate, last),
        q_es: table.at(StateField::Attitude, last),
        r_co_e: table.at(StateField::ComPosition, last),
        v_co_e: table.at(StateField::ComVelocity, last),
    };
    let mut wheels = WheelState::AT_REST;
    for (i, wheel) in scene.mass.wheels.iter().enumerate() {
        wheels.rates[i] = table.column(StateField::WheelRates, i)[last];
        wheels.angles[i] = table.column(StateField::WheelAngles, i)[last];
        wheels.momenta[i] = wheel.axial * (wheels.rates[i] + dot(wheel.axis, body.omega_se_s));
    }
    (body, wheels)
}

/// The nominal attitude at the times of `grid`, if `request` compares runs with it.
pub fn nominal_attitude(plan: &Plan, request: &Request, grid: &Grid, isa: Isa) -> Option<NominalAttitude> {
    if !request.groups.contains(Group::Motion) {
        return None;
    }
    let mut found = None;
    let settings = propagator(plan, grid.clone(), StateFields::NONE.with(StateField::Attitude));
    Flights::new(plan, &settings, Engines::of(isa)).fly_nominal(&mut |run, _| {
        found = Some(NominalAttitude::of(run.table, run.outcome));
    });
    found
}

/// Observes a run into `row`, with its arcs under a law or the schedule, and failed devices.
pub fn observe(
    plan: &Plan,
    observer: &mut Observer,
    isa: Isa,
    scene: &Scene,
    (run, of_law): (&CompletedRun<'_>, &[f64]),
    row: &mut [f64],
) -> Status {
    let status = match plan.law {
        None => observer.observe(isa, scene, run.table, run.outcome, row),
        Some(_) => {
            observer.observe_flown(isa, &FlownRun { scene, arcs: run.arcs, of_law }, run.table, run.outcome, row)
        }
    };
    if !scene.failures.is_empty() {
        let request = observer.request();
        let start = row.len() - request.windows.len() - request.of_law.of_events;
        let reaches_end = matches!(status, Status::Done | Status::Inaccurate);
        let end = if reaches_end { end_of(run) } else { f64::NAN };
        for (failure, columns) in scene.failures.iter().zip(row[start..].chunks_exact_mut(event_columns::EACH)) {
            let time = if failure.at_s < end { failure.at_s } else { f64::NAN };
            let happened = if reaches_end { f64::from(u8::from(failure.at_s < end)) } else { f64::NAN };
            columns.copy_from_slice(&[time, happened]);
        }
    }
    status
}

/// The end of a run, s: of the grid, or by its law.
pub fn end_of(run: &CompletedRun<'_>) -> f64 {
    let of_law = run.arcs.last().filter(|arc| arc.applied.ends_run).map(|arc| arc.start);
    of_law.map_or(run.outcome.time, |end| end.min(run.outcome.time))
}

#[derive(Clone, Copy, Debug)]
pub struct Means<'p> {
    pub plan: &'p Plan,
    pub request: Request,
    pub engines: Engines,
}

impl<'p> Means<'p> {
    /// With the campaign's columns.
    pub fn new(plan: &'p Plan, engines: Engines) -> Self {
        Means { plan, request: plan.request(), engines }
    }

    /// [`nominal_attitude`] of its request.
    pub fn nominal_attitude(self, grid: &Grid) -> Option<NominalAttitude> {
        nominal_attitude(self.plan, &self.request, grid, self.engines.isa)
    }

    pub fn runs(self, grid: &Grid) -> ObservedRuns<'p> {
        self.runs_with(grid, self.request.fields(), self.nominal_attitude(grid))
    }

    /// Runs with the states `fields`, compared with the `nominal` attitude if known.
    pub fn runs_with(self, grid: &Grid, fields: StateFields, nominal: Option<NominalAttitude>) -> ObservedRuns<'p> {
        let settings = propagator(self.plan, grid.clone(), fields);
        ObservedRuns {
            means: self,
            flights: Flights::new(self.plan, &settings, self.engines),
            observer: Observer::new(self.request, grid).with_nominal(nominal),
            row: vec![f64::NAN; self.request.columns().len()],
            errors: LoopErrors::default(),
            of_nominal: None,
        }
    }
}

/// What the loop does to the errors of a run.
pub type Judge<'p> = Box<dyn Fn(&CompletedRun<'_>) -> LoopError + 'p>;

/// Runs of one plan on one grid, independent of earlier ones.
pub struct ObservedRuns<'p> {
    pub means: Means<'p>,
    pub flights: Flights<'p>,
    observer: Observer,
    row: Vec<f64>,
    /// Runs under a law are judged by these errors, if known.
    pub errors: LoopErrors,
    /// Set for flights of the nominal run alone.
    of_nominal: Option<Option<Judge<'p>>>,
}

pub struct ObservedRun<'a> {
    pub run: CompletedRun<'a>,
    pub of_law: &'a [f64],
    pub status: Status,
    pub observer: &'a Observer,
    pub row: &'a [f64],
}

impl<'p> ObservedRuns<'p> {
    /// For the nominal run alone, which is compared with itself, and judged by `judge`.
    #[must_use]
    pub fn of_nominal(self, judge: Option<Judge<'p>>) -> Self {
        ObservedRuns { of_nominal: Some(judge), ..self }
    }

    #[must_use]
    pub fn judged(self, errors: LoopErrors) -> Self {
        ObservedRuns { errors, ..self }
    }

    pub fn fly(&mut self, runs: Runs<'_>, finish: &mut dyn FnMut(ObservedRun<'_>)) {
        let ObservedRuns { means: Means { plan, request, engines }, flights, observer, row, errors, of_nominal } = self;
        flights.fly(runs, &mut |run, of_law| {
            if let Some(judge) = of_nominal {
                if request.groups.contains(Group::Motion) {
                    observer.set_nominal(NominalAttitude::of(run.table, run.outcome));
                }
                errors.nominal = judge.as_ref().map(|judge| judge(&run));
            }
            observer.set_loop_error(runs.draws.get(run.index).and_then(|draw| errors.of(draw.sample)));
            let status = observe(plan, observer, engines.isa, &runs.scenes[run.index], (&run, of_law), row);
            finish(ObservedRun { run, of_law, status, observer, row });
        });
    }
}
