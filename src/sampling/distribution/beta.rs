//! `beta`: between `min` and `max`, with density proportional to x^(`alpha` - 1) (1 - x)^(`beta` - 1), by its regularised incomplete beta function I_x(a, b) and the inverse.
//!
//! I_x by its continued fraction (DLMF 8.17.22, evaluated by the method of Lentz as modified by Thompson & Barnett, *J. Comput.
//! Phys.* 64 (1986) 490), with I_x(a, b) = 1 - I_(1-x)(b, a) where that converges faster. The inverse is Newton's method for
//! ln I as a function of ln x: that function rises and is concave (x f(x)/I falls), so each step after the first comes from
//! the left and none overshoots; no bracket is needed. Elementary functions from `libm`.

use super::target::Target;
use super::traits::{Quantile, Scalar};
use crate::sampling::error::DispersionError;
use crate::sampling::keys::{KeyReader, KeyWriter, Values};

/// Allowed shape parameters: outside, the distribution is a spike or two, and the quantile's series need thousands of terms.
const SHAPES: std::ops::RangeInclusive<f64> = 0.01..=1e4;

/// As written.
#[derive(Clone, Debug, PartialEq)]
pub struct Beta {
    /// First shape parameter.
    pub alpha: Values,
    /// Second shape parameter.
    pub beta: Values,
    /// Lower end.
    pub min: Values,
    /// Upper end.
    pub max: Values,
}

impl Scalar for Beta {
    const NAME: &'static str = "beta";
    type Quantile = BetaQuantile;

    fn read(keys: &mut dyn KeyReader) -> Option<Self> {
        let shapes = keys.required("alpha", "2.0").zip(keys.required("beta", "5.0"));
        keys.ends().zip(shapes).map(|((min, max), (alpha, beta))| Beta { alpha, beta, min, max })
    }

    fn write(&self, keys: &mut dyn KeyWriter) {
        keys.values("alpha", &self.alpha);
        keys.values("beta", &self.beta);
        keys.ends(&self.min, &self.max);
    }

    fn quantiles(&self, target: &Target<'_>) -> Result<Vec<BetaQuantile>, DispersionError> {
        let shape = |key, values| {
            let allowed = "a number from 0.01 to 1e4";
            target.passing(key, values, |x| SHAPES.contains(&x), allowed, "1 is a uniform distribution")
        };
        let (alpha, beta) = (shape("alpha", &self.alpha)?, shape("beta", &self.beta)?);
        let (min, max) = target.ends(&self.min, &self.max)?;
        target.all(|k| Ok(BetaQuantile::new(alpha[k], beta[k], min[k], max[k])))
    }
}

/// A beta distribution from `min` to `max`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BetaQuantile {
    alpha: f64,
    beta: f64,
    min: f64,
    max: f64,
    /// ln B(alpha, beta).
    log_b: f64,
}

/// Terms after which the continued fraction has converged for the largest allowed shapes (about 5 sqrt(1e4) are needed).
const MOST_TERMS: u32 = 2000;
/// Newton steps: six to ten are typical; each beyond that repeats the last.
const MOST_STEPS: u32 = 100;
/// Steps of ln x below this leave x as it is.
const SMALLEST_STEP: f64 = f64::EPSILON;

impl BetaQuantile {
    /// The law of shapes `alpha`, `beta` > 0 from `min` to `max`.
    pub fn new(alpha: f64, beta: f64, min: f64, max: f64) -> Self {
        let log_b = libm::lgamma(alpha) + libm::lgamma(beta) - libm::lgamma(alpha + beta);
        BetaQuantile { alpha, beta, min, max, log_b }
    }

    /// PERT: mean (min + 4 mode + max)/6 (D. G. Malcolm et al., *Operations Research* 7 (1959) 646).
    pub fn pert(min: f64, mode: f64, max: f64) -> Self {
        let width = max - min;
        Self::new(1.0 + 4.0 * (mode - min) / width, 1.0 + 4.0 * (max - mode) / width, min, max)
    }
}

impl Quantile for BetaQuantile {
    /// The value below which the fraction `u` of the law lies; relative error of its place in the interval below 1e-12.
    fn quantile(&self, u: f64) -> f64 {
        // 1 - u is exact, so neither tail loses digits
        let value = if u <= 0.5 {
            self.min + (self.max - self.min) * inverse(u, self.alpha, self.beta, self.log_b)
        } else {
            self.max - (self.max - self.min) * inverse(1.0 - u, self.beta, self.alpha, self.log_b)
        };
        value.clamp(self.min, self.max)
    }

    fn text(&self, short: &dyn Fn(f64) -> String) -> String {
        let [alpha, beta, min, max] = [self.alpha, self.beta, self.min, self.max].map(short);
        format!("beta({alpha}, {beta}), {min} to {max}")
    }
}

