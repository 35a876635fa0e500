//! Steps that end where the right-hand side changes its branch.
//!
//! The signs of switch functions, smooth in time and state, select the branches. A step keeps its branches and
//! integrates their smooth continuation, so that a method keeps its order and error estimate (Hairer, Norsett & Wanner
//! 1993, section II.6; L. Shampine & S. Thompson, Comput. Math. Appl. 39, 2000). If a branch is wrong at the end of a
//! step, the switch is located on the dense output, and a step to it replaces the first one. The signs a little later
//! then choose the branches, whichever side the step ended on. A pair of switches within a step, which leaves all signs
//! as they were, shows in the derivatives at both ends ([`dip`]): the step first ends at the minimum of the function.
//! No function is evaluated while none can have come to zero since the last evaluation ([`System::sway`]).
//!
//! Nothing hangs: a switch function that is zero to rounding does not count, a step is replaced at most eight times,
//! and every accepted step counts against `max_steps`.

use super::explicit::{Step, each};
use super::runs::Runs;
use super::step_control::Control;
use super::stepper::{Attempt, Stepper, StepperLane};
use super::system::System;
use crate::math::real::{Mask, Real};

/// A switch function below minus this has changed sign; functions are of order one, rounding some 1e-15.
const NOISE: f64 = 1e-12;

/// Undershoot allowed at the end of a step to a switch, over the square root of the tolerance: an error of second
/// order, 1e-4/2 of the tolerance.
const LANDED: f64 = 1e-2;

/// Branches are chosen after this fraction of a step: beyond the error of location, negligible at second order.
const AHEAD: f64 = 1e-4;

/// Switches before this fraction of the step have just been passed.
const LEAST: f64 = 1e-3;

/// Limit of replacements of a step; measured for tumbling boxes: 3.
const MOST_CUTS: f64 = 8.0;

/// Limit of evaluations of dense output for a switch.
const MOST_EVALUATIONS: usize = 40;

/// A switch is located once its function, or the bracket of its time as a fraction of the step, is below these.
const LOCATED: [f64; 2] = [1e-14, 1e-15];

/// A minimum within a step counts if the cubic through both ends leaves less than this share of its depth: the error of
/// the cubic for a cosine over 2 rad.
const DOUBT: f64 = 0.1;

/// Distance, as a fraction of the step, of the two times from which [`dip`] computes a slope.
const BESIDE: f64 = 1e-3;

/// Longest step towards an edge, where f is not smooth, as a share of the time to it: graded as steps from an edge are.
const TOWARDS_EDGE: f64 = 0.4;

/// Pending switches, one run per lane.
pub(super) struct Switches<R: Real> {
    /// Lanes that are to choose branches, and the delay, s.
    pending: R::Mask,
    ahead: R,
    /// Lanes whose next step is a replacement, number of replacements, lengths of the first and the next, s.
    cut: R::Mask,
    cuts: R,
    whole: R,
    next: R,
    /// Lanes whose present step is a replacement.
    landing: R::Mask,
    /// Smallest switch function at the end of such a step.
    landed: R,
    /// Lower bound of the switch functions at the present time; zero if unknown.
    margin: R,
    /// Lanes at an edge, from which f is not smooth; length of the step from the last one, and longest next step, s.
    edge: R::Mask,
    from_edge: R,
    longest: R,
}

impl<R: Real> Switches<R> {
    #[inline(always)]
    pub(super) fn new(zero: R, control: &Control) -> Self {
        let never = zero.never();
        let landed = zero.splat(-(LANDED * control.tolerance.relative.sqrt()).max(NOISE));
        Switches {
            pending: !never,
            ahead: zero,
            cut: never,
            cuts: zero,
            whole: zero,
            next: zero,
            landing: never,
            landed,
            margin: zero,
            edge: never,
            from_edge: zero.splat(f64::INFINITY),
            longest: zero,
        }
    }

    #[inline(always)]
    pub(super) fn start_run(&mut self, lane: usize) {
        self.margin.set_lane(lane, 0.0);
        self.from_edge.set_lane(lane, f64::INFINITY);
        self.start_arc(lane);
    }

