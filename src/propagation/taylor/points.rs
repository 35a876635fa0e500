//! Observation points as the march passes them: of all lanes at once, and one by one from series that were kept.
#![expect(clippy::needless_range_loop, reason = "components are numbered alike in several arrays")]

use fearless_simd::Simd;

use super::dense::{value_at, values};
use super::driver::Driver;
use super::thrust::angle_of;
use crate::dynamics::gyrostat::equations::Constants;
use crate::dynamics::gyrostat::{
    ANGLE, ANGULAR_IMPULSE, IMPULSE, MOTOR_WORK, OMEGA, THRUST_WORK, WITH_MOTORS, WITH_THRUST,
};
use crate::math::Real;
use crate::math::lanes::WIDEST;

impl<S: Simd, R: Real, const N: usize, const J: usize, const FORCED: bool> Driver<'_, S, R, N, J, FORCED> {
    /// Evaluates the next observation point of every lane that has one before `covered`.
    #[inline(always)]
    pub(super) fn observe(&mut self, slot: usize, constants: &Constants<R>, begin: &[R; N], covered: R) {
        let zero = covered.zero();
        let segment = &self.work.ring[slot];
        let due = self.upcoming.lt(covered);
        let x = R::select(due, (self.upcoming - segment.start) - segment.start_low, zero);
        let [at] = values(&segment.jet, [x]);
        let mut all = [zero; N];
        all[..J].copy_from_slice(&at);
        if FORCED {
            let mut turned = angle_of(&at);
            for i in 0..3 {
                turned[i] -= segment.jet[0][ANGLE + i];
            }
            let grown = self.work.quadrature.growth(constants, &segment.jet, begin, turned, x);
            for i in J..N {
                all[i] = begin[i] + grown[i];
            }
        }
        let factors = factors::<R, N>(self.per_unit);
        let mut rows = [[0.0; WIDEST]; N];
        for i in 0..N {
            (all[i] * factors[i]).write(&mut rows[i]);
        }
        let flags = R::select(due, zero.splat(1.0), zero);
        for lane in 0..R::LANES {
            if flags.lane(lane) == 0.0 {
                continue;
            }
            let Some(place) = &mut self.places[lane] else { continue };
            let point = place.point;
            place.point += 1;
            for i in 0..N {
                self.work.trajectories[lane].column_mut(i)[point] = rows[i][lane];
            }
            self.look_ahead(lane);
        }
    }

    /// Evaluates the points of a watched stretch one by one from the series that were kept: those before the present time,
    /// or all of the stretch where it is the `whole`.
    #[cold]
    #[inline(never)]
    pub(super) fn evaluate_kept(&mut self, lane: usize, whole: bool) {
        let Some(mut place) = self.places[lane] else { return };
        let ring = &self.work.ring;
        let run = &self.runs[place.run];
        let bounds = &run.stretches[place.stretch];
        let last = place.stretch + 1 == run.stretches.len();
        let reached = self.time.lane(lane);
        let mut step = place.begun;
        while let Some(time) = self.grid.times().get(place.point) {
            let local = (time - bounds.start) / place.unit;
            if if whole { !last && *time > bounds.end } else { local >= reached } {
                break;
            }
            while step + 1 < self.clock && ring[(step + 1) % ring.len()].start.lane(lane) <= local {
                step += 1;
            }
            let segment = &ring[step % ring.len()];
            let x = (local - segment.start.lane(lane)) - segment.start_low.lane(lane);
            let factors = factors::<f64, N>(1.0 / place.unit);
            let trajectory = &mut self.work.trajectories[lane];
            for i in 0..J {
                trajectory.column_mut(i)[place.point] = value_at(&segment.jet, i, lane, x) * factors[i];
            }
            let riders = place.riders_after::<N, J>(local);
            for i in J..N {
                trajectory.column_mut(i)[place.point] = riders[i - J] * factors[i];
            }
            place.point += 1;
        }
        self.places[lane] = Some(place);
    }
}

/// What turns a component in the lane's unit of time into SI, given one over the unit.
#[inline(always)]
pub(super) fn factors<R: Real, const N: usize>(per_unit: R) -> [R; N] {
    let mut factors = [per_unit.splat(1.0); N];
    factors[OMEGA..OMEGA + 3].fill(per_unit);
    if N >= WITH_MOTORS {
        factors[MOTOR_WORK] = per_unit * per_unit;
    }
    if N >= WITH_THRUST {
        factors[IMPULSE..IMPULSE + 3].fill(per_unit);
        factors[ANGULAR_IMPULSE..ANGULAR_IMPULSE + 3].fill(per_unit);
        factors[THRUST_WORK] = per_unit * per_unit;
    }
    factors
}
