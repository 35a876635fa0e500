//! Berdoz's null-space formulation with Dormand-Prince 5(4), as an [`Engine`].

use fearless_simd::Simd;

use super::engine::{CompletedRun, CompletionCallback, Engine};
use super::local_error::{fastest, in_units};
use super::null_space_runs::NullSpaceRuns;
use super::settings::PropagationSettings;
use super::trajectory_recorder::{LaneTrajectory, TrajectoryRecorder};
use crate::dynamics::actuation::Laws;
use crate::dynamics::arc_record::ArcRecord;
use crate::dynamics::null_space::{complete, components};
use crate::ode::{Adaptive, DormandPrinceRestepped, LaneMethod, integrate};
use crate::run::{LocalErrors, Outcome, StateField, StateTable, Trajectory};
use crate::scene::{MAX_WHEELS, Scene};

/// Points inside a step take a step of their own, cheap next to the right-hand side.
type Pair = Adaptive<DormandPrinceRestepped>;

pub const TWO_WHEELS: usize = components(2);
/// Components for the largest number of wheels.
pub const ALL_WHEELS: usize = components(MAX_WHEELS);

/// Memory of a worker, for kernels of `W` wheels and `N` components.
pub struct NullSpaceEngine<S, const W: usize, const N: usize> {
    simd: S,
    settings: PropagationSettings,
    lanes: Vec<LaneTrajectory>,
    table: StateTable,
    arcs: ArcRecord,
}

impl<S: Simd, const W: usize, const N: usize> NullSpaceEngine<S, W, N> {
    pub fn new(simd: S, settings: &PropagationSettings) -> Self {
        let points = settings.grid.points();
        NullSpaceEngine {
            simd,
            settings: settings.clone(),
            lanes: LaneTrajectory::for_lanes(1, N, points),
            table: StateTable::new(settings.fields, settings.wheels, points),
            arcs: ArcRecord::default(),
        }
    }

    #[inline(always)]
    fn run(&mut self, mut laws: Laws<'_>, scenes: &[Scene], finish: &mut CompletionCallback<'_>) {
        if scenes.is_empty() {
            return;
        }
        let Self { settings, lanes, table, arcs, .. } = self;
        settings.check_laws(&laws);
        let (grid, control) = (&settings.grid, &settings.control);
        let mut runs = NullSpaceRuns::<W>::new(scenes, laws.reborrow(), grid.duration(), std::mem::take(arcs));
        let mut recorder = TrajectoryRecorder::new(
            grid,
            lanes,
            Pair::ERRORS,
            control.tolerance.relative,
            |runs: &NullSpaceRuns<'_, W>, _, index, trajectory: &Trajectory, outcome: &Outcome| {
                complete::<W, N>(&scenes[index], trajectory, grid, table);
                table.pad();
                let mut outcome = *outcome;
                outcome.debris_errors = of_debris(&outcome.local_errors, table);
                outcome.local_errors = of_body(&outcome.local_errors, table, grid.duration());
                // errors of the other states feed back into omega; nothing feeds back into the rate of the debris,
                // which is free
                outcome.local_errors.feedback = outcome.local_errors.truncation;
                finish(CompletedRun { index, table, outcome: &outcome, arcs: runs.arcs() });
            },
        );
        integrate::<_, _, _, _, N>(Adaptive(DormandPrinceRestepped), 0.0, &mut runs, &mut recorder, control);
        *arcs = runs.into_arcs();
    }
}

/// Power of a body's rate in the error of a step, which local extrapolation continues at order five.
const ORDER: i32 = 6;

fn rates(table: &StateTable, field: StateField) -> impl Iterator<Item = [f64; 3]> + '_ {
    (0..if table.has(field) { table.points() } else { 0 }).map(move |point| table.at(field, point))
}

/// Errors of the debris, from those of steps that follow the faster body.
fn of_debris(errors: &LocalErrors, table: &StateTable) -> LocalErrors {
    let ratio = fastest(rates(table, StateField::DebrisRate)) / fastest(rates(table, StateField::Rate));
    let share = if ratio < 1.0 { (0..ORDER).fold(1.0, |power, _| power * ratio) } else { 1.0 };
    let [truncation, attitude, dense] = [errors.truncation, errors.attitude, errors.dense].map(|error| share * error);
    let errors = LocalErrors { truncation, attitude, dense, ..*errors };
    in_units(errors, rates(table, StateField::DebrisRate), 0.0)
}

/// Errors of the body in a run of `duration` seconds, from those of steps that mostly follow faster wheels: the
/// attitude's is at most proportional to the body's turn, below a radian.
fn of_body(errors: &LocalErrors, table: &StateTable, duration: f64) -> LocalErrors {
    let share = (fastest(rates(table, StateField::Rate)) * duration).min(1.0);
    let (attitude, dense) = ((share * errors.attitude).max(errors.rounding), share * errors.dense);
    in_units(LocalErrors { attitude, dense, ..*errors }, rates(table, StateField::Rate), 0.0)
}

impl<S: Simd, const W: usize, const N: usize> Engine for NullSpaceEngine<S, W, N> {
    fn propagate_under(&mut self, laws: Laws<'_>, scenes: &[Scene], finish: &mut CompletionCallback<'_>) {
        let simd = self.simd;
        simd.vectorize(
            #[inline(always)]
            || self.run(laws, scenes, finish),
        );
    }
}
