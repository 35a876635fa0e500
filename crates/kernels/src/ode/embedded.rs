//! [`Embedded`]: explicit methods with error estimates.

use super::error_model::StepErrors;
use super::explicit::{Carried, Step};
use super::step_control::Controller;
use super::system::{System, Tolerance};
use crate::math::real::Real;

/// Result of an attempted step.
pub struct PairAttempt<R> {
    /// Norm of the error in units of the tolerance.
    pub ratio: R,
    /// The same without what is gained where f is smooth.
    pub rough: R,
    /// Zero if everything is finite, else NaN.
    pub poison: R,
}

/// An explicit method with error estimate and dense output, whose last stage is the first of the next step.
pub trait Embedded: Copy {
    /// Step-size controller.
    const CONTROLLER: Controller;
    /// Evaluations of the right-hand side per attempted step.
    const EVALUATIONS: f64;
    /// Evaluations at the start of an arc.
    const START_EVALUATIONS: f64;
    /// More of them in a step with observation points inside.
    const DENSE_EVALUATIONS: f64;
    /// More of them for each of these points.
    const POINT_EVALUATIONS: f64;
    const ERRORS: StepErrors;

    /// Stages, and data of dense output.
    type Stages<R: Real, const N: usize>;

    fn stages<R: Real, const N: usize>(zero: R) -> Self::Stages<R, N>;

    /// Derivative at the start of the step.
    fn first<R: Real, const N: usize>(stages: &mut Self::Stages<R, N>) -> &mut [R; N];

    /// Derivatives at both ends of the step.
    fn ends<R: Real, const N: usize>(stages: &Self::Stages<R, N>) -> [&[R; N]; 2];

    /// First step of an arc, s, from the derivative `slope` at its start.
    fn first_step<R: Real, Q: System<R, N>, const N: usize>(
        system: &Q,
        time: R,
        state: &[R; N],
        slope: &[R; N],
        longest: R,
        tolerance: Tolerance,
    ) -> R;

    /// Attempts a step from `start` to `end`.
    fn attempt<R: Real, Q: System<R, N>, const N: usize>(
        system: &Q,
        step: Step<R>,
        start: &Carried<R, N>,
        tolerance: Tolerance,
        stages: &mut Self::Stages<R, N>,
        end: &mut Carried<R, N>,
    ) -> PairAttempt<R>;

    /// Prepares [`Embedded::inside`] for the last attempted step.
    #[inline(always)]
    fn prepare_inside<R: Real, Q: System<R, N>, const N: usize>(
        _system: &Q,
        _step: Step<R>,
        _start: &Carried<R, N>,
        _end: &[R; N],
        _stages: &mut Self::Stages<R, N>,
    ) {
    }

    /// State at the fraction `s` of the last attempted step.
    fn inside<R: Real, Q: System<R, N>, const N: usize>(
        system: &Q,
        step: Step<R>,
        s: R,
        start: &Carried<R, N>,
        stages: &Self::Stages<R, N>,
    ) -> [R; N];
}
