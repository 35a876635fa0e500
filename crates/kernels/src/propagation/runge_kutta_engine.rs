//! Runge-Kutta methods on the gyrostat, as an [`Engine`].

use core::marker::PhantomData;

use fearless_simd::Simd;

use super::arc_source::ArcSource;
use super::engine::{CompletionCallback, Engine};
use super::gyrostat_batch::{DebrisRuns, GyrostatBatch};
use super::gyrostat_runs::GyrostatRuns;
use super::local_error::in_units;
use super::series_remainder::Remainders;
use super::settings::PropagationSettings;
use super::trajectory_recorder::{LaneTrajectory, TrajectoryRecorder};
use crate::dynamics::actuation::Laws;
use crate::dynamics::effects::within_arcs::WithinArcs;
use crate::dynamics::gyrostat::Gyrostat;
use crate::math::Real;
use crate::ode::{ErrorModel, LaneMethod, Tolerance, integrate};
use crate::run::{LocalErrors, Outcome, Trajectory};
use crate::scene::Scene;

/// Memory of a worker, for runs under the effects `E`.
pub struct RungeKuttaEngine<S, R, M, E, const N: usize> {
    simd: S,
    zero: R,
    method: M,
    settings: PropagationSettings,
    batch: GyrostatBatch,
    lanes: Vec<LaneTrajectory>,
    remainders: Option<Remainders>,
    effects: PhantomData<E>,
}

impl<S: Simd, R: Real, M: LaneMethod, E: WithinArcs<R>, const N: usize> RungeKuttaEngine<S, R, M, E, N> {
    pub fn new(simd: S, zero: R, method: M, settings: &PropagationSettings) -> Self {
        let points = settings.grid.points();
        RungeKuttaEngine {
            simd,
            zero,
            method,
            settings: settings.clone(),
            batch: GyrostatBatch::new(settings),
            lanes: LaneTrajectory::for_lanes(R::LANES, N, points),
            remainders: match M::ERRORS {
                ErrorModel::Remainder(remainder) => Some(Remainders::new(remainder)),
                ErrorModel::Estimated(_) => None,
            },
            effects: PhantomData,
        }
    }

    #[inline(always)]
    fn run(&mut self, mut laws: Laws<'_>, scenes: &[Scene], finish: &mut CompletionCallback<'_>) {
        let Self { simd, zero, method, settings, batch, lanes, remainders, .. } = self;
        settings.check_laws(&laws);
        let grid = &settings.grid;
        let mut integrate = |runs: &mut GyrostatRuns<'_, R, E>, finish: &mut RunCallback<'_, R, E>| {
            integrate_on::<S, R, M, E, N>(*simd, *zero, *method, runs, settings, lanes, finish);
        };
        if let Some(DebrisRuns { runs, trajectories, outcomes }) = batch.load_debris(scenes) {
            // one kernel for debris and spacecraft compiles faster, although the debris needs its attitude only
            let mut runs = GyrostatRuns::new(*zero, runs, ArcSource::free(grid.duration()), false);
            integrate(&mut runs, &mut |runs, index, trajectory, outcome| {
                trajectories[index].copy_from(trajectory);
                outcomes[index] = *outcome;
                outcomes[index].local_errors = errors_of(remainders, runs.run(index), trajectory, settings, outcome);
            });
        }
        let arcs = ArcSource::new(scenes, laws.reborrow(), grid);
        let (runs, completion) = batch.load(scenes, &arcs);
        let mut runs = GyrostatRuns::new(*zero, runs, arcs, settings.feedback);
        integrate(&mut runs, &mut |runs, index, trajectory, outcome| {
            let run = runs.run(index);
            let mut outcome = *outcome;
            outcome.local_errors = errors_of(remainders, run, trajectory, settings, &outcome);
            completion.complete(*simd, scenes, index, run, trajectory, &outcome, finish);
        });
    }
}

/// Errors of a run, in units; step control is relative to |omega|, at least absolute/relative tolerance times the rate
/// of the time scale.
fn errors_of(
    remainders: &mut Option<Remainders>,
    run: &Gyrostat<f64>,
    trajectory: &Trajectory,
    settings: &PropagationSettings,
    outcome: &Outcome,
) -> LocalErrors {
    if let Some(remainders) = remainders {
        return remainders.sum(run, trajectory, &settings.grid, outcome);
    }
    let Tolerance { absolute, relative } = settings.control.tolerance;
    let rates = (0..outcome.points).map(|point| trajectory.at(point));
    in_units(outcome.local_errors, rates, absolute / relative / run.time_unit())
}

/// Receives a completed run: runs, index, components at the observation points, outcome.
type RunCallback<'a, R, E> = dyn FnMut(&GyrostatRuns<'_, R, E>, usize, &Trajectory, &Outcome) + 'a;

/// The integration, compiled once for spacecraft and debris.
#[inline(never)]
fn integrate_on<S: Simd, R: Real, M: LaneMethod, E: WithinArcs<R>, const N: usize>(
    simd: S,
    zero: R,
    method: M,
    runs: &mut GyrostatRuns<'_, R, E>,
    settings: &PropagationSettings,
    lanes: &mut [LaneTrajectory],
    finish: &mut RunCallback<'_, R, E>,
) {
    let control = &settings.control;
    let finish = |runs: &GyrostatRuns<'_, R, E>, _, run: usize, trajectory: &Trajectory, outcome: &Outcome| {
        finish(runs, run, trajectory, outcome);
    };
    let mut recorder = TrajectoryRecorder::new(&settings.grid, lanes, M::ERRORS, control.tolerance.relative, finish);
    simd.vectorize(
        #[inline(always)]
        || integrate::<_, _, _, _, N>(method, zero, runs, &mut recorder, control),
    );
}

impl<S: Simd, R: Real + Send, M: LaneMethod + Send, E: WithinArcs<R> + Send, const N: usize> Engine
    for RungeKuttaEngine<S, R, M, E, N>
{
    fn propagate_under(&mut self, laws: Laws<'_>, scenes: &[Scene], finish: &mut CompletionCallback<'_>) {
        let simd = self.simd;
        simd.vectorize(
            #[inline(always)]
            || self.run(laws, scenes, finish),
        );
    }
}
