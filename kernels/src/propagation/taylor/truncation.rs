//! [`Truncation`]: the truncation errors of Taylor steps, from the last term that they keep.

use super::brief::{Brief, LEAST};
use super::step::StepRule;
use crate::dynamics::gyrostat::{ATTITUDE, OMEGA, WITH_ATTITUDE};
use crate::math::Real;
use crate::math::vector::norm;
use crate::propagation::local_error::rounding;
use crate::run::LocalErrors;

/// What the rest of omega's series amounts to in a brief step, as a share of the last term that it keeps: terms fall by e^-2 or more.
const BRIEF_REST: f64 = 0.15;

/// The sums of one run.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct TruncationSums {
    /// What is left out of omega, added up, rad per unit of time.
    rate: f64,
    /// First terms left out of the attitude, added up, rad.
    turn: f64,
}

/// Sums over the steps of a run, in lanes.
///
/// The first term left out of a series is estimated from the series: the last one kept, times the root of what that is of
/// the term two orders before; or the one before the last, times what that is of the term two orders before it, whichever is larger: from
/// rest at a constant acceleration all terms of odd order of the attitude are zero. Where only rates are integrated the attitude counts as turning
/// with constant omega, (|omega| h/2)^(p+1)/(p+1)!.
#[derive(Clone, Copy, Debug)]
pub(super) struct Truncation<R> {
    order: usize,
    /// 2/(p+1)!.
    factor: f64,
    /// What is left out of omega's series over the first term of that.
    all: f64,
    /// What is left out of omega, added up, rad per unit of time.
    rate: R,
    /// First terms left out of the attitude, added up, rad.
    turn: R,
}

impl<R: Real> Truncation<R> {
    /// No steps yet, by `rule`; `zero` says how many lanes.
    pub(super) fn new(zero: R, rule: &StepRule) -> Self {
        let order = rule.order;
        let factorial: f64 = (1..=order + 1).map(|n| n as f64).product();
        Truncation { order, factor: 2.0 / factorial, all: 1.0 + rule.rest(), rate: zero, turn: zero }
    }

    /// The sums of the run in `lane`.
    pub(super) fn sums(&self, lane: usize) -> TruncationSums {
        TruncationSums { rate: self.rate.lane(lane), turn: self.turn.lane(lane) }
    }

    /// Continues the sums of the run in `lane` in a unit of time that is `ratio` times as long.
    pub(super) fn rescale(&mut self, lane: usize, ratio: f64) {
        self.rate.set_lane(lane, self.rate.lane(lane) * ratio);
    }

    /// Sets the sums of the run in `lane`.
    pub(super) fn set(&mut self, lane: usize, sums: TruncationSums) {
        self.rate.set_lane(lane, sums.rate);
        self.turn.set_lane(lane, sums.turn);
    }

    /// Adds a step of length `length` along the series `jet`.
    #[inline(always)]
    pub(super) fn add<const N: usize>(&mut self, jet: &[[R; N]], length: R) {
        let order = self.order;
        let power = raised_to(length, order - 1);
        let [third, second, before, last] = [&jet[order - 3], &jet[order - 2], &jet[order - 1], &jet[order]];
        let rates = [size(third), size(second), size(before), size(last)];
        self.rate += length.splat(self.all) * (power * left_out(rates, length));
        self.turn += if N >= WITH_ATTITUDE {
            let turns = [turn(third), turn(second), turn(before), turn(last)];
            length.splat(2.0) * (power * left_out(turns, length))
        } else {
            length.splat(self.factor) * raised_to(length.splat(0.5) * (size(&jet[0]) * length), order + 1)
        };
    }
}

impl<R: Real> Truncation<R> {
    /// Adds the step of length `length` of the lanes in `brief`, along the series `jet`: what they leave out is bounded by their last two terms.
    #[inline(always)]
    pub(super) fn add_brief<const N: usize>(&mut self, jet: &[[R; N]], length: R, brief: &Brief<R>) {
        let zero = length.zero();
        let (mut before, mut last) = ([zero; 2], [zero; 2]);
        let mut power = raised_to(length, LEAST - 1);
        for (n, term) in jet.iter().enumerate().take(brief.most + 1).skip(LEAST - 1) {
            let beyond = brief.order.lt(zero.splat(n as f64));
            let sizes = [size(term) * power, if N >= WITH_ATTITUDE { turn(term) * power } else { zero }];
            for i in 0..2 {
                before[i] = R::select(beyond, before[i], last[i]);
                last[i] = R::select(beyond, last[i], sizes[i]);
            }
            power = power * length;
        }
        let (rate, turn) = (last[0].larger(before[0] * brief.turn), last[1].larger(before[1] * brief.turn));
        self.rate += R::select(brief.lanes, zero.splat(BRIEF_REST) * rate, zero);
        self.turn += R::select(brief.lanes, length.splat(2.0) * (turn * brief.turn), zero);
    }
}

impl TruncationSums {
    /// The errors after `steps` steps, whose rotation is repeated `periods` times; the unit of time is `unit` seconds.
    pub(super) fn errors(&self, steps: u64, periods: f64, unit: f64) -> LocalErrors {
        let LocalErrors { rounding, attitude, .. } = rounding(steps);
        let truncation = self.rate / unit;
        LocalErrors { truncation, rounding, feedback: 0.0, attitude: periods * (attitude + self.turn) }
    }
}

/// The first term left out of a series of order p in a step of length `length`, over `length` to the power p - 1; `sizes` are those of the coefficients
/// p - 3 to p.
#[inline(always)]
fn left_out<R: Real>(sizes: [R; 4], length: R) -> R {
    let [third, second, before, last] = sizes;
    let square = length * length;
    let from_last = last * length * share(last * square, second).sqrt();
    from_last.larger(before * share(before * square, third))
}

/// The share that `term` is of `of`, at most one.
#[inline(always)]
fn share<R: Real>(term: R, of: R) -> R {
    (term / of.larger(of.splat(f64::MIN_POSITIVE))).smaller(of.splat(1.0))
}

/// |omega| of one order of a series.
#[inline(always)]
fn size<R: Real, const N: usize>(term: &[R; N]) -> R {
    norm([term[OMEGA], term[OMEGA + 1], term[OMEGA + 2]])
}

/// |q| of one order of a series.
#[inline(always)]
fn turn<R: Real, const N: usize>(term: &[R; N]) -> R {
    let vector = norm([term[ATTITUDE + 1], term[ATTITUDE + 2], term[ATTITUDE + 3]]);
    term[ATTITUDE].mul_add(term[ATTITUDE], vector * vector).sqrt()
}

/// `x` to the power `n` >= 1, by squaring.
#[inline(always)]
fn raised_to<R: Real>(x: R, n: usize) -> R {
    let mut power = x.splat(1.0);
    let (mut square, mut left) = (x, n);
    while left > 0 {
        if left & 1 == 1 {
            power = power * square;
        }
        square = square * square;
        left >>= 1;
    }
    power
}
