//! Estimated errors of a run from the steps of its method: the sums behind [`LocalErrors`].
//!
//! Errors of the rotational state (of omega in rad/s, of the attitude in rad) of all steps, added as if all had the
//! same direction; and rounding, which accumulates as a random walk (H. Brouwer, Astron. J. 46, 1937).

use crate::ode::{EndedRun, ErrorModel};
use crate::run::LocalErrors;

/// The sums for a run of a method with error model `model`, at the relative tolerance `tolerance`.
///
/// For a method without error estimates only rounding: the rest is [`super::series_remainder`]. Where steps are
/// controlled relative to the states, truncation is so too: [`in_units`] follows.
pub fn local_errors(model: &ErrorModel, tolerance: f64, completion: &EndedRun) -> LocalErrors {
    let rounding = rounding(completion.accepted);
    match model {
        ErrorModel::Remainder(_) => rounding,
        ErrorModel::Estimated(errors) => {
            let error = errors.gain(tolerance) * tolerance * completion.error_sum;
            LocalErrors {
                truncation: error,
                // where no step comes near the tolerance, nor does a point inside it
                attitude: rounding.attitude
                    + error
                    + errors.dense * tolerance * (DENSE * completion.error_sum).min(1.0),
                ..rounding
            }
        }
    }
}

/// Errors whose truncation is relative to the larger of |omega| and `least`, rad/s, in units: relative to the fastest
/// of `rates`.
#[must_use]
pub fn in_units(errors: LocalErrors, rates: impl Iterator<Item = [f64; 3]>, least: f64) -> LocalErrors {
    LocalErrors { truncation: errors.truncation * fastest(rates).max(least), ..errors }
}

/// The largest magnitude of `rates`; what is not a number does not count.
pub fn fastest(rates: impl Iterator<Item = [f64; 3]>) -> f64 {
    rates.map(|[x, y, z]| x * x + y * y + z * z).fold(0.0, f64::max).sqrt()
}

/// How far the points inside the steps of a run may be off, in sums of the errors of its steps: measured in the same
/// campaigns and those of `at_rest.rs`, where 1 leaves the estimate below the error of `burn` by `dop853`.
const DENSE: f64 = 1.6;

/// Error of a compensated step as a fraction of a rounding: measured over the campaigns of
/// `tests/accuracy/error_estimate.rs`.
const WALK: f64 = 0.15;

/// Rounding of constants and states, and of the sum over `steps` compensated steps.
pub fn rounding(steps: u64) -> LocalErrors {
    rounding_of_turns(steps, f64::INFINITY)
}

/// The same if all steps together turn by `angle`, rad: what is rounded is the change over a step.
pub fn rounding_of_turns(steps: u64, angle: f64) -> LocalErrors {
    let steps = steps as f64;
    let share = if angle < steps { angle / steps } else { 1.0 };
    let walked = f64::EPSILON * (1.0 + WALK * share * steps.sqrt());
    // the attitude is turned between the axes of integration and F_s, which rounds once more
    LocalErrors { rounding: walked, attitude: walked + f64::EPSILON, ..LocalErrors::default() }
}
