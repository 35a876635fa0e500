//! [`SingleRun`]: a sample with all its states; [`run_each`]: several. They are drawn and propagated as in campaigns.

use super::threads::{Threads, unpoisoned};
use crate::campaign::{Plan, SceneDraws};
use crate::ensemble::audit::{Audit, Auditor, NoAudit};
use crate::ensemble::event_finder::{self, EndFinder, EventFinder, RunEnd};
use crate::ensemble::flights::{LawDraw, Means, ObservedRun, ObservedRuns, Runs, nominal_attitude, observe};
use crate::ensemble::loop_errors::LoopErrors;
use crate::ensemble::pilots::{Pilots, measured};
use crate::ensemble::runner::RunError;
use crate::ensemble::settings::Engines;
use crate::ensemble::supervision::Alone;
use crate::math::Isa;
use crate::observables::nominal_attitude::NominalAttitude;
use crate::observables::{Group, Observer, Request, Series};
use crate::run::{Grid, Outcome, StateField, StateFields, StateTable, Status, Telemetry, points_to};
use crate::sampling::SampleId;
use crate::scene::{Arc, Scene, SceneError};
use rayon::ThreadPoolBuilder;
use std::num::NonZeroUsize;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

const GROUPS: [Group; 6] = [
    Group::EnergyConservation,
    Group::MomentumConservation,
    Group::Attitude,
    Group::Constraints,
    Group::Energies,
    Group::EnergiesCom,
];

#[derive(Clone, Debug)]
pub struct SingleRun {
    pub scene: Scene,
    /// From zero.
    pub grid: Grid,
    pub table: StateTable,
    pub arcs: Vec<Arc>,
    pub outcome: Outcome,
    pub reason: String,
    /// Up to the points reached.
    pub series: Vec<(Series, Vec<f64>)>,
    pub telemetry: Telemetry,
    /// The row in a campaign on this grid, with the columns of [`SingleRun::request`].
    pub row: Vec<f64>,
    pub request: Request,
    draw: Option<LawDraw>,
    errors: LoopErrors,
    end: Option<RunEnd>,
}

impl SingleRun {
    /// Runs `sample` at the times of `grid`, also beyond the campaign's duration.
    ///
    /// # Errors
    /// The drawn scene is not physical.
    pub fn new(plan: &Plan, sample: SampleId, grid: Grid, isa: Isa) -> Result<Self, Vec<SceneError>> {
        let is_nominal = sample == SampleId(0);
        let is_judged = plan.request().groups.contains(Group::Numerics);
        let requests = requests(plan, &grid, &GROUPS);
        let ends = EndFinder::new(plan, Engines::of(isa));
        if is_nominal && grid == plan.grid && ends.is_none() {
            let mut runs = SingleRuns::without_ends(plan, grid, isa, requests, (None, false));
            runs.runs = runs.runs.of_nominal(Pilots::of_nominal(plan, isa).map(Pilots::judge));
            return runs.run(sample);
        }
        let mut runs = SingleRuns { ends, ..SingleRuns::compared(plan, grid, isa, requests, false) };
        runs.runs.errors = measured(plan, isa, [is_nominal, !is_nominal].map(|of_run| of_run && is_judged), &Alone);
        runs.run(sample)
    }

    /// Compares the run with the reference solution; under a control law, with the same loop at a tighter tolerance.
    ///
    /// # Errors
    /// A failure of the run or its reference solution, or the limit of work.
    pub fn audit(&self, plan: &Plan, isa: Isa) -> Result<Audit, NoAudit> {
        let run = Runs::one(&self.scene, self.draw.as_slice());
        let is_known = self.request.groups.contains(Group::Numerics);
        let is_nominal = self.draw.as_ref().is_some_and(|draw| draw.sample == SampleId(0));
        let errors = if is_known { self.errors } else { measured(plan, isa, [is_nominal, !is_nominal], &Alone) };
        let mut auditor = Auditor::new(plan, isa, &self.grid).under(errors);
        auditor.audit_flown(run, self.end, &[self.outcome.status]).swap_remove(0)
    }
}

/// Runs of one plan on one grid, independent of earlier ones.
pub struct SingleRuns<'p> {
    draws: SceneDraws<'p>,
    grid: Grid,
    isa: Isa,
    request: Request,
    shown: Request,
    ends: Option<EndFinder<'p>>,
    plan: &'p Plan,
    is_replay: bool,
    runs: ObservedRuns<'p>,
    series_observer: Observer,
    events: Option<EventFinder<'p>>,
    ignored: Vec<f64>,
    ended: Option<RunEnd>,
}

impl<'p> SingleRuns<'p> {
    /// Runs with the series of `groups` at the times of `grid`; replays are without differences from the nominal run
    /// and times of events, which only rows have.
    pub fn new(plan: &'p Plan, grid: Grid, isa: Isa, groups: &[Group], is_replay: bool) -> Self {
        let requests = requests(plan, &grid, groups);
        let ends = EndFinder::new(plan, Engines::of(isa));
        SingleRuns { ends, ..Self::compared(plan, grid, isa, requests, is_replay) }
    }

