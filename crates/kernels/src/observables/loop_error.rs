//! [`LoopError`]: estimated error of a run under a control law.
//!
//! A loop forgets what the integrator did wrong, at a pace that depends on plant, law, filter and limits of actuators
//! together. Pilots measure it: runs of the campaign that are flown twice, the second time in shorter arcs and at a
//! tighter tolerance. The difference of both is the error of the first, of any cause, and over its local errors
//! ([`LocalErrors::inherited`]) it says what the loop makes of these. A mean of the pilots judges other runs: where a
//! pulse or a wheel that stops makes one error a hundred times that of the others, the largest would judge all by it.
//! Pilots whose local errors are nearest to the run's own have the largest weights: where some runs settle and others
//! tumble to the end, both their local errors and what the loop makes of them differ by powers of ten.

use super::accuracy::INACCURATE_STATE;
use super::conditioning::{ErrorEstimate, LOST};
use super::torque_growth::MOST;
use crate::run::{LocalErrors, StateTable, rate_scale_of};

/// Safety factor: with seven pilots it covers 599 of 600 errors in the loops of `tests/accuracy/loop_errors.rs`.
const SAFETY: f64 = 30.0;

/// Most pilots.
const MOST_PILOTS: usize = 8;

/// Least local errors that are told apart, far below rounding.
const LEAST: f64 = 1e-20;

/// Least error in roundings of the run: states on which no error shows round as well.
const ROUNDED: f64 = 4.0;

/// The error of a pilot, and the sum of its local errors.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pilot {
    /// Of omega over its scale, or of the attitude in rad; infinite if the twin ends otherwise.
    pub error: f64,
    /// [`LocalErrors::inherited`].
    pub made: f64,
}

/// What a loop does to the errors of its runs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LoopError {
    pilots: [Pilot; MOST_PILOTS],
    count: usize,
    /// True if a pilot and its twin have parted: their states differ by more than those of an accurate run may.
    pub parts: bool,
    /// True if the outcomes of such pilots agree all the same.
    pub outcomes_agree: bool,
}

impl LoopError {
    /// Of runs that are not judged, which keep no errors.
    pub const UNMEASURED: LoopError = LoopError {
        pilots: [Pilot { error: 0.0, made: 1.0 }; MOST_PILOTS],
        count: 1,
        parts: false,
        outcomes_agree: true,
    };

    /// By the first of `pilots`; unknown without any.
    pub fn of_pilots(pilots: impl Iterator<Item = Pilot>) -> Self {
        let mut found = LoopError { count: 0, outcomes_agree: false, ..LoopError::UNMEASURED };
        for (own, pilot) in found.pilots.iter_mut().zip(pilots) {
            *own = pilot;
            found.count += 1;
            let is_one = SAFETY * pilot.error < INACCURATE_STATE;
            // true for NaN
            found.parts |= !is_one;
        }
        found
    }

    /// Error of a run over its local errors `made`: the square of the mean root over the pilots with the weights
    /// (2/(r + 1/r))^2, r the ratio of both local errors; infinite without a pilot, or with a lost one.
    fn kept(&self, made: f64) -> f64 {
        let (mut roots, mut weights) = (0.0, 0.0);
        for pilot in &self.pilots[..self.count] {
            let [own, other] = [made, pilot.made].map(|made| made.max(LEAST));
            let nearness = own * other / own.mul_add(own, other * other);
            weights += nearness * nearness;
            roots += nearness * nearness * (pilot.error / other).sqrt();
        }
        let root: f64 = roots / weights;
        // infinite for NaN
        (root * root).min(f64::INFINITY)
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
        let kept = self.kept(made);
        let error = (SAFETY * kept * made).max(ROUNDED * local.rounding);
        // false for NaN
        let error = if error < LOST { error } else { LOST };
        ErrorEstimate { error, amplification: kept.clamp(1.0, MOST) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::run::{StateField, StateFields};

    /// Law: the mean root of the pilots decides, those with like local errors most; a run with more local errors has a
    /// larger estimate; what is unknown is pi.
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
        assert!(!found.parts && (same.error / 1.172586724902675e-7 - 1.0).abs() < 1e-12, "{same:?}");
        let (_, more) = of(&pilots, 64e-8);
        assert!((more.error / 1.87613875984428e-6 - 1.0).abs() < 1e-12 && more.amplification == 1.0);
        // one settles, one tumbles
        let both = [[1e-12, 1e-9], [1e-3, 1e-7]];
        let [settled, tumbling] = [2e-9, 2e-7].map(|truncation| of(&both, truncation).1.error);
        assert!((settled / 1.5373730215127547e-10 - 1.0).abs() < 1e-9, "{settled}");
        assert!((tumbling / 0.029976026767733668 - 1.0).abs() < 1e-9, "{tumbling}");
        for pilots in [&[[f64::NAN, 1e-8], [1e-9, 1e-8]][..], &[], &[[f64::INFINITY, 1e-8]]] {
            let (found, lost) = of(pilots, 2e-8);
            assert_eq!((found.parts, lost.error), (!pilots.is_empty(), LOST));
        }
        assert!(of(&[[0.02, 1e-8]], 2e-8).0.parts && of(&[[0.0, 1e-8]], 0.0).1.error == 0.0);
    }
}
