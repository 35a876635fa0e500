//! Ends of runs: done, step limit, step floor, not finite; arcs and observation points are met exactly.

use crate::prelude::*;
use crate::textbook::*;

const ROUND_OFF: f64 = 1e-14;

#[test]
fn arcs_restart_exactly() {
    let case = Case { state: [0.0], parameters: [], ends: vec![0.3, 0.3, 1.0, 1.7] };
    let grid = Grid::at(vec![0.0, 0.1, 0.3, 0.9, 1.0, 1.1, 1.7]);
    let truth = |t: f64| {
        let cube = |t: f64| t * t * t;
        cube(t.min(0.3)) + 3.0 * (cube(t.clamp(0.3, 1.0)) - cube(0.3)) + 4.0 * (cube(t.max(1.0)) - 1.0)
    };
    for (name, Journey { points, outcome }) in by_every_method(Switched, case, &grid, &control(1e-6, 0.07)) {
        assert_eq!((outcome.status, outcome.time, outcome.points), (Status::Done, 1.7, 7), "{name}");
        assert_eq!(points[0], [0.0]);
        for (time, state) in grid.times().iter().zip(&points) {
            assert!((state[0] - truth(*time)).abs() < ROUND_OFF, "{name} at {time}: {} {}", state[0], truth(*time));
        }
    }
}

fn ends<L: Law<1, 0>>(law: L, state: f64) -> [(&'static str, Outcome); 4] {
    let case = Case { state: [state], parameters: [], ends: vec![2.0] };
    by_every_method(law, case, &Grid::uniform(2.0, 21), &control(1e-8, 0.01)).map(|(name, journey)| {
        let outcome = journey.outcome;
        assert!(outcome.time < 2.0);
        assert_eq!(outcome.points, 1 + (outcome.time / 0.1 + 1e-9) as usize, "{name}: {outcome:?}");
        for (point, state) in journey.points.iter().enumerate() {
            assert_eq!(state[0].is_nan(), point >= outcome.points, "{name}, point {point}");
        }
        (name, outcome)
    })
}

#[test]
fn a_pole_is_a_step_floor_or_not_finite() {
    let all = ends(BlowUp, 1.0);
    for (name, outcome) in &all[..2] {
        assert!(matches!(outcome.status, Status::StepFloor | Status::NonFinite), "{name}: {outcome:?}");
        assert!((outcome.time - 1.0).abs() < 1e-8, "{name}: the pole is at 1: {outcome:?}");
    }
    assert!(all[2..].iter().all(|(_, outcome)| outcome.status == Status::NonFinite), "{all:?}");
}

#[test]
fn what_is_no_number_from_the_start_ends_at_once() {
    let all = ends(NotANumber, -1.0);
    assert!(all.iter().all(|(_, outcome)| outcome.status == Status::NonFinite), "{all:?}");
}

#[test]
fn a_run_takes_max_steps_and_no_more() {
    let grid = Grid::uniform(1.0, 3);
    let mut scenes = mixed(1, false, 1.0);
    scenes[0].mass.debris = None;
    for method in spindrift::propagation::Method::ALL {
        let control = if method.has_fixed_step() { fixed(0.01) } else { adaptive(1e-6) };
        let run = |max_steps| propagate(method, Control { max_steps, ..control }, &grid, &scenes).remove(0).outcome;
        let attempts = |outcome: &Outcome| outcome.effort.steps + outcome.effort.rejected;
        let needed = attempts(&run(1_000_000));
        assert!(needed > 2, "{}: {needed}", method.name());
        let (enough, short) = (run(needed), run(needed - 1));
        assert_eq!((enough.status, attempts(&enough)), (Status::Done, needed), "{}", method.name());
        assert_eq!((short.status, attempts(&short)), (Status::StepLimit, needed - 1), "{}", method.name());
    }
}

#[test]
fn a_step_too_long_for_the_iteration_is_not_passed_over() {
    let case = Case { state: [1.0, 0.0], parameters: [40.0], ends: vec![2.0] };
    let journey =
        scalar(Fixed(GaussLegendre), Oscillator, &[case], &Grid::uniform(2.0, 3), &control(1e-8, 1.0)).remove(0);
    assert_eq!(journey.outcome.status, Status::NonFinite);
    assert_eq!((journey.outcome.time, journey.outcome.points), (0.0, 1));
}

fn gated(parameter: f64, end: f64, tolerance: f64) -> Journey<2> {
    let case = Case { state: [0.0; 2], parameters: [parameter], ends: vec![end] };
    let journey = scalar(Adaptive(Dop853), Gated, &[case], &Grid::uniform(end, 2), &control(tolerance, 0.1)).remove(0);
    assert_eq!(journey.outcome.status, Status::Done);
    journey
}

/// Law: pulses much shorter than a step, without a net change of branch, are all found. Truth: the integral of max(0,
/// cos t - c) over ten turns.
#[test]
fn short_pulses_within_a_step_are_found() {
    for depth in [0.3_f64, 1e-2, 1e-4, 1e-6] {
        let half = (1.0 - depth).acos();
        let expected = 21.0 * (half.sin() - (1.0 - depth) * half);
        let found = gated(depth, 20.0 * std::f64::consts::PI + 3.0, 1e-9).points[1][0];
        assert!((found - expected).abs() < 1e-8 * expected + 1e-10, "{depth:e}: {found} for {expected}");
    }
}

/// Law: difficult switch functions cost no more than some steps.
#[test]
fn no_switch_function_hangs() {
    for (number, (_, most)) in GATES.iter().enumerate() {
        let effort = gated(1.0 + number as f64, 20.0, 1e-10).outcome.effort;
        assert!(effort.steps + effort.rejected < *most, "{number}: {effort:?}");
    }
}
