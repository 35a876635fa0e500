//! Scenes with their reference solution (double-double), and the errors of runs.

use rayon::prelude::*;
use spindrift::math::Isa;
use spindrift::ode::Control;
use spindrift::propagation::Method;
use spindrift::propagation::PropagationSettings;
use spindrift::propagation::taylor::reference_solution::{ReferenceSolution, TOLERANCE};
use spindrift::run::Status;
use spindrift::run::{Grid, StateField, StateTable};
use spindrift::scene::Scene;

use super::runs::{Run, blocks, propagate_on};

/// Scenes, and the reference solution of their rotation at the times of a grid.
pub struct Exact {
    pub scenes: Vec<Scene>,
    pub grid: Grid,
    pub truths: Vec<ReferenceSolution>,
}

/// |a - b|, in all digits of b.
fn off<const N: usize>(
    table: &StateTable,
    truth: &ReferenceSolution,
    block: StateField,
    point: usize,
    sign: f64,
) -> f64 {
    let found = table.at::<N>(block, point);
    let (high, low) = (truth.high.at::<N>(block, point), truth.low.at::<N>(block, point));
    let square = |i: usize| ((sign * found[i] - high[i]) - low[i]).powi(2);
    let distance = (0..N).map(square).sum::<f64>().sqrt();
    if distance.is_nan() { f64::INFINITY } else { distance }
}

fn size<const N: usize>(v: [f64; N]) -> f64 {
    v.iter().map(|x| x * x).sum::<f64>().sqrt()
}

/// Largest |omega - truth| over the largest |omega|, and largest angle between the attitudes, rad, at any point.
pub fn distance(table: &StateTable, truth: &ReferenceSolution) -> [f64; 2] {
    let points = 0..truth.high.points();
    let scale = points.clone().map(|point| size(truth.high.at::<3>(StateField::Rate, point))).fold(0.0, f64::max);
    let scale = if scale > 0.0 { scale } else { 1.0 };
    points.fold([0.0, 0.0], |[rate, attitude], point| {
        let turned = |sign| 2.0 * off::<4>(table, truth, StateField::Attitude, point, sign);
        [
            rate.max(off::<3>(table, truth, StateField::Rate, point, 1.0) / scale),
            attitude.max(turned(1.0).min(turned(-1.0))),
        ]
    })
}

impl Exact {
    /// Solves `scenes` in double-double.
    pub fn new(scenes: Vec<Scene>, grid: Grid) -> Self {
        let fields = blocks([StateField::Rate, StateField::Attitude]);
        let solve = |scene: &Scene| {
            ReferenceSolution::new(Isa::best(), scene, &grid, fields, TOLERANCE)
                .expect("the reference solution is complete")
        };
        let truths = scenes.par_iter().map(solve).collect();
        Exact { scenes, grid, truths }
    }

    /// The runs of the scenes by `method`: rate, attitude and wheel rates, which must all be complete.
    pub fn runs(&self, method: Method, control: Control) -> Vec<Run> {
        let fields = blocks([StateField::Rate, StateField::Attitude, StateField::WheelRates]);
        let plan = PropagationSettings::new(method, control, self.grid.clone(), fields, &self.scenes[0]);
        let parts: Vec<_> = self.scenes.par_chunks(8).map(|part| propagate_on(Isa::best(), &plan, part)).collect();
        let runs: Vec<Run> = parts.into_iter().flatten().collect();
        assert!(runs.iter().all(|run| run.outcome.status == Status::Done), "{method:?}");
        runs
    }

    /// The larger of the errors of rate (relative) and attitude (rad) of each run.
    pub fn errors(&self, runs: &[Run]) -> Vec<f64> {
        let worst = |(run, truth): (&Run, &ReferenceSolution)| {
            let [rate, attitude] = distance(&run.table, truth);
            rate.max(attitude)
        };
        runs.iter().zip(&self.truths).map(worst).collect()
    }
}
