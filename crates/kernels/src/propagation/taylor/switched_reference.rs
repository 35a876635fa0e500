//! Reference solutions under effects with branches and without Taylor series: extrapolation
//! ([`crate::ode::extrapolation`]) in double-double, with steps that end at switches.
//!
//! Shadows, densities and the direction of the Sun are `f64` numbers in any arithmetic
//! ([`crate::dynamics::environment`]), so that torques of air and light are uncertain by some 1e-16. The orbit is
//! integrated with the attitude instead of by the closed form that it judges.

use fearless_simd::Simd;

use super::reference_run::{Integration, MOST_STEPS, N, ReferenceOrbit};
use crate::dynamics::effects::ChangingEffects;
use crate::dynamics::effects::within_arcs::{Beside, Motion, beside_orbit};
use crate::dynamics::gravity::Gravity;
use crate::dynamics::gyrostat::equations::Constants;
use crate::dynamics::gyrostat::{ATTITUDE, IMPULSE, IMPULSE_INTEGRAL, OMEGA};
use crate::dynamics::orbit_state::OrbitState;
use crate::math::double_double::DoubleDouble;
use crate::math::prelude::*;
use crate::ode::explicit::Step;
use crate::ode::extrapolation::{COLUMNS, Extrapolation};
use crate::ode::switches::beside;
use crate::ode::{System, Tolerance};
use crate::propagation::gyrostat_runs::SMALLEST_OFFSET;
use crate::run::Status;

/// Relative tolerance of a step: below the uncertainty of torques that change the rate by some percent per step.
pub const TOLERANCE: f64 = 1e-17;

/// Position and velocity on the orbit, after the components of the gyrostat.
const POSITION: usize = N;
const VELOCITY: usize = N + 3;
const ALL: usize = N + 6;

/// Switch functions below minus this have changed sign, and a switch is located to this; they round to 1e-16 to 1e-15.
const NOISE: f64 = 1e-13;

/// Branches are chosen by the signs after this fraction of a step; the error is of second order, 1e-18.
const AHEAD: f64 = 1e-9;

const MOST_CUTS: usize = 60;

/// Shortest step as a fraction of the time scale of the run.
const SHORTEST: f64 = 1e-12;

/// Factors on the step length: after no convergence, after all columns, after few columns.
const FACTORS: [f64; 3] = [0.4, 0.8, 1.6];

/// Number of columns of a step that could have been longer.
const FEW: usize = COLUMNS - 4;

type State = [DoubleDouble; ALL];

/// Equations of motion of an arc, compiled once for the instruction set of `simd`: in double-double each function is
/// long.
struct Motions<S> {
    simd: S,
    constants: Constants<DoubleDouble>,
    effects: ChangingEffects<DoubleDouble>,
    gravity: Gravity<DoubleDouble>,
    may_leave: bool,
    /// Floor of rates in the error norm, rad/s.
    rate: DoubleDouble,
}

#[inline(always)]
fn carrier(state: &State) -> OrbitState<DoubleDouble> {
    let position = three(state, POSITION);
    OrbitState { position, velocity: three(state, VELOCITY), distance: norm(position) }
}

#[inline(always)]
fn gyrostat(state: &State) -> [DoubleDouble; N] {
    let mut own = [DoubleDouble::exact(0.0); N];
    own.copy_from_slice(&state[..N]);
    own
}

impl<S: Simd> Motions<S> {
    /// Arguments of the effects, with the motion of the point on the orbit if the spacecraft may leave it.
    #[inline(always)]
    fn motion(
        &self,
        time: DoubleDouble,
        state: &State,
        for_torques: bool,
    ) -> (Motion<DoubleDouble>, Beside<DoubleDouble>) {
        let (mut place, mut point) = (carrier(state), None);
        if self.may_leave {
            (place, point) = beside_orbit(&self.gravity, &place, self.constants.inverse_mass, state);
        }
        let motion = Motion::of(time, state, place, &self.effects, for_torques);
        (motion, Beside { torque: [time.zero(); 3], force: None, carrier: point })
    }

    /// Chooses the branches `ahead` seconds after `time`.
    #[inline(always)]
    fn choose(&mut self, time: DoubleDouble, state: &State, ahead: DoubleDouble) {
        self.simd.vectorize(
            #[inline(always)]
            || {
                let slope = self.derivative(time, state);
                let mut later = *state;
                for n in 0..ALL {
                    later[n] = ahead.mul_add(slope[n], state[n]);
                }
                let (motion, _) = self.motion(time + ahead, &later, false);
                self.effects.choose_branches(true, &motion);
            },
        );
    }
}

