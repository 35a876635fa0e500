//! Error models of methods, from which the errors of a run are estimated.

/// Relation of the errors of a method's steps to the data of a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ErrorModel {
    /// Estimated per step, with the sum [`super::EndedRun::error_sum`].
    Estimated(StepErrors),
    /// Derived from the Taylor series of the solution.
    Remainder(Remainder),
}

/// Error model of a method with estimates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StepErrors {
    /// Ratio of error to estimate at a tolerance of one.
    pub factor: f64,
    /// 1/(order of the estimate + 1). With local extrapolation a step continues with one order more than the estimate,
    /// and its error is smaller by a step length: the tolerance to this power.
    pub extrapolation: f64,
    /// Error of dense output in units of the tolerance, which later steps do not inherit.
    pub dense: f64,
}

impl StepErrors {
    /// Error of a step over its estimate at the relative tolerance `tolerance`.
    pub fn gain(&self, tolerance: f64) -> f64 {
        self.factor * libm::pow(tolerance, self.extrapolation)
    }
}

impl ErrorModel {
    /// Weight of a step's estimate if the right-hand side is not smooth, where local extrapolation gains nothing.
    pub(super) fn rough_weight(&self, tolerance: f64) -> f64 {
        match self {
            ErrorModel::Estimated(errors) => (1.0 / errors.gain(tolerance)).max(1.0),
            ErrorModel::Remainder(_) => 1.0,
        }
    }
}

/// Error model of fixed steps: the first term of the solution's Taylor series that they do not reproduce.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Remainder {
    /// Order of the method.
    pub order: usize,
    /// Error of a step over the term of order + 1 of the series at its start.
    pub factor: f64,
}
