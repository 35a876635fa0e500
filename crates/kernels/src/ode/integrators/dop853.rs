//! Dormand-Prince 8(5,3) as in DOP853.

use crate::math::real::Real;
use crate::math::power::power;
use crate::ode::embedded::{Embedded, PairAttempt};
use crate::ode::error_model::StepErrors;
use crate::ode::explicit::{Carried, Step, each, fill_stages, poison, scaled, weighted};
use crate::ode::step_control::Controller;
use crate::ode::system::{System, Tolerance};
use crate::ode::tableau::Dop853Tableau;

/// Ratio of the error estimate to e5 in a step from an edge ([`StepErrors::from_edge`]), where e3 is 49 times e5.
const FROM_EDGE: f64 = 0.199;

/// Dormand-Prince 8(5,3) as in DOP853.
#[derive(Clone, Copy, Debug)]
pub struct Dop853;

/// Stages of [`Dop853`] and coefficients of its interpolant.
pub struct Dop853Stages<R, const N: usize> {
    k: [[R; N]; 16],
    interpolant: [[R; N]; 7],
}

impl Embedded for Dop853 {
    const CONTROLLER: Controller = Controller {
        exponent: 1.0 / 8.0,
        safety: 0.9,
        growth: 6.0,
        shrink: 0.333,
        shrink_again: None,
        hold_after_rejection: false,
        landing: 1.01,
        longest: 1.0,
    };
    // with the derivative at the end, which lanes with rejected steps evaluate too
    const EVALUATIONS: f64 = 12.0;
    const START_EVALUATIONS: f64 = 2.0;
    const DENSE_EVALUATIONS: f64 = 3.0;
    const POINT_EVALUATIONS: f64 = 0.0;
    const ERRORS: StepErrors = StepErrors { factor: 1.0, extrapolation: 0.125, dense: 6.0, from_edge: 3.44 };

    type Stages<R: Real, const N: usize> = Dop853Stages<R, N>;

    #[inline(always)]
    fn stages<R: Real, const N: usize>(zero: R) -> Dop853Stages<R, N> {
        Dop853Stages { k: [[zero; N]; 16], interpolant: [[zero; N]; 7] }
    }
    #[inline(always)]
    fn first<R: Real, const N: usize>(stages: &mut Dop853Stages<R, N>) -> &mut [R; N] {
        &mut stages.k[0]
    }
    #[inline(always)]
    fn ends<R: Real, const N: usize>(stages: &Dop853Stages<R, N>) -> [&[R; N]; 2] {
        [&stages.k[0], &stages.k[12]]
    }

    /// HINIT of dop853.f (section II.4): a guess from |y|/|f|, then from an Euler step's estimate of the second
    /// derivative.
    #[inline(always)]
    fn first_step<R: Real, Q: System<R, N>, const N: usize>(
        system: &Q,
        time: R,
        state: &[R; N],
        slope: &[R; N],
        longest: R,
        tolerance: Tolerance,
    ) -> R {
        let size = system.error_ratio(state, state, state, tolerance);
        let rate = system.error_ratio(slope, state, state, tolerance);
        let tiny = rate.lt(longest.splat(1e-5)) | size.lt(longest.splat(1e-5));
        let guess = R::select(tiny, longest.splat(1e-6), longest.splat(0.01) * (size / rate)).smaller(longest);
        let euler = each!(guess, |n| guess.mul_add(slope[n], state[n]));
        let end = system.derivative(time + guess, &euler);
        let turn = each!(guess, |n| end[n] - slope[n]);
        let bend = system.error_ratio(&turn, state, state, tolerance) / guess;
        let largest = bend.abs().larger(rate);
        let straight = (guess * longest.splat(1e-3)).larger(longest.splat(1e-6));
        let curved = power(longest.splat(0.01) / largest, 1.0 / 8.0);
        let refined = R::select(largest.lt(longest.splat(1e-15)), straight, curved);
        refined.smaller(longest.splat(100.0) * guess).smaller(longest)
    }

    /// The error combines the embedded solutions of order 5 and 3: e5^2 / sqrt(e5^2 + 0.01 e3^2) (section II.10). Where
    /// f is not smooth, a large and smooth e3 would hide e5.
    #[inline(always)]
    fn attempt<R: Real, Q: System<R, N>, const N: usize>(
        system: &Q,
        step: Step<R>,
        start: &Carried<R, N>,
        tolerance: Tolerance,
        stages: &mut Dop853Stages<R, N>,
        end: &mut Carried<R, N>,
    ) -> PairAttempt<R> {
        let k = &mut stages.k;
        fill_stages::<Dop853Tableau, R, Q, N, 16>(system, step, start, k, 1..13, 12, end);
        let fifth = scaled(step.length, &weighted(k, &Dop853Tableau::E5));
        let third = scaled(step.length, &weighted(k, &Dop853Tableau::E3));
        let e5 = system.error_ratio(&fifth, &start.state, &end.state, tolerance);
        let e3 = system.error_ratio(&third, &start.state, &end.state, tolerance);
        let sum = e5.mul_add(e5, e5.splat(0.01) * (e3 * e3));
        let ratio = R::select(e5.zero().lt(sum), e5 * (e5 / sum.sqrt()), e5);
        let poison = poison(&fifth, poison(&k[12], poison(&end.state, ratio.zero() * (e5 + e3))));
        PairAttempt { ratio, rough: e5 * e5.splat(FROM_EDGE), poison }
    }

    #[inline(always)]
    fn prepare_inside<R: Real, Q: System<R, N>, const N: usize>(
        system: &Q,
        step: Step<R>,
        start: &Carried<R, N>,
        end: &[R; N],
        stages: &mut Dop853Stages<R, N>,
    ) {
        let Dop853Stages { k, interpolant } = stages;
        let mut unused = *start;
        fill_stages::<Dop853Tableau, R, Q, N, 16>(system, step, start, k, 13..16, 16, &mut unused);
        let h = step.length;
        for n in 0..N {
            let difference = end[n] - start.state[n];
            let bend = h.mul_add(k[0][n], -difference);
            interpolant[0][n] = difference;
            interpolant[1][n] = bend;
            interpolant[2][n] = difference - h.mul_add(k[12][n], bend);
        }
        interpolant[3] = scaled(h, &weighted(k, &Dop853Tableau::D[0]));
        interpolant[4] = scaled(h, &weighted(k, &Dop853Tableau::D[1]));
        interpolant[5] = scaled(h, &weighted(k, &Dop853Tableau::D[2]));
        interpolant[6] = scaled(h, &weighted(k, &Dop853Tableau::D[3]));
    }

    /// CONTD8 of dop853.f.
    #[inline(always)]
    fn inside<R: Real, Q: System<R, N>, const N: usize>(
        _system: &Q,
        _step: Step<R>,
        s: R,
        start: &Carried<R, N>,
        stages: &Dop853Stages<R, N>,
    ) -> [R; N] {
        let (start, r) = (&start.state, s.splat(1.0) - s);
        each!(s, |n| {
            let c = &stages.interpolant;
            let inner = c[6][n].mul_add(s, c[5][n]).mul_add(r, c[4][n]).mul_add(s, c[3][n]);
            inner.mul_add(r, c[2][n]).mul_add(s, c[1][n]).mul_add(r, c[0][n]).mul_add(s, start[n])
        })
    }
}
