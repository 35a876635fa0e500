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

/// A pivot below this: the input is a linear combination of those before it. Correlations have about 1e-15.
const SMALLEST_PIVOT: f64 = 1e-10;

/// The regression of `y` on the `inputs`, all [`standardised`](super::correlation::standardised), with intervals at `confidence`.
///
/// `None` where the inputs are linearly dependent (a constant input included), or where there are not more rows than inputs and two.
pub fn regression(inputs: &[Vec<f64>], y: &[f64], confidence: f64) -> Option<Regression> {
    let count = inputs.len();
    let freedom = y.len().checked_sub(count + 1).filter(|freedom| *freedom > 0)? as f64;
    let r = DVector::from_iterator(count, inputs.iter().map(|x| product(x, y)));
    let inverse = inverse(&super::correlation::matrix(inputs))?;
    let beta = &inverse * &r;
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
        assert!((found.r_squared - 1.0).abs() < 5e-15, "{}", found.r_squared);
        let spread = |x: &[f64]| {
            let mean = x.iter().sum::<f64>() / x.len() as f64;
            libm::sqrt(x.iter().map(|x| (x - mean) * (x - mean)).sum::<f64>())
        };
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
        assert!((found.partial[0] - expected).abs() < 2e-15, "{} {expected}", found.partial[0]);
        let interval = found.coefficients[0];
        assert!(interval.lower < interval.value && interval.value < interval.upper);
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
