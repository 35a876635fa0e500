//! Linear regression of a standardised column on standardised inputs, and partial correlations.
//!
//! With the correlation matrix R of the inputs and their correlations r with the observable, the coefficients are R^-1
//! r, and R^2 = r^T R^-1 r (N. R. Draper & H. Smith, *Applied Regression Analysis*, 1998, section 5.5); partial
//! correlations follow from the same inverse (M. G. Kendall & A. Stuart, *The Advanced Theory of Statistics* 2, section
//! 27.5). With ranks this is the rank regression of R. L. Iman & W. J. Conover, *Technometrics* 21 (1979) 499.
//!
//! Intervals come from the [`super::jackknife`] with leave-one-out regressions (R. D. Cook & S. Weisberg, *Residuals
//! and Influence in Regression*, 1982, (2.2.1)). The scales of input and observable are estimated, so that coefficients
//! of an exact sum have intervals, too.

use nalgebra::{Cholesky, DMatrix, DVector};

use super::correlation::{Estimate, correlation, influence, product};
use super::jackknife;

/// True for each [`standardised`](super::correlation::standardised) input that is no linear combination of earlier
/// ones.
pub fn independent_inputs(inputs: &[Vec<f64>]) -> Vec<bool> {
    // Gram-Schmidt, twice because of rounding
    let mut basis: Vec<Vec<f64>> = Vec::new();
    let mut independent = Vec::with_capacity(inputs.len());
    for input in inputs {
        let mut rest = input.clone();
        for unit in basis.iter().chain(&basis) {
            let part = product(&rest, unit);
            rest.iter_mut().zip(unit).for_each(|(rest, unit)| *rest -= part * unit);
        }
        let square = product(&rest, &rest);
        // the margin leaves the pivots of the regression on the kept inputs
        let is_new = square > 10.0 * SMALLEST_PIVOT;
        if is_new {
            let length = libm::sqrt(square);
            rest.iter_mut().for_each(|value| *value /= length);
            basis.push(rest);
        }
        independent.push(is_new);
    }
    independent
}

/// Smallest pivot of independent inputs; correlations have errors of 1e-15.
const SMALLEST_PIVOT: f64 = 1e-10;

/// Inputs prepared for the regression of any number of columns.
#[derive(Clone, Debug)]
pub struct Regressors {
    inputs: Vec<Vec<f64>>,
    inverse: DMatrix<f64>,
    /// Part of each input independent of the others, over its sum of squares: sum_k C_jk x_k.
    alone: Vec<Vec<f64>>,
    /// Weight, 0 to 1, of each row's own value in its fitted value.
    leverages: Vec<f64>,
}

impl Regressors {
    /// Prepares [`standardised`](super::correlation::standardised) inputs; `None` if they are linearly dependent.
    pub fn new(inputs: Vec<Vec<f64>>) -> Option<Self> {
        let inverse = inverse(&super::correlation::matrix(&inputs))?;
        let rows = inputs.first()?.len();
        let mut leverages = vec![1.0 / rows as f64; rows];
        let of_input = |input: usize| {
            let mut alone = vec![0.0; rows];
            for (other, x) in inputs.iter().enumerate() {
                let factor = inverse[(input, other)];
                alone.iter_mut().zip(x).for_each(|(alone, x)| *alone += factor * x);
            }
            alone
        };
        let alone: Vec<Vec<f64>> = (0..inputs.len()).map(of_input).collect();
        for (x, alone) in inputs.iter().zip(&alone) {
            leverages.iter_mut().zip(x.iter().zip(alone)).for_each(|(leverage, (x, alone))| *leverage += x * alone);
        }
        Some(Regressors { inputs, inverse, alone, leverages })
    }

    /// Number of inputs.
    pub fn count(&self) -> usize {
        self.inputs.len()
    }

    /// Regression of a standardised `y`; `None` unless there are at least two more rows than inputs.
    pub fn regression<'a>(&'a self, y: &'a [f64]) -> Option<Regression<'a>> {
        if y.len() < self.count() + 2 {
            return None;
        }
        let r = DVector::from_iterator(self.count(), self.inputs.iter().map(|x| product(x, y)));
        let beta = &self.inverse * &r;
        let mut rest = y.to_vec();
        for (beta, x) in beta.iter().zip(&self.inputs) {
            rest.iter_mut().zip(x).for_each(|(rest, x)| *rest -= beta * x);
        }
        Some(Regression { of: self, y, beta, rest })
    }
}

/// A regression of one column on several.
#[derive(Clone, Debug)]
pub struct Regression<'a> {
    of: &'a Regressors,
    y: &'a [f64],
    beta: DVector<f64>,
    rest: Vec<f64>,
}

