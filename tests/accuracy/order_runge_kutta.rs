//! Runge-Kutta methods converge as their order and their tolerance say, at the steps and between them.

use crate::textbook::*;
use spindrift::ode::{Control, Dop853, DormandPrince, GaussLegendre, RungeKutta4, Tolerance};
use spindrift::run::{Grid, Status};

/// MATLAB's own documentation of ode45 (odeset, option Stats, van der Pol with mu = 1 on [0, 20] from [2; 0] at the
/// default tolerances) prints: 59 successful steps, 10 failed attempts, 415 function evaluations.
#[test]
fn dormand_prince_takes_the_steps_of_ode45() {
    let case = Case { state: [2.0, 0.0], parameters: [], ends: vec![20.0] };
    let control = Control { tolerance: Tolerance { relative: 1e-3, absolute: 1e-6 }, step: None, max_steps: 10_000 };
    let effort =
        scalar(Adaptive(DormandPrince), VanDerPol, &[case], &Grid::uniform(20.0, 2), &control)[0].outcome.effort;
    assert_eq!((effort.steps, effort.rejected, effort.evaluations), (59, 10, 415));
}

/// Arcs of the next test, each of one step or more, their length, s, and the slope.
const ARCS: u32 = 10_000;
const ARC: f64 = 0.1;
const SLOPE: f64 = 1.0 / 3.0;
/// What a compensated sum of the steps may be off: eight ulps of the end, 334. Measured: an ulp, and four with the
/// weights of DOP853.
const COMPENSATED: f64 = 8.0 * 256.0 * f64::EPSILON;

/// Law: every method carries what its steps lose: after 10,000 arcs of a constant slope the state is on the line, to an
/// ulp or two.
#[test]
fn every_method_carries_what_its_steps_lose() {
    let ends: Vec<f64> = (1..=ARCS).map(|k| ARC * f64::from(k)).collect();
    let time = ARC * f64::from(ARCS);
    let end = 1.0 + SLOPE * time;
    let case = Case { state: [1.0], parameters: [SLOPE], ends: ends.clone() };
    let grid = Grid::at(vec![0.0, time]);
    let mut errors = Vec::new();
    let mut off = |name: &'static str, journey: Journey<1>| {
        assert!(journey.outcome.status == Status::Done && journey.outcome.effort.steps >= u64::from(ARCS), "{name}");
        errors.push((name, (journey.points[1][0] - end).abs()));
    };
    let (cases, tolerance, step) = (std::slice::from_ref(&case), control(1e-6, 0.0), control(1e-6, 1.0));
    off("Dormand-Prince", scalar(Adaptive(DormandPrince), Slope, cases, &grid, &tolerance).remove(0));
    off("DOP853", scalar(Adaptive(Dop853), Slope, cases, &grid, &tolerance).remove(0));
    off("Runge-Kutta 4", scalar(Fixed(RungeKutta4), Slope, cases, &grid, &step).remove(0));
    off("Gauss-Legendre", scalar(Fixed(GaussLegendre), Slope, cases, &grid, &step).remove(0));
    println!("{errors:?}");
    assert!(errors.iter().all(|(_, error)| *error <= COMPENSATED), "{errors:?}");
}