    /// For runs that no event ends, compared with the nominal one unless they are replays.
    fn compared(plan: &'p Plan, grid: Grid, isa: Isa, requests: [Request; 2], is_replay: bool) -> Self {
        let mut compared = requests.iter().filter(|_| !is_replay);
        let nominal = compared.find_map(|request| nominal_attitude(plan, request, &grid, isa));
        Self::without_ends(plan, grid, isa, requests, (nominal, is_replay))
    }

    /// For requests of rows and of series; no event ends the runs.
    fn without_ends(
        plan: &'p Plan,
        grid: Grid,
        isa: Isa,
        requests: [Request; 2],
        (nominal, is_replay): (Option<NominalAttitude>, bool),
    ) -> Self {
        let [request, shown] = requests;
        let fields = states(&request).union(shown.fields()).union(request.fields());
        let engines = Engines::of(isa);
        let mut runs = Means { plan, request, engines }.runs_with(&grid, fields, nominal.clone());
        runs.flights = runs.flights.recording();
        let events = if is_replay { None } else { EventFinder::new(plan, &grid, engines) };
        SingleRuns {
            draws: SceneDraws::new(plan),
            plan,
            isa,
            request,
            shown,
            ends: None,
            ended: None,
            is_replay,
            runs,
            series_observer: Observer::new(shown, &grid).with_nominal(nominal),
            events: events.map(|events| events.ended_by(None)),
            ignored: vec![f64::NAN; shown.columns().len()],
            grid,
        }
    }

    /// # Errors
    /// The drawn scene is not physical.
    pub fn run(&mut self, sample: SampleId) -> Result<SingleRun, Vec<SceneError>> {
        self.run_with_noise_of(sample, sample)
    }

    /// Runs the scene of `sample` with the loop noise of the sample `noise`.
    ///
    /// # Errors
    /// The drawn scene is not physical.
    pub fn run_with_noise_of(&mut self, sample: SampleId, noise: SampleId) -> Result<SingleRun, Vec<SceneError>> {
        let scene = self.draws.scene(sample)?;
        let plan = self.plan;
        let draw = LawDraw::of(plan, noise, self.draws.drawn());
        let end = self.ends.as_mut().and_then(|ends| ends.end(&scene, draw.as_slice()));
        let Some(end) = end.filter(|end| end.time <= self.grid.duration()) else {
            return Ok(self.fly(Runs::one(&scene, draw.as_slice())).swap_remove(0));
        };
        let grid = end.grid(&self.grid).0;
        let mut ended = Self::compared(plan, grid, self.isa, [self.request, self.shown], self.is_replay);
        (ended.runs.errors, ended.ended) = (self.runs.errors, Some(end));
        ended.events = ended.events.map(|events| events.ended_by(Some(end)));
        Ok(ended.fly(Runs::one(&scene, draw.as_slice())).swap_remove(0))
    }

    /// Runs samples side by side, faster and with the same bits.
    pub fn run_all(&mut self, samples: &[SampleId]) -> Vec<Result<SingleRun, Vec<SceneError>>> {
        if self.ends.is_some() {
            return samples.iter().map(|sample| self.run(*sample)).collect();
        }
        let mut draws = Vec::new();
        let drawn: Vec<Result<Scene, Vec<SceneError>>> = samples
            .iter()
            .map(|sample| {
                let scene = self.draws.scene(*sample)?;
                draws.extend(LawDraw::of(self.plan, *sample, self.draws.drawn()));
                Ok(scene)
            })
            .collect();
        let scenes: Vec<Scene> = drawn.iter().flatten().cloned().collect();
        let mut flown = self.fly(Runs { scenes: &scenes, draws: &draws }).into_iter();
        drawn.into_iter().map(|scene| scene.map(|_| flown.next().expect("a run of each scene"))).collect()
    }

