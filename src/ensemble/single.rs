//! [`SingleRun`]: one sample of a campaign with all its states, as `simulate` shows it; [`run_each`]: several of them.
//!
//! The scene is drawn and propagated by the code that runs campaigns, so that the states are those behind the row.

use std::num::NonZeroUsize;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};

use rayon::ThreadPoolBuilder;

use crate::campaign::{Plan, SceneDraws};
use crate::ensemble::runner::RunError;
use crate::ensemble::settings::{nominal_attitude, propagator};
use crate::math::Isa;
use crate::observables::{Group, Observer, Request, Series};
use crate::propagation::{CompletedRun, Engine};
use crate::run::Outcome;
use crate::run::{Grid, StateField, StateFields, StateTable};
use crate::sampling::SampleId;
use crate::scene::{Scene, SceneError};

/// The groups whose series a time series shows.
const GROUPS: [Group; 5] =
    [Group::EnergyConservation, Group::MomentumConservation, Group::Attitude, Group::Constraints, Group::Energies];

/// One run with its states.
#[derive(Clone, Debug)]
pub struct SingleRun {
    /// The scene that was run.
    pub scene: Scene,
    /// The times of the table's points; the first is zero, whether it was asked for or not.
    pub grid: Grid,
    /// The states.
    pub table: StateTable,
    /// How the run ended.
    pub outcome: Outcome,
    /// Why it is not `ok`; empty where it is.
    pub reason: String,
    /// Energies and conservation errors at the points that were reached.
    pub series: Vec<(Series, Vec<f64>)>,
    /// The row of the sample, as a campaign on this grid has it, with the columns of [`SingleRun::request`].
    pub row: Vec<f64>,
    /// What the row holds.
    pub request: Request,
}

impl SingleRun {
    /// Runs sample `sample` of `plan`, observed at the times of `grid` (which may reach beyond the campaign's duration).
    ///
    /// # Errors
    /// Why the drawn scene is not physical.
    pub fn new(plan: &Plan, sample: SampleId, grid: Grid, isa: Isa) -> Result<Self, Vec<SceneError>> {
        SingleRuns::new(plan, grid, isa).run(sample)
    }

    /// The same with the series of other groups: those of `groups`.
    ///
    /// # Errors
    /// Why the drawn scene is not physical.
    pub fn with_series(
        plan: &Plan,
        sample: SampleId,
        grid: Grid,
        isa: Isa,
        groups: &[Group],
    ) -> Result<Self, Vec<SceneError>> {
        SingleRuns::with_series(plan, grid, isa, groups).run(sample)
    }
}

/// Memory for single runs of one plan on one grid. What an earlier run left in it does not reach a later one.
pub struct SingleRuns<'p> {
    draws: SceneDraws<'p>,
    grid: Grid,
    isa: Isa,
    request: Request,
    engine: Box<dyn Engine>,
    observer: Observer,
    series_observer: Observer,
    /// The columns of the groups that have series.
    ignored: Vec<f64>,
}

impl<'p> SingleRuns<'p> {
    /// Runs of `plan`, observed at the times of `grid`.
    pub fn new(plan: &'p Plan, grid: Grid, isa: Isa) -> Self {
        Self::with_series(plan, grid, isa, &GROUPS)
    }

    /// The same with the series of the groups `groups`.
    pub fn with_series(plan: &'p Plan, grid: Grid, isa: Isa, groups: &[Group]) -> Self {
        let request = plan.request_over(grid.duration());
        let shown = Request { groups: groups.iter().copied().collect(), ..request };
        let fields = states(&request).union(shown.fields()).union(request.fields());
        let nominal = |request: &Request| nominal_attitude(plan, request, &grid, isa);
        SingleRuns {
            draws: SceneDraws::new(plan),
            isa,
            request,
            engine: propagator(plan, grid.clone(), fields).engine(isa),
            observer: Observer::new(request, &grid).with_nominal(nominal(&request)),
            series_observer: Observer::new(shown, &grid).with_nominal(nominal(&shown)),
            ignored: vec![f64::NAN; shown.columns().len()],
            grid,
        }
    }

    /// Runs a sample.
    ///
    /// # Errors
    /// Why the drawn scene is not physical.
    pub fn run(&mut self, sample: SampleId) -> Result<SingleRun, Vec<SceneError>> {
        let scene = self.draws.scene(sample)?;
        let mut row = vec![f64::NAN; self.request.columns().len()];
        let (mut result, mut reason) = (None, String::new());
        let (isa, observer, series_observer) = (self.isa, &mut self.observer, &mut self.series_observer);
        let ignored = &mut self.ignored;
        self.engine.propagate(std::slice::from_ref(&scene), &mut |CompletedRun { table, outcome, .. }| {
            let status = observer.observe(isa, &scene, table, outcome, &mut row);
            series_observer.observe(isa, &scene, table, outcome, ignored);
            reason = observer.reason(status, outcome, &row);
            result = Some((table.clone(), Outcome { status, ..*outcome }));
        });
        let (table, outcome) = result.expect("the propagator finishes every scene that it is given");
        let series = self.series_observer.series().map(|(series, values)| (series, values.collect())).collect();
        Ok(SingleRun { scene, grid: self.grid.clone(), table, outcome, reason, series, row, request: self.request })
    }
}

/// Runs `samples` of `plan` on its own grid, on `threads` threads (`None`: one per core), and shows each run to `seen`, on any thread
/// and in any order; one whose scene is not physical as an error.
///
/// # Errors
/// Where threads could not be started, or the first error of `seen`, after which no run is started.
pub fn run_each<E: Send>(
    plan: &Plan,
    samples: &[SampleId],
    (isa, threads): (Isa, Option<NonZeroUsize>),
    seen: &(dyn Fn(SampleId, Result<SingleRun, Vec<SceneError>>) -> Result<(), E> + Sync),
) -> Result<(), RunError<E>> {
    let pool = ThreadPoolBuilder::new().num_threads(threads.map_or(0, NonZeroUsize::get)).build()?;
    let next = AtomicUsize::new(0);
    let failure: Mutex<Option<E>> = Mutex::new(None);
    pool.broadcast(|_| {
        let mut runs = None;
        while let Some(sample) = samples.get(next.fetch_add(1, Ordering::Relaxed)) {
            let runs = runs.get_or_insert_with(|| SingleRuns::new(plan, plan.grid.clone(), isa));
            if let Err(error) = seen(*sample, runs.run(*sample)) {
                next.store(samples.len(), Ordering::Relaxed);
                failure.lock().unwrap_or_else(PoisonError::into_inner).get_or_insert(error);
            }
        }
    });
    match failure.into_inner().unwrap_or_else(PoisonError::into_inner) {
        Some(error) => Err(RunError::Sink(error)),
        None => Ok(()),
    }
}

/// Every state of scenes of the kind of `request`.
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
