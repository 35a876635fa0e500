//! The lanes: runs side by side, each with its own step, stretch, period and end.
#![expect(clippy::needless_range_loop, reason = "components are numbered alike in several arrays")]

use fearless_simd::Simd;

use super::dense::{Buckets, Segment};
use super::jet::{Reciprocals, Scratch, expand};
use super::period::{Period, Section};
use super::step::StepRule;
use super::unfold::{growth, unfold, value_at};
use crate::dynamics::gyrostat::equations::Constants;
use crate::dynamics::gyrostat::{
    ANGULAR_IMPULSE, ATTITUDE, Gyrostat, IMPULSE, MOTOR_WORK, OMEGA, THRUST_WORK, WITH_ATTITUDE, WITH_MOTORS,
    WITH_THRUST,
};
use crate::dynamics::outcome::{Effort, Outcome, Status};
use crate::dynamics::table::{Grid, Trajectory};
use crate::math::lanes::WIDTH;
use crate::math::vector::hamilton;
use crate::math::{Lanes, Real};

/// Steps whose series are kept at first; a period within them is found without any allocation.
const RING: usize = 24;
/// Steps whose series are kept at most; a run that takes more without a period goes on as plain Taylor integration.
const LARGEST_RING: usize = 192;

/// What a march is asked for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// Relative tolerance.
    pub tolerance: f64,
    /// Whether stretches free of torque are propagated by their period.
    pub periodic: bool,
    /// Steps after which a run is given up.
    pub max_steps: u64,
}

/// The reusable memory of a march.
#[derive(Clone, Debug)]
pub struct Workspace<R, const N: usize> {
    rule: StepRule,
    settings: Settings,
    reciprocals: Reciprocals<R>,
    scratch: Scratch<R>,
    ring: Vec<Segment<R, N>>,
    trajectories: Vec<Trajectory>,
    buckets: Buckets,
    starts: Vec<f64>,
}

impl<R: Real, const N: usize> Workspace<R, N> {
    /// Memory for runs observed at `points` points; `zero` says how many lanes.
    pub fn new(zero: R, settings: Settings, points: usize) -> Self {
        let rule = StepRule::new(settings.tolerance);
        Workspace {
            rule,
            settings,
            reciprocals: Reciprocals::new(zero, rule.order),
            scratch: Scratch::new(zero),
            ring: (0..RING).map(|_| Segment::new(zero, rule.order)).collect(),
            trajectories: (0..R::LANES).map(|_| Trajectory::new(N, points)).collect(),
            buckets: Buckets::new(points, RING),
            starts: Vec::with_capacity(LARGEST_RING),
        }
    }
}

/// One lane's place in its run.
#[derive(Clone, Copy, Debug)]
struct Place {
    run: usize,
    stretch: usize,
    /// Unit of time, s: a power of two near the time scale of the motion, so that every conversion is exact.
    unit: f64,
    /// Length of the stretch, units.
    length: f64,
    /// Number of kept steps since the last point that was evaluated, up to the current one.
    kept: usize,
    /// First observation point that is not evaluated yet.
    point: usize,
    section: Option<Section>,
    /// Whether a return is looked for.
    watching: bool,
    steps: u64,
}

/// Marches `runs` over `grid`; `finish` is called once for each, with its index and its components at the points.
///
/// Every result is a function of the run alone: lanes share no decision.
#[inline(always)]
pub fn march<S: Simd, R: Real, const N: usize, const FORCED: bool>(
    simd: S,
    zero: R,
    runs: &[Gyrostat<f64>],
    grid: &Grid,
    workspace: &mut Workspace<R, N>,
    finish: &mut dyn FnMut(usize, &mut Trajectory, &Outcome),
) {
    let mut lanes = March::<S, R, N, FORCED> {
        simd,
        runs,
        grid,
        next: 0,
        constants: Constants::zero(zero),
        state: [zero; N],
        state_low: [zero; N],
        time: zero,
        time_low: zero,
        left: zero,
        pushed: zero,
        places: [None; WIDTH],
        clock: 0,
        work: workspace,
    };
    for lane in 0..R::LANES {
        lanes.refill(lane);
    }
    while lanes.places[..R::LANES].iter().any(Option::is_some) {
        lanes.step(finish);
    }
}

