//! Dormand-Prince 5(4) as in ode45, with its interpolant or with shorter steps to points inside a step.

use crate::math::real::Real;
use crate::math::power::power;
use crate::ode::embedded::{Embedded, PairAttempt};
use crate::ode::error_model::StepErrors;
use crate::ode::explicit::{Carried, Step, each, fill_stages, poison, scaled, weighted};
use crate::ode::step_control::Controller;
use crate::ode::system::{System, Tolerance};
use crate::ode::tableau::{DormandPrinceTableau, Tableau};

/// Lower limit of the relative tolerance for the choice of the first step (ode45: 100 eps).
const FINEST: f64 = 100.0 * f64::EPSILON;

/// Dormand-Prince 5(4) as in ode45.
#[derive(Clone, Copy, Debug)]
pub struct DormandPrince;

/// [`DormandPrince`] with a shorter step of order 5 to a point inside a step: five evaluations; errors of ode45's
/// interpolant of order 4 (ntrp45) have the size of the tolerance.
#[derive(Clone, Copy, Debug)]
pub struct DormandPrinceRestepped;

/// States inside a step, in which the two variants differ.
trait PointsInside: Copy {
    /// Evaluations of the right-hand side per point.
    const EVALUATIONS: f64;
    /// [`StepErrors::factor`].
    const ERROR_FACTOR: f64;
    /// [`StepErrors::dense`].
    const DENSE_ERROR: f64;

    /// [`Embedded::inside`].
    fn inside<R: Real, Q: System<R, N>, const N: usize>(
        system: &Q,
        step: Step<R>,
        s: R,
        start: &Carried<R, N>,
        stages: &[[R; N]; 7],
    ) -> [R; N];
}

impl<P: PointsInside> Embedded for P {
    const CONTROLLER: Controller = Controller {
        exponent: 1.0 / 5.0,
        safety: 0.8,
        growth: 5.0,
        shrink: 0.1,
        shrink_again: Some(0.5),
        hold_after_rejection: true,
        landing: 1.1,
        longest: 0.1,
    };
    const EVALUATIONS: f64 = 6.0;
    const START_EVALUATIONS: f64 = 1.0;
    const DENSE_EVALUATIONS: f64 = 0.0;
    const POINT_EVALUATIONS: f64 = P::EVALUATIONS;
    const ERRORS: StepErrors =
        StepErrors { factor: P::ERROR_FACTOR, extrapolation: 0.2, dense: P::DENSE_ERROR, from_edge: 11.34 };

    type Stages<R: Real, const N: usize> = [[R; N]; 7];

    #[inline(always)]
    fn stages<R: Real, const N: usize>(zero: R) -> [[R; N]; 7] {
        [[zero; N]; 7]
    }
    #[inline(always)]
    fn first<R: Real, const N: usize>(stages: &mut [[R; N]; 7]) -> &mut [R; N] {
        &mut stages[0]
    }
    #[inline(always)]
    fn ends<R: Real, const N: usize>(stages: &[[R; N]; 7]) -> [&[R; N]; 2] {
        [&stages[0], &stages[6]]
    }

    /// ode45: the longest step, or 1/rh with rh = |f0 / max(|y|, atol/rtol)| / (0.8 rtol^(1/5)) if shorter.
    #[inline(always)]
    fn first_step<R: Real, Q: System<R, N>, const N: usize>(
        system: &Q,
        _time: R,
        state: &[R; N],
        slope: &[R; N],
        longest: R,
        tolerance: Tolerance,
    ) -> R {
        let relative = longest.splat(tolerance.relative.max(FINEST));
        let rate = system.error_ratio(slope, state, state, tolerance) * longest.splat(tolerance.relative);
        let rate = rate / (longest.splat(0.8) * power(relative, 0.2));
        let one = longest.splat(1.0);
        R::select(one.lt(longest * rate), one / rate, longest)
    }

    #[inline(always)]
    fn attempt<R: Real, Q: System<R, N>, const N: usize>(
        system: &Q,
        step: Step<R>,
        start: &Carried<R, N>,
        tolerance: Tolerance,
        stages: &mut [[R; N]; 7],
        end: &mut Carried<R, N>,
    ) -> PairAttempt<R> {
        fill_stages::<DormandPrinceTableau, R, Q, N, 7>(system, step, start, stages, 1..7, 6, end);
        let error = scaled(step.length, &weighted(stages, &DormandPrinceTableau::E));
        let ratio = system.error_ratio(&error, &start.state, &end.state, tolerance);
        let poison = poison(&error, poison(&end.state, ratio.zero() * ratio));
        PairAttempt { ratio, rough: ratio, poison }
    }

    #[inline(always)]
    fn inside<R: Real, Q: System<R, N>, const N: usize>(
        system: &Q,
        step: Step<R>,
        s: R,
        start: &Carried<R, N>,
        stages: &[[R; N]; 7],
    ) -> [R; N] {
        P::inside(system, step, s, start, stages)
    }
}

impl PointsInside for DormandPrince {
    const EVALUATIONS: f64 = 0.0;
    const ERROR_FACTOR: f64 = 1.0;
    const DENSE_ERROR: f64 = 4.0;

    #[inline(always)]
    fn inside<R: Real, Q: System<R, N>, const N: usize>(
        _system: &Q,
        step: Step<R>,
        s: R,
        start: &Carried<R, N>,
        stages: &[[R; N]; 7],
    ) -> [R; N] {
        let (length, start) = (step.length, &start.state);
        let weights: [R; 7] = each!(s, |i| {
            let c = DormandPrinceTableau::DENSE[i];
            let cubic = s.splat(c[3]).mul_add(s, s.splat(c[2])).mul_add(s, s.splat(c[1])).mul_add(s, s.splat(c[0]));
            length * (s * cubic)
        });
        each!(s, |n| {
            let mut sum = start[n];
            // stage 1 has no weight
            for i in [0, 2, 3, 4, 5, 6] {
                sum = weights[i].mul_add(stages[i][n], sum);
            }
            sum
        })
    }
}

impl PointsInside for DormandPrinceRestepped {
    const EVALUATIONS: f64 = 5.0;
    const ERROR_FACTOR: f64 = 0.5;
    const DENSE_ERROR: f64 = 0.0;

    #[inline(always)]
    fn inside<R: Real, Q: System<R, N>, const N: usize>(
        system: &Q,
        step: Step<R>,
        s: R,
        start: &Carried<R, N>,
        stages: &[[R; N]; 7],
    ) -> [R; N] {
        let length = s * step.length;
        let mut own = [[s.zero(); N]; 7];
        own[0] = stages[0];
        let mut end = *start;
        fill_stages::<DormandPrinceTableau, R, Q, N, 7>(system, step.part(length), start, &mut own, 1..6, 7, &mut end);
        start.advance_into(length, &weighted(&own, &<DormandPrinceTableau as Tableau<7>>::A[6]), &mut end);
        end.state
    }
}
