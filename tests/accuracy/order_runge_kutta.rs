//! Runge-Kutta methods converge with their order and tolerance, at the steps and between them.

use crate::prelude::*;
use crate::textbook::*;

const HORIZON: f64 = 10.0;
const FREQUENCY: f64 = 2.0;

fn oscillator() -> Case<2, 1> {
    Case { state: [1.0, 0.0], parameters: [FREQUENCY], ends: vec![HORIZON] }
}

fn oscillation<M: LaneMethod>(method: M, control: &Control) -> (f64, f64, u64) {
    let grid = Grid::uniform(HORIZON, 102);
    let journey = scalar(method, Oscillator, &[oscillator()], &grid, control).remove(0);
    assert_eq!(journey.outcome.status, Status::Done);
    assert_eq!((journey.outcome.time, journey.outcome.points), (HORIZON, 102));
    let errors: Vec<f64> = std::iter::zip(grid.times(), &journey.points)
        .map(|(t, y)| libm::hypot(y[0] - libm::cos(FREQUENCY * t), y[1] + libm::sin(FREQUENCY * t)))
        .collect();
    let between = errors[..101].iter().copied().fold(0.0, f64::max);
    (errors[101], between, journey.outcome.effort.steps)
}

fn fixed_order<M: LaneMethod>(method: M, step: f64) -> (f64, f64) {
    let (coarse, coarse_between, _) = oscillation(method, &control(1e-9, step));
    let (fine, fine_between, _) = oscillation(method, &control(1e-9, step / 2.0));
    ((coarse / fine).log2(), (coarse_between / fine_between).log2())
}

#[test]
fn fixed_steps_converge_with_their_order_at_and_between_steps() {
    for (order, (at, between)) in
        [(4.0, fixed_order(Fixed(RungeKutta4), 0.02)), (6.0, fixed_order(Fixed(GaussLegendre), 0.2))]
    {
        // measured: 0.007 at steps, 0.021 between them
        assert!((at - order).abs() < 0.05, "order {order}: {at}");
        assert!((between - order).abs() < 0.15, "order {order} between steps: {between}");
    }
}

/// MATLAB's documentation of ode45 (odeset, option Stats, van der Pol with mu = 1): 59 successful steps, 10 failed
/// attempts, 415 function evaluations.
#[test]
fn dormand_prince_takes_the_steps_of_ode45() {
    let case = Case { state: [2.0, 0.0], parameters: [], ends: vec![20.0] };
    let control = Control { tolerance: Tolerance { relative: 1e-3, absolute: 1e-6 }, step: None, max_steps: 10_000 };
    let effort =
        scalar(Adaptive(DormandPrince), VanDerPol, &[case], &Grid::uniform(20.0, 2), &control)[0].outcome.effort;
    assert_eq!((effort.steps, effort.rejected, effort.evaluations), (59, 10, 415));
}

/// Quantities of order one after 10,000 compensated steps: a few ulps; uncompensated near 1e-14.
const INVARIANT_ROUND_OFF: f64 = 2e-15;

fn invariant_drift<M: LaneMethod>(method: M) -> f64 {
    let (state, inertia) = RIGID_BODY;
    let case = Case { state, parameters: inertia, ends: vec![1000.0] };
    let grid = Grid::uniform(1000.0, 777);
    let journey = scalar(method, RigidBody, &[case], &grid, &control(1e-9, 0.1)).remove(0);
    assert_eq!(journey.outcome.status, Status::Done);
    let invariants = |y: &[f64; 3]| {
        let sum = |weights: [f64; 3]| (0..3).map(|i| weights[i] * y[i] * y[i]).sum::<f64>();
        [sum([1.0; 3]), sum(inertia.map(|i| 0.5 / i))]
    };
    let first = invariants(&state);
    journey
        .points
        .iter()
        .flat_map(|y| {
            let now = invariants(y);
            [(now[0] - first[0]).abs(), (now[1] - first[1]).abs()]
        })
        .fold(0.0, f64::max)
}

/// Arcs of a step or more, their length, s, and the slope.
const ARCS: u32 = 10_000;
const ARC: f64 = 0.1;
const SLOPE: f64 = 1.0 / 3.0;
/// Error of a compensated sum of the steps: eight ulps of the end, 334. Measured: one, and four by DOP853.
const COMPENSATED: f64 = 8.0 * 256.0 * f64::EPSILON;

/// Law: every method compensates its steps: after 10,000 arcs of a constant slope the state is on the line.
#[test]
fn every_method_carries_what_its_steps_lose() {
    let ends: Vec<f64> = (1..=ARCS).map(|k| ARC * f64::from(k)).collect();
    let time = ARC * f64::from(ARCS);
    let end = 1.0 + SLOPE * time;
    let case = Case { state: [1.0], parameters: [SLOPE], ends: ends.clone() };
    let grid = Grid::at(vec![0.0, time]);
    let errors = by_every_method(Slope, case, &grid, &control(1e-6, 1.0)).map(|(name, Journey { points, outcome })| {
        assert!(outcome.status == Status::Done && outcome.effort.steps >= u64::from(ARCS), "{name}");
        (name, (points[1][0] - end).abs())
    });
    assert!(errors.iter().all(|(_, error)| *error <= COMPENSATED), "{errors:?}");
    let steps = ends.iter().scan(0.0, |last, end| Some(end - std::mem::replace(last, *end)));
    let plain = (steps.fold(1.0, |sum: f64, step| sum + SLOPE * step) - end).abs();
    // measured: 1.6e-11, 35 times
    assert!(plain > 10.0 * COMPENSATED, "{plain:e}");
}

#[test]
fn gauss_legendre_keeps_quadratic_invariants_to_round_off() {
    let drift = invariant_drift(Fixed(GaussLegendre));
    assert!(drift < INVARIANT_ROUND_OFF, "{drift:e}");
    let explicit = invariant_drift(Fixed(RungeKutta4));
    // measured: 2.1e-6
    assert!(explicit > 1e-8, "{explicit:e}");
}
