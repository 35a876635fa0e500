//! `pert`: the beta distribution between `min` and `max` with shapes 1 + 4 (mode - min)/(max - min) and
//! 1 + 4 (max - mode)/(max - min); `mode` defaults to the nominal value.
//!
//! The shapes, 1 to 5 with sum 6, need few terms of the continued fraction of the incomplete beta function (DLMF
//! 8.17.22, by Lentz's method as modified by Thompson & Barnett, *J. Comput. Phys.* 64 (1986) 490) and no table as
//! [`super::beta`]. The inverse is Newton's method for ln I in ln x, which rises and is concave: steps after the first
//! do not overshoot.

use super::prelude::*;
use super::triangular::Triangular;

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pert {
    alpha: f64,
    beta: f64,
    min: f64,
    max: f64,
    /// ln B(alpha, beta).
    log_b: f64,
}

/// A dozen are needed.
const MOST_TERMS: u32 = 2000;
/// Six to ten are typical.
const MOST_STEPS: u32 = 100;
/// Smaller steps of ln x leave x unchanged.
const SMALLEST_STEP: f64 = f64::EPSILON;

impl Pert {
    /// Mean (min + 4 mode + max)/6 (D. G. Malcolm et al., *Operations Research* 7 (1959) 646).
    pub fn new(min: f64, mode: f64, max: f64) -> Self {
        // halves: the width may be beyond the largest number
        let width = 0.5 * max - 0.5 * min;
        let shape = |side: f64| 1.0 + 4.0 * (side / width);
        let (alpha, beta) = (shape(0.5 * mode - 0.5 * min), shape(0.5 * max - 0.5 * mode));
        let log_b = libm::lgamma(alpha) + libm::lgamma(beta) - libm::lgamma(alpha + beta);
        Pert { alpha, beta, min, max, log_b }
    }
}

impl Scalar for Pert {
    const NAME: &'static str = "pert";
    const KEYS: &'static [Row] = Triangular::KEYS;
    type Quantile = Self;

    fn of(target: &Target<'_>) -> Result<Vec<Self>> {
        target.check_mode()?;
        target.of_numbers(["min", "mode", "max"], |[min, mode, max]| Pert::new(min, mode, max))
    }
}

impl Quantile for Pert {
    /// The distance from the nearer end has a relative error below 1e-12.
    fn quantile(&self, u: f64) -> f64 {
        // 1 - u is exact, so neither tail loses digits
        let width = self.max - self.min;
        let value = if !width.is_finite() {
            let x = inverse(u, self.alpha, self.beta, self.log_b);
            (1.0 - x) * self.min + x * self.max
        } else if u <= 0.5 {
            self.min + width * inverse(u, self.alpha, self.beta, self.log_b)
        } else {
            self.max - width * inverse(1.0 - u, self.beta, self.alpha, self.log_b)
        };
        value.clamp(self.min, self.max)
    }

    fn text(&self, words: NumberWords<'_>) -> String {
        let [alpha, beta] = [self.alpha, self.beta].map(words.number);
        let [min, max] = [self.min, self.max].map(words.amount);
        format!("PERT, beta({alpha}, {beta}), {min} to {max}")
    }
}

/// ln I_x(a, b), and x f(x)/I, its slope in ln x; 0 < x < 1, `log_b` = ln B(a, b).
fn log_probability(x: f64, a: f64, b: f64, log_b: f64) -> (f64, f64) {
    // ln of x^a (1 - x)^b / B, that is x (1 - x) times the density
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
    /// Replaces zero, so that Lentz's method continues (Thompson & Barnett).
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
    // the series' first term, below the root for b > 1; else half the interval
    let start = (log_p + libm::log(a) + log_b) / a;
    let mut log_x = if start < -core::f64::consts::LN_2 { start } else { -core::f64::consts::LN_2 };
    for _ in 0..MOST_STEPS {
        let (log, slope) = log_probability(libm::exp(log_x), a, b, log_b);
        let step = (log_p - log) / slope;
        // from the right of the root a step may go too far left
        let next = (log_x + step).min(0.5 * log_x);
        let moved = (next - log_x).abs();
        log_x = next;
        if moved <= SMALLEST_STEP * (1.0 + log_x.abs()) {
            break;
        }
    }
    libm::exp(log_x)
}