impl<S: Simd> System<DoubleDouble, ALL> for Motions<S> {
    #[inline(always)]
    fn derivative(&self, time: DoubleDouble, state: &State) -> State {
        self.simd.vectorize(
            #[inline(always)]
            || {
                let (motion, mut all) = self.motion(time, state, true);
                all.torque = sum(self.constants.torque, self.effects.torque(&motion));
                all.force = self.effects.force(&motion);
                let mut rate = [DoubleDouble::exact(0.0); ALL];
                rate[..N].copy_from_slice(&self.constants.derivative(time, &gyrostat(state), &all));
                let place = carrier(state);
                let pull = self.gravity.acceleration(place.position, place.distance);
                rate[POSITION..VELOCITY].copy_from_slice(&place.velocity);
                rate[VELOCITY..].copy_from_slice(&pull);
                rate
            },
        )
    }

    /// The largest error of rate, attitude, orbit and offset, each relative to its size.
    #[inline(always)]
    fn error_ratio(&self, error: &State, old: &State, new: &State, tolerance: Tolerance) -> DoubleDouble {
        let size = |first: usize| norm(three(old, first)).larger(norm(three(new, first)));
        let mut ratio = norm(three(error, OMEGA)) / size(OMEGA).larger(self.rate);
        for component in &error[ATTITUDE..ATTITUDE + 4] {
            ratio = component.abs().larger(ratio);
        }
        for first in [POSITION, VELOCITY] {
            ratio = (norm(three(error, first)) / size(first)).larger(ratio);
        }
        if self.may_leave {
            let least = self.constants.mass * DoubleDouble::exact(SMALLEST_OFFSET);
            let turning = size(VELOCITY) / size(POSITION);
            ratio = (norm(three(error, IMPULSE_INTEGRAL)) / size(IMPULSE_INTEGRAL).larger(least)).larger(ratio);
            let least = size(IMPULSE).larger(turning * size(IMPULSE_INTEGRAL).larger(least));
            ratio = (norm(three(error, IMPULSE)) / least).larger(ratio);
        }
        let mut poison = ratio.zero();
        for (error, new) in error.iter().zip(new) {
            poison = (*error + *new).mul_add(ratio.zero(), poison);
        }
        ratio / ratio.splat(tolerance.relative) + poison
    }

    #[inline(always)]
    fn margin(&self, time: DoubleDouble, state: &State) -> DoubleDouble {
        self.simd.vectorize(
            #[inline(always)]
            || self.effects.margin(&self.motion(time, state, false).0),
        )
    }

    #[inline(always)]
    fn dip(&self, step: Step<DoubleDouble>, ends: [[&State; 2]; 2]) -> DoubleDouble {
        self.simd.vectorize(
            #[inline(always)]
            || {
                let (times, [after, before]) = beside(step, ends);
                let states = [ends[0][0], &after, &before, ends[1][0]];
                let mut motions = [self.motion(times[0], states[0], false).0; 4];
                for m in 1..4 {
                    motions[m] = self.motion(times[m], states[m], false).0;
                }
                self.effects.dip(&motions)
            },
        )
    }
}

struct Taken {
    length: DoubleDouble,
    end: State,
    /// Derivative and smallest switch function at its end.
    slope: State,
    margin: f64,
    columns: usize,
}

struct Steps {
    extrapolation: Box<Extrapolation<DoubleDouble, ALL>>,
    length: f64,
    shortest: f64,
    count: u64,
}

impl Steps {
    /// The step of `length` seconds from `time`, or a shorter one that converges.
    #[inline(always)]
    fn attempt<S: Simd>(
        &mut self,
        motions: &Motions<S>,
        time: DoubleDouble,
        mut length: DoubleDouble,
        start: [&State; 2],
    ) -> Result<Taken, Status> {
        loop {
            self.count += 1;
            if self.count > MOST_STEPS {
                return Err(Status::StepLimit);
            }
            let step = Step { time, end: time + length, length };
            let tolerance = Tolerance { relative: TOLERANCE, absolute: TOLERANCE };
            if let Some((end, columns)) = self.extrapolation.step(motions, step, start, tolerance) {
                let slope = motions.derivative(step.end, &end);
                let margin = motions.margin(step.end, &end).high;
                return Ok(Taken { length, end, slope, margin, columns });
            }
            length = length * DoubleDouble::exact(FACTORS[0]);
            self.length = length.high;
            if self.length.is_nan() || self.length < self.shortest {
                return Err(Status::NonFinite);
            }
        }
    }

