//! Outcomes of inputs, with the share of the variance that each cause explains alone.

use core::f64::consts::{E, PI};

pub struct Structure {
    pub name: &'static str,
    pub inputs: usize,
    /// Of standard normal inputs, which may be replaced by functions of their uniform numbers.
    pub of: fn(&mut [f64], &[f64]) -> f64,
    /// With their first-order shares; NaN if unknown.
    pub causes: &'static [(usize, f64)],
    /// Inputs correlated with a cause, with their shares.
    pub others: &'static [(usize, f64)],
    /// No number of runs tells the share of a cause without a fourth moment.
    pub has_tail: bool,
    /// The shares are those of whether it is missed.
    pub limit: Option<f64>,
}

fn step(is: bool) -> f64 {
    f64::from(u8::from(is))
}

/// By its quantile: the root of p = 1/2 + (t/(3 + t^2) sqrt(3) + atan(t/sqrt(3)))/pi.
fn student(p: f64) -> f64 {
    let root = 3.0_f64.sqrt();
    let mut ends = [-1e6, 1e6];
    for _ in 0..80 {
        let t: f64 = 0.5 * (ends[0] + ends[1]);
        let below = 0.5 + (root * t / (3.0 + t * t) + (t / root).atan()) / PI < p;
        ends[usize::from(!below)] = t;
    }
    ends[0]
}

/// x + a Pareto number of this index a, of variance a/((a - 1)^2 (a - 2)).
fn with_pareto(x: &mut [f64], u: &[f64], index: f64) -> f64 {
    x[1] = u[1].powf(-1.0 / index);
    x[0] + x[1]
}

fn uniform(x: &mut [f64], u: &[f64]) -> f64 {
    x[0] = u[0];
    u[0]
}

fn ishigami(x: &mut [f64], u: &[f64]) -> f64 {
    x.iter_mut().zip(u).for_each(|(x, u)| *x = PI * (2.0 * *u - 1.0));
    x[0].sin() * (1.0 + 0.1 * x[2].powi(4)) + 7.0 * x[1].sin() * x[1].sin()
}

fn correlated(x: &mut [f64]) -> f64 {
    x[1] = 0.8 * x[0] + 0.6 * x[1];
    x[0]
}