/// The march while it runs.
struct March<'a, S, R, const N: usize, const FORCED: bool> {
    simd: S,
    runs: &'a [Gyrostat<f64>],
    grid: &'a Grid,
    /// The next run that waits for a lane.
    next: usize,
    constants: Constants<R>,
    state: [R; N],
    state_low: [R; N],
    /// Time since the start of the stretch, units, as an unevaluated sum.
    time: R,
    time_low: R,
    /// Time to the end of the stretch, units.
    left: R,
    /// One where thrust acts in the lane's stretch, else zero.
    pushed: R,
    places: [Option<Place>; WIDTH],
    /// Steps of the march, which number the slots of the ring.
    clock: usize,
    work: &'a mut Workspace<R, N>,
}

impl<S: Simd, R: Real, const N: usize, const FORCED: bool> March<'_, S, R, N, FORCED> {
    /// Puts the next run into `lane`, or empties it.
    #[inline(never)]
    fn refill(&mut self, lane: usize) {
        let zero = 0.0;
        for i in 0..N {
            self.state[i].set_lane(lane, zero);
            self.state_low[i].set_lane(lane, zero);
        }
        self.left.set_lane(lane, zero);
        self.time.set_lane(lane, zero);
        self.time_low.set_lane(lane, zero);
        if self.next >= self.runs.len() {
            self.places[lane] = None;
            return;
        }
        let run = &self.runs[self.next];
        let unit = run.time_unit();
        self.constants.set_run(lane, run, unit);
        for i in 0..3 {
            self.state[OMEGA + i].set_lane(lane, run.omega_b[i] * unit);
        }
        if N >= WITH_ATTITUDE {
            for i in 0..4 {
                self.state[ATTITUDE + i].set_lane(lane, run.q_eb[i]);
            }
        }
        self.places[lane] = Some(Place {
            run: self.next,
            stretch: 0,
            unit,
            length: 0.0,
            kept: 0,
            point: 0,
            section: None,
            watching: false,
            steps: 0,
        });
        self.next += 1;
        self.enter(lane, 0);
    }

    /// Prepares `lane` for a stretch.
    #[inline(never)]
    fn enter(&mut self, lane: usize, stretch: usize) {
        let Some(place) = &mut self.places[lane] else { return };
        let run = &self.runs[place.run];
        self.constants.set_stretch(lane, run, stretch, place.unit);
        let bounds = &run.stretches[stretch];
        let pushed = bounds.force_b.iter().chain(&bounds.torque_b).any(|component| *component != 0.0);
        self.pushed.set_lane(lane, if pushed { 1.0 } else { 0.0 });
        place.stretch = stretch;
        place.length = (bounds.end - bounds.start) / place.unit;
        place.kept = 0;
        place.section = None;
        place.watching = self.work.settings.periodic && !bounds.actuated;
        self.time.set_lane(lane, 0.0);
        self.time_low.set_lane(lane, 0.0);
        self.left.set_lane(lane, place.length);
    }

    /// One step of every lane.
    #[inline(always)]
    fn step(&mut self, finish: &mut dyn FnMut(usize, &mut Trajectory, &Outcome)) {
        let order = self.work.rule.order;
        let slot = self.clock % self.work.ring.len();
        let mut constants = self.constants;
        if FORCED {
            for i in 0..3 {
                constants.momentum[i] = constants.momentum_rate[i].mul_add(self.time, constants.momentum[i]);
            }
            constants.motor_power = constants.motor_power_rate.mul_add(self.time, constants.motor_power);
        }
        let segment = &mut self.work.ring[slot];
        segment.jet[0] = self.state;
        segment.start = self.time;
        segment.start_low = self.time_low;
        expand::<R, N, FORCED>(&constants, &self.work.reciprocals, order, &mut self.work.scratch, &mut segment.jet);
        let wanted = self.work.rule.step(&segment.jet, self.pushed);
        let lands = self.left.lt(wanted);
        let length = R::select(lands, self.left, wanted);
        // the increment first, then the state with its carry
        for i in 0..N {
            let mut sum = segment.jet[order][i];
            for n in (1..order).rev() {
                sum = sum.mul_add(length, segment.jet[n][i]);
            }
            let increment = sum.mul_add(length, self.state_low[i]);
            (self.state[i], self.state_low[i]) = fast_two_sum(self.state[i], increment);
        }
        let (time, error) = fast_two_sum(self.time, length + self.time_low);
        (self.time, self.time_low) = (time, error);
        self.clock += 1;
        for lane in 0..R::LANES {
            self.attend(lane, slot, length.lane(lane), finish);
        }
    }

    /// What a lane does after a step: note the section, fold by a period, end a stretch or a run.
    #[inline(never)]
    fn attend(
        &mut self,
        lane: usize,
        slot: usize,
        length: f64,
        finish: &mut dyn FnMut(usize, &mut Trajectory, &Outcome),
    ) {
        self.simd.vectorize(
            #[inline(always)]
            || self.attended(lane, slot, length, finish),
        );
    }

    #[inline(always)]
    fn attended(
        &mut self,
        lane: usize,
        slot: usize,
        length: f64,
        finish: &mut dyn FnMut(usize, &mut Trajectory, &Outcome),
    ) {
        let Some(mut place) = self.places[lane] else { return };
        let order = self.work.rule.order;
        place.steps += 1;
        place.kept += 1;
        let omega = [self.state[0].lane(lane), self.state[1].lane(lane), self.state[2].lane(lane)];
        let left = (place.length - self.time.lane(lane)) - self.time_low.lane(lane);
        self.left.set_lane(lane, left);
        if !(omega[0].is_finite() && omega[1].is_finite() && omega[2].is_finite()) {
            // the failed step is not to be evaluated
            place.kept -= 1;
            self.places[lane] = Some(place);
            self.fail(lane, Status::NonFinite, slot, finish);
            return;
        }
        let mut found = None;
        if place.watching {
            let jet = &self.work.ring[slot].jet;
            let at_rest = if place.section.is_none() {
                let get = |n: usize| [jet[n][0].lane(lane), jet[n][1].lane(lane), jet[n][2].lane(lane)];
                place.section = Section::new(get(0), get(1));
                place.section.is_none()
            } else {
                false
            };
            if at_rest {
                found = Some(length);
            } else if let Some(section) = &mut place.section
                && section.passes(omega)
            {
                found = section.crossing(jet, lane, order, length, self.work.settings.tolerance);
            }
        }
        self.places[lane] = Some(place);
        if let Some(within) = found
            && left > 0.0
            && let Some(period) = self.period(lane, slot, within)
        {
            self.evaluate(lane, slot, Some(&period), true);
            if place.stretch + 1 < self.runs[place.run].stretches.len() {
                self.jump_to_end(lane, slot, &period);
            }
            self.end_stretch(lane, finish);
        } else if left <= 0.0 {
            self.evaluate(lane, slot, None, true);
            self.end_stretch(lane, finish);
        } else if place.steps >= self.work.settings.max_steps {
            self.fail(lane, Status::StepLimit, slot, finish);
        } else if length <= f64::EPSILON * self.time.lane(lane) * f64::EPSILON {
            self.fail(lane, Status::StepFloor, slot, finish);
        } else if place.kept == self.work.ring.len() {
            self.make_room(lane, slot);
        }
    }

    /// The period of the stretch in `lane`, of which the last step comes back after `within` units.
    #[inline(never)]
    fn period(&self, lane: usize, slot: usize, within: f64) -> Option<Period> {
        self.simd.vectorize(
            #[inline(always)]
            || self.period_of(lane, slot, within),
        )
    }

    #[inline(always)]
    fn period_of(&self, lane: usize, slot: usize, within: f64) -> Option<Period> {
        let place = self.places[lane]?;
        let segment = &self.work.ring[slot];
        let length = {
            let start = segment.start.lane(lane);
            let sum = start + within;
            [sum, (within - (sum - start)) + segment.start_low.lane(lane)]
        };
        if N < WITH_ATTITUDE {
            return Some(Period { length, half_turns: 0.0, axis_e: [0.0; 3] });
        }
        let run = &self.runs[place.run];
        let first = &self.work.ring[self.slot_back(slot, place.kept - 1)].jet[0];
        let order = self.work.rule.order;
        let (mut start, mut end) = ([0.0; 4], [0.0; 4]);
        for i in 0..4 {
            start[i] = first[ATTITUDE + i].lane(lane);
            end[i] = value_at(&segment.jet, ATTITUDE + i, lane, order, within);
        }
        let mut momentum_b = [0.0; 3];
        let mut scale = 0.0_f64;
        for i in 0..3 {
            let own = run.moments[i] * first[OMEGA + i].lane(lane);
            momentum_b[i] = own + self.constants.momentum[i].lane(lane);
            scale = scale.max(own.abs());
        }
        let c_eb = crate::math::vector::dcm_from_quaternion(start);
        Period::new(length, start, end, crate::math::vector::product(c_eb, momentum_b), scale)
    }

    /// The slot `back` steps before `slot`.
    #[inline(always)]
    fn slot_back(&self, slot: usize, back: usize) -> usize {
        let ring = self.work.ring.len();
        (slot + ring - back) % ring
    }

    /// Evaluates the points of the stretch that the kept steps cover: all that are left of it where `whole`.
    #[inline(never)]
    fn evaluate(&mut self, lane: usize, slot: usize, period: Option<&Period>, whole: bool) {
        self.simd.vectorize(
            #[inline(always)]
            || self.evaluated(lane, slot, period, whole),
        );
    }

    #[inline(always)]
    fn evaluated(&mut self, lane: usize, slot: usize, period: Option<&Period>, whole: bool) {
        let Some(place) = &mut self.places[lane] else { return };
        let run = &self.runs[place.run];
        let bounds = &run.stretches[place.stretch];
        let times = self.grid.times();
        let local = |time: f64| (time - bounds.start) / place.unit;
        let covered = self.time.lane(lane);
        let last = place.stretch + 1 == run.stretches.len();
        let end = if whole && last {
            times.len()
        } else {
            let reached = |time: &f64| if whole { *time <= bounds.end } else { local(*time) <= covered };
            place.point + times[place.point..].iter().take_while(|time| reached(time)).count()
        };
        let points = end - place.point;
        if points == 0 || place.kept == 0 {
            return;
        }
        let work = &mut *self.work;
        let ring = work.ring.len();
        work.starts.clear();
        for back in (0..place.kept).rev() {
            work.starts.push(work.ring[(slot + ring - back) % ring].start.lane(lane));
        }
        let origin = work.starts[0];
        let buckets = &mut work.buckets;
        let offset = place.point;
        let start = Lanes::broadcast(self.simd, bounds.start);
        let inverse = Lanes::broadcast(self.simd, 1.0 / place.unit);
        let padded = self.grid.padded_times();
        for first in (0..points).step_by(WIDTH) {
            let mut chunk = [0.0; WIDTH];
            for (k, value) in chunk.iter_mut().enumerate() {
                *value = padded[(offset + first + k).min(padded.len() - 1)];
            }
            let time = (Lanes::load(self.simd, &chunk) - start) * inverse;
            let (turns, rest) = match period {
                Some(period) => period.fold(time),
                None => (time.zero(), time),
            };
            turns.store(&mut buckets.whole[first..]);
            rest.store(&mut buckets.rest[first..]);
        }
        debug_assert!(period.is_none() || origin == 0.0);
        buckets.sort(self.simd, points, &work.starts);
        let factors = factors::<N>(place.unit);
        let trajectory = &mut work.trajectories[lane];
        let order = work.rule.order;
        for number in 0..place.kept {
            let segment = &work.ring[(slot + ring - (place.kept - 1 - number)) % ring];
            buckets.evaluate(self.simd, number, segment, lane, order, &factors, offset, trajectory);
        }
        if let Some(period) = period {
            let first = &work.ring[(slot + ring - (place.kept - 1)) % ring].jet[0];
            let growth = growth::<R, N>(first, &work.ring[slot], lane, order, period);
            unfold(self.simd, period, &growth, &buckets.whole[..points], offset, trajectory);
        }
        place.point = end;
    }

    /// Sets the state of `lane` to that at the end of its stretch, by folding.
    #[inline(never)]
    fn jump_to_end(&mut self, lane: usize, slot: usize, period: &Period) {
        self.simd.vectorize(
            #[inline(always)]
            || self.jumped(lane, slot, period),
        );
    }

    #[inline(always)]
    fn jumped(&mut self, lane: usize, slot: usize, period: &Period) {
        let Some(place) = self.places[lane] else { return };
        let order = self.work.rule.order;
        let (whole, rest) = period.fold(Lanes::broadcast(self.simd, place.length));
        let rest_time = rest.lane(0);
        let ring = &self.work.ring;
        let mut number = 0;
        for back in 0..place.kept {
            let candidate = self.slot_back(slot, back);
            if ring[candidate].start.lane(lane) <= rest_time || back + 1 == place.kept {
                number = candidate;
                break;
            }
        }
        let segment = &ring[number];
        let x = (rest_time - segment.start.lane(lane)) - segment.start_low.lane(lane);
        let first = &ring[self.slot_back(slot, place.kept - 1)].jet[0];
        let growth = growth::<R, N>(first, &ring[slot], lane, order, period);
        let mut end = [0.0; N];
        for (i, value) in end.iter_mut().enumerate() {
            *value = whole.lane(0).mul_add(growth[i], value_at(&segment.jet, i, lane, order, x));
        }
        if N >= WITH_ATTITUDE {
            let turn = period.turn(whole);
            let turn = [turn[0].lane(0), turn[1].lane(0), turn[2].lane(0), turn[3].lane(0)];
            let q = hamilton(turn, [end[ATTITUDE], end[ATTITUDE + 1], end[ATTITUDE + 2], end[ATTITUDE + 3]]);
            end[ATTITUDE..ATTITUDE + 4].copy_from_slice(&q);
        }
        for i in 0..N {
            self.state[i].set_lane(lane, end[i]);
            self.state_low[i].set_lane(lane, 0.0);
        }
    }

    /// Goes on with the next stretch, or hands the run over and takes the next.
    #[inline(never)]
    fn end_stretch(&mut self, lane: usize, finish: &mut dyn FnMut(usize, &mut Trajectory, &Outcome)) {
        let Some(place) = self.places[lane] else { return };
        let run = &self.runs[place.run];
        if place.stretch + 1 < run.stretches.len() {
            self.enter(lane, place.stretch + 1);
            return;
        }
        let outcome = Outcome {
            status: Status::Done,
            time: self.grid.duration(),
            points: self.grid.points(),
            effort: Effort { steps: place.steps, rejected: 0, evaluations: place.steps },
        };
        let trajectory = &mut self.work.trajectories[lane];
        trajectory.pad();
        finish(place.run, trajectory, &outcome);
        self.refill(lane);
    }

    /// Hands a run over that cannot go on.
    #[cold]
    fn fail(
        &mut self,
        lane: usize,
        status: Status,
        slot: usize,
        finish: &mut dyn FnMut(usize, &mut Trajectory, &Outcome),
    ) {
        let Some(place) = self.places[lane] else { return };
        let last_good = if status == Status::NonFinite { self.slot_back(slot, 1) } else { slot };
        let reached = {
            let segment = &self.work.ring[slot];
            if status == Status::NonFinite { segment.start.lane(lane) } else { self.time.lane(lane) }
        };
        self.time.set_lane(lane, reached);
        self.evaluate(lane, last_good, None, false);
        let Some(place) = self.places[lane].map(|now| Place { steps: place.steps, ..now }) else { return };
        let bounds = &self.runs[place.run].stretches[place.stretch];
        let outcome = Outcome {
            status,
            time: reached.mul_add(place.unit, bounds.start),
            points: place.point,
            effort: Effort { steps: place.steps, rejected: 0, evaluations: place.steps },
        };
        let trajectory = &mut self.work.trajectories[lane];
        trajectory.fill_after(place.point, f64::NAN);
        finish(place.run, trajectory, &outcome);
        self.refill(lane);
    }

    /// More memory for a long period, or no longer looking for it.
    #[cold]
    fn make_room(&mut self, lane: usize, slot: usize) {
        let old = self.work.ring.len();
        if old < LARGEST_RING && self.places[lane].is_some_and(|place| place.watching) {
            let zero = self.state[0].zero();
            let order = self.work.rule.order;
            let mut ring: Vec<Segment<R, N>> = (0..2 * old).map(|_| Segment::new(zero, order)).collect();
            for back in 0..old.min(self.clock) {
                let step = self.clock - 1 - back;
                core::mem::swap(&mut ring[step % (2 * old)], &mut self.work.ring[step % old]);
            }
            self.work.ring = ring;
            return;
        }
        self.evaluate(lane, slot, None, false);
        if let Some(place) = &mut self.places[lane] {
            place.kept = 0;
            place.watching = false;
        }
    }
}

/// What turns a component in the lane's unit of time into SI.
#[inline(always)]
pub(super) fn factors<const N: usize>(unit: f64) -> [f64; N] {
    let mut factors = [1.0; N];
    let inverse = 1.0 / unit;
    factors[OMEGA..OMEGA + 3].fill(inverse);
    if N >= WITH_MOTORS {
        factors[MOTOR_WORK] = inverse * inverse;
    }
    if N >= WITH_THRUST {
        factors[IMPULSE..IMPULSE + 3].fill(inverse);
        factors[ANGULAR_IMPULSE..ANGULAR_IMPULSE + 3].fill(inverse);
        factors[THRUST_WORK] = inverse * inverse;
    }
    factors
}

/// The sum and its rounding error, for |a| >= |b| or a = 0 (T. J. Dekker, Numerische Mathematik 18, 1971).
#[inline(always)]
fn fast_two_sum<R: Real>(a: R, b: R) -> (R, R) {
    let sum = a + b;
    (sum, b - (sum - a))
}