    fn fly(&mut self, runs: Runs<'_>) -> Vec<SingleRun> {
        let (isa, series_observer) = (self.isa, &mut self.series_observer);
        let (plan, ignored, events, grid) = (self.plan, &mut self.ignored, &mut self.events, &self.grid);
        let (request, end) = (self.request, self.ended);
        let mut flown: Vec<Option<SingleRun>> = vec![None; runs.scenes.len()];
        if let Some(events) = events {
            events.restart(runs.scenes.len());
        }
        self.runs.fly(runs, &mut |ObservedRun { run, of_law, status, observer, row }| {
            let scene = &runs.scenes[run.index];
            if let Some(events) = events {
                events.look(&run, observer, status);
            }
            let reason = observer.reason(status, run.outcome, row);
            observe(plan, series_observer, isa, scene, (&run, of_law), ignored);
            let series = series_observer.series().map(|(series, values)| (series, values.collect())).collect();
            flown[run.index] = Some(SingleRun {
                scene: scene.clone(),
                grid: grid.clone(),
                table: run.table.clone(),
                arcs: run.arcs.to_vec(),
                outcome: Outcome { status, ..*run.outcome },
                reason,
                series,
                telemetry: Telemetry::default(),
                row: row.to_vec(),
                request,
                draw: runs.draws.get(run.index).cloned(),
                errors: LoopErrors::default(),
                end,
            });
        });
        let every = "the propagator finishes every scene that it is given";
        let mut flown: Vec<SingleRun> = flown.into_iter().map(|run| run.expect(every)).collect();
        let is_located = |run: &SingleRun| matches!(run.outcome.status, Status::Done | Status::Inaccurate);
        if let Some(events) = events.as_mut().filter(|_| flown.iter().any(is_located)) {
            events.locate(runs);
        }
        for (index, run) in flown.iter_mut().enumerate() {
            let outcome = &mut run.outcome;
            if let Some(end) = run.arcs.last().filter(|arc| arc.applied.ends_run).map(|arc| arc.start) {
                outcome.points = outcome.points.min(points_to(grid.times(), end));
            }
            match outcome.status {
                Status::Done | Status::Inaccurate => {
                    self.runs.flights.report(index, &mut run.row[request.places_of_law()]);
                    if let Some(events) = events {
                        let places = event_finder::places(plan, &request);
                        let values = events.values(index);
                        run.row[places].iter_mut().zip(values).for_each(|(place, value)| *place = value);
                    }
                }
                Status::Surface => {
                    outcome.points = outcome.points.min(grid.times().partition_point(|time| *time <= outcome.time));
                }
                Status::Diverged => run.reason = self.runs.flights.divergence(index),
                _ => {}
            }
            run.telemetry = self.runs.flights.telemetry(index).unwrap_or_default();
            run.errors = self.runs.errors;
        }
        flown
    }

    /// The last draw, in the order of [`crate::sampling::Dispersions::columns`].
    pub fn applied(&self) -> &[f64] {
        self.draws.applied()
    }
}

/// The requests of rows and of the series of `groups`.
fn requests(plan: &Plan, grid: &Grid, groups: &[Group]) -> [Request; 2] {
    let request = plan.request_over(grid.duration());
    [request, Request { groups: groups.iter().copied().collect(), ..request }]
}

/// The results of `job` on `samples`, in order, on `threads` threads.
///
/// # Errors
/// A failure to start threads, or the first error of `job`, after which no job starts.
pub fn run_each<T: Send, E: Send>(
    plan: &Plan,
    samples: &[SampleId],
    (isa, threads): (Isa, Threads),
    job: &(dyn Fn(&mut SingleRuns<'_>, SampleId) -> Result<T, E> + Sync),
) -> Result<Vec<T>, RunError<E>> {
    let pool = ThreadPoolBuilder::new().num_threads(threads.map_or(0, NonZeroUsize::get)).build()?;
    let next = AtomicUsize::new(0);
    let made: Mutex<Result<Vec<(usize, T)>, E>> = Mutex::new(Ok(Vec::with_capacity(samples.len())));
    pool.broadcast(|_| {
        let mut runs = None;
        loop {
            let place = next.fetch_add(1, Ordering::Relaxed);
            let Some(sample) = samples.get(place) else { break };
            let runs = runs.get_or_insert_with(|| SingleRuns::new(plan, plan.grid.clone(), isa, &GROUPS, false));
            let result = job(runs, *sample);
            let mut made = unpoisoned(made.lock());
            match (&mut *made, result) {
                (Ok(list), Ok(one)) => list.push((place, one)),
                (Ok(_), Err(error)) => {
                    next.store(samples.len(), Ordering::Relaxed);
                    *made = Err(error);
                }
                (Err(_), _) => {}
            }
        }
    });
    let mut list = unpoisoned(made.into_inner()).map_err(RunError::Sink)?;
    list.sort_unstable_by_key(|(place, _)| *place);
    Ok(list.into_iter().map(|(_, one)| one).collect())
}

pub fn states(request: &Request) -> StateFields {
    let spacecraft = [
        StateField::Rate,
        StateField::Attitude,
        StateField::WheelRates,
        StateField::WheelAngles,
        StateField::ComPosition,
        StateField::ComVelocity,
    ];
    let debris =
        [StateField::DebrisPosition, StateField::DebrisVelocity, StateField::DebrisAttitude, StateField::DebrisRate];
    let constrained: &[StateField] = if request.constrained { &[StateField::Dcm] } else { &[] };
    let debris: &[StateField] = if request.debris { &debris } else { &[] };
    spacecraft.iter().chain(debris).chain(constrained).fold(StateFields::NONE, |fields, field| fields.with(*field))
}
