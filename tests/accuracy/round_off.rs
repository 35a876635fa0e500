//! Round-off: at the smallest tolerance errors of conserved quantities are a random walk of last digits (D. Brouwer,
//! Astronomical Journal 46, 1937), and nothing grows faster.
//!
//! Of the signed relative errors e of 64 random scenes after N steps: rms e <= bound sqrt(N); the log-log slope of rms
//! e is 0.5 +- 0.1; the mean of e is within three standard errors of zero (alpha = 0.0027).

use crate::support::{invariants::Invariants, prelude::*};
use rayon::prelude::*;

const SECTION: &str = "round_off";
const TOLERANCE: f64 = 1e-16;
const SCENES: u64 = 64;
/// rms |dE/E| after N steps, over sqrt(N).
const ENERGY: f64 = 1.5e-16;
const MAGNITUDE: f64 = 1.5e-16;
/// Bound for the vector L in F_e.
const MOMENTUM: f64 = 3e-16;
/// Median error of the attitude quaternion's norm, which nothing renormalises, over sqrt(N).
const NORM: f64 = 1.5e-16;
/// Largest such error over N: nearly constant rates repeat their roundings (2.6e-18 a step in two of 64 scenes).
const NORM_A_STEP: f64 = 1e-17;
/// The random walk's slope and its slack.
const SLOPE: f64 = 0.5;
const SLOPE_SLACK: f64 = 0.1;
const SIGMAS: f64 = 3.0;

/// Signed errors by point: mean number of steps, errors over the scenes, and errors over sqrt(N).
struct Walk {
    steps: Vec<f64>,
    errors: Vec<Vec<f64>>,
    scaled: Vec<Vec<f64>>,
}

fn rms(values: &[f64]) -> f64 {
    (values.iter().map(|x| x * x).sum::<f64>() / values.len() as f64).sqrt()
}

impl Walk {
    fn rate(&self) -> f64 {
        self.scaled.iter().map(|errors| rms(errors)).fold(0.0, f64::max)
    }

    fn slope(&self) -> f64 {
        let points: Vec<[f64; 2]> =
            self.steps.iter().zip(&self.errors).map(|(n, e)| [libm::log(*n), libm::log(rms(e))]).collect();
        draws::slope(&points)
    }

    fn bias(&self) -> f64 {
        let bias = |e: &Vec<f64>| {
            let n = e.len() as f64;
            let mean = e.iter().sum::<f64>() / n;
            let variance = e.iter().map(|x| (x - mean) * (x - mean)).sum::<f64>() / (n - 1.0);
            mean.abs() / (variance / n).sqrt()
        };
        self.scaled.iter().map(bias).fold(0.0, f64::max)
    }

    fn broken(&self, bound: f64) -> Vec<String> {
        let (rate, slope, bias) = (self.rate(), self.slope(), self.bias());
        let mut broken = Vec::new();
        if rate.is_nan() || rate > bound {
            broken.push(format!("rms e / sqrt(N) = {rate:e} > {bound:e}"));
        }
        if slope.is_nan() || (slope - SLOPE).abs() > SLOPE_SLACK {
            broken.push(format!("slope {slope}"));
        }
        if bias.is_nan() || bias > SIGMAS {
            broken.push(format!("mean off by {bias} standard errors"));
        }
        broken
    }
}

fn taylor(steps: &[f64]) -> [Walk; 4] {
    let scenes = mixed(SCENES, false, 10.0);
    let run = |times: Vec<f64>, scenes: &[Scene]| {
        let grid = Grid::at(times);
        let fields = rotational();
        let plan = PropagationSettings::new(Method::Taylor, adaptive(TOLERANCE), grid, fields, &scenes[0]);
        let parts: Vec<_> = scenes.par_chunks(8).map(|part| propagate_on(Isa::best(), &plan, part)).collect();
        parts.into_iter().flatten().collect::<Vec<_>>()
    };
    let rates: Vec<f64> =
        run(vec![0.0, 20.0], &scenes).iter().map(|run| run.outcome.effort.steps as f64 / 20.0).collect();
    let mean = libm::exp(rates.iter().map(|rate| libm::log(*rate)).sum::<f64>() / rates.len() as f64);
    let times: Vec<f64> = std::iter::once(0.0).chain(steps.iter().map(|n| n / mean)).collect();
    let runs = run(times.clone(), &scenes);
    for (scene, run) in runs.iter().enumerate() {
        assert_eq!(run.outcome.status, Status::Done, "scene {scene}");
    }
    from_fn(|quantity| {
        let mut walk = Walk { steps: steps.to_vec(), errors: Vec::new(), scaled: Vec::new() };
        for (point, time) in times.iter().enumerate().skip(1) {
            let errors: Vec<f64> = scenes
                .iter()
                .zip(&runs)
                .map(|(scene, run)| {
                    let start = Invariants::of(scene, &run.table, 0);
                    Invariants::of(scene, &run.table, point).errors(&start)[quantity]
                })
                .collect();
            walk.scaled.push(errors.iter().zip(&rates).map(|(e, rate)| e / (rate * time).sqrt()).collect());
            walk.errors.push(errors);
        }
        walk
    })
}

