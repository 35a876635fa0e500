//! Correlation of two columns, or of their ranks, with a confidence interval for independent rows.
//!
//! The interval is that of R. A. Fisher's atanh r (*Metron* 1 (1921) 3) with the width of the [`super::jackknife`]: for
//! y = x z, x and z normal, the usual variance 1/(n - 3) covers 0.75 instead of 0.95.

use super::jackknife;
pub use super::jackknife::Estimate;

/// Rows of `values` in ascending order ([`f64::total_cmp`]); stable.
pub fn ascending_order(values: &[f64]) -> Vec<usize> {
    // integers that order as the values: sorting pairs with their rows needs no indirection
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

/// [`mid_ranks`] with the known [`ascending_order`] of `values`.
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

/// `values` minus their mean, scaled to length one; zeros if all are equal.
pub fn standardised(values: &[f64]) -> Vec<f64> {
    let n = values.len() as f64;
    let scale = values.iter().fold(0.0_f64, |scale, value| scale.max(value.abs()));
    if values.is_empty() || scale == 0.0 {
        return vec![0.0; values.len()];
    }
    // a power of two, hence exact
    let inverse_scale = libm::ldexp(1.0, (-libm::ilogb(scale)).min(MAX_EXPONENT));
    let mut off: Vec<f64> = values.iter().map(|value| value * inverse_scale).collect();
    let mean = sum(&off) / n;
    off.iter_mut().for_each(|value| *value -= mean);
    let rest = sum(&off) / n;
    off.iter_mut().for_each(|value| *value -= rest);
    let length = libm::sqrt(product(&off, &off));
    // equal values leave the rounding of their mean only
    let rounding = 8.0 * f64::EPSILON * libm::sqrt(n);
    let inverse_length = 1.0 / length;
    off.iter_mut().for_each(|value| *value = if length > rounding { *value * inverse_length } else { 0.0 });
    off
}

const MAX_EXPONENT: i32 = f64::MAX_EXP - 1;

/// Pearson's coefficient; 0 if a column does not vary.
pub fn pearson(x: &[f64], y: &[f64]) -> f64 {
    product(&standardised(x), &standardised(y)).clamp(-1.0, 1.0)
}

/// Correlation matrix of [`standardised`] columns, by rows.
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

/// Pearson's coefficient of two [`standardised`] columns, given `fixed` other columns, with its interval. For
/// Spearman's coefficient pass ranks; the interval is then up to a tenth too wide or too narrow.
pub fn correlation(x: &[f64], y: &[f64], fixed: usize, confidence: f64) -> Estimate {
    let rows = x.len();
    let value = product(x, y).clamp(-1.0, 1.0);
    if rows < fixed + 4 {
        return Estimate { value, lower: -1.0, upper: 1.0 };
    }
    let slope = 1.0 - value * value;
    if slope <= 0.0 {
        return Estimate { value, lower: value, upper: value };
    }
    // each fixed column costs one degree of freedom
    let scale = libm::sqrt((rows - 1) as f64 / (rows - 1 - fixed) as f64) / slope;
    let influences = jackknife::spaced_rows(rows).map(|row| {
        let change = x[row] * (y[row] - value * x[row]) / (1.0 - 1.0 / rows as f64 - x[row] * x[row]);
        scale * influence(value, change, [x[row], y[row]], rows)
    });
    let [lower, upper] = jackknife::ends(libm::atanh(value), rows, influences, confidence).map(libm::tanh);
    Estimate { value, lower, upper }
}
/// n - 1 times the change of a standardised coefficient if a row with the values `x` and `y` is left out, given the
/// `change` at fixed scales of both columns.
pub(super) fn influence(coefficient: f64, change: f64, [x, y]: [f64; 2], rows: usize) -> f64 {
    let n = rows as f64;
    // sum of squares without the row and its part in the mean
    let rest = |value: f64| (1.0 - value * value * n / (n - 1.0)).max(0.0);
    (n - 1.0) * (coefficient - (coefficient - change) * libm::sqrt(rest(x) / rest(y)))
}

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

/// Independent partial sums, which hide the latency of a sum.
const SUMS: usize = 8;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn known_coefficients() {
        let x = [1.0, 2.0, 3.0, 4.0, 5.0];
        // measured 2.2e-16 and 0; far from zero 6.7e-9: seven digits after the point
        assert!((pearson(&x, &[2.0, 1.0, 4.0, 3.0, 5.0]) - 0.8).abs() < 1e-15);
        assert_eq!(pearson(&x, &[0.1; 5]), 0.0, "a column that does not vary");
        let mixed = [0.5, f64::NAN, -0.0, 0.0, f64::NEG_INFINITY, -3.0, 0.5, f64::INFINITY, -f64::NAN, -3.0];
        let mut expected: Vec<usize> = (0..mixed.len()).collect();
        expected.sort_by(|a, b| mixed[*a].total_cmp(&mixed[*b]));
        assert_eq!(ascending_order(&mixed), expected);
        assert_eq!(mid_ranks(&[7.0, 7.0, 9.0, 1.0]), [1.5, 1.5, 3.0, 0.0]);
        // far from zero only the digits of the numbers are lost
        let far: Vec<f64> = [2.0, 1.0, 4.0, 3.0, 5.0].iter().map(|value| value + 1e9).collect();
        assert!((pearson(&x, &far) - 0.8).abs() < 5e-8);
    }
}
