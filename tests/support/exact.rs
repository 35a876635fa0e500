//! Scenes with their reference solution (double-double), and the errors of runs.

use super::prelude::*;
use rayon::prelude::*;

pub struct Exact {
    pub scenes: Vec<Scene>,
    pub grid: Grid,
    pub truths: Vec<ReferenceSolution>,
}

pub fn distance(table: &StateTable, grid: &Grid, reference: &ReferenceSolution) -> [f64; 2] {
    let error = RotationError::largest(rotation_errors(reference, grid, table));
    [error.omega, error.attitude].map(|error| if error.is_nan() { f64::INFINITY } else { error })
}

impl Exact {
    pub fn new(scenes: Vec<Scene>, grid: Grid) -> Self {
        let fields = rotational();
        let truths = scenes.par_iter().map(|scene| solved(scene, &grid, fields)).collect();
        Exact { scenes, grid, truths }
    }

    pub fn runs(&self, method: Method, control: Control) -> Vec<Run> {
        let fields = blocks([StateField::Rate, StateField::Attitude, StateField::WheelRates]);
        let plan = PropagationSettings::new(method, control, self.grid.clone(), fields, &self.scenes[0]);
        let parts: Vec<_> = self.scenes.par_chunks(8).map(|part| propagate_on(Isa::best(), &plan, part)).collect();
        let runs: Vec<Run> = parts.into_iter().flatten().collect();
        for (scene, run) in runs.iter().enumerate() {
            assert_eq!(run.outcome.status, Status::Done, "{method:?}, scene {scene}");
        }
        runs
    }

    pub fn errors(&self, runs: &[Run]) -> Vec<f64> {
        let worst = |(run, truth): (&Run, &ReferenceSolution)| {
            let [rate, attitude] = distance(&run.table, &self.grid, truth);
            rate.max(attitude)
        };
        runs.iter().zip(&self.truths).map(worst).collect()
    }
}

pub fn solved(scene: &Scene, grid: &Grid, fields: StateFields) -> ReferenceSolution {
    ReferenceSolution::new(Isa::best(), scene, grid, fields, TOLERANCE).unwrap()
}