/// ln I_x(a, b), and x f(x)/I, its slope in ln x; 0 < x < 1, `log_b` = ln B(a, b).
fn log_probability(x: f64, a: f64, b: f64, log_b: f64) -> (f64, f64) {
    // ln of x^a (1 - x)^b / B: x times (1 - x) times the density
    let log_front = a * libm::log(x) + b * libm::log1p(-x) - log_b;
    let log = if x < (a + 1.0) / (a + b + 2.0) {
        log_front + libm::log(continued_fraction(x, a, b) / a)
    } else {
        libm::log1p(-libm::exp(log_front) * continued_fraction(1.0 - x, b, a) / b)
    };
    (log, libm::exp(log_front - log) / (1.0 - x))
}

/// The continued fraction of a I_x(a, b) B(a, b) / (x^a (1-x)^b), for x below (a + 1)/(a + b + 2).
fn continued_fraction(x: f64, a: f64, b: f64) -> f64 {
    /// In place of a zero, so that Lentz's method continues (Thompson & Barnett).
    const TINY: f64 = 1e-300;
    let kept = |value: f64| if value.abs() < TINY { TINY } else { value };
    let mut c = 1.0;
    let mut d = 1.0 / kept(1.0 - (a + b) * x / (a + 1.0));
    let mut fraction = d;
    for term in 1..MOST_TERMS {
        let m = f64::from(term);
        let even = m * (b - m) * x / ((a + 2.0 * m - 1.0) * (a + 2.0 * m));
        d = 1.0 / kept(1.0 + even * d);
        c = kept(1.0 + even / c);
        fraction *= c * d;
        let odd = -(a + m) * (a + b + m) * x / ((a + 2.0 * m) * (a + 2.0 * m + 1.0));
        d = 1.0 / kept(1.0 + odd * d);
        c = kept(1.0 + odd / c);
        let factor = c * d;
        fraction *= factor;
        if (factor - 1.0).abs() <= f64::EPSILON {
            break;
        }
    }
    fraction
}

/// x with I_x(a, b) = `p`, 0 < p <= 1/2.
fn inverse(p: f64, a: f64, b: f64, log_b: f64) -> f64 {
    let log_p = libm::log(p);
    // the first term of the series, below the root for b > 1; half the interval where it lies outside
    let start = (log_p + libm::log(a) + log_b) / a;
    let mut log_x = if start < -core::f64::consts::LN_2 { start } else { -core::f64::consts::LN_2 };
    for _ in 0..MOST_STEPS {
        let (log, slope) = log_probability(libm::exp(log_x), a, b, log_b);
        let step = (log_p - log) / slope;
        // from the right of the root a step may lead anywhere to its left; to the right x = 1 is the end
        let next = (log_x + step).min(0.5 * log_x);
        let moved = (next - log_x).abs();
        log_x = next;
        if moved <= SMALLEST_STEP * (1.0 + log_x.abs()) {
            break;
        }
    }
    libm::exp(log_x)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn closed_forms() {
        // a = 1: 1 - (1 - x)^b; b = 1: x^a; a = b = 1/2: sin^2(pi u/2)
        for u in [1e-15, 1e-6, 0.1, 0.4999, 0.5, 0.7, 0.999, 1.0 - 1e-12] {
            for shape in [0.05, 0.5, 1.0, 2.5, 40.0] {
                let first = BetaQuantile::new(1.0, shape, 0.0, 1.0).quantile(u);
                let expected = -libm::expm1(libm::log1p(-u) / shape);
                assert!((first / expected - 1.0).abs() < 1e-13, "1, {shape}: {u} {first} {expected}");
                let second = BetaQuantile::new(shape, 1.0, 0.0, 1.0).quantile(u);
                let expected = libm::exp(libm::log(u) / shape);
                assert!((second / expected - 1.0).abs() < 5e-13, "{shape}, 1: {u} {second} {expected}");
            }
            let sine = libm::sin(core::f64::consts::FRAC_PI_2 * u);
            let arcsine = BetaQuantile::new(0.5, 0.5, 0.0, 1.0).quantile(u);
            assert!((arcsine / (sine * sine) - 1.0).abs() < 3e-14, "{u} {arcsine}");
        }
    }

    #[test]
    fn a_pert_distribution_has_its_mean() {
        // the mean of a law is the mean of its quantiles: midpoint rule, whose error is below 1/n at these shapes
        let law = BetaQuantile::pert(2.0, 3.0, 7.0);
        const N: u32 = 2000;
        let mean = (0..N).map(|k| law.quantile((f64::from(k) + 0.5) / f64::from(N))).sum::<f64>() / f64::from(N);
        assert!((mean - (2.0 + 12.0 + 7.0) / 6.0).abs() < 1e-4, "{mean}");
    }
}
