//! How a run ended and what it cost.

/// How a run ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Status {
    /// Reached the end of its horizon.
    Done,
    /// Gave up after the largest allowed number of steps.
    StepLimit,
    /// The step that the tolerance asks for is below what the time's last digits can hold.
    StepFloor,
    /// A state component stopped being a finite number.
    NonFinite,
    /// The drawn scene is physically impossible; nothing was integrated.
    InvalidSample,
}

impl Status {
    /// All values, in the order of their codes.
    pub const ALL: [Status; 5] =
        [Status::Done, Status::StepLimit, Status::StepFloor, Status::NonFinite, Status::InvalidSample];

    /// The name in rows and summaries.
    pub const fn name(self) -> &'static str {
        match self {
            Status::Done => "ok",
            Status::StepLimit => "step_limit",
            Status::StepFloor => "step_floor",
            Status::NonFinite => "non_finite",
            Status::InvalidSample => "invalid_sample",
        }
    }
}

/// What a run cost, in counts that do not depend on the machine.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct StepStatistics {
    /// Accepted steps.
    pub steps: u64,
    /// Rejected steps.
    pub rejected: u64,
    /// Evaluations of the right-hand side (for Taylor methods: jets, one per step).
    pub evaluations: u64,
}

/// How a run ended, when, and what it cost.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Outcome {
    /// How.
    pub status: Status,
    /// The time that was reached, s: the duration where the status is [`Status::Done`].
    pub time: f64,
    /// Number of observation points that were filled, from the first; all where the status is [`Status::Done`].
    pub points: usize,
    /// What it cost.
    pub effort: StepStatistics,
    /// The errors that the method reckons to have made on the way.
    pub local_errors: LocalErrors,
}

/// Errors of the rotational state that a method reckons to have made on its way, added up as if all pointed the same way, before
/// the motion amplifies them. Of omega they are relative to the largest |omega|. Estimates, by what they go with.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LocalErrors {
    /// Of omega, in proportion to how fast it changes: truncation.
    pub truncation: f64,
    /// Of omega, in proportion to its components: rounding.
    pub rounding: f64,
    /// Of omega, wherever it stands: of a kernel whose other states feed back into it.
    pub feedback: f64,
    /// Of the attitude alone, rad: truncation, rounding and dense output.
    pub attitude: f64,
}
