//! Requirements on means: what bounds of the values guarantee, what is assumed without them, and how often the number
//! of runs that is named decides. H0: a bound misses with at most 5%; alpha = 1e-4. docs/results.md has the rates.

use crate::prelude::*;
use spindrift::{
    math::normal,
    statistics::{
        binomial::{Decision, at_least},
        gate::{bounded_mean_gate, fraction_gate},
        mean::{bounded_mean_bounds, mean_bounds},
    },
};

const ALPHA: f64 = 1e-4;
const RISK: f64 = 0.05;

fn may_miss(count: u32, campaigns: u32) -> bool {
    count == 0 || at_least(u64::from(count), u64::from(campaigns), RISK) > ALPHA
}

fn rate(count: u32, campaigns: u32) -> f64 {
    f64::from(count) / f64::from(campaigns)
}

fn normal_number(random: &mut Uniform) -> f64 {
    normal::quantile(random.uniform())
}

fn exponential(random: &mut Uniform) -> f64 {
    -libm::log(random.uniform())
}

/// Ordinary spread with a rare event: name, a number of it, mean, probability of the event.
type Tailed = (&'static str, fn(&mut Uniform) -> f64, f64, f64);

const TAILED: [Tailed; 3] = [
    (
        "1000 in a thousandth",
        |random| f64::from(u8::from(random.uniform() < 0.001)) * 1000.0 + normal_number(random),
        1.0,
        0.001,
    ),
    (
        "fifty times an exponential number in 2%",
        |random| if random.uniform() < 0.02 { 50.0 * exponential(random) } else { exponential(random) },
        1.98,
        0.02,
    ),
    ("10 in 5%", |random| f64::from(u8::from(random.uniform() < 0.05)) * 10.0 + normal_number(random), 0.5, 0.05),
];

/// Of such events in a campaign (`RARE` of the program).
const RARE: f64 = 10.0;

/// Law: an upper bound of a mean without bounds of the values misses as stated from ten rare events on; with one or
/// fewer it misses far more often.
#[test]
fn rare_events_are_what_a_mean_assumes() {
    for (index, (name, draw, mean, probability)) in TAILED.into_iter().enumerate() {
        for runs in [20_u32, 50, 100, 200, 500, 1000, 2000, 10_000] {
            let campaigns = if runs > 1000 { 300 } else { 1000 };
            let mut random = Uniform::new(100 * index as u64 + u64::from(runs));
            let mut misses = 0;
            for _ in 0..campaigns {
                let values: Vec<f64> = (0..runs).map(|_| draw(&mut random)).collect();
                misses += u32::from(mean_bounds(&Moments::of_block(&values), 1.0 - RISK)[1] < mean);
            }
            let events = f64::from(runs) * probability;
            if events >= RARE {
                assert!(may_miss(misses, campaigns), "{name} {runs}: {misses} of {campaigns}");
            } else if events <= 1.0 {
                assert!(rate(misses, campaigns) > 0.15, "the counter-test: {name} {runs}: {misses} of {campaigns}");
            }
        }
    }
}

fn flat(random: &mut Uniform) -> f64 {
    3.0_f64.sqrt() * (2.0 * random.uniform() - 1.0)
}

const LONGEST: f64 = 10.0;

fn cut(random: &mut Uniform) -> f64 {
    -libm::log1p(-random.uniform() * (1.0 - libm::exp(-LONGEST)))
}

/// Name, a number of it, mean, bounds.
type Bounded = (&'static str, fn(&mut Uniform) -> f64, f64, [f64; 2]);

/// 1 - 10/(e^10 - 1).
const MEAN_BELOW: f64 = 0.999_545_980_089_903;
const ROOT_3: f64 = 1.732_050_807_568_877_2;

const BOUNDED: [Bounded; 5] = [
    (
        "1000 in a thousandth",
        |random| f64::from(u8::from(random.uniform() < 0.001)) * 1000.0 + flat(random),
        1.0,
        [-ROOT_3, 1000.0 + ROOT_3],
    ),
    (
        "fifty times an exponential number in 2%",
        |random| if random.uniform() < 0.02 { 50.0 * cut(random) } else { cut(random) },
        1.98 * MEAN_BELOW,
        [0.0, 50.0 * LONGEST],
    ),
    (
        "10 in 5%",
        |random| f64::from(u8::from(random.uniform() < 0.05)) * 10.0 + flat(random),
        0.5,
        [-ROOT_3, 10.0 + ROOT_3],
    ),
    ("flat", flat, 0.0, [-ROOT_3, ROOT_3]),
    ("half 0, half 1", |random| f64::from(u8::from(random.uniform() < 0.5)), 0.5, [0.0, 1.0]),
];

/// Law: with bounds of the values both bounds of the mean miss as stated, whatever the tail; a limit at a quarter of
/// the range above the mean passes with 1,000 runs. Without the bounds the same numbers pass wrongly.
#[test]
fn bounded_means_miss_as_seldom_as_stated() {
    let mut worst: f64 = 0.0;
    for (index, (name, draw, mean, range)) in BOUNDED.into_iter().enumerate() {
        for runs in [3_u32, 20, 100, 1000] {
            let campaigns = if runs == 1000 { 500 } else { 2000 };
            let mut random = Uniform::new(7000 + 100 * index as u64 + u64::from(runs));
            let (mut misses, mut passes, mut free) = ([0_u32; 2], 0_u32, 0_u32);
            for _ in 0..campaigns {
                let values: Vec<f64> = (0..runs).map(|_| draw(&mut random)).collect();
                assert!(values.iter().all(|value| range[0] <= *value && *value <= range[1]), "{name}");
                let moments = Moments::of_block(&values);
                let [lower, upper] = bounded_mean_bounds(&moments, range, 1.0 - RISK);
                assert!(range[0] <= lower && lower <= upper && upper <= range[1], "{name}: {lower} {upper}");
                misses[0] += u32::from(lower > mean);
                misses[1] += u32::from(upper < mean);
                let clear = GateLimit::AtMost(mean + 0.25 * (range[1] - range[0]));
                passes += u32::from(bounded_mean_gate(&moments, range, clear, 1.0 - RISK).decision == Decision::Pass);
                free += u32::from(mean_bounds(&moments, 1.0 - RISK)[1] < mean);
            }
            assert!(misses.iter().all(|count| may_miss(*count, campaigns)), "{name} {runs}: {misses:?}");
            assert!(misses.iter().all(|count| *count <= u32::from(campaigns == 2000)), "{name} {runs}: {misses:?}");
            assert!(runs < 1000 || passes == campaigns, "{name}: {passes}");
            worst = worst.max(rate(free, campaigns));
        }
    }
    assert!(worst > 0.3, "the counter-test: {worst}");
}

/// True if a campaign of the runs named decides; `None` where the first is decided, or names no number up to [`MOST`].
fn followed(
    gate: impl Fn(&[f64]) -> Decision,
    draw: fn(&mut Uniform) -> f64,
    runs: u64,
    random: &mut Uniform,
) -> Option<bool> {
    let campaign = |runs: u64, random: &mut Uniform| gate(&(0..runs).map(|_| draw(random)).collect::<Vec<f64>>());
    let Decision::Undecided(Some(needed)) = campaign(runs, random) else { return None };
    (needed <= MOST).then(|| !matches!(campaign(needed, random), Decision::Undecided(_)))
}

const MOST: u64 = 30_000;

/// Law: of campaigns of the number of runs that is named, half decide or more: what was seen is off by its error.
#[test]
fn half_of_those_that_follow_the_number_of_runs_decide() {
    const FOLLOWED: u32 = 200;
    const LEAST: f64 = 0.42;
    let mean_at = |limit: f64| {
        move |values: &[f64]| mean_gate(&Moments::of_block(values), GateLimit::AtMost(limit), 0.95).decision
    };
    let share = |target: f64| {
        move |values: &[f64]| {
            let within = values.iter().filter(|value| **value == 1.0).count() as u64;
            fraction_gate(within, values.len() as u64, target, 0.95).decision
        }
    };
    let check = |what: &str, seed: u64, one: &dyn Fn(&mut Uniform) -> Option<bool>| {
        let mut random = Uniform::new(seed);
        let found: Vec<bool> = (0..4 * FOLLOWED).filter_map(|_| one(&mut random)).take(FOLLOWED as usize).collect();
        let decided = rate(found.iter().filter(|decided| **decided).count() as u32, found.len() as u32);
        assert!(found.len() > 50 && decided >= LEAST, "{what}: {decided}");
    };
    for (index, runs) in [20_u64, 100].into_iter().enumerate() {
        for distance in [0.1, 0.2] {
            let seed = 10 * index as u64 + (100.0 * distance) as u64;
            check(&format!("normal, {distance} from the limit, {runs} runs"), 100 + seed, &|random| {
                followed(mean_at(distance), normal_number, runs, random)
            });
            check(&format!("exponential, {distance} from the limit, {runs} runs"), 200 + seed, &|random| {
                followed(mean_at(1.0 + distance), exponential, runs, random)
            });
        }
        check(&format!("97% within the limit for 95%, {} runs", 5 * runs), 300 + index as u64, &|random| {
            followed(share(0.95), |random| f64::from(u8::from(random.uniform() < 0.97)), 5 * runs, random)
        });
    }
}
