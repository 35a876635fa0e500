//! Linear regression of a standardised column on standardised inputs, and partial correlations: how much of an observable a sum of
//! linear terms explains, and which term.
//!
//! With the correlation matrix R of the inputs and their correlations r with the observable, the standardised regression
//! coefficients are R^-1 r, and R^2 = r^T R^-1 r (N. R. Draper & H. Smith, *Applied Regression Analysis*, 1998, section 5.5). The
//! same inverse gives the partial correlations (M. G. Kendall & A. Stuart, *The Advanced Theory of Statistics* 2, section 27.5).
//! Applied to ranks it is the rank regression of R. L. Iman & W. J. Conover, *Technometrics* 21 (1979) 499.

use nalgebra::{Cholesky, DMatrix, DVector};

use super::correlation::{Estimate, product};
use super::student::two_sided_quantile;

/// A regression of one column on several.
#[derive(Clone, Debug, PartialEq)]
pub struct Regression {
    /// Standardised regression coefficient of each input.
    pub coefficients: Vec<Estimate>,
    /// Partial correlation of each input with the observable, the other inputs held fixed.
    pub partial: Vec<f64>,
    /// Share of the variance that the linear terms explain, R^2.
    pub r_squared: f64,
}

/// The interval of R^2 from `count` rows and `inputs` inputs, for many rows (I. Olkin & J. D. Finn, *Psychol. Bull.* 118 (1995) 155).
pub fn r_squared_interval(r_squared: f64, count: usize, inputs: usize, confidence: f64) -> Estimate {
    let (n, k) = (count as f64, inputs as f64);
    let rest = (1.0 - r_squared) * (n - k - 1.0).max(0.0);
    let variance = 4.0 * r_squared * rest * rest / ((n * n - 1.0) * (n + 3.0));
    let half = crate::math::normal::quantile(0.5 + 0.5 * confidence) * libm::sqrt(variance);
    Estimate { value: r_squared, lower: (r_squared - half).max(0.0), upper: (r_squared + half).min(1.0) }
}