    /// An arc goes on in the branches of the last, unless a switch may be near.
    #[inline(always)]
    pub(super) fn start_arc(&mut self, lane: usize) {
        if self.margin.lane(lane) <= 0.0 {
            self.pending.set(lane, true);
        }
        self.ahead.set_lane(lane, 0.0);
        self.landing.set(lane, false);
        self.edge.set(lane, false);
        self.cuts.set_lane(lane, 0.0);
    }

    #[inline(always)]
    pub(super) fn choose<Q, P, const N: usize>(&mut self, runs: &mut Q, stepper: &mut P, lanes: &mut StepperLane<R, N>)
    where
        Q: Runs<R, N>,
        P: Stepper<R, N>,
    {
        if !self.pending.any() {
            return;
        }
        let (ahead, zero) = (self.ahead, self.ahead.zero());
        let passed = self.pending & zero.lt(ahead);
        let state = &lanes.now.state;
        let [slope, _] = stepper.slopes();
        let later = each!(zero, |n| R::select(passed, ahead.mul_add(slope[n], state[n]), state[n]));
        let rough = runs.is_rough(zero);
        runs.choose_branches(self.pending, lanes.time + ahead, &later);
        let [into, out_of] = [passed & !rough & runs.is_rough(zero), passed & rough & !runs.is_rough(zero)];
        self.edge = self.edge | into;
        stepper.pass_edges(into, out_of);
        if passed.any() {
            stepper.renew(&*runs, passed, lanes);
        }
        self.pending = zero.never();
    }

    #[inline(always)]
    pub(super) fn find<Q, P, const N: usize>(
        &mut self,
        runs: &Q,
        stepper: &mut P,
        lanes: &mut StepperLane<R, N>,
        step: Step<R>,
        attempt: &mut Attempt<R>,
        end: &[R; N],
    ) where
        Q: System<R, N>,
        P: Stepper<R, N>,
    {
        let (zero, one) = (self.cuts.zero(), self.cuts.splat(1.0));
        let rough = runs.is_rough(zero);
        attempt.from_edge = self.edge;
        self.longest = one.splat(f64::INFINITY);
        let reach = runs.sway(step.length, [&lanes.now.state, end]);
        let twice = reach + reach;
        let near = attempt.accepted & (rough | !twice.lt(self.margin));
        let before = self.margin;
        self.margin = R::select(attempt.accepted, before - reach, before);
        if !near.any() {
            self.cut = zero.never();
            self.cuts = R::select(attempt.accepted, zero, self.cuts);
            return;
        }
        let margin = runs.margin(step.end, end);
        self.margin = R::select(near, margin, self.margin);
        let open = near & self.cuts.lt(one.splat(MOST_CUTS));
        let over = open & margin.lt(R::select(self.landing, self.landed, one.splat(-NOISE)));
        let [first, last] = stepper.slopes();
        let may_dip = open & !twice.lt(before + margin);
        let mut fraction = one.splat(f64::INFINITY);
        if may_dip.any() {
            let dip = runs.dip(step, [[&lanes.now.state, first], [end, last]]);
            fraction = R::select(may_dip, dip, fraction);
        }
        let cut = over | (open & fraction.lt(one));
        self.cut = cut;
        if over.any() {
            stepper.prepare_inside(runs, step, end, over, lanes);
            let located = locate(runs, stepper, lanes, step, over, margin);
            fraction = R::select(over, located, fraction);
        }
        self.margin = R::select(cut, before, self.margin);
        attempt.accepted = attempt.accepted & !cut;
        self.from_edge = R::select(self.edge & attempt.accepted, step.length, self.from_edge);
        self.edge = self.edge & !attempt.accepted;
        // the time to the next switch, by the last change of the switch function
        let share = one.splat(TOWARDS_EDGE) * (margin * (step.length / (before - margin)));
        let towards = rough & attempt.accepted & margin.lt(before) & self.from_edge.lt(share);
        self.longest = R::select(towards, share, self.longest);
        self.next = fraction * step.length;
        self.whole = R::select(cut & !self.landing, step.length, self.whole);
        self.cuts = R::select(attempt.accepted, zero, self.cuts + zero.indicator(cut));
    }