fn decades(count: i32) -> Vec<f64> {
    (0..=2 * count).map(|k| libm::pow(10.0, 2.0 + 0.5 * f64::from(k))).collect()
}

fn hold_law(count: i32, last: &str) {
    let steps = decades(count);
    let [energy, momentum, norm, vector] = taylor(&steps);
    for (name, walk, bound) in [("energy", &energy, ENERGY), ("magnitude of L", &momentum, MAGNITUDE)] {
        let (slope, bias) = (walk.slope(), walk.bias());
        assert!(walk.broken(bound).is_empty(), "{name}: {:?}", walk.broken(bound));
        let claim = |what: &str| format!("`taylor` at 1e-16, {name}: {what}, N to {last}");
        hold(SECTION, &claim("rms over 64 scenes of the relative error / sqrt(N)"), bound, walk.rate());
        hold(SECTION, &claim("distance of its log-log slope from 1/2"), SLOPE_SLACK, (slope - SLOPE).abs());
        hold(SECTION, &claim("mean in standard errors"), SIGMAS, bias);
    }
    let claim = |what: &str| format!("`taylor` at 1e-16, {what}, N to {last}");
    assert!((vector.slope() - SLOPE).abs() < SLOPE_SLACK, "vector L: slope {}", vector.slope());
    hold(
        SECTION,
        &claim("vector L in F_e: rms over 64 scenes of the relative error / sqrt(N)"),
        MOMENTUM,
        vector.rate(),
    );
    let (mut middle, mut largest) = (0.0_f64, 0.0_f64);
    for (n, (errors, scaled)) in steps.iter().zip(norm.errors.iter().zip(&norm.scaled)) {
        let mut sizes: Vec<f64> = scaled.iter().map(|x| x.abs()).collect();
        sizes.sort_by(f64::total_cmp);
        middle = middle.max(sizes[sizes.len() / 2]);
        let size = errors.iter().fold(0.0_f64, |size, e| size.max(e.abs()));
        largest = if *n > 1e3 { largest.max(size / n) } else { largest };
    }
    hold(SECTION, &claim("norm of the quaternion: median error / sqrt(N)"), NORM, middle);
    hold(SECTION, &claim("norm of the quaternion: largest error / N"), NORM_A_STEP, largest);
}

#[test]
fn taylor_errors_are_a_random_walk() {
    hold_law(3, "1e5");
}

#[test]
#[ignore = "a minute: cargo test --release --test accuracy -- --ignored a_million_steps"]
fn taylor_errors_are_a_random_walk_over_a_million_steps() {
    hold_law(4, "1e6");
}

const PERIODIC: f64 = 1e-14;
const GROWTH: f64 = 2.0;

const MOST_STEPS: u64 = 200;

#[test]
fn periods_add_no_error_of_conservation() {
    let scenes = mixed(SCENES, false, 10.0);
    let fields = rotational();
    let (mut first, mut all) = (0.0_f64, 0.0_f64);
    for exponent in 2..=6 {
        let horizon = libm::pow(10.0, f64::from(exponent));
        let plan = PropagationSettings::new(
            Method::Auto,
            Control { max_steps: MOST_STEPS, ..adaptive(TOLERANCE) },
            Grid::uniform(horizon, 101),
            fields,
            &scenes[0],
        );
        let mut worst = 0.0_f64;
        let mut periodic = 0;
        for (scene, run) in scenes.iter().zip(propagate_on(Isa::best(), &plan, &scenes)) {
            if run.outcome.status == Status::StepLimit {
                continue;
            }
            assert_eq!(run.outcome.status, Status::Done);
            periodic += 1;
            let start = Invariants::of(scene, &run.table, 0);
            for point in 1..101 {
                let errors = Invariants::of(scene, &run.table, point).errors(&start);
                worst = errors.iter().fold(worst, |worst, e| worst.max(e.abs()));
            }
        }
        assert!(periodic > 50, "most random scenes have a period: {periodic}");
        first = if exponent == 2 { worst } else { first };
        all = all.max(worst);
    }
    let claim = |what: &str| format!("`auto` at 1e-16, 64 scenes, 1e2 to 1e6 s: {what}");
    hold(SECTION, &claim("largest error of energy, magnitude of L, vector L, norm"), PERIODIC, all);
    hold(SECTION, &claim("largest error at any horizon over that at 1e2 s"), GROWTH, all / first);
}
