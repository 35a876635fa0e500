//! Outcome and effort of a run.

use super::state_field::StateField;
use super::state_table::StateTable;
use crate::math::enumeration::named;
use crate::math::real::Real;

named! {
    /// Status of a run.
    #[derive(Hash)]
    pub enum Status {
        /// Reached the end of its horizon.
        Done = "ok",
        /// Reached the maximum number of steps, or would before the end of the horizon.
        StepLimit = "step_limit",
        /// The step required by the tolerance is below the resolution of the time.
        StepFloor = "step_floor",
        /// A state component became infinite or NaN.
        NonFinite = "non_finite",
        /// The sampled scene is physically impossible; nothing was integrated.
        InvalidSample = "invalid_sample",
        /// Reached the end of its horizon with errors beyond any use ([`crate::observables::accuracy`]).
        Inaccurate = "inaccurate",
        /// A defect of spindrift showed in this run; other runs are not affected.
        InternalError = "internal_error",
        /// Reached the surface of the central body of its orbit.
        Surface = "surface",
        /// Ended by its control loop, which is unstable.
        Diverged = "diverged",
    }
}

impl Status {
    /// Reason for this status after `time`, s, in words, if it does not depend on the run.
    pub fn reason(self, time: f64) -> Option<String> {
        Some(match self {
            Status::Done | Status::InvalidSample | Status::Inaccurate | Status::InternalError | Status::Diverged => {
                return None;
            }
            Status::StepLimit => format!("integrator.max_steps does not suffice: the run reached {time:?} s"),
            Status::StepFloor => format!("the step fell below the resolution of time at {time:?} s"),
            Status::NonFinite => format!("a state became infinite or not a number after {time:?} s"),
            Status::Surface => format!("the spacecraft reached the surface of the central body at {time:?} s"),
        })
    }
}

/// Effort of a run, independent of the machine.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct StepStatistics {
    /// Accepted steps.
    pub steps: u64,
    /// Rejected steps.
    pub rejected: u64,
    /// Evaluations of the right-hand side (Taylor methods: one jet per step).
    pub evaluations: u64,
}

/// Status, time and effort of a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Outcome {
    /// Status.
    pub status: Status,
    /// Time reached, s; the duration if the status is [`Status::Done`].
    pub time: f64,
    /// Number of filled observation points; all if the status is [`Status::Done`].
    pub points: usize,
    /// Effort.
    pub effort: StepStatistics,
    /// Estimated errors of the method.
    pub local_errors: LocalErrors,
    /// Estimated errors of the debris' rotation; zero if it was not integrated.
    pub debris_errors: LocalErrors,
}

impl Outcome {
    /// A run that has not begun.
    pub const NOTHING: Outcome = Outcome {
        status: Status::InvalidSample,
        time: 0.0,
        points: 0,
        effort: StepStatistics { steps: 0, rejected: 0, evaluations: 0 },
        local_errors: LocalErrors::NONE,
        debris_errors: LocalErrors::NONE,
    };
}

/// Reference rate of errors of omega, rad/s: the largest |omega| of the run, at least one radian over the `duration`,
/// s: if a body turns by less, the error is the resulting angle.
#[inline(always)]
pub fn rate_scale(largest: f64, duration: f64) -> f64 {
    if duration > 0.0 { largest.larger(1.0 / duration) } else { 1.0 }
}

/// [`rate_scale`] of a run with the states `table` at the first `filled` of `times`.
pub fn rate_scale_of(table: &StateTable, times: &[f64], filled: usize) -> f64 {
    let [x, y, z] = [0, 1, 2].map(|axis| &table.column(StateField::Rate, axis)[..filled]);
    let square = |point: usize| x[point] * x[point] + y[point] * y[point] + z[point] * z[point];
    rate_scale((0..filled).map(square).fold(0.0, f64::max).sqrt(), times[filled - 1])
}

/// Estimated errors of the rotational state over all steps of a run, added in magnitude, before their amplification by
/// the motion.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LocalErrors {
    /// Error of omega, rad/s, proportional to its rate of change: truncation.
    pub truncation: f64,
    /// Relative error of omega, proportional to its components: rounding.
    pub rounding: f64,
    /// Error of omega, rad/s, in any direction: feedback from other states.
    pub feedback: f64,
    /// Error of the attitude alone, rad: truncation, rounding and dense output.
    pub attitude: f64,
    /// That of dense output alone, which later steps do not inherit.
    pub dense: f64,
}

impl LocalErrors {
    /// No errors.
    pub const NONE: LocalErrors =
        LocalErrors { truncation: 0.0, rounding: 0.0, feedback: 0.0, attitude: 0.0, dense: 0.0 };

    /// Sum of those that later steps inherit, with errors of omega relative to `scale`, rad/s ([`rate_scale`]).
    pub fn inherited(&self, scale: f64) -> f64 {
        (self.truncation + self.feedback) / scale + self.rounding + (self.attitude - self.dense)
    }
}
