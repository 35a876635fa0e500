//! Lane i of eight equals the scalar run bit for bit, whatever runs are in other lanes or came before.

use crate::support::prelude::*;
use std::collections::HashSet;

use crate::textbook::*;
use spindrift::ode::{Dop853, DormandPrince, GaussLegendre, RungeKutta4};

const HORIZON: f64 = 6.0;

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

fn equal_in_all_lanes<M: LaneMethod>(method: M, control: &Control) {
    equal(method, ThreeBody, &cases(), control);
}

fn equal<M: LaneMethod, L: Law<N, 1>, const N: usize>(method: M, law: L, cases: &[Case<N, 1>], control: &Control) {
    let grid = Grid::uniform(HORIZON, 45);
    let truth = scalar(method, law, cases, &grid, control);
    let bits = |journeys: &[Journey<N>]| journeys.iter().map(Journey::bits).collect::<Vec<_>>();
    let found = |isa: Isa, cases: &[Case<N, 1>]| bits(&lanes(isa, method, law, cases, &grid, control));
    let truth = bits(&truth);
    for isa in Isa::available() {
        assert!(found(isa, cases) == truth, "{}", isa.name());
    }
    let backwards: Vec<_> = cases.iter().rev().cloned().collect();
    assert!(found(Isa::best(), &backwards).iter().rev().eq(&truth) && found(Isa::best(), &cases[..3]) == truth[..3]);
}

fn bounded(max_steps: u64) -> Control {
    Control { tolerance: Tolerance { relative: 1e-7, absolute: 1e-8 }, step: Some(0.003), max_steps }
}

#[test]
fn lanes_are_scalar_runs() {
    let control = bounded(100_000);
    equal_in_all_lanes(Adaptive(DormandPrince), &control);
    equal_in_all_lanes(Adaptive(Dop853), &control);
    equal_in_all_lanes(Fixed(RungeKutta4), &control);
    equal_in_all_lanes(Fixed(GaussLegendre), &control);
}

#[test]
fn lanes_switch_apart_from_each_other() {
    let case = |run: u32| {
        let share = f64::from(run) / 29.0;
        let frequency = if run % 5 == 4 { 0.1 } else { 1.0 + 7.0 * share };
        Case { state: [1e-3 + share, 1.0 - share], parameters: [frequency], ends: vec![0.4 + share, HORIZON] }
    };
    let cases: Vec<Case<2, 1>> = (0..29).map(case).collect();
    let control = bounded(100_000);
    equal(Adaptive(DormandPrince), TwoSprings, &cases, &control);
    equal(Adaptive(Dop853), TwoSprings, &cases, &control);
    let ended = scalar(Adaptive(Dop853), TwoSprings, &cases, &Grid::uniform(HORIZON, 45), &control);
    let replaced: HashSet<u64> = ended.iter().map(|journey| journey.outcome.effort.rejected).collect();
    assert!(replaced.len() > 8 && ended.iter().all(|journey| journey.outcome.status == Status::Done), "{replaced:?}");
}

#[test]
fn runs_that_fail_beside_runs_that_do_not() {
    let of =
        |control: &Control| scalar(Adaptive(DormandPrince), ThreeBody, &cases(), &Grid::uniform(HORIZON, 45), control);
    let whole = of(&bounded(100_000));
    let steps: HashSet<u64> = whole.iter().map(|journey| journey.outcome.effort.steps).collect();
    assert!(steps.len() > 15, "runs differ, so that equality says something: {steps:?}");
    let attempts = |journey: &Journey<4>| journey.outcome.effort.steps + journey.outcome.effort.rejected;
    let mut attempts: Vec<u64> = whole.iter().map(attempts).collect();
    attempts.sort_unstable();
    let control = bounded(attempts[attempts.len() / 2]);
    let statuses: Vec<Status> = of(&control).iter().map(|journey| journey.outcome.status).collect();
    assert!(statuses.contains(&Status::Done) && statuses.contains(&Status::StepLimit), "{statuses:?}");
    equal_in_all_lanes(Adaptive(DormandPrince), &control);
}
