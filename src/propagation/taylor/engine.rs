//! The Taylor and periodic propagation as an [`Engine`].

use fearless_simd::Simd;

use super::driver::march;
use super::workspace::{Settings, Workspace};
use crate::dynamics::gyrostat::WITH_ATTITUDE;
use crate::math::Real;
use crate::propagation::gyrostat_batch::GyrostatBatch;
use crate::propagation::method::Method;
use crate::propagation::settings::{CompletionCallback, Engine, PropagationSettings};
use crate::run::StateTable;
use crate::scene::Scene;

/// One worker's memory: `N` components, of which the first `J` have series of their own.
pub struct TaylorEngine<S, R, const N: usize, const J: usize, const FORCED: bool> {
    simd: S,
    zero: R,
    plan: PropagationSettings,
    batch: GyrostatBatch,
    workspace: Workspace<R, J>,
    debris_workspace: Option<Workspace<R, WITH_ATTITUDE>>,
    table: StateTable,
}

impl<S: Simd, R: Real + Send + 'static, const N: usize, const J: usize, const FORCED: bool>
    TaylorEngine<S, R, N, J, FORCED>
{
    /// Memory for the runs of `plan`; `zero` says how many lanes.
    pub fn new(simd: S, zero: R, plan: &PropagationSettings) -> Self {
        TaylorEngine {
            simd,
            zero,
            plan: plan.clone(),
            batch: GyrostatBatch::new(plan),
            workspace: Workspace::new(zero, settings(plan), N, plan.grid.points()),
            debris_workspace: None,
            table: StateTable::new(plan.blocks, plan.grid.points()),
        }
    }

    #[inline(always)]
    fn run(&mut self, scenes: &[Scene], finish: &mut CompletionCallback<'_>) {
        let Self { simd, zero, plan, batch, workspace, debris_workspace, table } = self;
        batch.take(scenes);
        if batch.begin_debris(scenes) {
            let workspace = debris_workspace
                .get_or_insert_with(|| Workspace::new(*zero, settings(plan), WITH_ATTITUDE, plan.grid.points()));
            let (runs, store) = batch.debris();
            march::<S, R, WITH_ATTITUDE, WITH_ATTITUDE, false>(
                *simd,
                *zero,
                runs,
                &plan.grid,
                workspace,
                &mut |run, states, _| {
                    core::mem::swap(&mut store[run], states);
                },
            );
        }
        let batch = &*batch;
        march::<S, R, N, J, FORCED>(*simd, *zero, batch.runs(), &plan.grid, workspace, &mut |run, states, outcome| {
            batch.complete::<S, N>(*simd, scenes, run, states, table);
            finish(run, table, outcome);
        });
    }
}

/// What `plan` says of the march.
fn settings(plan: &PropagationSettings) -> Settings {
    Settings {
        tolerance: plan.control.tolerance.relative,
        periodic: plan.method == Method::Auto,
        max_steps: plan.control.max_steps,
    }
}

impl<S: Simd, R: Real + Send + 'static, const N: usize, const J: usize, const FORCED: bool> Engine
    for TaylorEngine<S, R, N, J, FORCED>
{
    fn propagate(&mut self, scenes: &[Scene], finish: &mut CompletionCallback<'_>) {
        let simd = self.simd;
        simd.vectorize(
            #[inline(always)]
            || self.run(scenes, finish),
        );
    }
}
