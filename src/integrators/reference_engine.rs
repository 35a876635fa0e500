//! The report's 62-state form with Dormand-Prince 5(4), as an [`Engine`].

use fearless_simd::Simd;

use super::adaptive;
use super::embedded::DormandPrinceRestepped;
use super::propagate::{Engine, Finish, Propagator};
use super::reference_runs::ReferenceRuns;
use super::workspace::Workspace;
use crate::dynamics::reference::{COMPONENTS, complete};
use crate::dynamics::table::StateTable;
use crate::scene::Scene;

/// One worker's memory.
pub struct ReferenceEngine<S> {
    simd: S,
    plan: Propagator,
    workspace: Workspace,
    table: StateTable,
}

impl<S: Simd> ReferenceEngine<S> {
    /// Memory for the runs of `plan`.
    pub fn new(simd: S, plan: &Propagator) -> Self {
        let points = plan.grid.points();
        ReferenceEngine {
            simd,
            plan: plan.clone(),
            workspace: Workspace::new(1, COMPONENTS, points),
            table: StateTable::new(plan.blocks, points),
        }
    }

    #[inline(always)]
    fn run(&mut self, scenes: &[Scene], finish: &mut Finish<'_>) {
        if scenes.is_empty() {
            return;
        }
        let Self { plan, workspace, table, .. } = self;
        let mut runs = ReferenceRuns::new(scenes, plan.grid.duration());
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

impl<S: Simd> Engine for ReferenceEngine<S> {
    fn propagate(&mut self, scenes: &[Scene], finish: &mut Finish<'_>) {
        let simd = self.simd;
        simd.vectorize(
            #[inline(always)]
            || self.run(scenes, finish),
        );
    }
}
