//! Embedded explicit pairs: a step with an estimate of its error, and a state anywhere inside it.
//!
//! - [`DormandPrince`] behaves as ode45 does: Shampine & Reichelt 1997, *The MATLAB ODE Suite*, and ode45.m.
//! - [`Dop853`] behaves as DOP853 does: Hairer, Norsett & Wanner 1993, sections II.4 to II.6, and dop853.f.
//!
//! The norm of an error is the kernel's ([`System::error_ratio`]). The march itself stands in [`super::adaptive`].

mod dop853;
mod dormand_prince;

pub use dop853::Dop853;
pub use dormand_prince::{DormandPrince, DormandPrinceRestepped};

use super::explicit::{Carried, Step};
use super::step_control::Controller;
use super::{System, Tolerance};
use crate::math::Real;
use crate::propagation::local_error::StepErrors;

/// An attempted step.
pub struct Attempt<R, const N: usize> {
    /// The state at its end.
    pub end: Carried<R, N>,
    /// The size of its error in units of the tolerance.
    pub ratio: R,
    /// Zero where everything in it is finite, else not a number.
    pub poison: R,
}

/// An explicit method with an error estimate and dense output, whose last stage is the first of the next step.
pub trait Embedded: Copy {
    /// Its step-size controller.
    const CONTROLLER: Controller;
    /// Evaluations of the right-hand side per attempted step.
    const EVALUATIONS: f64;
    /// Evaluations at the start of a stretch.
    const START_EVALUATIONS: f64;
    /// Further evaluations in a step inside which there is an observation point.
    const DENSE_EVALUATIONS: f64;
    /// Further evaluations for each such point.
    const POINT_EVALUATIONS: f64;
    /// What its error estimates say of its errors.
    const ERRORS: StepErrors;

    /// Stages and what dense output needs.
    type Stages<R: Real, const N: usize>;

    /// Room for the stages.
    fn stages<R: Real, const N: usize>(zero: R) -> Self::Stages<R, N>;

    /// The derivative at the start of the step.
    fn first<R: Real, const N: usize>(stages: &mut Self::Stages<R, N>) -> &mut [R; N];

    /// The derivative at the end of the step.
    fn last<R: Real, const N: usize>(stages: &Self::Stages<R, N>) -> &[R; N];

    /// The length of the first step of a stretch, s, from the derivative `slope` at its start.
    fn first_step<R: Real, Q: System<R, N>, const N: usize>(
        system: &Q,
        time: R,
        state: &[R; N],
        slope: &[R; N],
        longest: R,
        tolerance: Tolerance,
    ) -> R;

    /// Attempts a step.
    fn attempt<R: Real, Q: System<R, N>, const N: usize>(
        system: &Q,
        step: Step<R>,
        start: &Carried<R, N>,
        tolerance: Tolerance,
        stages: &mut Self::Stages<R, N>,
    ) -> Attempt<R, N>;

    /// Prepares [`Embedded::inside`] for the step that was attempted last.
    fn prepare_inside<R: Real, Q: System<R, N>, const N: usize>(
        system: &Q,
        step: Step<R>,
        start: &Carried<R, N>,
        end: &[R; N],
        stages: &mut Self::Stages<R, N>,
    );

    /// The state at the fraction `s` of the step that was attempted last.
    fn inside<R: Real, Q: System<R, N>, const N: usize>(
        system: &Q,
        step: Step<R>,
        s: R,
        start: &Carried<R, N>,
        stages: &Self::Stages<R, N>,
    ) -> [R; N];
}
