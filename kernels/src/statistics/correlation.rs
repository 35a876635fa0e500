//! Correlation of two columns, plain, of ranks, and with other columns held fixed; each with a confidence interval.
//!
//! - Pearson's coefficient with R. A. Fisher's interval (*Metron* 1 (1921) 3): atanh r is normal with variance 1/(n - 3).
//! - Spearman's: Pearson's of mid-ranks; variance (1 + r^2/2)/(n - 3) (D. G. Bonett & T. A. Wright, *Psychometrika* 65 (2000) 23).
//! - Partial: from the inverse of the correlation matrix; each column held fixed costs one degree of freedom.
//!
//! Intervals are for independent rows.

use crate::math::normal::quantile;

/// An estimate and the interval that covers the true value with the stated confidence.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Estimate {
    /// The estimate.
    pub value: f64,
    /// Lower end.
    pub lower: f64,
    /// Upper end.
    pub upper: f64,
}

/// The rows of `values` in ascending order ([`f64::total_cmp`]); equal values in the order of their rows.
pub fn ascending_order(values: &[f64]) -> Vec<usize> {
    // the bits as an integer of the same order: sorting moves values with their rows, and looks nothing up
    let key = |value: f64| {
        let bits = value.to_bits().cast_signed();
        bits ^ ((bits >> 63) as u64 >> 1).cast_signed()
    };
    let mut keyed: Vec<(i64, usize)> = values.iter().enumerate().map(|(row, value)| (key(*value), row)).collect();
    keyed.sort_unstable();
    keyed.into_iter().map(|(_, row)| row).collect()
}

/// Ranks from zero; equal values share their mean rank.
pub fn mid_ranks(values: &[f64]) -> Vec<f64> {
    mid_ranks_in_order(values, &ascending_order(values))
}

/// As [`mid_ranks`], for the [`ascending_order`] of `values`.
pub fn mid_ranks_in_order(values: &[f64], order: &[usize]) -> Vec<f64> {
    let mut ranks = vec![0.0; values.len()];
    let mut start = 0;
    while start < order.len() {
        let first = values[order[start]];
        let equal = order[start..].iter().take_while(|index| values[**index] == first).count().max(1);
        let rank = start as f64 + 0.5 * (equal - 1) as f64;
        order[start..start + equal].iter().for_each(|index| ranks[*index] = rank);
        start += equal;
    }
    ranks
}

/// `values` minus their mean, scaled to length one; zeros where all are equal.
pub fn standardised(values: &[f64]) -> Vec<f64> {
    let n = values.len() as f64;
    let scale = values.iter().fold(0.0_f64, |scale, value| scale.max(value.abs()));
    if values.is_empty() || scale == 0.0 {
        return vec![0.0; values.len()];
    }
    // a power of two, by which dividing is exact
    let inverse_scale = libm::ldexp(1.0, (-libm::ilogb(scale)).min(MAX_EXPONENT));
    let mut off: Vec<f64> = values.iter().map(|value| value * inverse_scale).collect();
    let mean = sum(&off) / n;
    off.iter_mut().for_each(|value| *value -= mean);
    let rest = sum(&off) / n;
    off.iter_mut().for_each(|value| *value -= rest);
    let length = libm::sqrt(product(&off, &off));
    // equal values leave the rounding of their mean
    let rounding = 8.0 * f64::EPSILON * libm::sqrt(n);
    let inverse_length = 1.0 / length;
    off.iter_mut().for_each(|value| *value = if length > rounding { *value * inverse_length } else { 0.0 });
    off
}

/// The exponent of the largest power of two.
const MAX_EXPONENT: i32 = f64::MAX_EXP - 1;

/// Pearson's coefficient of two columns of equal length; 0 where one does not vary.
pub fn pearson(x: &[f64], y: &[f64]) -> f64 {
    product(&standardised(x), &standardised(y)).clamp(-1.0, 1.0)
}

/// Spearman's coefficient of two columns of equal length; 0 where one does not vary.
pub fn spearman(x: &[f64], y: &[f64]) -> f64 {
    pearson(&mid_ranks(x), &mid_ranks(y))
}

/// The correlation matrix of columns that are [`standardised`], by rows.
pub fn matrix(columns: &[Vec<f64>]) -> Vec<Vec<f64>> {
    let mut matrix = vec![vec![0.0; columns.len()]; columns.len()];
    for (i, x) in columns.iter().enumerate() {
        for (j, y) in columns[..=i].iter().enumerate() {
            matrix[i][j] = product(x, y);
            matrix[j][i] = matrix[i][j];
        }
    }
    matrix
}

