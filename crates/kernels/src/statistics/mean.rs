//! Bounds of a mean and of a standard deviation from the moments of independent numbers.
//!
//! Student's bound misses the long tail of skewed numbers several times as often as stated. Each bound is therefore the
//! wider of Student's and one corrected for skewness (P. Hall, *J. R. Stat. Soc. B* 54 (1992) 221, exponential
//! transformation): with r, the skewness over sqrt(n), f(T) = (e^(2 r T/3) - 1)/(2 r/3) + r/6 is closer to a t
//! distribution than T = (mean - mu)/(s/sqrt(n)), and -T at the bound is -log(1 - (2 r/3)(t + r/6))/(2 r/3). Without
//! that logarithm there are too few runs for their skewness, and no bound.
//!
//! These bounds hold unless an event seen fewer than some ten times contributes much to the mean;
//! [`bounded_mean_bounds`] need no such assumption. The tests `coverage_of_means` measure the coverage.

use core::cell::Cell;

use super::moments::Moments;
use super::student::two_sided_quantile;

/// Factor on the sample skewness, which mostly underestimates long tails. With 1 the upper bound of lognormal(1) misses
/// 6 to 8% instead of 5% at 20 to 300 runs, with 3/2 and [`SKEWNESS_ERRORS`] 4.0 to 5.2%.
const SKEWNESS_FACTOR: f64 = 1.5;

/// Standard errors sqrt(6/n) added to the skewness, which few runs do not show.
const SKEWNESS_ERRORS: f64 = 2.0;

/// Skewness of squared deviations (normal 2, exponential 3.75), which would take the sixth moment.
const SKEWNESS_OF_SQUARES: f64 = 4.0;

/// Largest share of one run in the squared (or fourth-power) deviations for which the standard error of the mean (or of
/// the standard deviation) is meaningful.
pub const MOST_SHARE: f64 = 1.0 / 3.0;

/// Relative spread due to rounding.
const ROUNDING: f64 = 4.0 * f64::EPSILON;

/// t with P(T <= t) = `confidence`, 0 below 1/2.
pub fn one_sided(confidence: f64, degrees: f64) -> f64 {
    thread_local! {
        /// Arguments and result of the last call: columns share a count, and the root is expensive.
        static LAST: Cell<[f64; 3]> = const { Cell::new([0.0; 3]) };
    }
    if confidence <= 0.5 {
        return 0.0;
    }
    let last = LAST.get();
    if last[..2] == [confidence, degrees] {
        return last[2];
    }
    let t = two_sided_quantile(2.0 * confidence - 1.0, degrees);
    LAST.set([confidence, degrees, t]);
    t
}

/// One-sided bounds of the mean, each at `confidence`; infinite for fewer than three numbers, without spread (it may
/// hide a rare event), or with too few numbers for the skewness.
pub fn mean_bounds(moments: &Moments, confidence: f64) -> [f64; 2] {
    let Some((mean, error)) = moments.mean().zip(spread_error(moments)) else {
        return [f64::NEG_INFINITY, f64::INFINITY];
    };
    // the root behind t is expensive
    let (count, t) = (moments.count(), one_sided(confidence, moments.count() as f64 - 1.0));
    let [below, above] = [-1.0, 1.0].map(|side| reach(count, side * skewness(moments), t));
    [mean - below * error, mean + above * error]
}

/// One-sided bounds of the mean of independent numbers in `[low, high]`, each at `confidence`, for any distribution:
/// the empirical Bernstein bound (A. Maurer & M. Pontil, COLT 2009, theorem 4).
pub fn bounded_mean_bounds(moments: &Moments, [low, high]: [f64; 2], confidence: f64) -> [f64; 2] {
    let Some((mean, deviation)) = moments.mean().zip(moments.standard_deviation()) else { return [low, high] };
    let half = bernstein_reach(moments.count(), high - low, deviation, confidence);
    [(mean - half).max(low), (mean + half).min(high)]
}