impl Regression<'_> {
    /// Standardised regression coefficient of `input`.
    pub fn coefficient(&self, input: usize, confidence: f64) -> Estimate {
        let (value, rows, alone) = (self.beta[input], self.y.len(), &self.of.alone[input]);
        let influences = jackknife::spaced_rows(rows).map(|row| {
            let change = alone[row] * self.rest[row] / (1.0 - self.of.leverages[row]);
            influence(value, change, [self.of.inputs[input][row], self.y[row]], rows)
        });
        let [lower, upper] = jackknife::ends(value, rows, influences, confidence);
        Estimate { value, lower, upper }
    }

    /// Correlation of the residuals of `input` and observable on the other inputs.
    pub fn partial(&self, input: usize, confidence: f64) -> Estimate {
        let alone = &self.of.alone[input];
        let factor = self.beta[input] / self.of.inverse[(input, input)];
        let rest: Vec<f64> = self.rest.iter().zip(alone).map(|(rest, alone)| rest + factor * alone).collect();
        let unit = |column: &[f64]| {
            let length = libm::sqrt(product(column, column));
            column.iter().map(|value| if length > 0.0 { value / length } else { 0.0 }).collect::<Vec<f64>>()
        };
        correlation(&unit(alone), &unit(&rest), self.of.count() - 1, confidence)
    }

    /// R^2, the share of the variance that the linear terms explain, corrected for the number of inputs (Ezekiel 1930).
    pub fn r_squared(&self, confidence: f64) -> Estimate {
        let (rows, square) = (self.y.len(), product(&self.rest, &self.rest));
        let freedom = (rows - self.of.count() - 1) as f64;
        let left = square * (rows - 1) as f64 / freedom;
        let parts = jackknife::spaced_rows(rows).map(|row| {
            let rest = self.rest[row] * self.rest[row] / (1.0 - self.of.leverages[row]).max(f64::MIN_POSITIVE);
            [rest / square * freedom / rows as f64, self.y[row] * self.y[row]]
        });
        let found = jackknife::explained_share(left, rows, parts, confidence);
        let [value, lower, upper] = [found.value, found.lower, found.upper].map(|share| share.max(0.0));
        Estimate { value, lower, upper }
    }
}

/// Inverse of a correlation matrix; `None` if singular.
fn inverse(correlation: &[Vec<f64>]) -> Option<DMatrix<f64>> {
    let n = correlation.len();
    let factor = Cholesky::new(DMatrix::from_fn(n, n, |i, j| correlation[i][j]))?;
    let regular = factor.l_dirty().diagonal().iter().all(|pivot| pivot * pivot >= SMALLEST_PIVOT);
    regular.then(|| factor.inverse())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::statistics::correlation::standardised;

    fn of(inputs: &[Vec<f64>]) -> Option<Regressors> {
        Regressors::new(inputs.to_vec())
    }

    /// Multiples of an irrational number, modulo one.
    fn irregular(multiplier: f64, n: usize) -> Vec<f64> {
        (1..=n).map(|k| (k as f64 * multiplier).fract()).collect()
    }

    fn inputs() -> [Vec<f64>; 3] {
        [2.0_f64, 3.0, 5.0].map(|prime| irregular(libm::sqrt(prime), 500))
    }

    #[test]
    fn an_exact_sum_is_explained() {
        let [a, b, c] = inputs();
        let y: Vec<f64> = a.iter().zip(&b).map(|(a, b)| 3.0 * a - 2.0 * b).collect();
        let columns: Vec<Vec<f64>> = [&a, &b, &c].map(|x| standardised(x)).to_vec();
        let (of, sy) = (of(&columns).expect("independent inputs"), standardised(&y));
        let found = of.regression(&sy).expect("more rows than inputs");
        let explained = found.r_squared(0.95);
        assert!((explained.value - 1.0).abs() < 5e-15 && explained.upper - explained.lower < 1e-13, "{explained:?}");
        let coefficients = [0, 1, 2].map(|input| found.coefficient(input, 0.95));
        let spread = |x: &[f64]| {
            let mean = x.iter().sum::<f64>() / x.len() as f64;
            libm::sqrt(x.iter().map(|x| (x - mean) * (x - mean)).sum::<f64>())
        };
        // measured 7.8e-16, 2.2e-16 and less
        assert!((coefficients[0].value - 3.0 * spread(&a) / spread(&y)).abs() < 7e-15);
        assert!((coefficients[1].value + 2.0 * spread(&b) / spread(&y)).abs() < 2e-15);
        assert!(coefficients[2].value.abs() < 2e-16);
        // no residual, but the spread of the inputs is estimated; an input without influence has no width
        assert!(coefficients[0].upper - coefficients[0].lower > 1e-3, "{coefficients:?}");
        assert!(coefficients[2].upper - coefficients[2].lower < 1e-13, "{coefficients:?}");
    }

    /// Law: constant inputs and combinations of earlier ones are dependent; the rest have a regression.
    #[test]
    fn dependent_inputs_are_found() {
        let [a, b, c] = inputs();
        let sum: Vec<f64> = a.iter().zip(&b).map(|(a, b)| 2.0 * a - b).collect();
        let columns: Vec<Vec<f64>> = [&a, &b, &sum, &vec![7.0; 500], &c].map(|x| standardised(x)).to_vec();
        assert_eq!(independent_inputs(&columns), [true, true, false, false, true]);
        let kept = [columns[0].clone(), columns[1].clone(), columns[4].clone()];
        assert!(of(&kept).is_some() && of(&columns).is_none());
    }
}
