//! The report's 62-state form with Dormand-Prince 5(4), as an [`Engine`].

use fearless_simd::Simd;

use super::null_space_runs::NullSpaceRuns;
use super::settings::{CompletedRun, CompletionCallback, Engine, PropagationSettings};
use crate::dynamics::actuation::Laws;
use crate::dynamics::null_space::{COMPONENTS, complete};
use crate::ode::adaptive;
use crate::ode::embedded::DormandPrinceRestepped;
use crate::ode::workspace::Workspace;
use crate::run::StateTable;
use crate::scene::{Arc, Scene};

/// One worker's memory.
pub struct NullSpaceEngine<S> {
    simd: S,
    plan: PropagationSettings,
    workspace: Workspace,
    table: StateTable,
    arcs: Vec<Arc>,
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
            arcs: Vec::new(),
        }
    }

    #[inline(always)]
    fn run(&mut self, mut laws: Laws<'_>, scenes: &[Scene], finish: &mut CompletionCallback<'_>) {
        if scenes.is_empty() {
            return;
        }
        let Self { plan, workspace, table, arcs, .. } = self;
        plan.check_laws(&laws);
        let mut runs = NullSpaceRuns::new(scenes, plan.grid.duration()).under(laws.reborrow(), std::mem::take(arcs));
        adaptive::march::<_, _, _, _, COMPONENTS>(
            DormandPrinceRestepped,
            0.0,
            &mut runs,
            &plan.grid,
            &plan.control,
            workspace,
            |runs, _, index, trajectory, outcome| {
                complete(&scenes[index], trajectory, &plan.grid, table);
                table.pad();
                finish(CompletedRun { index, table, outcome, arcs: runs.arcs() });
            },
        );
        *arcs = runs.into_arcs();
    }
}

impl<S: Simd> Engine for NullSpaceEngine<S> {
    fn propagate_under(&mut self, laws: Laws<'_>, scenes: &[Scene], finish: &mut CompletionCallback<'_>) {
        let simd = self.simd;
        simd.vectorize(
            #[inline(always)]
            || self.run(laws, scenes, finish),
        );
    }
}