/// Half-width of [`bounded_mean_bounds`] for `count` numbers in a range of length `range`.
pub fn bernstein_reach(count: u64, range: f64, deviation: f64, confidence: f64) -> f64 {
    let (n, risk) = (count as f64, libm::log(2.0 / (1.0 - confidence)));
    deviation * libm::sqrt(2.0 * risk / n) + 7.0 * range * risk / (3.0 * (n - 1.0))
}

/// Distance of the mean's bound towards `limit` for `count` runs of the same spread and skewness.
pub fn distance_towards(limit: f64, moments: &Moments, count: u64, confidence: f64) -> f64 {
    let Some((mean, deviation)) = moments.mean().zip(moments.standard_deviation()) else { return f64::INFINITY };
    let side = if mean < limit { 1.0 } else { -1.0 };
    if count < 3 {
        return f64::INFINITY;
    }
    let t = one_sided(confidence, count as f64 - 1.0);
    reach(count, side * skewness(moments), t) * deviation / libm::sqrt(count as f64)
}

/// One-sided bounds of the standard deviation, each at `confidence`, from those of the mean squared deviation. Too few
/// runs (some 70 normal ones), or one run with more than [`MOST_SHARE`] of the fourth powers, have no upper bound.
pub fn deviation_bounds(moments: &Moments, confidence: f64) -> [f64; 2] {
    let Some(((deviation, kurtosis), _)) =
        moments.standard_deviation().zip(moments.kurtosis()).zip(spread_error(moments))
    else {
        return [0.0, f64::INFINITY];
    };
    let n = moments.count() as f64;
    let relative = libm::sqrt((kurtosis - 1.0).max(0.0) / (n - 1.0));
    let t = one_sided(confidence, n - 1.0);
    let above =
        if moments.largest_share(4) > MOST_SHARE { f64::INFINITY } else { unskewed(t, SKEWNESS_OF_SQUARES * relative) };
    [deviation * libm::sqrt((1.0 - t * relative).max(0.0)), deviation * libm::sqrt(1.0 + above * relative)]
}

/// Standard error of the mean; `None` for fewer than three numbers, or without spread.
fn spread_error(moments: &Moments) -> Option<f64> {
    let (mean, deviation) = moments.mean().zip(moments.standard_deviation())?;
    let is_spread = moments.count() > 2 && deviation > ROUNDING * mean.abs();
    is_spread.then(|| deviation / libm::sqrt(moments.count() as f64))
}

/// Sample skewness G_1, unbiased for normal numbers; 0 if undefined.
fn skewness(moments: &Moments) -> f64 {
    let n = moments.count() as f64;
    moments.skewness().map_or(0.0, |skewness| skewness * libm::sqrt(n * (n - 1.0)) / (n - 2.0).max(1.0))
}

/// Distance, in standard errors, of the bound of a mean on the side to which `skewness` refers; `t` is Student's.
fn reach(count: u64, skewness: f64, t: f64) -> f64 {
    let n = count as f64;
    let skewness = SKEWNESS_FACTOR * skewness + SKEWNESS_ERRORS * libm::sqrt(6.0 / n);
    unskewed(t, skewness / libm::sqrt(n))
}