/// Fisher's interval of a coefficient from `count` rows, `fixed` other columns held fixed.
pub fn pearson_interval(r: f64, count: usize, fixed: usize, confidence: f64) -> Estimate {
    interval(r, 1.0, count, fixed, confidence)
}

/// Bonett & Wright's interval of a rank coefficient from `count` rows, `fixed` other columns held fixed.
pub fn spearman_interval(r: f64, count: usize, fixed: usize, confidence: f64) -> Estimate {
    interval(r, 1.0 + 0.5 * r * r, count, fixed, confidence)
}

fn interval(r: f64, variance: f64, count: usize, fixed: usize, confidence: f64) -> Estimate {
    let freedom = count as f64 - 3.0 - fixed as f64;
    if freedom <= 0.0 || r.abs() >= 1.0 {
        let whole = if freedom <= 0.0 { [-1.0, 1.0] } else { [r, r] };
        return Estimate { value: r, lower: whole[0], upper: whole[1] };
    }
    let half = quantile(0.5 + 0.5 * confidence) * libm::sqrt(variance / freedom);
    let middle = libm::atanh(r);
    Estimate { value: r, lower: libm::tanh(middle - half), upper: libm::tanh(middle + half) }
}

/// Sum of products.
pub(super) fn product(x: &[f64], y: &[f64]) -> f64 {
    let (mut sums, chunks) = ([0.0; SUMS], x.chunks_exact(SUMS).zip(y.chunks_exact(SUMS)));
    chunks.for_each(|(x, y)| (0..SUMS).for_each(|at| sums[at] += x[at] * y[at]));
    let whole = x.len() / SUMS * SUMS;
    sums.iter().sum::<f64>() + x[whole..].iter().zip(&y[whole..]).map(|(x, y)| x * y).sum::<f64>()
}

fn sum(x: &[f64]) -> f64 {
    let (mut sums, chunks) = ([0.0; SUMS], x.chunks_exact(SUMS));
    let rest = chunks.remainder().iter().sum::<f64>();
    chunks.for_each(|x| (0..SUMS).for_each(|at| sums[at] += x[at]));
    sums.iter().sum::<f64>() + rest
}

/// Sums that are added up side by side: none waits for the one before.
const SUMS: usize = 8;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn known_coefficients() {
        let x = [1.0, 2.0, 3.0, 4.0, 5.0];
        // measured 2.2e-16 and 0; far from zero 6.7e-9, where a number has seven digits after the point
        assert!((pearson(&x, &[2.0, 1.0, 4.0, 3.0, 5.0]) - 0.8).abs() < 1e-15);
        assert!((spearman(&x, &[1.0, 8.0, 27.0, 64.0, 125.0]) - 1.0).abs() < 1e-15);
        assert_eq!(pearson(&x, &[0.1; 5]), 0.0, "a column that does not vary");
        let mixed = [0.5, f64::NAN, -0.0, 0.0, f64::NEG_INFINITY, -3.0, 0.5, f64::INFINITY, -f64::NAN, -3.0];
        let mut expected: Vec<usize> = (0..mixed.len()).collect();
        expected.sort_by(|a, b| mixed[*a].total_cmp(&mixed[*b]));
        assert_eq!(ascending_order(&mixed), expected);
        assert_eq!(mid_ranks(&[7.0, 7.0, 9.0, 1.0]), [1.5, 1.5, 3.0, 0.0]);
        // far from zero: the mean costs no digits of the deviations beyond those of the numbers themselves
        let far: Vec<f64> = [2.0, 1.0, 4.0, 3.0, 5.0].iter().map(|value| value + 1e9).collect();
        assert!((pearson(&x, &far) - 0.8).abs() < 5e-8);
    }

    #[test]
    fn known_intervals() {
        // r = 0.6, n = 28: atanh 0.6 -+ 1.959964/5
        let found = pearson_interval(0.6, 28, 0, 0.95);
        let half = 1.959_963_984_540_054 / 5.0;
        let middle = 0.5 * libm::log(4.0);
        // measured 5.6e-17
        assert!(
            (found.lower - libm::tanh(middle - half)).abs() < 4e-16
                && (found.upper - libm::tanh(middle + half)).abs() < 4e-16
        );
        assert_eq!(pearson_interval(0.6, 3, 0, 0.95), Estimate { value: 0.6, lower: -1.0, upper: 1.0 });
        let wider = spearman_interval(0.6, 28, 0, 0.95);
        assert!(wider.lower < found.lower && wider.upper > found.upper);
    }
}
