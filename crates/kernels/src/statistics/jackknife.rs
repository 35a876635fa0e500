//! The jackknife: intervals of estimates other than means from the influence of each independent row (J. W. Tukey,
//! *Ann. Math. Stat.* 29 (1958) 614; B. Efron & C. Stein, *Ann. Stat.* 9 (1981) 586).
//!
//! The influence of a row is n - 1 times the change of the estimate without it. The estimate varies as the mean of the
//! influences and has its bounds ([`super::mean`]). Resampling takes hundreds of estimates and covers heavy tails no
//! better. The tests `coverage_of_sensitivities` measure the coverage.

use super::mean::mean_bounds;
use super::moments::Moments;

/// An estimate with its confidence interval.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Estimate {
    /// The estimate.
    pub value: f64,
    /// Lower end.
    pub lower: f64,
    /// Upper end.
    pub upper: f64,
}

/// Most rows whose influence is computed; widths are then accurate to about 1%, a few % for heavy tails.
const MOST_ROWS: usize = 10_000;

/// Rows whose influence is needed: all, or evenly spaced ones.
pub fn spaced_rows(rows: usize) -> impl Iterator<Item = usize> {
    (0..rows).step_by(rows.div_ceil(MOST_ROWS).max(1))
}

/// Ends of the interval of `estimate` from the influences of the [`spaced_rows`] of `rows`; infinite if nothing bounds
/// it.
pub fn ends(estimate: f64, rows: usize, influences: impl Iterator<Item = f64>, confidence: f64) -> [f64; 2] {
    let influences: Vec<f64> = influences.collect();
    let moments = Moments::of_block(&influences);
    let everything = [f64::NEG_INFINITY, f64::INFINITY];
    let Some((mean, deviation)) = moments.mean().zip(moments.standard_deviation()) else { return everything };
    if deviation == 0.0 {
        return [estimate; 2];
    }
    let scale = libm::sqrt(influences.len() as f64 / rows as f64);
    let found = mean_bounds(&moments, 0.5 + 0.5 * confidence).map(|end| estimate + scale * (end - mean));
    if found.iter().any(|end| end.is_nan()) { everything } else { found }
}

/// sum(numerator)/sum(denominator) with its interval; `None` if the denominator is zero.
pub fn ratio(numerator: &[f64], denominator: &[f64], confidence: f64) -> Option<Estimate> {
    let (rows, below) = (numerator.len(), denominator.iter().sum::<f64>());
    if below <= 0.0 || !below.is_finite() {
        return None;
    }
    let value = numerator.iter().sum::<f64>() / below;
    let influence =
        |row: usize| (rows - 1) as f64 * (numerator[row] - value * denominator[row]) / (below - denominator[row]);
    let [lower, upper] = ends(value, rows, spaced_rows(rows).map(influence), confidence);
    Some(Estimate { value, lower, upper })
}

/// `share` of a variance, with infinite ends replaced by 0 and 1, or by an estimate beyond them.
pub fn of_whole(share: Estimate) -> Estimate {
    let Estimate { value, lower, upper } = share;
    Estimate {
        value,
        lower: if lower.is_finite() { lower } else { value.min(0.0) },
        upper: if upper.is_finite() { upper } else { value.max(1.0) },
    }
}

/// The explained share 1 - `left` of a variance, at most 1, with the interval of the logarithm of `left`. `parts` are
/// the shares of the [`spaced_rows`] in the residual and in the whole variance.
pub fn explained_share(left: f64, rows: usize, parts: impl Iterator<Item = [f64; 2]>, confidence: f64) -> Estimate {
    if left <= 0.0 {
        return Estimate { value: 1.0, lower: 1.0, upper: 1.0 };
    }
    let influences = parts.map(|[left, whole]| (rows - 1) as f64 * (left - whole) / (1.0 - whole));
    let [lower, upper] = ends(0.0, rows, influences, confidence).map(|end| 1.0 - left * libm::exp(end));
    of_whole(Estimate { value: 1.0 - left, lower: upper, upper: lower })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Law: a ratio to one has the interval of a mean.
    #[test]
    fn a_ratio_to_one_is_a_mean() {
        let values: Vec<f64> = (0..200).map(|k| libm::exp(libm::sin(f64::from(k)))).collect();
        let found = ratio(&values, &[1.0; 200], 0.95).expect("a mean");
        let [lower, upper] = mean_bounds(&Moments::of(values.iter().copied()), 0.975);
        assert!(
            (found.lower - lower).abs() < 1e-13 && (found.upper - upper).abs() < 1e-13,
            "{found:?} {lower} {upper}"
        );
        assert_eq!(ratio(&values, &[0.0; 200], 0.95), None);
        // proportional numbers: all rows agree
        let doubled: Vec<f64> = values.iter().map(|value| 2.0 * value).collect();
        assert_eq!(ratio(&doubled, &values, 0.95), Some(Estimate { value: 2.0, lower: 2.0, upper: 2.0 }));
    }

    /// Law: beyond 10,000 rows the width falls with the root of their number, to 5%.
    #[test]
    fn spaced_rows_have_the_width_of_all() {
        let width = |rows: usize| {
            let values: Vec<f64> = (0..rows).map(|k| (k as f64 * 0.618_033_988_749_895).fract()).collect();
            let found = ratio(&values, &vec![1.0; rows], 0.95).expect("a mean");
            assert!(spaced_rows(rows).count() <= MOST_ROWS && (found.value - 0.5).abs() < 1e-2);
            found.upper - found.lower
        };
        for rows in [10_001, 65_536] {
            let expected = width(10_000) * libm::sqrt(10_000.0 / rows as f64);
            assert!((width(rows) / expected - 1.0).abs() < 0.05, "{rows}");
        }
    }

    /// Law: an explained share is at most 1, and 1 without a residual.
    #[test]
    fn shares_are_at_most_one() {
        let parts = (0..100).map(|k| if k < 50 { [0.02, 0.002] } else { [0.0, 0.018] });
        let found = explained_share(0.2, 100, parts, 0.95);
        assert!(found.value == 0.8 && found.lower < 0.8 && found.upper > 0.8 && found.upper < 1.0, "{found:?}");
        let nothing = explained_share(0.0, 100, std::iter::empty(), 0.95);
        assert_eq!(nothing, Estimate { value: 1.0, lower: 1.0, upper: 1.0 });
    }
}
