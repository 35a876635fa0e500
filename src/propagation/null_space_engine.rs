//! The report's 62-state form with Dormand-Prince 5(4), as an [`Engine`].

use fearless_simd::Simd;

use super::null_space_runs::NullSpaceRuns;
use super::settings::{CompletionCallback, Engine, PropagationSettings};
use crate::dynamics::null_space::{COMPONENTS, complete};
use crate::ode::adaptive;
use crate::ode::embedded::DormandPrinceRestepped;
use crate::ode::workspace::Workspace;
use crate::run::StateTable;
use crate::scene::Scene;

/// One worker's memory.
pub struct NullSpaceEngine<S> {
    simd: S,
    plan: PropagationSettings,
    workspace: Workspace,
    table: StateTable,
}

impl<S: Simd> NullSpaceEngine<S> {
    /// Memory for the runs of `plan`.
    pub fn new(simd: S, plan: &PropagationSettings) -> Self {
        let points = plan.grid.points();
        NullSpaceEngine {
            simd,
            plan: plan.clone(),
            workspace: Workspace::new(1, COMPONENTS, points),
            table: StateTable::new(plan.blocks, points),
        }
    }

    #[inline(always)]
    fn run(&mut self, scenes: &[Scene], finish: &mut CompletionCallback<'_>) {
        if scenes.is_empty() {
            return;
        }
        let Self { plan, workspace, table, .. } = self;
        let mut runs = NullSpaceRuns::new(scenes, plan.grid.duration());
        adaptive::march::<_, _, _, _, COMPONENTS>(
            DormandPrinceRestepped,
            0.0,
            &mut runs,
            &plan.grid,
            &plan.control,
            workspace,
            |_, _, run, trajectory, outcome| {
                complete(&scenes[run], trajectory, &plan.grid, table);
                table.pad();
                finish(run, table, outcome);
            },
        );
    }
}

impl<S: Simd> Engine for NullSpaceEngine<S> {
    fn propagate(&mut self, scenes: &[Scene], finish: &mut CompletionCallback<'_>) {
        let simd = self.simd;
        simd.vectorize(
            #[inline(always)]
            || self.run(scenes, finish),
        );
    }
}
