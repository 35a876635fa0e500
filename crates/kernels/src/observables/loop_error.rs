//! [`LoopError`]: estimated error of a run under a control law.
//!
//! A loop forgets what the integrator did wrong, at a pace that depends on plant, law, filter and limits of actuators
//! together. Pilots measure it: runs of the campaign that are flown twice, the second time in shorter arcs and at a
//! tighter tolerance. The difference of both is the error of the first, of any cause. For another run it is scaled by
//! the local errors of both ([`LocalErrors::total`]) to the power 3/4: between a loop whose errors follow their
//! estimates, and one whose estimates vanish beside rounding while its errors do not.

use super::accuracy::INACCURATE_STATE;
use super::conditioning::{ErrorEstimate, LOST};
use super::torque_growth::MOST;
use crate::run::{LocalErrors, StateTable, rate_scale_of};

/// Safety factor: with seven pilots it covers 473 of 480 errors in the loops of `tests/accuracy/loop_errors.rs`, in the
/// worst of them 36 of 40.
const SAFETY: f64 = 8.0;

/// Least error in roundings of the run: states on which no error shows round as well.
const ROUNDED: f64 = 4.0;

/// The error of a pilot, and the sum of its local errors.
#[derive(Clone, Copy, Debug)]
pub struct Pilot {
    /// Of omega over its scale, or of the attitude in rad; infinite if the twin ends otherwise.
    pub error: f64,
    /// [`LocalErrors::total`].
    pub made: f64,
}

/// What a loop does to the errors of its runs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LoopError {
    /// Largest error of a pilot over its local errors to the power 3/4; infinite without a pilot.
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
        let mut found: Option<LoopError> = None;
        for Pilot { error, made } in pilots {
            // NaN counts as lost
            let [error, kept] = [error, error / power(made)].map(|x| if x.is_nan() { f64::INFINITY } else { x });
            let before = found.unwrap_or(LoopError { kept: 0.0, parts: false, outcomes_agree: false });
            let parts = before.parts || SAFETY * error >= INACCURATE_STATE;
            found = Some(LoopError { kept: before.kept.max(kept), parts, ..before });
        }
        found.unwrap_or(LoopError { kept: f64::INFINITY, parts: false, outcomes_agree: false })
    }

    /// The estimate for a run with these local errors and states at the first `filled` of `times`.
    pub(super) fn estimate(
        &self,
        table: &StateTable,
        times: &[f64],
        filled: usize,
        local: &LocalErrors,
    ) -> ErrorEstimate {
        let made = local.total(rate_scale_of(table, times, filled));
        let expected = self.kept * power(made);
        let error = (SAFETY * expected).max(ROUNDED * local.rounding);
        ErrorEstimate {
            // false for NaN
            error: if error < LOST { error } else { LOST },
            amplification: if expected < MOST * made { (expected / made).max(1.0) } else { MOST },
        }
    }
}

/// `made` to the power 3/4.
fn power(made: f64) -> f64 {
    made.sqrt() * made.sqrt().sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::run::{StateField, StateFields};

    /// Law: the worst pilot decides; a run with more local errors has a larger estimate; what is unknown is pi.
    #[test]
    fn the_worst_pilot_decides() {
        let mut table = StateTable::new(StateFields::NONE.with(StateField::Rate), 0, 2);
        table.set(StateField::Rate, 1, [0.0, 2.0, 0.0]);
        let of = |pilots: &[[f64; 2]], truncation| {
            let of = LoopError::of_pilots(pilots.iter().map(|[error, made]| Pilot { error: *error, made: *made }));
            (of, of.estimate(&table, &[0.0, 4.0], 2, &LocalErrors { truncation, ..LocalErrors::NONE }))
        };
        let pilots = [[1e-9, 1e-8], [1e-8, 1e-8], [1e-12, 1e-8]];
        let (found, same) = of(&pilots, 4e-8);
        assert!(!found.parts && (same.error / 1.345434264405943e-7 - 1.0).abs() < 1e-12, "{same:?}");
        let (_, more) = of(&pilots, 64e-8);
        assert!((more.error / 1.076347411524755e-6 - 1.0).abs() < 1e-12 && more.amplification == 1.0);
        for pilots in [&[[f64::NAN, 1e-8], [1e-9, 1e-8]][..], &[], &[[f64::INFINITY, 1e-8]]] {
            let (found, lost) = of(pilots, 2e-8);
            assert_eq!((found.parts, lost.error), (!pilots.is_empty(), LOST));
        }
        assert!(of(&[[0.02, 1e-8]], 2e-8).0.parts && of(&[[0.0, 1e-8]], 0.0).1.error == 0.0);
    }
}