/// Which of the `inputs`, all [`standardised`](super::correlation::standardised), are no linear combination of those before them.
pub fn independent_inputs(inputs: &[Vec<f64>]) -> Vec<bool> {
    // Gram and Schmidt, twice for the rounding of the first time
    let mut basis: Vec<Vec<f64>> = Vec::new();
    let mut independent = Vec::with_capacity(inputs.len());
    for input in inputs {
        let mut rest = input.clone();
        for unit in basis.iter().chain(&basis) {
            let part = product(&rest, unit);
            rest.iter_mut().zip(unit).for_each(|(rest, unit)| *rest -= part * unit);
        }
        let square = product(&rest, &rest);
        // with a margin, so that the regression on those that are kept has its pivots
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

/// A pivot below this: the input is a linear combination of those before it. Correlations have about 1e-15.
const SMALLEST_PIVOT: f64 = 1e-10;

/// The regression of `y` on the `inputs`, all [`standardised`](super::correlation::standardised), with intervals at `confidence`.
///
/// `None` where the inputs are linearly dependent (a constant input included), or where there are not more rows than inputs and two.
pub fn regression(inputs: &[Vec<f64>], y: &[f64], confidence: f64) -> Option<Regression> {
    Regressors::new(inputs.to_vec())?.regression(y, confidence)
}

/// Inputs that are ready for the regression of any number of columns.
#[derive(Clone, Debug)]
pub struct Regressors {
    inputs: Vec<Vec<f64>>,
    inverse: DMatrix<f64>,
}

impl Regressors {
    /// `inputs`, all [`standardised`](super::correlation::standardised); `None` where they are linearly dependent.
    pub fn new(inputs: Vec<Vec<f64>>) -> Option<Self> {
        Some(Regressors { inverse: inverse(&super::correlation::matrix(&inputs))?, inputs })
    }

    /// How many inputs there are.
    pub fn count(&self) -> usize {
        self.inputs.len()
    }

    /// As [`regression()`].
    pub fn regression(&self, y: &[f64], confidence: f64) -> Option<Regression> {
        of_inverse(&self.inputs, &self.inverse, y, confidence)
    }
}

fn of_inverse(inputs: &[Vec<f64>], inverse: &DMatrix<f64>, y: &[f64], confidence: f64) -> Option<Regression> {
    let count = inputs.len();
    let freedom = y.len().checked_sub(count + 1).filter(|freedom| *freedom > 0)? as f64;
    let r = DVector::from_iterator(count, inputs.iter().map(|x| product(x, y)));
    let beta = inverse * &r;
    let r_squared = beta.dot(&r).clamp(0.0, 1.0);
    let t = two_sided_quantile(confidence, freedom);
    let estimate = |j: usize| {
        let half = t * libm::sqrt((1.0 - r_squared) / freedom * inverse[(j, j)]);
        Estimate { value: beta[j], lower: beta[j] - half, upper: beta[j] + half }
    };
    // beta_j^2 / C_jj is the part of R^2 that input j adds to the others
    let partial = |j: usize| {
        let added = beta[j] / libm::sqrt(inverse[(j, j)]);
        let whole = libm::sqrt(added * added + (1.0 - r_squared));
        if whole > 0.0 { (added / whole).clamp(-1.0, 1.0) } else { 0.0 }
    };
    Some(Regression {
        coefficients: (0..count).map(estimate).collect(),
        partial: (0..count).map(partial).collect(),
        r_squared,
    })
}

/// The inverse of a correlation matrix; `None` where it is singular.
fn inverse(correlation: &[Vec<f64>]) -> Option<DMatrix<f64>> {
    let n = correlation.len();
    let factor = Cholesky::new(DMatrix::from_fn(n, n, |i, j| correlation[i][j]))?;
    let regular = factor.l_dirty().diagonal().iter().all(|pivot| pivot * pivot >= SMALLEST_PIVOT);
    regular.then(|| factor.inverse())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::statistics::correlation::{pearson, standardised};

    /// Numbers without a pattern: multiples of an irrational number, modulo one.
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
        let found = regression(&columns, &standardised(&y), 0.95).expect("independent inputs");
        // measured 6.7e-16
        assert!((found.r_squared - 1.0).abs() < 5e-15, "{}", found.r_squared);
        let spread = |x: &[f64]| {
            let mean = x.iter().sum::<f64>() / x.len() as f64;
            libm::sqrt(x.iter().map(|x| (x - mean) * (x - mean)).sum::<f64>())
        };
        // measured 7.8e-16, 2.2e-16 and less: rounding of sums of 500 numbers
        assert!((found.coefficients[0].value - 3.0 * spread(&a) / spread(&y)).abs() < 7e-15);
        assert!((found.coefficients[1].value + 2.0 * spread(&b) / spread(&y)).abs() < 2e-15);
        assert!(found.coefficients[2].value.abs() < 2e-16);
    }

    /// Law: the partial correlation is the correlation of what is left of both columns after regression on the others.
    #[test]
    fn partial_correlations_are_those_of_residuals() {
        let [a, b, c] = inputs();
        let x: Vec<f64> = a.iter().zip(&b).map(|(a, b)| a + 0.8 * b).collect();
        let y: Vec<f64> = (0..500).map(|k| x[k] + b[k] + c[k]).collect();
        let found = regression(&[standardised(&x), standardised(&b)], &standardised(&y), 0.95).expect("independent");
        let (sx, sb, sy) = (standardised(&x), standardised(&b), standardised(&y));
        let residual = |v: &[f64]| -> Vec<f64> {
            let slope = product(v, &sb);
            v.iter().zip(&sb).map(|(v, b)| v - slope * b).collect()
        };
        let expected = pearson(&residual(&sx), &residual(&sy));
        // measured 2.2e-16
        assert!((found.partial[0] - expected).abs() < 2e-15, "{} {expected}", found.partial[0]);
        // Law: coefficient over standard error is the partial correlation's t = rho sqrt(n - k - 1)/sqrt(1 - rho^2)
        let (interval, freedom) = (found.coefficients[0], 500.0 - 3.0);
        let statistic = expected * libm::sqrt(freedom / (1.0 - expected * expected));
        let half = two_sided_quantile(0.95, freedom) * interval.value / statistic;
        let found = [interval.upper - interval.value, interval.value - interval.lower];
        // rounding of sums of 500 numbers
        assert!(half > 0.0 && found.iter().all(|found| (found / half - 1.0).abs() < 1e-13), "{found:?} {half}");
    }

    /// Law: an input that is a combination of those before it, or constant, is not independent; the rest have a regression.
    #[test]
    fn dependent_inputs_are_found() {
        let [a, b, c] = inputs();
        let sum: Vec<f64> = a.iter().zip(&b).map(|(a, b)| 2.0 * a - b).collect();
        let columns: Vec<Vec<f64>> = [&a, &b, &sum, &vec![7.0; 500], &c].map(|x| standardised(x)).to_vec();
        assert_eq!(independent_inputs(&columns), [true, true, false, false, true]);
        let kept = [columns[0].clone(), columns[1].clone(), columns[4].clone()];
        assert!(regression(&kept, &columns[2], 0.95).is_some() && regression(&columns, &columns[2], 0.95).is_none());
    }

    /// Known: R^2 = 0.5, n = 103, k = 2: variance 4 * 0.5 * (0.5 * 100)^2/((103^2 - 1) * 106) = 0.0044464.
    #[test]
    fn known_interval_of_r_squared() {
        let found = r_squared_interval(0.5, 103, 2, 0.95);
        let half = 1.959_963_984_540_054 * libm::sqrt(5000.0 / (10_608.0 * 106.0));
        // measured 5.6e-17
        assert!((found.upper - 0.5 - half).abs() < 5e-16 && (found.lower - 0.5 + half).abs() < 5e-16, "{found:?}");
        assert_eq!(r_squared_interval(1.0, 103, 2, 0.95).upper, 1.0);
    }

    #[test]
    fn dependent_inputs_have_no_regression() {
        let [a, _, c] = inputs();
        let (sa, sc) = (standardised(&a), standardised(&c));
        assert_eq!(regression(&[sa.clone(), sa.clone()], &sc, 0.95), None);
        assert_eq!(regression(&[sa.clone(), vec![0.0; 500]], &sc, 0.95), None);
        assert_eq!(regression(&[sa[..2].to_vec(), sc[..2].to_vec()], &sa[..2], 0.95), None, "as many inputs as rows");
    }
}
