//! Estimated errors of a run from the steps of its method: the sums behind [`LocalErrors`].
//!
//! Errors of all steps (omega in rad/s, attitude in rad) add as if aligned; rounding is a random walk (H. Brouwer,
//! Astron. J. 46, 1937).

use crate::ode::{EndedRun, ErrorModel};
use crate::run::LocalErrors;

/// The sums for a run of a method with this error model and relative tolerance: rounding alone without error estimates
/// ([`super::series_remainder`]). Truncation is relative to the states if step control is ([`in_units`]).
pub fn local_errors(model: &ErrorModel, tolerance: f64, completion: &EndedRun) -> LocalErrors {
    let rounding = rounding(completion.accepted);
    match model {
        ErrorModel::Remainder(_) => rounding,
        ErrorModel::Estimated(errors) => {
            let error = errors.gain(tolerance) * tolerance * completion.error_sum;
            // if no step comes near the tolerance, no point inside a step does
            let dense = errors.dense * tolerance * (DENSE * completion.error_sum).min(1.0);
            LocalErrors { truncation: error, attitude: rounding.attitude + error + dense, dense, ..rounding }
        }
    }
}

/// Converts truncation relative to the larger of |omega| and `least` (rad/s) to units of the fastest of `rates`.
#[must_use]
pub fn in_units(errors: LocalErrors, rates: impl Iterator<Item = [f64; 3]>, least: f64) -> LocalErrors {
    LocalErrors { truncation: errors.truncation * fastest(rates).max(least), ..errors }
}

/// The largest magnitude of `rates`; NaN does not count.
pub fn fastest(rates: impl Iterator<Item = [f64; 3]>) -> f64 {
    rates.map(|[x, y, z]| x * x + y * y + z * z).fold(0.0, f64::max).sqrt()
}

/// Error of points inside steps, in sums of the errors of the steps, measured in the campaigns of `at_rest.rs` and of
/// [`WALK`]; at 1 the estimate is below the error of `burn` by `dop853`.
const DENSE: f64 = 1.6;

/// Error of a compensated step as a fraction of a rounding, measured over the campaigns of
/// `tests/accuracy/error_estimate.rs`.
const WALK: f64 = 0.15;

/// Rounding of constants, states and `steps` compensated steps.
pub fn rounding(steps: u64) -> LocalErrors {
    rounding_of_turns(steps, f64::INFINITY)
}

/// [`rounding`] if all steps together turn by `angle`, rad: the change over a step is rounded.
pub fn rounding_of_turns(steps: u64, angle: f64) -> LocalErrors {
    let steps = steps as f64;
    let share = if angle < steps { angle / steps } else { 1.0 };
    let walked = f64::EPSILON * (1.0 + WALK * share * steps.sqrt());
    // conversion of the attitude between B and F_s rounds once more
    LocalErrors { rounding: walked, attitude: walked + f64::EPSILON, ..LocalErrors::default() }
}
