//! Error models of methods, for estimates of the errors of a run.

/// Source of the errors of a method's steps.
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
    /// 1/(order of the estimate + 1): with local extrapolation a step has one order more than its estimate, and its
    /// error is smaller by a step length, the tolerance to this power.
    pub extrapolation: f64,
    /// Error of dense output in units of the tolerance, which later steps do not inherit.
    pub dense: f64,
    /// Ratio of error to estimate of a step from an edge, such as that of a penumbra, where f grows with the power 3/2
    /// of time; test `steps_from_an_edge_err_as_stated`.
    pub from_edge: f64,
}

impl StepErrors {
    /// Error of a step over its estimate at the relative tolerance `tolerance`.
    pub fn gain(&self, tolerance: f64) -> f64 {
        self.factor * libm::pow(tolerance, self.extrapolation)
    }
}

impl ErrorModel {
    /// Weight of a step's estimate if f is not smooth, where local extrapolation gains nothing.
    pub(super) fn rough_weight(&self, tolerance: f64) -> f64 {
        match self {
            ErrorModel::Estimated(errors) => (errors.from_edge / errors.gain(tolerance)).max(1.0),
            ErrorModel::Remainder(_) => 1.0,
        }
    }
}

/// Error model of fixed steps: the first term of the Taylor series that they do not reproduce.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Remainder {
    /// Order of the method.
    pub order: usize,
    /// Error of a step over the term of order + 1 of the series at its start.
    pub factor: f64,
}

#[cfg(test)]
mod tests {
    use super::super::embedded::Embedded;
    use super::super::explicit::{Carried, Step};
    use super::super::{Dop853, DormandPrince, DormandPrinceRestepped, System, Tolerance};
    use crate::testing::near;

    /// y' = t^(3/2), its edge at time zero; errors in units of y.
    struct Edge;

    impl System<f64, 1> for Edge {
        fn derivative(&self, time: f64, _state: &[f64; 1]) -> [f64; 1] {
            [time * time.sqrt()]
        }

        fn error_ratio(&self, error: &[f64; 1], _old: &[f64; 1], _new: &[f64; 1], _tolerance: Tolerance) -> f64 {
            error[0].abs()
        }
    }

    fn errs_as_stated<M: Embedded>() {
        let mut stages = M::stages(0.0);
        let start = Carried { state: [0.0], carry: [0.0] };
        let mut end = start;
        *M::first(&mut stages) = [0.0];
        let tolerance = Tolerance { relative: 1.0, absolute: 1.0 };
        let step = Step { time: 0.0, end: 1.0, length: 1.0 };
        let attempt = M::attempt(&Edge, step, &start, tolerance, &mut stages, &mut end);
        let (ratio, stated) = ((end.state[0] - 0.4).abs() / attempt.ratio, M::ERRORS.from_edge);
        near(ratio, stated, 1e-2);
        near(attempt.rough, attempt.ratio, 1e-2);
    }

    /// Law: the integral of t^(3/2) over (0, 1) is 2/5.
    #[test]
    fn steps_from_an_edge_err_as_stated() {
        errs_as_stated::<DormandPrince>();
        errs_as_stated::<DormandPrinceRestepped>();
        errs_as_stated::<Dop853>();
    }
}