    /// The step from `time` of at most `left` seconds, without a switch inside; true if it ends at one.
    #[inline(always)]
    fn next<S: Simd>(
        &mut self,
        motions: &Motions<S>,
        time: DoubleDouble,
        left: DoubleDouble,
        start: [&State; 2],
    ) -> Result<(Taken, bool), Status> {
        let natural = self.length;
        let mut length = left.smaller(DoubleDouble::exact(natural));
        let mut between: Option<[(DoubleDouble, f64); 2]> = None;
        let mut stays = 0;
        for cut in 0.. {
            let taken = self.attempt(motions, time, length, start)?;
            if cut == 0 && natural == taken.length.high {
                self.length *= match taken.columns {
                    COLUMNS => FACTORS[1],
                    FEW.. => 1.0,
                    _ => FACTORS[2],
                };
            }
            let here = (taken.length, taken.margin);
            let [low, high] = match between {
                Some([_, high]) if taken.margin > 0.0 => {
                    stays = stays.max(0) + 1;
                    [here, (high.0, high.1 * if stays > 1 { 0.5 } else { 1.0 })]
                }
                Some([low, _]) => {
                    stays = stays.min(0) - 1;
                    [(low.0, low.1 * if stays < -1 { 0.5 } else { 1.0 }), here]
                }
                None => {
                    // a pair of switches within the step: first to where they are suspected
                    let step = Step { time, end: time + taken.length, length: taken.length };
                    let dip = motions.dip(step, [start, [&taken.end, &taken.slope]]);
                    if dip.lt(DoubleDouble::exact(1.0)) && cut < MOST_CUTS {
                        length = dip * taken.length;
                        continue;
                    }
                    if taken.margin >= -NOISE {
                        return Ok((taken, false));
                    }
                    [(DoubleDouble::exact(0.0), motions.margin(time, start[0]).high.max(NOISE)), here]
                }
            };
            if taken.margin.abs() < NOISE || (high.0 - low.0).high < self.shortest || cut >= MOST_CUTS {
                return Ok((taken, true));
            }
            // false position; the end that stays has its margin halved
            let share = (low.1 / (low.1 - high.1)).clamp(AHEAD, 1.0 - AHEAD);
            length = (high.0 - low.0).mul_add(DoubleDouble::exact(share), low.0);
            between = Some([low, high]);
        }
        unreachable!("a step is replaced so often at most")
    }
}

impl Integration<'_, '_> {
    /// Integrated components at the observation points, SI.
    #[inline(always)]
    pub fn switched_states(mut self, simd: impl Simd) -> Result<Vec<[DoubleDouble; N]>, Status> {
        let zero = DoubleDouble::exact(0.0);
        let (grid, scale) = (self.grid, self.coarse.time_unit());
        let Some(orbit) = self.run.orbit.as_ref().map(|orbit| ReferenceOrbit::new(self.run, orbit)) else {
            unreachable!("air and light act on an orbit")
        };
        let mut state = [zero; ALL];
        state[OMEGA..OMEGA + 3].copy_from_slice(&self.run.omega_b);
        state[ATTITUDE..ATTITUDE + 4].copy_from_slice(&self.run.q_eb);
        if let Some(offset) = self.run.start_of_offset() {
            state[IMPULSE..IMPULSE_INTEGRAL + 3].copy_from_slice(&offset);
        }
        state[POSITION..VELOCITY].copy_from_slice(&orbit.start.position);
        state[VELOCITY..].copy_from_slice(&orbit.start.velocity);
        let mut steps = Steps {
            extrapolation: Box::new(Extrapolation::new(zero)),
            length: scale,
            shortest: scale * SHORTEST,
            count: 0,
        };
        let times = grid.times();
        let mut states: Vec<[DoubleDouble; N]> = Vec::with_capacity(times.len());
        let mut observe = |time: f64, state: &State| {
            while times.get(states.len()).is_some_and(|at| *at <= time) {
                let mut values = gyrostat(state);
                orbit.complete(time, &carrier(state), &mut values);
                states.push(values);
            }
            times.get(states.len()).copied().unwrap_or(f64::INFINITY)
        };
        let mut observed = observe(0.0, &state);
        let mut reached = 0.0;
        while reached < grid.duration() {
            self.begin_arc(reached, 1.0, &gyrostat(&state));
            let number = self.run.arcs.len() - 1;
            let mut motions = Motions {
                simd,
                constants: Constants::of(self.run, number, 1.0),
                effects: self.run.effects,
                gravity: orbit.gravity,
                may_leave: self.run.offset.is_some(),
                rate: DoubleDouble::exact(1.0 / scale),
            };
            let mut time = DoubleDouble::exact(reached);
            reached = self.run.arcs[number].arc.end();
            motions.choose(time, &state, DoubleDouble::exact(AHEAD * steps.length));
            let mut slope = motions.derivative(time, &state);
            while time.lt(DoubleDouble::exact(reached)) {
                let stop = DoubleDouble::exact(observed.min(reached));
                let left = stop - time;
                let (taken, is_switch) = steps.next(&motions, time, left, [&state, &slope])?;
                time = if taken.length == left { stop } else { time + taken.length };
                (state, slope) = (taken.end, taken.slope);
                if is_switch {
                    motions.choose(time, &state, DoubleDouble::exact(AHEAD * steps.length));
                    slope = motions.derivative(time, &state);
                }
                if time == stop {
                    observed = observe(stop.high, &state);
                }
            }
        }
        Ok(states)
    }
}