/// The larger of `t` and -T at the bound; `r` is the skewness over sqrt(n). Infinite if undefined.
fn unskewed(t: f64, r: f64) -> f64 {
    if r.is_nan() || r <= 0.0 {
        return t;
    }
    let factor = 2.0 / 3.0 * r;
    let part = factor * (t + r / 6.0);
    if part < 1.0 { t.max(-libm::log1p(-part) / factor) } else { f64::INFINITY }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Known: f(T) at the bound is -t. With r = 0.5 and t = 2: 1 - (1/3)(2 + 1/12) = 11/36, and T = 3 log(11/36).
    #[test]
    fn the_transformation_at_the_bound_is_students() {
        let found = unskewed(2.0, 0.5);
        assert!((found + 3.0 * libm::log(11.0 / 36.0)).abs() < 4e-15, "{found}");
        let transformed = (libm::exp(-found / 3.0) - 1.0) * 3.0 + 0.5 / 6.0;
        assert!((transformed + 2.0).abs() < 4e-15, "{transformed}");
        assert_eq!((unskewed(2.0, -0.5), unskewed(2.0, 1.0)), (2.0, f64::INFINITY));
        // to first order t + r (2 t^2 + 1)/6: Johnson's (1978) shift of the bound
        assert!((unskewed(2.0, 1e-6) - 2.0 - 1.5e-6).abs() < 1e-11);
    }

    /// Law: a standard deviation has an upper bound unless one number has more than a third of the fourth powers: next
    /// to 10,000 numbers 1 and -1, d has d^4/(10,000 + d^4) of them, but less than a hundredth of the squares.
    #[test]
    fn one_number_may_make_a_third_of_the_fourth_powers() {
        let of = |fourth: f64| {
            let far = libm::sqrt(libm::sqrt(fourth));
            let moments = Moments::of((0..10_000).map(|k| if k % 2 == 0 { 1.0 } else { -1.0 }).chain([far]));
            assert!(moments.largest_share(2) < 0.01);
            deviation_bounds(&moments, 0.95)
        };
        for (fourth, is_bounded) in [(2_000.0, true), (4_950.0, true), (5_050.0, false), (9_000.0, false)] {
            let [lower, upper] = of(fourth);
            assert!(lower > 0.95 && lower < 1.004, "{fourth}: {lower}");
            assert_eq!(upper.is_finite(), is_bounded, "{fourth}: {upper}");
            assert!(upper > 1.0 && (upper < 1.05 || !is_bounded), "{fourth}: {upper}");
        }
    }

    /// Known: 50 numbers 0, 50 numbers 1 and one 1/2, of variance 1/4, have the half-width 1/2 sqrt(4/101) + 14/300 at
    /// 1 - 2/e^2; few numbers have the range, numbers without spread its term alone.
    #[test]
    fn the_bounds_of_bounded_numbers_are_bernsteins() {
        let values = [0.0, 1.0].repeat(50).into_iter().chain([0.5]);
        let [lower, upper] = bounded_mean_bounds(&Moments::of(values), [0.0, 1.0], 1.0 - 2.0 / libm::exp(2.0));
        let half = 0.5 * libm::sqrt(4.0 / 101.0) + 14.0 / 300.0;
        assert!((upper - 0.5 - half).abs() < 1e-14 && (0.5 - lower - half).abs() < 1e-14, "{lower} {upper} {half}");
        for few in [&[][..], &[0.3], &[0.3, 0.4]] {
            assert_eq!(bounded_mean_bounds(&Moments::of(few.iter().copied()), [0.0, 1.0], 0.95), [0.0, 1.0]);
        }
        let [lower, upper] = bounded_mean_bounds(&Moments::of([0.25; 1000]), [0.0, 1.0], 0.95);
        let half = 7.0 * libm::log(40.0) / (3.0 * 999.0);
        assert!((upper - 0.25 - half).abs() < 1e-15 && (0.25 - lower - half).abs() < 1e-15, "{lower} {upper}");
    }

    /// Law: nothing bounds few or equal numbers, or the long tail of too few.
    #[test]
    fn few_and_equal_numbers_bound_nothing() {
        let everything = [f64::NEG_INFINITY, f64::INFINITY];
        for values in [vec![], vec![1.0], vec![1.0, 2.0], vec![0.0; 100], vec![0.3, 0.1 + 0.2, 0.3, 0.3]] {
            let moments = Moments::of(values);
            assert_eq!(mean_bounds(&moments, 0.95), everything, "{moments:?}");
            assert_eq!(deviation_bounds(&moments, 0.95), [0.0, f64::INFINITY]);
        }
        let rare = Moments::of((0..100).map(|k| if k == 50 { 1.0 } else { 0.0 }));
        let [lower, upper] = mean_bounds(&rare, 0.95);
        assert!(lower.is_finite() && upper == f64::INFINITY, "{lower} {upper}");
    }
}
