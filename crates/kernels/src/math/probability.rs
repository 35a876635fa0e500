//! [`Probability`]: a probability with its complement, and the search for a quantile.

/// A probability and its complement, each with its own relative accuracy.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Probability {
    pub lower: f64,
    /// 1 - P.
    pub upper: f64,
}

/// Replaces a zero, so that Lentz's method for continued fractions continues (I. J. Thompson & A. R. Barnett, *J.
/// Comput. Phys.* 64 (1986) 490).
pub const TINY: f64 = 1e-300;

/// `value`, or [`TINY`] if it is zero.
pub fn nonzero(value: f64) -> f64 {
    if value.abs() < TINY { TINY } else { value }
}

/// Limit of steps; some ten are needed.
const MAX_STEPS: u32 = 200;

/// ln x of the value x with the probability `target`, from the guess `log_x` within `bracket`.
///
/// `at` is the distribution function and its derivative with respect to ln x. Newton's method for the logarithm of the
/// smaller probability, with bisection for steps that leave the bracket.
pub fn log_of_quantile(
    target: Probability,
    mut log_x: f64,
    bracket: [f64; 2],
    at: impl Fn(f64) -> (Probability, f64),
) -> f64 {
    let [mut low, mut high] = bracket;
    for _ in 0..MAX_STEPS {
        let (found, density) = at(log_x);
        let (ratio, slope) = if target.lower <= target.upper {
            (libm::log(found.lower / target.lower), density / found.lower)
        } else {
            (-libm::log(found.upper / target.upper), density / found.upper)
        };
        if ratio > 0.0 {
            high = high.min(log_x);
        } else {
            low = low.max(log_x);
        }
        let newton = log_x - ratio / slope;
        let next = if newton > low && newton < high { newton } else { 0.5 * (low + high) };
        let moved = (next - log_x).abs();
        log_x = next;
        if moved <= f64::EPSILON * (1.0 + log_x.abs()) || high - low <= f64::EPSILON * log_x.abs() {
            break;
        }
    }
    log_x
}
