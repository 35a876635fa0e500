//! Lane i of eight equals the scalar run bit for bit, whatever runs are in other lanes or came before.

use crate::prelude::*;
use std::collections::HashSet;

use crate::textbook::*;

const HORIZON: f64 = 6.0;
const CONTROL: Control =
    Control { tolerance: Tolerance { relative: 1e-7, absolute: 1e-8 }, step: Some(0.003), max_steps: 100_000 };

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

fn equal<M: LaneMethod, L: Law<N, 1>, const N: usize>(method: M, law: L, cases: &[Case<N, 1>]) {
    let grid = Grid::uniform(HORIZON, 45);
    let truth = scalar(method, law, cases, &grid, &CONTROL);
    let bits = |journeys: &[Journey<N>]| journeys.iter().map(Journey::bits).collect::<Vec<_>>();
    let found = |isa: Isa, cases: &[Case<N, 1>]| bits(&lanes(isa, method, law, cases, &grid, &CONTROL));
    let truth = bits(&truth);
    for isa in Isa::available() {
        assert!(found(isa, cases) == truth, "{}", isa.name());
    }
    let backwards: Vec<_> = cases.iter().rev().cloned().collect();
    assert!(found(Isa::best(), &backwards).iter().rev().eq(&truth) && found(Isa::best(), &cases[..3]) == truth[..3]);
}

#[test]
fn lanes_are_scalar_runs() {
    let cases = cases();
    equal(Adaptive(DormandPrince), ThreeBody, &cases);
    equal(Adaptive(Dop853), ThreeBody, &cases);
    equal(Fixed(RungeKutta4), ThreeBody, &cases);
    equal(Fixed(GaussLegendre), ThreeBody, &cases);
}

#[test]
fn lanes_switch_apart_from_each_other() {
    let case = |run: u32| {
        let share = f64::from(run) / 29.0;
        let frequency = if run % 5 == 4 { 0.1 } else { 1.0 + 7.0 * share };
        Case { state: [1e-3 + share, 1.0 - share], parameters: [frequency], ends: vec![0.4 + share, HORIZON] }
    };
    let cases: Vec<Case<2, 1>> = (0..29).map(case).collect();
    equal(Adaptive(DormandPrince), TwoSprings, &cases);
    equal(Adaptive(Dop853), TwoSprings, &cases);
    let ended = scalar(Adaptive(Dop853), TwoSprings, &cases, &Grid::uniform(HORIZON, 45), &CONTROL);
    let replaced: HashSet<u64> = ended.iter().map(|journey| journey.outcome.effort.rejected).collect();
    assert!(replaced.len() > 8 && ended.iter().all(|journey| journey.outcome.status == Status::Done), "{replaced:?}");
}
