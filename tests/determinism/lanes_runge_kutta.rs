//! Lane i of eight equals the scalar run bit for bit, on every path, whatever runs are in other lanes or came before it.

use crate::textbook::*;
use spindrift::math::Isa;
use spindrift::ode::Control;
use spindrift::ode::GaussLegendre;
use spindrift::ode::RungeKutta4;
use spindrift::ode::Tolerance;
use spindrift::ode::{Dop853, DormandPrince};
use spindrift::run::Grid;
use spindrift::run::Status;

const HORIZON: f64 = 6.0;

/// Three-body runs of very different length and outcome, with arcs of their own.
fn cases() -> Vec<Case<4, 1>> {
    (0..29)
        .map(|run| {
            let share = f64::from(run) / 29.0;
            let mut ends = vec![0.37 + 5.0 * share, HORIZON];
            if run % 3 == 0 {
                ends.insert(0, 0.11);
            }
            Case {
                state: [0.994 - 0.3 * share, 0.01 * share, 0.0, -2.0 + share],
                parameters: [0.0123 + 0.01 * share],
                ends,
            }
        })
        .collect()
}

fn equal_in_all_lanes<M: Method>(method: M, control: &Control) {
    let (cases, grid) = (cases(), Grid::uniform(HORIZON, 45));
    let truth = scalar(method, ThreeBody, &cases, &grid, control);
    for isa in Isa::available() {
        let found = lanes(isa, method, ThreeBody, &cases, &grid, control);
        for (run, (found, truth)) in std::iter::zip(&found, &truth).enumerate() {
            assert_eq!(found.bits(), truth.bits(), "run {run} on {}", isa.name());
        }
    }
    // Other neighbours, other lanes.
    let backwards: Vec<_> = cases.iter().rev().cloned().collect();
    let found = lanes(Isa::best(), method, ThreeBody, &backwards, &grid, control);
    for (found, truth) in std::iter::zip(found.iter().rev(), &truth) {
        assert_eq!(found.bits(), truth.bits());
    }
    // Fewer runs than lanes.
    let found = lanes(Isa::best(), method, ThreeBody, &cases[..3], &grid, control);
    for (found, truth) in std::iter::zip(&found, &truth) {
        assert_eq!(found.bits(), truth.bits());
    }
}

fn bounded(max_steps: u64) -> Control {
    Control { tolerance: Tolerance { relative: 1e-7, absolute: 1e-8 }, step: Some(0.003), max_steps }
}

#[test]
fn dormand_prince() {
    equal_in_all_lanes(Adaptive(DormandPrince), &bounded(100_000));
}

#[test]
fn dop853() {
    equal_in_all_lanes(Adaptive(Dop853), &bounded(100_000));
}

#[test]
fn runge_kutta_4() {
    equal_in_all_lanes(Fixed(RungeKutta4), &bounded(100_000));
}

#[test]
fn gauss_legendre() {
    equal_in_all_lanes(Fixed(GaussLegendre), &bounded(100_000));
}

#[test]
fn runs_that_fail_beside_runs_that_do_not() {
    // Half of them: the median of the attempts that they need.
    let grid = Grid::uniform(HORIZON, 45);
    let mut attempts: Vec<u64> = scalar(Adaptive(DormandPrince), ThreeBody, &cases(), &grid, &bounded(100_000))
        .iter()
        .map(|journey| journey.outcome.effort.steps + journey.outcome.effort.rejected)
        .collect();
    attempts.sort_unstable();
    let control = bounded(attempts[attempts.len() / 2]);
    let statuses: Vec<Status> =
        scalar(Adaptive(DormandPrince), ThreeBody, &cases(), &Grid::uniform(HORIZON, 45), &control)
            .iter()
            .map(|journey| journey.outcome.status)
            .collect();
    assert!(statuses.contains(&Status::Done) && statuses.contains(&Status::StepLimit), "{statuses:?}");
    equal_in_all_lanes(Adaptive(DormandPrince), &control);
}

#[test]
fn runs_differ_so_that_equality_says_something() {
    let truth = scalar(Adaptive(DormandPrince), ThreeBody, &cases(), &Grid::uniform(HORIZON, 45), &bounded(100_000));
    let steps: std::collections::HashSet<u64> = truth.iter().map(|journey| journey.outcome.effort.steps).collect();
    assert!(steps.len() > 15, "{steps:?}");
}
