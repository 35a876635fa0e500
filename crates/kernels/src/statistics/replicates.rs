//! Intervals from replicates: independent scrambles of a design whose samples depend on each other (Latin hypercubes,
//! scrambled sequences), each with its own estimate (A. B. Owen, *Ann. Stat.* 25 (1997) 1541; M. Stein, *Technometrics*
//! 29 (1987) 143).
//!
//! A mean has the bounds of the mean of the replicates' means ([`super::mean`]), or else those of independent runs,
//! whose variance such designs do not exceed. A fraction has Student's bounds with a floor of the variance
//! ([`COUNT_VARIANCE`]). A quantile's interval holds every x for which the interval of P(X <= x) contains p.

use super::mean::{self, one_sided};
use super::moments::Moments;

/// Least variance of a replicate's number of runs within a limit, as equal counts show too little: without it the
/// interval of p05 of 16 scrambles covers 0.83 instead of 0.95.
pub const COUNT_VARIANCE: f64 = 0.5;

/// One-sided bounds of a mean, each at `confidence`, from the `means` of replicates and the moments of all runs.
pub fn mean_bounds(means: &[f64], whole: &Moments, confidence: f64) -> [f64; 2] {
    let of_means = mean::mean_bounds(&Moments::of(means.iter().copied()), confidence);
    let independent = mean::mean_bounds(whole, confidence);
    [0, 1].map(|end| if of_means[end].is_finite() { of_means[end] } else { independent[end] })
}

/// One-sided bounds of a fraction, each at `confidence`, from the fractions of replicates with `runs` runs in all; 0
/// and 1 for fewer than two.
pub fn fraction_bounds(fractions: &[f64], runs: u64, confidence: f64) -> [f64; 2] {
    let moments = Moments::of(fractions.iter().copied());
    let Some((mean, deviation)) = moments.mean().zip(moments.standard_deviation()) else { return [0.0, 1.0] };
    let replicates = fractions.len() as f64;
    let each = runs as f64 / replicates;
    let variance = (deviation * deviation).max(COUNT_VARIANCE / (each * each));
    let half = one_sided(confidence, replicates - 1.0) * libm::sqrt(variance / replicates);
    [(mean - half).max(0.0), (mean + half).min(1.0)]
}

/// Step of the distribution function of a replicate at one of its values, or buckets of values.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Step {
    /// The value, or the upper end of a bucket.
    pub value: f64,
    /// The value, or the lower end.
    pub lower: f64,
    /// Replicate, from zero.
    pub replicate: usize,
    /// Number of values in the step.
    pub count: u64,
}