pub fn structures() -> Vec<Structure> {
    const LOG: f64 = E * (E - 1.0);
    // 3^2 p (1 - p) of P(x > 1.5)
    const STEP: f64 = 9.0 * 0.066_807_201_268_858_1 * 0.933_192_798_731_141_9;
    type Of = fn(&mut [f64], &[f64]) -> f64;
    let plain = |name, inputs, of: Of, causes| Structure {
        name,
        inputs,
        of,
        causes,
        others: &[],
        has_tail: false,
        limit: None,
    };
    let tail = |name, of: Of, causes| Structure { has_tail: true, ..plain(name, 2, of, causes) };
    let beside = |name, of: Of, causes, others| Structure { others, ..plain(name, 3, of, causes) };
    let required = |name, of: Of| Structure { limit: Some(1.0), ..plain(name, 2, of, &[(0, 1.0)]) };
    vec![
        plain(
            "x + rare jump",
            2,
            |x, u| {
                x[1] = 20.0 * step(u[1] < 0.02);
                x[0] + x[1]
            },
            &[(0, 1.0 / 8.84), (1, 7.84 / 8.84)],
        ),
        plain(
            "x + dead part",
            2,
            |x, u| {
                x[1] = step(u[1] < 0.04);
                x[0] + 3.0 * x[1]
            },
            &[(0, 1.0 / 1.3456), (1, 0.3456 / 1.3456)],
        ),
        tail("x + Pareto 2.2", |x, u| with_pareto(x, u, 2.2), &[(0, 0.115_755_627), (1, 0.884_244_373)]),
        tail("x + Pareto 2.5", |x, u| with_pareto(x, u, 2.5), &[(0, 9.0 / 29.0), (1, 20.0 / 29.0)]),
        tail("x + Pareto 4", |x, u| with_pareto(x, u, 4.0), &[(0, 9.0 / 11.0), (1, 2.0 / 11.0)]),
        tail(
            "x + Student 3",
            |x, u| {
                x[1] = student(u[1]);
                x[0] + x[1]
            },
            &[(0, 0.25), (1, 0.75)],
        ),
        plain("|x|", 2, |x, _| x[0].abs(), &[(0, 1.0)]),
        plain("x^2", 2, |x, _| x[0] * x[0], &[(0, 1.0)]),
        plain("x^2 + z", 3, |x, _| x[0] * x[0] + x[1], &[(0, 2.0 / 3.0), (1, 1.0 / 3.0)]),
        plain("none of 50", 51, |x, _| x[50], &[(50, 1.0)]),
        plain("one of 300", 300, |x, _| x[7] + x[11], &[(7, 0.5), (11, 0.5)]),
        plain("XOR", 4, |x, _| step((x[0] > 0.0) != (x[3] > 0.0)), &[(0, 0.0), (3, 0.0)]),
        plain("x z", 3, |x, _| x[0] * x[1], &[(0, 0.0), (1, 0.0)]),
        plain("product of the third and fourth of five", 5, |x, _| x[2] * x[3], &[(2, 0.0), (3, 0.0)]),
        plain("x + x z", 3, |x, _| x[0] + x[0] * x[1], &[(0, 0.5), (1, 0.0)]),
        plain("3x + z", 3, |x, _| 3.0 * x[0] + x[1], &[(0, 0.9), (1, 0.1)]),
        plain("x^3 + z", 3, |x, _| x[0].powi(3) + x[1], &[(0, 15.0 / 16.0), (1, 1.0 / 16.0)]),
        plain("e^x + z", 3, |x, _| x[0].exp() + x[1], &[(0, LOG / (LOG + 1.0)), (1, 1.0 / (LOG + 1.0))]),
        plain("e^(x + z)", 3, |x, _| (x[0] + x[1]).exp(), &[(0, 1.0 / (E + 1.0)), (1, 1.0 / (E + 1.0))]),
        plain("x^2 + z^2", 3, |x, _| x[0] * x[0] + x[1] * x[1], &[(0, 0.5), (1, 0.5)]),
        plain("sum of five", 6, |x, _| x[..5].iter().sum(), &[(0, 0.2), (1, 0.2), (2, 0.2), (3, 0.2), (4, 0.2)]),
        plain(
            "five levels + z",
            3,
            |x, u| {
                x[2] = (5.0 * u[2]).floor();
                x[2] + x[1]
            },
            &[(2, 2.0 / 3.0), (1, 1.0 / 3.0)],
        ),
        plain("five steps", 2, |x, u| (5.0 * uniform(x, u)).floor(), &[(0, 1.0)]),
        plain(
            "a step + z",
            2,
            |x, _| 3.0 * step(x[0] > 1.5) + x[1],
            &[(0, STEP / (STEP + 1.0)), (1, 1.0 / (STEP + 1.0))],
        ),
        plain("two waves", 2, |x, u| (4.0 * PI * uniform(x, u)).sin(), &[(0, 1.0)]),
        plain("Ishigami", 4, ishigami, &[(0, 0.313_905_191_147_811_46), (1, 0.442_411_144_790_040_73), (2, 0.0)]),
        plain("x + 2|x| z", 3, |x, _| x[0] + 2.0 * x[0].abs() * x[1], &[(0, 0.2), (1, 1.6 / PI)]),
        beside("x, and z correlated", |x, _| correlated(x), &[(0, 1.0)], &[(1, 0.64)]),
        beside("x + e, and z correlated", |x, _| correlated(x) + 0.5 * x[2], &[(0, 0.8), (2, 0.2)], &[(1, 0.512)]),
        beside("x^2, and z correlated", |x, _| correlated(x).powi(2), &[(0, 1.0)], &[(1, 0.409_6)]),
        required("x > 1", |x, _| x[0]),
        required("|x| > 1", |x, _| x[0].abs()),
        Structure {
            limit: Some(1.0),
            ..beside("x > 1, and z correlated", |x, _| correlated(x), &[(0, 1.0)], &[(1, f64::NAN)])
        },
    ]
}
