//! [`Truncation`]: truncation errors of Taylor steps, from the last term kept.

use super::brief::{Brief, LEAST};
use super::step::StepRule;
use crate::dynamics::gyrostat::equations::Constants;
use crate::dynamics::gyrostat::{ATTITUDE, OMEGA, WITH_ATTITUDE};
use crate::math::prelude::*;
use crate::propagation::local_error::rounding;
use crate::run::LocalErrors;

/// Sum of the rest of omega's series in a brief step, as a share of the last term: terms fall by e^-2 or more.
const BRIEF_REST: f64 = 0.15;

#[derive(Clone, Copy, Debug, Default)]
pub struct TruncationSums {
    /// Truncation of omega, rad per unit of time.
    rate: f64,
    /// First neglected terms of the attitude, rad.
    turn: f64,
}

/// Sums over the steps of a run, in lanes.
///
/// If effects act within arcs, truncation of omega has every direction over hundreds of librations and turns. There
/// each step counts as a vector: the neglected angular momentum, which persists in inertial axes, along the last two
/// terms together, with the sign of the term two orders later (terms two orders apart alternate). The sum of a run is
/// the largest magnitude of the vector sum so far, plus the root of the sum of squares, since directions are only
/// estimated.
///
/// The first neglected term is estimated as the last one kept, times the root of its ratio to the term two orders
/// before; or as the last but one, times its ratio to the term two orders before, if larger: from rest at constant
/// acceleration all odd terms of the attitude are zero. If only rates are integrated, the attitude counts as turning
/// with constant omega, (|omega| h/2)^(p+1)/(p+1)!.
#[derive(Clone, Copy, Debug)]
pub struct Truncation<R> {
    order: usize,
    factor: f64,
    /// Ratio of the neglected sum of omega's series to its first term.
    all: f64,
    /// Truncation of omega, rad per unit of time.
    rate: R,
    /// First neglected terms of the attitude, rad.
    turn: R,
    /// Neglected angular momentum under effects within arcs, over the mean moment of inertia, in inertial axes.
    momentum: [R; 3],
    /// Largest square of `momentum` so far.
    farthest: R,
    /// Sum of the squares of its parts.
    squares: R,
}

impl<R: Real> Truncation<R> {
    pub fn new(zero: R, rule: &StepRule) -> Self {
        let order = rule.order;
        let factorial: f64 = (1..=order + 1).map(|n| n as f64).product();
        Truncation {
            order,
            factor: 2.0 / factorial,
            all: 1.0 + rule.rest(),
            rate: zero,
            turn: zero,
            momentum: [zero; 3],
            farthest: zero,
            squares: zero,
        }
    }

    pub fn sums(&self, lane: usize) -> TruncationSums {
        let directed = self.farthest.lane(lane).sqrt() + self.squares.lane(lane).sqrt();
        TruncationSums { rate: self.rate.lane(lane) + directed, turn: self.turn.lane(lane) }
    }

    /// Converts the sums in `lane` to a unit of time that is `ratio` times as long.
    pub fn rescale(&mut self, lane: usize, ratio: f64) {
        let rescale = |sum: &mut R, ratio: f64| sum.set_lane(lane, sum.lane(lane) * ratio);
        rescale(&mut self.rate, ratio);
        self.momentum.iter_mut().for_each(|sum| rescale(sum, ratio));
        rescale(&mut self.farthest, ratio * ratio);
        rescale(&mut self.squares, ratio * ratio);
    }

    pub fn set(&mut self, lane: usize, sums: TruncationSums) {
        self.rate.set_lane(lane, sums.rate);
        self.turn.set_lane(lane, sums.turn);
        for sum in self.momentum.iter_mut().chain([&mut self.farthest, &mut self.squares]) {
            sum.set_lane(lane, 0.0);
        }
    }

    #[inline(always)]
    pub fn add<const N: usize>(&mut self, jet: &[[R; N]], length: R) {
        let rate = self.left_out_of_rate(jet, length);
        self.rate += rate;
        self.add_turn(jet, length);
    }