/// Interval of the `p`-quantile, 0 < p < 1, from steps in ascending order of `value` and the `sizes` of the replicates.
/// Ends are rounded outward to those of buckets; `None` beyond all values.
pub fn quantile_interval(steps: &[Step], sizes: &[u64], p: f64, confidence: f64) -> [Option<f64>; 2] {
    let replicates = sizes.len() as f64;
    if sizes.len() < 2 || sizes.contains(&0) {
        return [None; 2];
    }
    let t = one_sided(0.5 + 0.5 * confidence, replicates - 1.0);
    let factor = t * t / (replicates * (replicates - 1.0));
    let each = sizes.iter().sum::<u64>() as f64 / replicates;
    let floor = COUNT_VARIANCE * (replicates - 1.0) / (each * each);
    let mut fractions = vec![0.0_f64; sizes.len()];
    let mut counts = vec![0_u64; sizes.len()];
    // the mean of the fractions is inside if (mean - p)^2 <= factor * spread
    let (mut first, mut last) = (None, None);
    // true if the fraction zero, below all values, is inside
    let is_unbounded = p * p <= factor * floor;
    let mut at = 0;
    while at < steps.len() {
        let (value, mut lower, start) = (steps[at].value, steps[at].lower, at);
        while at < steps.len() && steps[at].value == value {
            let step = steps[at];
            lower = lower.min(step.lower);
            counts[step.replicate] += step.count;
            fractions[step.replicate] = counts[step.replicate] as f64 / sizes[step.replicate] as f64;
            at += 1;
        }
        let mean = fractions.iter().sum::<f64>() / replicates;
        let spread: f64 = fractions.iter().map(|fraction| (fraction - mean) * (fraction - mean)).sum();
        let is_inside = (mean - p) * (mean - p) <= factor * spread.max(floor);
        if first.is_none() && (is_inside || mean >= p) {
            first = Some(lower);
        }
        if is_inside || mean < p {
            last = Some((start, at));
        }
    }
    // distribution functions are constant up to the next value
    let upper = match last {
        None => steps.first().map(|step| step.value),
        Some((_, next)) => steps.get(next).map(|step| step.value),
    };
    [first.filter(|_| !is_unbounded), upper]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::close;

    /// Known: fractions 0.1 ... 0.4 of many runs have s = sqrt(5/3)/10 and t(0.95, 3) = 2.3533634348018264; equal
    /// fractions of 10 runs each have the floor of the variance.
    #[test]
    fn known_bounds_of_fractions() {
        let half = |deviation: f64| 2.353_363_434_801_826_4 * deviation / 2.0;
        let upper = |fractions: &[f64], runs| fraction_bounds(fractions, runs, 0.95)[1];
        let found = upper(&[0.1, 0.2, 0.3, 0.4], 4000);
        close(found - 0.25, half(libm::sqrt(5.0 / 3.0) / 10.0), 1e-15);
        let found = upper(&[0.2; 4], 40);
        close(found - 0.2, half(libm::sqrt(0.5) / 10.0), 1e-15);
        assert_eq!([fraction_bounds(&[1.0; 4], 40, 0.95)[1], fraction_bounds(&[0.0; 4], 40, 0.95)[0]], [1.0, 0.0]);
        assert_eq!(fraction_bounds(&[0.5], 10, 0.95), [0.0, 1.0]);
    }

    /// Law: means have bounds of their own, or else those of independent runs.
    #[test]
    fn means_fall_back_on_independent_runs() {
        let whole = Moments::of((0..400).map(|k| f64::from(k % 20)));
        let means: Vec<f64> = (0..16).map(|k| 9.5 + 0.01 * f64::from(k % 4)).collect();
        let of_means = mean::mean_bounds(&Moments::of(means.iter().copied()), 0.95);
        assert!(of_means[1] < 9.6);
        assert_eq!(mean_bounds(&means, &whole, 0.95), of_means);
        assert_eq!(mean_bounds(&means[..2], &whole, 0.95), mean::mean_bounds(&whole, 0.95));
        assert_eq!(mean_bounds(&[9.5; 16], &whole, 0.95), mean::mean_bounds(&whole, 0.95));
    }

    /// Law: the interval holds the x for which Student's interval of the fractions at most x contains p.
    #[test]
    fn a_quantile_interval_inverts_that_of_fractions() {
        let replicates: Vec<Vec<f64>> = (0..8)
            .map(|r| (0..50).map(|k| libm::fmod(0.618_034 * f64::from(k) + 0.37 * f64::from(r * r), 1.0)).collect())
            .collect();
        let of = |(replicate, values): (usize, &Vec<f64>)| {
            values.clone().into_iter().map(move |value| Step { value, lower: value, replicate, count: 1 })
        };
        let mut steps: Vec<Step> = replicates.iter().enumerate().flat_map(of).collect();
        steps.sort_by(|a, b| a.value.total_cmp(&b.value));
        for p in [0.1, 0.5, 0.9] {
            let [lower, upper] = quantile_interval(&steps, &[50; 8], p, 0.95).map(|end| end.expect("an end"));
            let interval = |x: f64| {
                let fraction =
                    |values: &Vec<f64>| values.iter().filter(|value| **value <= x).count() as f64 / values.len() as f64;
                fraction_bounds(&replicates.iter().map(fraction).collect::<Vec<_>>(), 400, 0.975)
            };
            // inside at the ends, outside beyond them
            assert!(interval(lower)[1] >= p && interval(lower - 1e-9)[1] < p, "{p}: {lower}");
            assert!(interval(upper - 1e-9)[0] <= p && interval(upper)[0] > p, "{p}: {upper}");
            assert!(lower < p + 0.03 && upper > p - 0.03 && upper - lower < 0.2, "{p}: {lower} {upper}");
        }
        assert_eq!(quantile_interval(&steps, &[50], 0.5, 0.95), [None; 2], "one replicate");
        let [lower, upper] = quantile_interval(&steps, &[50; 8], 0.002, 0.95);
        assert!(lower.is_none() && upper.is_some(), "400 numbers do not bound their 0.2% quantile from below");
    }
}
