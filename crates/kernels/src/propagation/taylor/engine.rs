//! Taylor and periodic propagation as an [`Engine`].

use core::marker::PhantomData;

use fearless_simd::Simd;

use super::driver::integrate;
use super::lanes::RunCallback;
use super::workspace::{Settings, Workspace};
use crate::dynamics::actuation::Laws;
use crate::dynamics::effects::ChangingSeries;
use crate::dynamics::effects::within_arcs::{NoEffects, WithinArcs};
use crate::dynamics::gyrostat::{Gyrostat, WITH_ATTITUDE};
use crate::math::Real;
use crate::propagation::arc_source::ArcSource;
use crate::propagation::engine::{CompletionCallback, Engine};
use crate::propagation::gyrostat_batch::{DebrisRuns, GyrostatBatch};
use crate::propagation::method::Method;
use crate::propagation::settings::PropagationSettings;
use crate::run::Grid;
use crate::scene::Scene;

/// Memory of a worker for `N` components, the first `J` with series of their own, under the effects `E`.
pub struct TaylorEngine<S, R, E, const N: usize, const J: usize, const FORCED: bool> {
    simd: S,
    zero: R,
    plan: PropagationSettings,
    batch: GyrostatBatch,
    workspace: Workspace<R, J>,
    debris_workspace: Option<Workspace<R, WITH_ATTITUDE>>,
    effects: PhantomData<E>,
}

impl<S: Simd, R: Real + Send + 'static, E: WithinArcs<R>, const N: usize, const J: usize, const FORCED: bool>
    TaylorEngine<S, R, E, N, J, FORCED>
{
    /// Memory for the runs of `plan`, in the lanes of `zero`.
    pub fn new(simd: S, zero: R, plan: &PropagationSettings) -> Self {
        let mut own = settings(plan);
        own.periodic &= !E::ACT;
        let mut workspace = Workspace::new(zero, own, N, plan.grid.points());
        if E::ACT {
            workspace.effects = ChangingSeries::new(zero, workspace.rule.order);
        }
        TaylorEngine {
            simd,
            zero,
            plan: plan.clone(),
            batch: GyrostatBatch::new(plan),
            workspace,
            debris_workspace: None,
            effects: PhantomData,
        }
    }

    #[inline(always)]
    fn run(&mut self, mut laws: Laws<'_>, scenes: &[Scene], finish: &mut CompletionCallback<'_>) {
        let Self { simd, zero, plan, batch, workspace, debris_workspace, .. } = self;
        plan.check_laws(&laws);
        let grid = &plan.grid;
        if let Some(DebrisRuns { runs, trajectories, outcomes }) = batch.load_debris(scenes) {
            let workspace = debris_workspace
                .get_or_insert_with(|| Workspace::new(*zero, settings(plan), WITH_ATTITUDE, grid.points()));
            let arcs = ArcSource::free(grid.duration());
            integrate_on::<S, R, NoEffects, WITH_ATTITUDE, WITH_ATTITUDE, false>(
                *simd,
                *zero,
                runs,
                arcs,
                grid,
                workspace,
                &mut |index, _, states, outcome| {
                    core::mem::swap(&mut trajectories[index], states);
                    outcomes[index] = *outcome;
                },
            );
        }
        let arcs = ArcSource::new(scenes, laws.reborrow(), grid);
        let (runs, completion) = batch.load(scenes, &arcs);
        integrate_on::<S, R, E, N, J, FORCED>(
            *simd,
            *zero,
            runs,
            arcs,
            grid,
            workspace,
            &mut |index, run, states, outcome| {
                completion.complete(*simd, scenes, index, run, states, outcome, finish);
            },
        );
    }
}

/// The integration, not inlined: all engines share one kernel for debris and spacecraft without actuators.
#[inline(never)]
fn integrate_on<'a, S: Simd, R: Real, E: WithinArcs<R>, const N: usize, const J: usize, const FORCED: bool>(
    simd: S,
    zero: R,
    runs: &'a mut [Gyrostat<f64>],
    arcs: ArcSource<'a>,
    grid: &'a Grid,
    workspace: &'a mut Workspace<R, J>,
    finish: &mut RunCallback<'_>,
) {
    simd.vectorize(
        #[inline(always)]
        || integrate::<S, R, E, N, J, FORCED>(simd, zero, runs, arcs, grid, workspace, finish),
    );
}

fn settings(plan: &PropagationSettings) -> Settings {
    Settings {
        tolerance: plan.control.tolerance.relative,
        periodic: plan.method == Method::Auto,
        max_steps: plan.control.max_steps,
    }
}

impl<S: Simd, R: Real + Send + 'static, E: WithinArcs<R> + Send, const N: usize, const J: usize, const FORCED: bool>
    Engine for TaylorEngine<S, R, E, N, J, FORCED>
{
    fn propagate_under(&mut self, laws: Laws<'_>, scenes: &[Scene], finish: &mut CompletionCallback<'_>) {
        let simd = self.simd;
        simd.vectorize(
            #[inline(always)]
            || self.run(laws, scenes, finish),
        );
    }
}
