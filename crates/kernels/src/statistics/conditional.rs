//! Effect of an input on an observable given correlated inputs: the generalised covariance measure of R. D. Shah & J.
//! Peters, *Ann. Stat.* 48 (2020) 1514.
//!
//! Without an effect of its own, the residuals of both columns, after lines through cells of the other inputs, are
//! uncorrelated, whatever the model of the observable. Each line takes two degrees of freedom, else 30 to 60 runs err
//! twice as often.

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
