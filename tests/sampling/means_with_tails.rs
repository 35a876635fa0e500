//! Requirements on means: what bounds of the values guarantee, what is assumed without them, and how often the number
//! of runs that an undecided one names decides.
//!
//! Seeds are fixed. H0 of each: a bound misses with at most 5%; one-sided, alpha = 1e-4. `--nocapture` prints the rates
//! that docs/results.md lists.

use crate::support::scenes::Uniform;
use spindrift::statistics::binomial::{Decision, at_least};
use spindrift::statistics::gate::{GateLimit, bounded_mean_gate};
use spindrift::statistics::mean::{bounded_mean_bounds, mean_bounds};
use spindrift::statistics::moments::Moments;

const ALPHA: f64 = 1e-4;
/// The risk of a bound.
const RISK: f64 = 0.05;

fn may_miss(count: u32, campaigns: u32) -> bool {
    count == 0 || at_least(u64::from(count), u64::from(campaigns), RISK) > ALPHA
}

fn rate(count: u32, campaigns: u32) -> f64 {
    f64::from(count) / f64::from(campaigns)
}

fn flat(random: &mut Uniform) -> f64 {
    3.0_f64.sqrt() * (2.0 * random.uniform() - 1.0)
}

/// The longest exponential number of those that are cut off.
const LONGEST: f64 = 10.0;

fn cut(random: &mut Uniform) -> f64 {
    -libm::log1p(-random.uniform() * (1.0 - libm::exp(-LONGEST)))
}

/// The same with bounds: flat spread in place of normal, exponential numbers cut off at [`LONGEST`]; name, a number of
/// it, its mean, its bounds.
type Bounded = (&'static str, fn(&mut Uniform) -> f64, f64, [f64; 2]);

/// The mean of exponential numbers below [`LONGEST`]: 1 - 10/(e^10 - 1).
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
            println!(
                "{name}, {runs} runs: bounds miss {misses:?} of {campaigns}, without bounds {free}; a clear one passes \
                in {passes}"
            );
            assert!(misses.iter().all(|count| may_miss(*count, campaigns)), "{name} {runs}: {misses:?}");
            // what docs/results.md says of these campaigns
            assert!(misses.iter().all(|count| *count <= u32::from(campaigns == 2000)), "{name} {runs}: {misses:?}");
            assert!(runs < 1000 || passes == campaigns, "{name}: {passes}");
            worst = worst.max(rate(free, campaigns));
        }
    }
    assert!(worst > 0.3, "the counter-test: {worst}");
}
