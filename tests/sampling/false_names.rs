//! Rate at which an input without effect is named as a driver, by design.

use crate::prelude::*;
use spindrift::{
    analysis::effects::{TestedInput, on_spread},
    math::normal::quantile,
    statistics::correlation::ascending_order,
};

const CAMPAIGNS: u64 = 300;

pub fn numbers(design: &Design, seed: u64, dimensions: usize, points: u64) -> Vec<Vec<f64>> {
    let names: Vec<String> = (0..dimensions).map(|k| format!("d{k}")).collect();
    let factors: Vec<usize> = (0..dimensions).collect();
    let of = Dimensions { seed, samples: points + 1, names: &names, factors: &factors };
    let (mut source, mut u) = (design.points(of), vec![[0.0; 8]; dimensions]);
    let mut inputs = vec![Vec::new(); dimensions];
    for block in 0..=points / 8 {
        source.fill(block, &mut u);
        for (input, u) in inputs.iter_mut().zip(&u) {
            let sample = |lane: &usize| (1..=points).contains(&(block * 8 + *lane as u64));
            input.extend((0..8).filter(sample).map(|lane| u[lane]));
        }
    }
    inputs
}

fn named(design: &Design, dimensions: usize, points: u64) -> u64 {
    let pairs: Vec<[usize; 2]> = (0..dimensions).flat_map(|j| (0..j).map(move |k| [k, j])).collect();
    let is_named = |seed: &u64| {
        let inputs = numbers(design, *seed, dimensions, points);
        let [j, k] = pairs[*seed as usize % pairs.len()];
        let y = inputs[j].iter().zip(&inputs[k]).map(|(a, b)| match seed / pairs.len() as u64 % 2 {
            0 => quantile(*a) * quantile(*b),
            _ => f64::from(u8::from((*a > 0.5) != (*b > 0.5))),
        });
        let tested: Vec<_> = inputs.iter().map(|x| TestedInput::new(x, &ascending_order(x))).collect();
        let p_values = on_spread(&tested, &y.collect::<Vec<f64>>(), 1);
        p_values.iter().enumerate().any(|(input, p)| input != j && input != k && p.is_some_and(|p| p <= 0.05))
    };
    (0..CAMPAIGNS).filter(is_named).count() as u64
}

/// H0: an input that does nothing is named in at most 0.05 of 300 campaigns: 26 (alpha = 2e-3). Counter-test: a
/// sequence with too few points binds inputs to each other.
#[test]
fn what_does_nothing_is_seldom_named() {
    let sobol = Design::Sobol(Written::NONE);
    let others = [Design::DEFAULT, Design::LatinHypercube(Written::NONE)];
    let mut cases = Vec::new();
    for design in &others {
        cases.extend([(5, 64), (10, 256), (50, 64), (50, 256), (50, 1000), (6, 1024)].map(|case| (design, case)));
    }
    cases.extend([(3, 128), (3, 256), (5, 512), (6, 1024), (6, 1000)].map(|case| (&sobol, case)));
    let halton = Design::Halton(Written::NONE);
    cases.extend([(3, 30), (4, 30), (5, 97), (6, 251), (8, 1050), (10, 3169)].map(|case| (&halton, case)));
    for (design, (dimensions, points)) in cases {
        assert_eq!(design.bound(dimensions, points), None);
        let count = named(design, dimensions, points);
        assert!(count <= 26, "{} {dimensions} inputs, {points} points: {count}", design.name());
    }
    let bound = [(10, 64), (10, 256), (50, 256), (50, 1024)].map(|case| (&sobol, case));
    for (design, (dimensions, points)) in bound.into_iter().chain([(&halton, (10, 256)), (&halton, (30, 1024))]) {
        let count = named(design, dimensions, points);
        assert!(design.bound(dimensions, points).is_some() && count > 26, "{dimensions} {points}: {count}");
    }
}
