//! The Taylor and periodic propagation as an [`Engine`].

use fearless_simd::Simd;

use super::march::{Settings, Workspace, march};
use crate::dynamics::debris;
use crate::dynamics::gyrostat::completion::complete;
use crate::dynamics::gyrostat::{Gyrostat, WITH_ATTITUDE};
use crate::dynamics::table::{StateTable, Trajectory};
use crate::integrators::method::Method;
use crate::integrators::propagate::{Engine, Finish, Propagator, observes_debris_rotation};
use crate::math::Real;
use crate::scene::Scene;

/// One worker's memory.
pub struct TaylorEngine<S, R, const N: usize, const FORCED: bool> {
    simd: S,
    zero: R,
    plan: Propagator,
    runs: Vec<Gyrostat<f64>>,
    workspace: Workspace<R, N>,
    table: StateTable,
    debris: Option<DebrisRotation<R>>,
}

/// The rotation of debris that is not isotropic: a gyrostat without wheels, marched before the spacecraft.
struct DebrisRotation<R> {
    workspace: Workspace<R, WITH_ATTITUDE>,
    trajectories: Vec<Trajectory>,
    runs: Vec<Gyrostat<f64>>,
}

impl<S: Simd, R: Real + Send + 'static, const N: usize, const FORCED: bool> TaylorEngine<S, R, N, FORCED> {
    /// Memory for the runs of `plan`; `zero` says how many lanes.
    pub fn new(simd: S, zero: R, plan: &Propagator) -> Self {
        let settings = Settings {
            tolerance: plan.control.tolerance.relative,
            periodic: plan.method == Method::Auto,
            max_steps: plan.control.max_steps,
        };
        let points = plan.grid.points();
        TaylorEngine {
            simd,
            zero,
            plan: plan.clone(),
            runs: Vec::new(),
            workspace: Workspace::new(zero, settings, points),
            table: StateTable::new(plan.blocks, points),
            debris: observes_debris_rotation(plan.blocks).then(|| DebrisRotation {
                workspace: Workspace::new(zero, settings, points),
                trajectories: Vec::new(),
                runs: Vec::new(),
            }),
        }
    }

    /// Marches the rotation of every debris that needs it; true where there was any.
    #[inline(always)]
    fn rotate_debris(&mut self, scenes: &[Scene]) -> bool {
        let Some(debris) = &mut self.debris else { return false };
        let general = |scene: &Scene| scene.mass.debris.as_ref().is_some_and(|body| !debris::is_isotropic(body));
        if !scenes.iter().any(general) {
            return false;
        }
        let duration = self.plan.grid.duration();
        while debris.runs.len() < scenes.len() {
            debris.runs.push(Gyrostat::blank(0.0));
            debris.trajectories.push(Trajectory::new(WITH_ATTITUDE, self.plan.grid.points()));
        }
        for (run, scene) in debris.runs.iter_mut().zip(scenes) {
            debris::set_rotation(run, scene, duration);
        }
        let DebrisRotation { workspace, trajectories, runs } = debris;
        march::<S, R, WITH_ATTITUDE, false>(
            self.simd,
            self.zero,
            &runs[..scenes.len()],
            &self.plan.grid,
            workspace,
            &mut |run, trajectory, _| core::mem::swap(&mut trajectories[run], trajectory),
        );
        true
    }

    #[inline(always)]
    fn run(&mut self, scenes: &[Scene], finish: &mut Finish<'_>) {
        let duration = self.plan.grid.duration();
        while self.runs.len() < scenes.len() {
            self.runs.push(Gyrostat::blank(0.0));
        }
        for (run, scene) in self.runs.iter_mut().zip(scenes) {
            run.reset(0.0, scene, duration);
        }
        let rotated = self.rotate_debris(scenes);
        let Self { simd, zero, plan, runs, workspace, table, debris } = self;
        let runs = &runs[..scenes.len()];
        march::<S, R, N, FORCED>(*simd, *zero, runs, &plan.grid, workspace, &mut |index, trajectory, outcome| {
            // a closure behind `dyn` is compiled apart: it enters the instruction set again
            simd.vectorize(
                #[inline(always)]
                || {
                    let scene = &scenes[index];
                    complete::<S, N>(*simd, &runs[index], trajectory, &plan.grid, table);
                    if let Some(body) = &scene.mass.debris {
                        debris::complete_translation(*simd, scene, &plan.grid, table);
                        if debris::is_isotropic(body) {
                            debris::complete_isotropic(*simd, scene, &plan.grid, table);
                        } else if let Some(rotation) = debris
                            && rotated
                        {
                            let (run, trajectory) = (&rotation.runs[index], &rotation.trajectories[index]);
                            debris::complete_rotation::<S, WITH_ATTITUDE>(*simd, run, trajectory, table);
                        }
                    }
                },
            );
            finish(index, table, outcome);
        });
    }
}

impl<S: Simd, R: Real + Send + 'static, const N: usize, const FORCED: bool> Engine for TaylorEngine<S, R, N, FORCED> {
    fn propagate(&mut self, scenes: &[Scene], finish: &mut Finish<'_>) {
        let simd = self.simd;
        simd.vectorize(
            #[inline(always)]
            || self.run(scenes, finish),
        );
    }
}
