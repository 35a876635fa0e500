//! [`Probability`]: a probability with its complement, and the search for the value that has it.

/// A probability and its complement. Each has its own relative accuracy, so neither tail loses digits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Probability {
    /// P.
    pub lower: f64,
    /// 1 - P.
    pub upper: f64,
}

/// Newton steps or bisections after which a search ends; some ten are needed.
const MAX_STEPS: u32 = 200;

/// ln x of the value x with the probability `target`, from the guess `log_x` between the ends of `bracket`.
///
/// `at` gives the distribution function at ln x and its derivative with respect to ln x. Newton's method for the
/// logarithm of the smaller of the two probabilities, which has the digits; a step that leaves the bracket is a
/// bisection, so that it always converges.
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
