//! [`Embedded`]: an explicit method with an error estimate and dense output.

use super::error_model::StepErrors;
use super::explicit::{Carried, Step};
use super::step_control::Controller;
use super::system::{System, Tolerance};
use crate::math::real::Real;

/// An attempted step, without the state at its end.
pub struct PairAttempt<R> {
    /// Norm of its error in units of the tolerance.
    pub ratio: R,
    /// Zero if everything is finite, else NaN.
    pub poison: R,
}

/// An explicit method with an error estimate and dense output, whose last stage is the first of the next step.
pub trait Embedded: Copy {
    /// Its step-size controller.
    const CONTROLLER: Controller;
    /// Evaluations of the right-hand side per attempted step.
    const EVALUATIONS: f64;
    /// Evaluations at the start of an arc.
    const START_EVALUATIONS: f64;
    /// Further evaluations in a step with observation points inside.
    const DENSE_EVALUATIONS: f64;
    /// Further evaluations for each such point.
    const POINT_EVALUATIONS: f64;
    /// Relation of errors to estimates.
    const ERRORS: StepErrors;

    /// Stages, and data of dense output.
    type Stages<R: Real, const N: usize>;

    /// Memory for the stages.
    fn stages<R: Real, const N: usize>(zero: R) -> Self::Stages<R, N>;

    /// The derivative at the start of the step.
    fn first<R: Real, const N: usize>(stages: &mut Self::Stages<R, N>) -> &mut [R; N];

    /// The derivative at the start of the step, read-only.
    fn at_start<R: Real, const N: usize>(stages: &Self::Stages<R, N>) -> &[R; N];

    /// The derivative at the end of the step.
    fn last<R: Real, const N: usize>(stages: &Self::Stages<R, N>) -> &[R; N];

    /// First step of an arc, s, from the derivative `slope` at its start.
    fn first_step<R: Real, Q: System<R, N>, const N: usize>(
        system: &Q,
        time: R,
        state: &[R; N],
        slope: &[R; N],
        longest: R,
        tolerance: Tolerance,
    ) -> R;

    /// Attempts a step from `start` and writes its end to `end`.
    fn attempt<R: Real, Q: System<R, N>, const N: usize>(
        system: &Q,
        step: Step<R>,
        start: &Carried<R, N>,
        tolerance: Tolerance,
        stages: &mut Self::Stages<R, N>,
        end: &mut Carried<R, N>,
    ) -> PairAttempt<R>;

    /// Prepares [`Embedded::inside`] for the last attempted step, if dense output needs evaluations of its own.
    #[inline(always)]
    fn prepare_inside<R: Real, Q: System<R, N>, const N: usize>(
        _system: &Q,
        _step: Step<R>,
        _start: &Carried<R, N>,
        _end: &[R; N],
        _stages: &mut Self::Stages<R, N>,
    ) {
    }

    /// The state at the fraction `s` of the last attempted step.
    fn inside<R: Real, Q: System<R, N>, const N: usize>(
        system: &Q,
        step: Step<R>,
        s: R,
        start: &Carried<R, N>,
        stages: &Self::Stages<R, N>,
    ) -> [R; N];
}