    /// Adds a step under effects within arcs.
    #[inline(always)]
    pub fn add_directed<const N: usize>(&mut self, jet: &[[R; N]], length: R, constants: &Constants<R>) {
        let rate = self.left_out_of_rate(jet, length);
        self.add_turn(jet, length);
        let order = self.order;
        let [second, last] = [three(&jet[order - 2], OMEGA), three(&jet[order], OMEGA)];
        let before = three(&jet[order - 1], OMEGA);
        let direction = sum(before, scaled(length, last));
        let moments = constants.inverse.map(|inverse| length.splat(1.0) / inverse);
        let mean = length.splat(1.0 / 3.0) * (moments[0] + moments[1] + moments[2]);
        let tiny = length.splat(f64::MIN_POSITIVE);
        let share = rate / (norm(direction).larger(tiny) * mean);
        let share = R::select(dot(last, second).lt(length.zero()), -share, share);
        let left: [R; 3] = core::array::from_fn(|i| moments[i] * (direction[i] * share));
        self.squares += dot(left, left);
        let c_eb = dcm_from_quaternion(four(&jet[0], ATTITUDE));
        self.momentum = sum(self.momentum, product(c_eb, left));
        self.farthest = self.farthest.larger(dot(self.momentum, self.momentum));
    }

    /// Truncation of omega's series in a step of length `length`, in magnitude.
    #[inline(always)]
    fn left_out_of_rate<const N: usize>(&self, jet: &[[R; N]], length: R) -> R {
        let order = self.order;
        let sizes = [&jet[order - 3], &jet[order - 2], &jet[order - 1], &jet[order]].map(size);
        length.splat(self.all) * (raised_to(length, order - 1) * left_out(sizes, length))
    }

    #[inline(always)]
    fn add_turn<const N: usize>(&mut self, jet: &[[R; N]], length: R) {
        let order = self.order;
        self.turn += if N >= WITH_ATTITUDE {
            let turns = [&jet[order - 3], &jet[order - 2], &jet[order - 1], &jet[order]].map(turn);
            length.splat(2.0) * (raised_to(length, order - 1) * left_out(turns, length))
        } else {
            length.splat(self.factor) * raised_to(length.splat(0.5) * (size(&jet[0]) * length), order + 1)
        };
    }

    /// Adds brief steps of length `length` along `jet`, bounded by their last two terms.
    #[inline(always)]
    pub fn add_brief<const N: usize>(&mut self, jet: &[[R; N]], length: R, brief: &Brief<R>) {
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
    /// Errors after `steps` steps, repeated in each of `periods` periods; the unit of time is `unit` seconds.
    pub fn errors(&self, steps: u64, periods: f64, unit: f64) -> LocalErrors {
        let errors = rounding(steps);
        let truncation = periods * self.rate / unit;
        LocalErrors { truncation, attitude: periods * (errors.attitude + self.turn), ..errors }
    }
}

/// First neglected term of a series of order p in a step, over `length` to the power p - 1, from the sizes of the
/// coefficients p - 3 to p.
#[inline(always)]
fn left_out<R: Real>(sizes: [R; 4], length: R) -> R {
    let [third, second, before, last] = sizes;
    let square = length * length;
    let from_last = last * length * share(last * square, second).sqrt();
    from_last.larger(before * share(before * square, third))
}

#[inline(always)]
fn share<R: Real>(term: R, of: R) -> R {
    (term / of.larger(of.splat(f64::MIN_POSITIVE))).smaller(of.splat(1.0))
}

#[inline(always)]
fn size<R: Real, const N: usize>(term: &[R; N]) -> R {
    norm(three(term, OMEGA))
}

#[inline(always)]
fn turn<R: Real, const N: usize>(term: &[R; N]) -> R {
    let vector = norm(three(term, ATTITUDE + 1));
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
