//! [`LoopError`]: estimated error of a run under a control law.
//!
//! A loop forgets what the integrator did wrong, at a pace that depends on plant, law, filter and limits of actuators
//! together. Pilots measure it: runs of the campaign that are flown twice, the second time in shorter arcs and at a
//! tighter tolerance. The difference of both is the error of the first, of any cause, and over its local errors
//! ([`LocalErrors::inherited`]) it says what the loop makes of these. A mean of the pilots judges other runs, since where
//! a pulse or a wheel that stops makes one error a hundred times that of the others, the largest would judge all by it.

use super::accuracy::INACCURATE_STATE;
use super::conditioning::{ErrorEstimate, LOST};
use super::torque_growth::MOST;
use crate::run::{LocalErrors, StateTable, rate_scale_of};

/// Safety factor: with seven pilots it covers 520 of 520 errors in the loops of `tests/accuracy/loop_errors.rs`.
const SAFETY: f64 = 20.0;

/// Least error in roundings of the run: states on which no error shows round as well.
const ROUNDED: f64 = 4.0;

/// The error of a pilot, and the sum of its local errors.
#[derive(Clone, Copy, Debug)]
pub struct Pilot {
    /// Of omega over its scale, or of the attitude in rad; infinite if the twin ends otherwise.
    pub error: f64,
    /// [`LocalErrors::inherited`].
    pub made: f64,
}

/// What a loop does to the errors of its runs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LoopError {
    /// Error of a pilot over its local errors: the square of the mean root over all; infinite without a pilot.
    kept: f64,
    /// True if a pilot and its twin have parted: their states differ by more than those of an accurate run may.
    pub parts: bool,
    /// True if the outcomes of such pilots agree all the same.
    pub outcomes_agree: bool,
}

impl LoopError {
    /// Of runs that are not judged, which keep no errors.
    pub const UNMEASURED: LoopError = LoopError { kept: 0.0, parts: false, outcomes_agree: true };

    /// By `pilots`; unknown without any.
    pub fn of_pilots(pilots: impl Iterator<Item = Pilot>) -> Self {
        let (mut count, mut roots, mut are_one) = (0.0, 0.0, true);
        for Pilot { error, made } in pilots {
            count += 1.0;
            roots += (error / made).sqrt();
            // false for NaN
            are_one &= SAFETY * error < INACCURATE_STATE;
        }
        let root: f64 = roots / count;
        // infinite for NaN
        LoopError { kept: (root * root).min(f64::INFINITY), parts: !are_one, outcomes_agree: false }
    }

    /// The estimate for a run with these local errors and states at the first `filled` of `times`.
    pub(super) fn estimate(
        &self,
        table: &StateTable,
        times: &[f64],
        filled: usize,
        local: &LocalErrors,
    ) -> ErrorEstimate {
        let made = local.inherited(rate_scale_of(table, times, filled));
        let error = (SAFETY * self.kept * made).max(ROUNDED * local.rounding);
        // false for NaN
        let error = if error < LOST { error } else { LOST };
        ErrorEstimate { error, amplification: self.kept.clamp(1.0, MOST) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::run::{StateField, StateFields};

    /// Law: the mean root of the pilots decides; a run with more local errors has a larger estimate; what is unknown is pi.
    #[test]
    fn a_mean_of_the_pilots_decides() {
        let mut table = StateTable::new(StateFields::NONE.with(StateField::Rate), 0, 2);
        table.set(StateField::Rate, 1, [0.0, 2.0, 0.0]);
        let of = |pilots: &[[f64; 2]], truncation| {
            let of = LoopError::of_pilots(pilots.iter().map(|[error, made]| Pilot { error: *error, made: *made }));
            let local = LocalErrors { truncation, attitude: 0.5, dense: 0.5, ..LocalErrors::NONE };
            (of, of.estimate(&table, &[0.0, 4.0], 2, &local))
        };
        let pilots = [[1e-9, 1e-8], [1e-8, 1e-8], [1e-12, 1e-8]];
        let (found, same) = of(&pilots, 4e-8);
        assert!(!found.parts && (same.error / 7.817244832684503e-8 - 1.0).abs() < 1e-12, "{same:?}");
        let (_, more) = of(&pilots, 64e-8);
        assert!((more.error / 1.2507591732295205e-6 - 1.0).abs() < 1e-12 && more.amplification == 1.0);
        for pilots in [&[[f64::NAN, 1e-8], [1e-9, 1e-8]][..], &[], &[[f64::INFINITY, 1e-8]]] {
            let (found, lost) = of(pilots, 2e-8);
            assert_eq!((found.parts, lost.error), (!pilots.is_empty(), LOST));
        }
        assert!(of(&[[0.02, 1e-8]], 2e-8).0.parts && of(&[[0.0, 1e-8]], 0.0).1.error == 0.0);
    }
}
