//! Intervals from replicates: R independent scrambles of one design, each with an estimate of its own.
//!
//! Samples of a Latin hypercube or of a scrambled sequence are not independent of each other, replicates are (A. B. Owen, *Scrambled net
//! variance for integrals of smooth functions*, Ann. Stat. 25 (1997) 1541; M. Stein, *Technometrics* 29 (1987) 143). The interval of a mean or of
//! a fraction is Student's of the R estimates. That of a quantile follows from the intervals of fractions: it has every x for which the
//! interval of P(X <= x) has p in it.

use super::correlation::Estimate;
use super::moments::Moments;
use super::student::{half_width, two_sided_quantile};

/// Mean of the estimates of replicates, with Student's interval; infinitely wide for fewer than two.
pub fn mean_interval(estimates: &[f64], confidence: f64) -> Estimate {
    let moments = Moments::of(estimates.iter().copied());
    let value = moments.mean().unwrap_or(f64::NAN);
    let half = half_width(moments.standard_deviation().unwrap_or(f64::NAN), moments.count(), confidence);
    let half = if half.is_nan() { f64::INFINITY } else { half };
    Estimate { value, lower: value - half, upper: value + half }
}

/// A step of the distribution functions of the replicates: so many more of the numbers of one replicate are at most `value`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Step {
    /// The numbers, or the upper end of the bucket that they are in.
    pub value: f64,
    /// The lower end of that bucket; the numbers themselves where they are known.
    pub lower: f64,
    /// The replicate, from zero.
    pub replicate: usize,
    /// How many numbers.
    pub count: u64,
}

/// The interval of the `p`-quantile, 0 < p < 1, from the numbers of replicates of the `sizes` given, as steps in ascending order of
/// `value`; an end is `None` where it lies beyond the numbers.
///
/// No end is outside of what [`Step::lower`] and [`Step::value`] allow: ends are rounded outward.
pub fn quantile_interval(steps: &[Step], sizes: &[u64], p: f64, confidence: f64) -> [Option<f64>; 2] {
    let replicates = sizes.len() as f64;
    if sizes.len() < 2 || sizes.contains(&0) {
        return [None; 2];
    }
    let t = two_sided_quantile(confidence, replicates - 1.0);
    let factor = t * t / (replicates * (replicates - 1.0));
    let mut fractions = vec![0.0_f64; sizes.len()];
    let mut counts = vec![0_u64; sizes.len()];
    // sums over replicates of the deviations from p, and of their squares: the mean is inside where sum^2 <= factor * spread
    let (mut first, mut last) = (None, None);
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
        let is_inside = (mean - p) * (mean - p) <= factor * spread;
        if first.is_none() && (is_inside || mean >= p) {
            first = Some(lower);
        }
        if is_inside || mean < p {
            last = Some((start, at));
        }
    }
    // up to the next number the distribution functions are as they are at this one
    let upper = match last {
        None => steps.first().map(|step| step.value),
        Some((_, next)) => steps.get(next).map(|step| step.value),
    };
    [first, upper]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn known_interval() {
        // 1, 2, 3, 4: mean 2.5, s = sqrt(5/3), t(0.975, 3) = 3.18244630528371
        let found = mean_interval(&[1.0, 2.0, 3.0, 4.0], 0.95);
        let half = 3.182_446_305_283_71 * libm::sqrt(5.0 / 3.0) / 2.0;
        // measured 0 and 8.9e-16
        assert!(found.value == 2.5 && (found.upper - 2.5 - half).abs() < 8e-15, "{found:?}");
        assert_eq!(mean_interval(&[1.0], 0.95).upper, f64::INFINITY);
    }

    /// Law: the interval is the set of x for which Student's interval of the fractions at most x has p in it.
    #[test]
    fn a_quantile_interval_inverts_that_of_fractions() {
        let replicates: Vec<Vec<f64>> = (0..8)
            .map(|r| {
                let mut values: Vec<f64> =
                    (0..50).map(|k| libm::fmod(0.618_034 * f64::from(k) + 0.37 * f64::from(r * r), 1.0)).collect();
                values.sort_by(f64::total_cmp);
                values
            })
            .collect();
        let mut steps: Vec<Step> = replicates
            .iter()
            .enumerate()
            .flat_map(|(replicate, values)| {
                values.iter().map(move |value| Step { value: *value, lower: *value, replicate, count: 1 })
            })
            .collect();
        steps.sort_by(|a, b| a.value.total_cmp(&b.value));
        for p in [0.1, 0.5, 0.9] {
            let [lower, upper] = quantile_interval(&steps, &[50; 8], p, 0.95).map(|end| end.expect("an end"));
            let interval = |x: f64| {
                let fraction =
                    |values: &Vec<f64>| values.iter().filter(|value| **value <= x).count() as f64 / values.len() as f64;
                mean_interval(&replicates.iter().map(fraction).collect::<Vec<_>>(), 0.95)
            };
            // inside at the ends, outside just beyond them
            assert!(interval(lower).upper >= p && interval(lower - 1e-9).upper < p, "{p}: {lower}");
            assert!(interval(upper - 1e-9).lower <= p && interval(upper).lower > p, "{p}: {upper}");
            assert!(lower < p + 0.03 && upper > p - 0.03 && upper - lower < 0.2, "{p}: {lower} {upper}");
        }
        assert_eq!(quantile_interval(&steps, &[50], 0.5, 0.95), [None; 2], "one replicate says nothing");
    }
}
