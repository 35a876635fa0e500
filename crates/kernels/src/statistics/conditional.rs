//! Test of the effect of an input on an observable given correlated inputs: the generalised covariance measure of R. D.
//! Shah & J. Peters, *Ann. Stat.* 48 (2020) 1514.
//!
//! If the input has no effect of its own, the residuals of both columns, after lines through cells of the other inputs,
//! are uncorrelated. This needs no model of the observable, and errs as stated as long as the lines follow it: only the
//! product of both errors counts. Each line takes two degrees of freedom, else 30 to 60 runs err twice as often.

use super::rank_tests::two_sided;
use super::sensitivity::{cells, left_by_lines};

/// Passes over several inputs, each of which leaves a little of the others.
const ROUNDS: usize = 3;
/// Relative residual sum of squares, by rounding, of a column that is a function of the inputs.
const ROUNDING: f64 = 1e-20;

/// P-value of the association of `y` with any of `columns` (forms of one input) if `y` depends only on the inputs
/// `given` by [`super::correlation::ascending_order`] and values. Ranks make it distribution-free.
pub fn conditional_test(y: &[f64], columns: &[&[f64]], given: &[(&[usize], &[f64])]) -> f64 {
    let left = |column: &[f64]| {
        let mean = column.iter().sum::<f64>() / column.len() as f64;
        let mut left: Vec<f64> = column.iter().map(|value| value - mean).collect();
        let whole = square(&left);
        for _ in 0..if given.len() > 1 { ROUNDS } else { 1 } {
            given.iter().for_each(|(order, x)| left = left_by_lines(order, x, &left));
        }
        (square(&left) > ROUNDING * whole).then_some(left)
    };
    let Some(of_y) = left(y) else { return 1.0 };
    let lines: usize = given.iter().map(|(order, x)| cells(order, x).count()).sum();
    let freedom = (1.0 - 2.0 * lines as f64 / y.len() as f64).max(0.0);
    let p_value = |column: &&[f64]| {
        let products: Vec<f64> = left(column)?.iter().zip(&of_y).map(|(x, y)| x * y).collect();
        Some(two_sided(products.iter().sum::<f64>() * libm::sqrt(freedom / square(&products))))
    };
    let least = columns.iter().filter_map(p_value).fold(1.0, f64::min);
    (columns.len() as f64 * least).min(1.0)
}

fn square(values: &[f64]) -> f64 {
    values.iter().map(|value| value * value).sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::normal::quantile;
    use crate::statistics::correlation::{ascending_order, mid_ranks};
    use crate::statistics::rank_tests::tests::Uniform;

    /// H0: given x, an observable of x and noise is independent of z, correlated with x by 0.8: at most 5% of 600
    /// studies find an effect (6 standard deviations of the count are 32). Power: a little of z, linear or V-shaped, is
    /// found by nine of ten studies of 300 runs, half of those of 60.
    #[test]
    fn effects_are_found_given_correlated_inputs() {
        let mut random = Uniform(5);
        let mut normal = || quantile(random.next());
        type Model = fn(f64, f64, f64) -> f64;
        let cases: [(Model, bool); 7] = [
            (|x, _, _| x, false),
            (|x, _, e| x + e, false),
            (|x, _, e| x * x + 0.1 * e, false),
            (|x, _, e| if x > 1.0 { 1.0 } else { 0.0 } * (2.0 + e), false),
            (|x, _, e| libm::exp(x) * e, false),
            (|x, z, e| x + 0.5 * z + 0.5 * e, true),
            (|x, z, e| x + z * z + 0.5 * e, true),
        ];
        for (rows, studies) in [(60, 600), (300, 200)] {
            for (case, (of, acts)) in cases.into_iter().enumerate() {
                let mut found = 0;
                for _ in 0..studies {
                    let (mut x, mut z, mut y) = (Vec::new(), Vec::new(), Vec::new());
                    for _ in 0..rows {
                        let (a, b) = (normal(), normal());
                        x.push(a);
                        z.push(0.8 * a + 0.6 * b);
                        y.push(of(a, 0.8 * a + 0.6 * b, normal()));
                    }
                    let (order, x, ranks) = (ascending_order(&x), mid_ranks(&x), mid_ranks(&z));
                    let middle = 0.5 * (rows - 1) as f64;
                    let far = mid_ranks(&ranks.iter().map(|rank| (rank - middle).abs()).collect::<Vec<_>>());
                    let p = conditional_test(&mid_ranks(&y), &[&ranks, &far], &[(&order, &x)]);
                    found += u32::from(p <= 0.05);
                }
                let expected = 0.05 * f64::from(studies);
                let most = expected + 6.0 * libm::sqrt(expected);
                let least = if rows > 100 { studies * 9 / 10 } else { studies / 2 };
                let is_right = if acts { found > least } else { f64::from(found) <= most };
                assert!(is_right, "{rows} rows, case {case}: {found} of {studies}");
            }
        }
    }
}
