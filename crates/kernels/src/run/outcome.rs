//! Outcome and effort of a run.

use crate::math::real::Real;

/// Status of a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Status {
    /// Reached the end of its horizon.
    Done,
    /// The maximum number of steps was reached, or makes the end of the horizon unreachable.
    StepLimit,
    /// The step required by the tolerance is below the resolution of the time.
    StepFloor,
    /// A state component became infinite or NaN.
    NonFinite,
    /// The sampled scene is physically impossible; nothing was integrated.
    InvalidSample,
    /// Reached the end of its horizon with errors beyond any use: see [`crate::observables::accuracy`].
    Inaccurate,
    /// The program failed in this run, a defect of spindrift; other runs are not affected.
    InternalError,
    /// Reached the surface of the central body of its orbit.
    Surface,
    /// Ended by its control loop, which is unstable.
    Diverged,
}

impl Status {
    /// All values, in the order of their codes.
    pub const ALL: [Status; 9] = [
        Status::Done,
        Status::StepLimit,
        Status::StepFloor,
        Status::NonFinite,
        Status::InvalidSample,
        Status::Inaccurate,
        Status::InternalError,
        Status::Surface,
        Status::Diverged,
    ];

    /// The name in rows and summaries.
    pub const fn name(self) -> &'static str {
        match self {
            Status::Done => "ok",
            Status::StepLimit => "step_limit",
            Status::StepFloor => "step_floor",
            Status::NonFinite => "non_finite",
            Status::InvalidSample => "invalid_sample",
            Status::Inaccurate => "inaccurate",
            Status::InternalError => "internal_error",
            Status::Surface => "surface",
            Status::Diverged => "diverged",
        }
    }

    /// The reason for this status after `time` seconds, in words, if it does not depend on the run.
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

/// Effort of a run, in counts that do not depend on the machine.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct StepStatistics {
    /// Accepted steps.
    pub steps: u64,
    /// Rejected steps.
    pub rejected: u64,
    /// Evaluations of the right-hand side (for Taylor methods: jets, one per step).
    pub evaluations: u64,
}

/// Status, time and effort of a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Outcome {
    /// Its status.
    pub status: Status,
    /// Time reached, s: the duration if the status is [`Status::Done`].
    pub time: f64,
    /// Number of filled observation points, from the first: all if the status is [`Status::Done`].
    pub points: usize,
    /// Its effort.
    pub effort: StepStatistics,
    /// Estimated errors of the method.
    pub local_errors: LocalErrors,
    /// Estimated errors of the debris' rotation; zero without, or if it was not integrated.
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
/// s. A body that turns by less than a radian may have any rate, down to none; its error is then the resulting angle.
#[inline(always)]
pub fn rate_scale(largest: f64, duration: f64) -> f64 {
    if duration > 0.0 { largest.larger(1.0 / duration) } else { 1.0 }
}

/// Estimated errors of the rotational state over all steps of a run, added in magnitude, before amplification by the
/// motion, by their proportionality.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LocalErrors {
    /// Of omega, rad/s, proportional to its rate of change: truncation.
    pub truncation: f64,
    /// Of omega, relative, proportional to its components: rounding.
    pub rounding: f64,
    /// Of omega, rad/s, in any direction: from kernels whose other states feed back into it.
    pub feedback: f64,
    /// Of the attitude alone, rad: truncation, rounding and dense output.
    pub attitude: f64,
}

impl LocalErrors {
    /// No errors.
    pub const NONE: LocalErrors = LocalErrors { truncation: 0.0, rounding: 0.0, feedback: 0.0, attitude: 0.0 };
}