    /// After [`Stepper::advance`]: shortens the next step to the switch, and returns the lanes with one.
    #[inline(always)]
    pub(super) fn cut<P: Stepper<R, N>, const N: usize>(&mut self, stepper: &mut P, attempt: &Attempt<R>) -> R::Mask {
        let ended = self.landing & attempt.accepted;
        self.pending = ended;
        self.ahead = R::select(ended, self.whole * self.whole.splat(AHEAD), self.ahead.zero());
        self.landing = (self.landing & !attempt.accepted) | self.cut;
        stepper.limit(self.longest);
        if self.cut.any() {
            stepper.cut(self.cut, self.next);
        }
        self.cut
    }
}

/// Fraction of `step` at which its dense output reaches a switch in the lanes `over`, for the margin `last` at its end:
/// false position with the retained margin halved (M. Dowell & P. Jarratt, BIT 11, 1971).
#[inline(always)]
fn locate<R, Q, P, const N: usize>(
    system: &Q,
    stepper: &mut P,
    lanes: &mut StepperLane<R, N>,
    step: Step<R>,
    over: R::Mask,
    last: R,
) -> R
where
    R: Real,
    Q: System<R, N>,
    P: Stepper<R, N>,
{
    let number = |value: f64| last.splat(value);
    let (mut low, mut high, mut found) = (number(LEAST), number(1.0), number(LEAST));
    let (mut above, mut below) = (last, last);
    let mut open = over;
    let mut stays = [last.never(); 2];
    for k in 0..MOST_EVALUATIONS {
        let secant = (high - low).mul_add(above / (above - below), low);
        let middle = number(0.5) * (low + high);
        let inner = R::select(low.lt(secant) & secant.lt(high), secant, middle);
        let s = if k == 0 { low } else { inner };
        // a closure would be compiled without vector instructions
        let length = R::select(over, s * step.length, s.zero());
        let part = step.part(length);
        let state = stepper.inside(system, step, part, over, lanes);
        let margin = system.margin(part.end, &state);
        found = R::select(open, s, found);
        let is_above = open & low.zero().lt(margin);
        if k == 0 {
            // an earlier switch: the step ends there
            (open, above) = (is_above, margin);
            continue;
        }
        let is_below = open & !is_above;
        let half = number(0.5);
        below = R::select(is_above & stays[0], half * below, below);
        above = R::select(is_below & stays[1], half * above, above);
        (low, above) = (R::select(is_above, s, low), R::select(is_above, margin, above));
        (high, below) = (R::select(is_below, s, high), R::select(is_below, margin, below));
        stays = [is_above, is_below];
        open = open & number(LOCATED[0]).lt(margin.abs()) & number(LOCATED[1]).lt(high - low);
        if !open.any() {
            break;
        }
    }
    found
}

/// Times at which [`dip`] needs a switch function, and the states at the inner two, from states and derivatives at both
/// ends of `step`.
#[inline(always)]
pub fn beside<R: Real, const N: usize>(step: Step<R>, ends: [[&[R; N]; 2]; 2]) -> ([R; 4], [[R; N]; 2]) {
    let short = step.length * step.length.splat(BESIDE);
    let state = |[state, slope]: [&[R; N]; 2], time: R| each!(time, |n| time.mul_add(slope[n], state[n]));
    let times = [step.time, step.time + short, step.end - short, step.end];
    (times, [state(ends[0], short), state(ends[1], -short)])
}

/// Fraction of a step at which a switch function, positive at both ends, may be negative by the cubic through them;
/// infinite if none. The function is given at the times of [`beside`].
#[inline(always)]
pub fn dip<R: Real>([start, after, before, end]: [R; 4]) -> R {
    let number = |value: f64| start.splat(value);
    let (zero, per) = (start.zero(), number(1.0 / BESIDE));
    let (falls, rises) = ((after - start) * per, (end - before) * per);
    // start + falls s + square s^2 + cube s^3
    let rise = end - start;
    let square = number(3.0) * rise - (falls + falls + rises);
    let cube = (falls + rises) - (rise + rise);
    let root = square.mul_add(square, number(-3.0) * (cube * falls)).larger(zero).sqrt();
    let s = -falls / (square + root);
    let least = cube.mul_add(s, square).mul_add(s, falls).mul_add(s, start);
    let depth = start.smaller(end) - least;
    let doubtful = falls.lt(zero)
        & zero.lt(rises)
        & zero.lt(start)
        & zero.lt(end)
        & least.lt(number(DOUBT) * depth)
        & number(LEAST).lt(s)
        & s.lt(number(1.0));
    R::select(doubtful, s, number(f64::INFINITY))
}
