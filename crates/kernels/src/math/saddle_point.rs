//! Saddle-point form of binomial and Poisson probabilities: C. Loader, *Fast and Accurate Computation of Binomial
//! Probabilities* (2000). Logarithms of gamma functions would lose as many digits as their arguments have.

use core::f64::consts::PI;

/// ln(n!) - ln(sqrt(2 pi n) (n/e)^n), for n > 0 (Loader, section 2.1).
pub fn stirling_error(n: f64) -> f64 {
    if n < 16.0 {
        return libm::lgamma(n + 1.0) - (n + 0.5) * libm::log(n) + n - 0.5 * libm::log(2.0 * PI);
    }
    let square = n * n;
    (1.0 / 12.0 - (1.0 / 360.0 - (1.0 / 1260.0 - (1.0 / 1680.0 - 1.0 / 1188.0 / square) / square) / square) / square)
        / n
}

/// x ln(x/m) + m - x without cancellation, for x, m > 0 (Loader, section 2.2).
pub fn deviance(x: f64, m: f64) -> f64 {
    let difference = x - m;
    if difference.abs() < 0.1 * (x + m) {
        let ratio = difference / (x + m);
        let mut sum = difference * ratio;
        let square = ratio * ratio;
        let mut power = 2.0 * x * ratio;
        for j in 1..1000 {
            power *= square;
            let next = sum + power / f64::from(2 * j + 1);
            if next == sum {
                return next;
            }
            sum = next;
        }
    }
    x * libm::log(x / m) + m - x
}
