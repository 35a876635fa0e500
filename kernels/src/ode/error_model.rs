//! What a method knows about its own errors: data from which the errors of a run can be estimated.

/// How the errors of a method's steps follow from what is known after a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ErrorModel {
    /// The method estimates the error of each step; their sum is [`super::EndedRun::error_sum`].
    Estimated(StepErrors),
    /// The method does not estimate errors: they follow from the Taylor series of the solution.
    Remainder(Remainder),
}

/// Error model of a method that estimates the error of each step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StepErrors {
    /// Ratio of error to estimate at a tolerance of one.
    pub factor: f64,
    /// One over the order of the estimate plus one: the step is continued with a formula of one order more than the
    /// estimate (local extrapolation), so that its error is smaller by the step, which is the tolerance to this power.
    pub extrapolation: f64,
    /// Error of dense output in units of the tolerance; later steps do not start from it.
    pub dense: f64,
}

impl StepErrors {
    /// The error of a step in units of its estimate, at the relative tolerance `tolerance`.
    pub fn gain(&self, tolerance: f64) -> f64 {
        self.factor * libm::pow(tolerance, self.extrapolation)
    }
}

impl ErrorModel {
    /// How many times the estimate of a step counts where the right-hand side is not smooth: local extrapolation gains
    /// nothing there.
    pub(super) fn rough_weight(&self, tolerance: f64) -> f64 {
        match self {
            ErrorModel::Estimated(errors) => (1.0 / errors.gain(tolerance)).max(1.0),
            ErrorModel::Remainder(_) => 1.0,
        }
    }
}

/// Error model of a method with a given step: the first term of the solution's Taylor series that its steps do not
/// reproduce.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Remainder {
    /// Order of the method.
    pub order: usize,
    /// The error of a step divided by the term of order + 1 of the solution's series at its start.
    pub factor: f64,
}
