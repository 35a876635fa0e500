//! [`GyrostatBatch`]: a batch of scenes as gyrostats, and what completes their components to physical states.
//!
//! What every method on the gyrostat shares: the spacecraft's runs, the rotation of debris that is not isotropic (marched
//! first, as gyrostats without wheels), and the way back into the state table.

use fearless_simd::Simd;

use super::settings::{PropagationSettings, observes_debris_rotation};
use crate::dynamics::debris;
use crate::dynamics::gyrostat::completion::complete;
use crate::dynamics::gyrostat::{Gyrostat, WITH_ATTITUDE};
use crate::run::{Grid, StateTable, Trajectory};
use crate::scene::Scene;

/// A batch's runs in buffers that are reused.
#[derive(Clone, Debug)]
pub struct GyrostatBatch {
    grid: Grid,
    observes_debris_rotation: bool,
    count: usize,
    runs: Vec<Gyrostat<f64>>,
    debris_runs: Vec<Gyrostat<f64>>,
    debris_trajectories: Vec<Trajectory>,
    debris_marched: bool,
}

impl GyrostatBatch {
    /// Empty buffers for batches of `plan`.
    pub fn new(plan: &PropagationSettings) -> Self {
        GyrostatBatch {
            grid: plan.grid.clone(),
            observes_debris_rotation: observes_debris_rotation(plan.blocks),
            count: 0,
            runs: Vec::new(),
            debris_runs: Vec::new(),
            debris_trajectories: Vec::new(),
            debris_marched: false,
        }
    }

    /// Turns `scenes` into runs.
    pub fn take(&mut self, scenes: &[Scene]) {
        let duration = self.grid.duration();
        self.count = scenes.len();
        while self.runs.len() < scenes.len() {
            self.runs.push(Gyrostat::blank(0.0));
        }
        for (run, scene) in self.runs.iter_mut().zip(scenes) {
            run.reset(0.0, scene, duration);
        }
        self.debris_marched = false;
    }

    /// Prepares the rotations of the debris of `scenes`; true where there is any that [`GyrostatBatch::debris`] must march.
    pub fn begin_debris(&mut self, scenes: &[Scene]) -> bool {
        let general = |scene: &Scene| scene.mass.debris.as_ref().is_some_and(|body| !debris::is_isotropic(body));
        if !self.observes_debris_rotation || !scenes.iter().any(general) {
            return false;
        }
        while self.debris_runs.len() < scenes.len() {
            self.debris_runs.push(Gyrostat::blank(0.0));
            self.debris_trajectories.push(Trajectory::new(WITH_ATTITUDE, self.grid.points()));
        }
        for (run, scene) in self.debris_runs.iter_mut().zip(scenes) {
            debris::set_rotation(run, scene, self.grid.duration());
        }
        self.debris_marched = true;
        true
    }

    /// The debris as gyrostats without wheels, and where their components go.
    pub fn debris(&mut self) -> (&[Gyrostat<f64>], &mut [Trajectory]) {
        (&self.debris_runs[..self.count], &mut self.debris_trajectories[..self.count])
    }

    /// The spacecraft's runs.
    pub fn runs(&self) -> &[Gyrostat<f64>] {
        &self.runs[..self.count]
    }

    /// Fills `table` with the physical states of run `index`, whose first `N` components are `trajectory`.
    #[inline(never)]
    pub fn complete<S: Simd, const N: usize>(
        &self,
        simd: S,
        scenes: &[Scene],
        index: usize,
        trajectory: &Trajectory,
        table: &mut StateTable,
    ) {
        let scene = &scenes[index];
        // called through closures, which are compiled apart: it enters the instruction set again
        simd.vectorize(
            #[inline(always)]
            || {
                complete::<S, N>(simd, &self.runs[index], trajectory, &self.grid, table);
                if let Some(body) = &scene.mass.debris {
                    debris::complete_translation(simd, scene, &self.grid, table);
                    if debris::is_isotropic(body) {
                        debris::complete_isotropic(simd, scene, &self.grid, table);
                    } else if self.debris_marched {
                        let (run, states) = (&self.debris_runs[index], &self.debris_trajectories[index]);
                        debris::complete_rotation::<S, WITH_ATTITUDE>(simd, run, states, table);
                    }
                }
            },
        );
    }
}
