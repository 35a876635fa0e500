//! Runge-Kutta methods on the gyrostat, as an [`Engine`].

use fearless_simd::Simd;

use super::arc_source::ArcSource;
use super::gyrostat_batch::GyrostatBatch;
use super::gyrostat_runs::GyrostatRuns;
use super::local_error::{Remainder, Remainders};
use super::settings::{CompletionCallback, Engine, PropagationSettings};
use crate::dynamics::actuation::Laws;
use crate::math::Real;
use crate::ode::embedded::Embedded;
use crate::ode::fixed::FixedStep;
use crate::ode::step_control::Control;
use crate::ode::workspace::Workspace;
use crate::ode::{Runs, adaptive, fixed};
use crate::run::Outcome;
use crate::run::{Grid, Trajectory};
use crate::scene::Scene;

/// A method together with its march.
pub trait LaneIntegrator: Copy {
    /// What its steps leave out, where it does not estimate that itself.
    fn remainder(self) -> Option<Remainder>;

    /// Marches all runs; as [`adaptive::march`].
    fn march<R, Q, F, const N: usize>(
        self,
        zero: R,
        runs: &mut Q,
        grid: &Grid,
        control: &Control,
        workspace: &mut Workspace,
        finish: F,
    ) where
        R: Real,
        Q: Runs<R, N>,
        F: FnMut(&Q, usize, usize, &Trajectory, &Outcome);
}

/// A method that follows the tolerance.
#[derive(Clone, Copy, Debug)]
pub struct Adaptive<M>(pub M);

/// A method with a fixed step.
#[derive(Clone, Copy, Debug)]
pub struct Fixed<M>(pub M);

macro_rules! march {
    ($kind:ident, $bound:ident, $module:ident, $remainder:expr) => {
        impl<M: $bound> LaneIntegrator for $kind<M> {
            fn remainder(self) -> Option<Remainder> {
                $remainder
            }

            #[inline(always)]
            fn march<R, Q, F, const N: usize>(
                self,
                zero: R,
                runs: &mut Q,
                grid: &Grid,
                control: &Control,
                workspace: &mut Workspace,
                finish: F,
            ) where
                R: Real,
                Q: Runs<R, N>,
                F: FnMut(&Q, usize, usize, &Trajectory, &Outcome),
            {
                $module::march(self.0, zero, runs, grid, control, workspace, finish);
            }
        }
    };
}
march!(Adaptive, Embedded, adaptive, None);
march!(Fixed, FixedStep, fixed, Some(M::REMAINDER));

/// One worker's memory.
pub struct RungeKuttaEngine<S, R, M, const N: usize> {
    simd: S,
    zero: R,
    march: M,
    plan: PropagationSettings,
    batch: GyrostatBatch,
    workspace: Workspace,
    remainders: Option<Remainders>,
}

impl<S: Simd, R: Real, M: LaneIntegrator, const N: usize> RungeKuttaEngine<S, R, M, N> {
    /// Memory for the runs of `plan`; `zero` says how many lanes.
    pub fn new(simd: S, zero: R, march: M, plan: &PropagationSettings) -> Self {
        let points = plan.grid.points();
        RungeKuttaEngine {
            simd,
            zero,
            march,
            plan: plan.clone(),
            batch: GyrostatBatch::new(plan),
            workspace: Workspace::new(R::LANES, N, points),
            remainders: march.remainder().map(Remainders::new),
        }
    }

    #[inline(always)]
    fn run(&mut self, mut laws: Laws<'_>, scenes: &[Scene], finish: &mut CompletionCallback<'_>) {
        let Self { simd, zero, march, plan, batch, workspace, remainders } = self;
        let zero = *zero;
        plan.check_laws(&laws);
        let duration = plan.grid.duration();
        if let Some((runs, trajectories)) = batch.load_debris(scenes) {
            // the debris is a gyrostat without wheels; it needs only its attitude, but this saves compiling one more kernel
            let mut runs = GyrostatRuns::new(zero, runs, ArcSource::free(duration));
            march.march::<_, _, _, N>(
                zero,
                &mut runs,
                &plan.grid,
                &plan.control,
                workspace,
                |_, _, run, trajectory, _| trajectories[run].copy_from(trajectory),
            );
        }
        let arcs = ArcSource::new(scenes, laws.reborrow(), duration);
        let (runs, completion) = batch.load(scenes, &arcs);
        let mut runs = GyrostatRuns::new(zero, runs, arcs);
        march.march::<_, _, _, N>(
            zero,
            &mut runs,
            &plan.grid,
            &plan.control,
            workspace,
            |runs, _, index, trajectory, outcome| {
                let run = runs.run(index);
                let mut outcome = *outcome;
                if let Some(remainders) = remainders {
                    outcome.local_errors = remainders.sum(run, trajectory, &plan.grid, &outcome);
                }
                completion.complete::<S, N>(*simd, scenes, index, run, trajectory, &outcome, finish);
            },
        );
    }
}

impl<S: Simd, R: Real + Send, M: LaneIntegrator + Send, const N: usize> Engine for RungeKuttaEngine<S, R, M, N> {
    fn propagate_under(&mut self, laws: Laws<'_>, scenes: &[Scene], finish: &mut CompletionCallback<'_>) {
        let simd = self.simd;
        simd.vectorize(
            #[inline(always)]
            || self.run(laws, scenes, finish),
        );
    }
}
