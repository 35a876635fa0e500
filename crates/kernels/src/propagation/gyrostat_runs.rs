//! [`GyrostatRuns`]: gyrostats in lanes, for Runge-Kutta methods.

use super::arc_source::ArcSource;
use crate::dynamics::effects::within_arcs::{Beside, WithinArcs};
use crate::dynamics::gyrostat::equations::Constants;
use crate::dynamics::gyrostat::{ATTITUDE, Gyrostat, IMPULSE, IMPULSE_INTEGRAL, OMEGA, WITH_ATTITUDE, WITH_THRUST};
use crate::math::prelude::*;
use crate::ode::explicit::Step;
use crate::ode::switches::beside;
use crate::ode::{Runs, System, Tolerance};

/// Reference size of offsets from an orbit smaller than this, m.
pub const SMALLEST_OFFSET: f64 = 1e-3;

/// Runs of the gyrostat's first `N` components under the effects `E`, one per lane.
pub struct GyrostatRuns<'a, R, E> {
    runs: &'a mut [Gyrostat<f64>],
    arcs: ArcSource<'a>,
    /// True if arcs are those of a control loop.
    continues: bool,
    constants: Constants<R>,
    effects: E,
    run_in_lane: [usize; WIDTH],
    /// Time scale of the run in each lane as a rate, rad/s, a floor for rates in the error norm.
    scale: R,
}

impl<'a, R: Real, E: WithinArcs<R>> GyrostatRuns<'a, R, E> {
    /// Runs before their first arcs, which `arcs` provides, those of a loop if it `continues`; `zero` determines the
    /// number of lanes.
    pub fn new(zero: R, runs: &'a mut [Gyrostat<f64>], arcs: ArcSource<'a>, continues: bool) -> Self {
        GyrostatRuns {
            runs,
            arcs,
            continues,
            constants: Constants::zero(zero),
            effects: E::none(zero),
            run_in_lane: [0; WIDTH],
            scale: zero.splat(1.0),
        }
    }

    pub fn run(&self, run: usize) -> &Gyrostat<f64> {
        &self.runs[run]
    }
}

impl<R: Real, E: WithinArcs<R>, const N: usize> System<R, N> for GyrostatRuns<'_, R, E> {
    #[inline(always)]
    fn derivative(&self, time: R, state: &[R; N]) -> [R; N] {
        let mut beside = Beside { torque: self.constants.torque, force: None, carrier: None };
        if E::ACT {
            let own = self.effects.act(time, state);
            beside = Beside { torque: sum(beside.torque, own.torque), ..own };
        }
        self.constants.derivative(time, state, &beside)
    }

    /// The largest error of: the rate against |omega| (at least the time scale times absolute/relative), the attitude
    /// against |q|, the offset from an orbit against itself; NaN if any component is not finite.
    #[inline(always)]
    fn error_ratio(&self, error: &[R; N], old: &[R; N], new: &[R; N], tolerance: Tolerance) -> R {
        let threshold = self.scale.splat(tolerance.absolute / tolerance.relative);
        let rate = three(old, OMEGA);
        let rate_new = three(new, OMEGA);
        let size = norm(rate).larger(norm(rate_new)).larger(threshold * self.scale);
        let off = error[OMEGA].abs().larger(error[OMEGA + 1].abs()).larger(error[OMEGA + 2].abs());
        let mut ratio = off / size;
        if N >= WITH_ATTITUDE {
            let vector = three(new, ATTITUDE + 1);
            let size = new[ATTITUDE].mul_add(new[ATTITUDE], dot(vector, vector)).sqrt().larger(threshold);
            let mut off = error[ATTITUDE].abs();
            for i in 1..4 {
                off = off.larger(error[ATTITUDE + i].abs());
            }
            ratio = ratio.larger(off / size);
        }
        if let (Some([rate, mass]), true) = (self.effects.scales_of_offset(), N >= WITH_THRUST) {
            let slowness = rate.splat(1.0) / rate;
            // the distance, or the velocity times the time of one radian of the orbit
            let reach = |of: &[R; N]| norm(three(of, IMPULSE_INTEGRAL)).larger(slowness * norm(three(of, IMPULSE)));
            let size = reach(old).larger(reach(new)).larger(rate.splat(SMALLEST_OFFSET) * mass);
            ratio = ratio.larger(reach(error) / size);
        }
        let zero = self.scale.zero();
        let mut poison = zero;
        for i in 0..N {
            poison = (error[i] + new[i]).mul_add(zero, poison);
        }
        ratio * self.scale.splat(1.0 / tolerance.relative) + poison
    }

    #[inline(always)]
    fn continues(&self) -> bool {
        self.continues
    }

    #[inline(always)]
    fn has_switches(&self) -> bool {
        E::ACT && self.effects.has_switches()
    }

    #[inline(always)]
    fn is_rough(&self, zero: R) -> R::Mask {
        self.effects.is_rough(zero)
    }

    #[inline(always)]
    fn margin(&self, time: R, state: &[R; N]) -> R {
        self.effects.margin(time, state)
    }

    #[inline(always)]
    fn sway(&self, length: R, [first, last]: [&[R; N]; 2]) -> R {
        self.effects.sway(length, norm(three(first, OMEGA)).larger(norm(three(last, OMEGA))))
    }

    #[inline(always)]
    fn dip(&self, step: Step<R>, ends: [[&[R; N]; 2]; 2]) -> R {
        let (times, [after, before]) = beside(step, ends);
        self.effects.dip(times, [ends[0][0], &after, &before, ends[1][0]])
    }
}

impl<R: Real, E: WithinArcs<R>, const N: usize> Runs<R, N> for GyrostatRuns<'_, R, E> {
    fn count(&self) -> usize {
        self.runs.len()
    }

    fn load(&mut self, lane: usize, run: usize) -> [f64; N] {
        self.run_in_lane[lane] = run;
        let run = &self.runs[run];
        self.constants.set_run(lane, run, 1.0);
        self.effects.set_lane(lane, run);
        let mut state = [0.0; N];
        if let (Some(offset), true) = (run.start_of_offset(), N >= WITH_THRUST) {
            state[IMPULSE..IMPULSE_INTEGRAL + 3].copy_from_slice(&offset);
        }
        state[OMEGA..OMEGA + 3].copy_from_slice(&run.omega_b);
        if N >= WITH_ATTITUDE {
            state[ATTITUDE..ATTITUDE + 4].copy_from_slice(&run.q_eb);
        }
        state
    }

    fn next_arc(&mut self, lane: usize, time: f64, state: &[f64; N]) -> Option<f64> {
        if time >= self.arcs.duration() {
            return None;
        }
        self.scale.apart(
            #[inline(always)]
            || {
                let index = self.run_in_lane[lane];
                let run = &mut self.runs[index];
                let mut components = [0.0; WITH_THRUST];
                components[..N].copy_from_slice(state);
                self.arcs.begin_arc(
                    index,
                    run,
                    time,
                    #[inline(always)]
                    || components,
                );
                let arc = run.arcs.len() - 1;
                self.constants.set_arc(lane, run, arc, 1.0);
                self.effects.set_arc(lane, run);
                self.effects.follow(lane, run);
                self.scale.set_lane(lane, 1.0 / run.time_unit());
                Some(run.arcs[arc].arc.end())
            },
        )
    }

    #[inline(always)]
    fn choose_branches(&mut self, lanes: R::Mask, time: R, state: &[R; N]) {
        self.effects.choose_branches(lanes, time, state);
    }
}
