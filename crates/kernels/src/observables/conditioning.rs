//! [`Conditioning`]: estimated error of a run, and amplification of small errors of its rotational state.
//!
//! With H = K omega + wheels' momentum in the body frame and A = K^-1, a small error eta of H obeys
//! eta' = eta x omega + H x A eta. Without torque H . eta and omega . eta are constant (changes of |H|^2/2 and of the
//! energy T; Zhukovskii's gyrostat: V. Volterra, Acta Math. 22, 1899), which gives the error across the curve of H at
//! any time; only the shift along the curve is integrated. With w, the part of omega across H, and v = H x w,
//! eta = X H/|H| + Y w/|w| + Z v/|v|:
//!
//! ```text
//! X constant;   |w_i| Y_i = |w_k| Y_k + (mu_k - mu_i) |H| X,   mu = omega . H/|H|^2;   Z = alpha |H| |w|,
//! alpha' = X A_wH/|w| + Y (A_ww - A_vv)/|w|      (alpha: the shift in time, s)
//! ```
//!
//! Near an unstable equilibrium (a separatrix) |w| stays small for long, and the shift grows like 1/|w|^2. The error of
//! the attitude across L follows from eta, since L is constant in F_e. The error about L is the integral of H . A
//! eta/|H|, with the part of alpha, a derivative, integrated by parts. [`super::error_sums`] has the sums, over:
//! - truncation of any method: changes of |H|^2 and of T - mu_0 |H|^2/2 (which is |w| Y) since point 0 beyond rounding.
//!   mu_0 is mu at minimal |w|: near a separatrix this invariant is the distance from it;
//! - rounding of each component;
//! - with feedback of other states into omega, and near a separatrix: errors along the curve, and errors too small to
//!   show in the invariants;
//! - rounding of the wheels' momentum, which turns omega about it;
//! - under torque, without invariants: the method's estimate of truncation, in proportion to |w|, at least the |w| that
//!   the torque causes within a radian of rotation.
//!
//! If H is small (at rest, or with cancelling wheel momenta), no curve is well conditioned, but errors hardly grow:
//! |eta| grows by the symmetric part of H x A, at most |H| s with the distance s of A from a multiple of one. |eta| is
//! at most e^(integral of |H| s) times the sum of all errors, the attitude's error |A| times its integral. The estimate
//! is the smaller of both.
//!
//! Magnitudes are added; errors are assumed to arise evenly along the run. The method's own estimates are
//! [`crate::run::Outcome::local_errors`].

use fearless_simd::Simd;

use super::acting::Acting;
use super::error_sums::{Here, Sums, dip};
use super::rotor::{Body, adjugate};
use super::torque_growth::{self, LARGEST_EXPONENT, MOST};
use crate::dynamics::effects::ForceModel;
use crate::math::prelude::*;
use crate::math::{Lanes, Real};
use crate::run::{LocalErrors, StateField, StateTable, rate_scale};

/// Most points examined at first.
const POINTS: usize = 32;

/// Most points examined near a separatrix, where |w| varies a lot.
const MOST_POINTS: usize = 128;

/// Smallest over largest |w| near a separatrix.
const NEAR: f64 = 0.1;

/// |w|/|omega| of an equilibrium, to rounding.
const STILL: f64 = 1e-12;

/// Lower limit of |w|/|omega|: a tenth of rounding.
const LEAST: f64 = 1e-17;

/// Component along each of three axes of a unit error in a random direction: 1/sqrt(3).
const PER_AXIS: f64 = 0.577_350_269_189_625_8;

/// Safety factor:
const SAFETY: f64 = 2.0;

/// Half a turn: nothing is known.
pub const LOST: f64 = core::f64::consts::PI;

const NOISE: f64 = 4.0 * f64::EPSILON;

const HALF_ROUNDING: f64 = 0.5 * f64::EPSILON;

/// Factor on the rounding of a component by a change to principal axes.
const TURNED: f64 = 4.0;

#[derive(Clone, Copy)]
pub struct ObservedStates<'a> {
    pub table: &'a StateTable,
    pub times: &'a [f64],
    pub filled: usize,
    pub local: &'a LocalErrors,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ErrorEstimate {
    /// Estimated largest error: of omega over its [`rate_scale`], or of the attitude in rad.
    pub error: f64,
    /// Largest growth factor, from one to 1e200, of relative errors of omega that arise evenly along the run and in any
    /// direction.
    pub amplification: f64,
}

impl ErrorEstimate {
    /// For a run that was not observed.
    pub const UNKNOWN: ErrorEstimate = ErrorEstimate { error: f64::NAN, amplification: f64::NAN };
}

/// Operands of the sums at each examined point.
#[derive(Clone, Debug)]
pub struct Conditioning {
    times: [f64; MOST_POINTS],
    scale: f64,
    /// |H|, N m s.
    momentum: [f64; MOST_POINTS],
    /// mu = omega . H/|H|^2, 1/(kg m^2).
    along: [f64; MOST_POINTS],
    /// |w|, rad/s.
    across: [f64; MOST_POINTS],
    /// A_HH, 1/(kg m^2).
    axial: [f64; MOST_POINTS],
    /// |A_wH|.
    twist: [f64; MOST_POINTS],
    /// |A_ww - A_vv|.
    shear: [f64; MOST_POINTS],
    /// |w|'/|w| without torque, 1/s.
    widening: [f64; MOST_POINTS],
    /// |omega|, rad/s.
    rate: [f64; MOST_POINTS],
    /// |H|^2.
    square: [f64; MOST_POINTS],
    /// omega . K omega/2, J.
    energy: [f64; MOST_POINTS],
    /// sum |J_i Omega_i| of the wheels, N m s.
    wheels: [f64; MOST_POINTS],
    /// Errors of H along H, w and v due to relative errors of omega's components, N m s.
    digits: [[f64; MOST_POINTS]; 3],
}

impl Conditioning {
    pub fn new() -> Self {
        let zero = [0.0; MOST_POINTS];
        Conditioning {
            times: zero,
            scale: 1.0,
            momentum: zero,
            along: zero,
            across: zero,
            axial: zero,
            twist: zero,
            shear: zero,
            widening: zero,
            rate: zero,
            square: zero,
            energy: zero,
            wheels: zero,
            digits: [zero; 3],
        }
    }

    #[inline(always)]
    pub fn estimate<S: Simd>(&mut self, simd: S, acting: Acting<'_>, states: ObservedStates<'_>) -> ErrorEstimate {
        let ObservedStates { table, times, filled, local } = states;
        let body = Body::of(acting, table, times[filled - 1]);
        let Some(growth) = torque_growth::growth(acting.scene(), table, times, filled) else {
            return self.estimate_of(simd, &body, Some(acting), states);
        };
        let stirred = HALF_ROUNDING * growth.stirred;
        let local = LocalErrors { rounding: local.rounding + stirred, ..*local };
        let found = self.estimate_of(simd, &body, Some(acting), ObservedStates { local: &local, ..states });
        let Some(followed) = growth.followed else {
            let error = lesser(found.error * growth.beside, LOST);
            return ErrorEstimate { error, amplification: lesser(found.amplification * growth.beside, MOST) };
        };
        // a restoring torque is not relied upon
        let amplification = followed.larger(found.amplification);
        let made = local.truncation / self.scale + local.attitude + TURNED * local.rounding;
        ErrorEstimate { error: lesser(followed * made, LOST).larger(found.error), amplification }
    }

    #[inline(always)]
    pub fn estimate_debris<S: Simd>(
        &mut self,
        simd: S,
        inertia: [[f64; 3]; 3],
        states: ObservedStates<'_>,
    ) -> ErrorEstimate {
        self.estimate_of(simd, &Body::debris(inertia), None, states)
    }

    #[inline(always)]
    fn estimate_of<S: Simd>(
        &mut self,
        simd: S,
        body: &Body<'_>,
        acting: Option<Acting<'_>>,
        states: ObservedStates<'_>,
    ) -> ErrorEstimate {
        let ObservedStates { table, filled, local, .. } = states;
        let last = filled - 1;
        let [mut stride, mut count] = self.examine(simd, body, states, POINTS);
        let (mut largest, mut widest, mut narrowest) = (0.0_f64, 0.0_f64, f64::INFINITY);
        for k in 0..count {
            largest = largest.larger(self.rate[k]);
            widest = widest.larger(self.across[k]);
            narrowest = narrowest.smaller(self.across[k]);
        }
        let is_near = narrowest < NEAR * widest && widest > STILL * largest;
        if is_near && stride > 1 {
            [stride, count] = self.examine(simd, body, states, MOST_POINTS);
        }
        if largest == 0.0 {
            return ErrorEstimate { error: SAFETY * (local.rounding + local.attitude), amplification: 1.0 };
        }
        let scale = rate_scale(largest, self.times[count - 1]);
        self.scale = scale;
        // relative from here on
        let local = LocalErrors { truncation: local.truncation / scale, feedback: local.feedback / scale, ..*local };
        // a torque that follows the attitude leaves no equilibrium: truncation turns the body further and further
        let is_changed = acting.is_some_and(|acting| ForceModel::of(acting.scene()).changes_within_arcs());
        let curve = if widest <= STILL * largest && !is_changed {
            self.at_equilibrium(body, [count, stride, last], scale, table, &local)
        } else if is_near && body.offset.is_some() {
            self.along_curve::<true>(body, count, scale, acting, &local)
        } else {
            self.along_curve::<false>(body, count, scale, acting, &local)
        };
        let bound = self.bound(body, count, scale, &local);
        let (error, amplification) = (lesser(curve.0, bound.0), lesser(curve.1, bound.1));
        // NaN counts as lost
        let error = SAFETY * (error + local.truncation + local.attitude);
        ErrorEstimate {
            error: if error < LOST { error } else { LOST },
            amplification: if amplification < MOST { amplification.larger(1.0) } else { MOST },
        }
    }

    /// Fills at most `most` entries; returns the stride between points, and their number.
    #[inline(always)]
    fn examine<S: Simd>(&mut self, simd: S, body: &Body<'_>, states: ObservedStates<'_>, most: usize) -> [usize; 2] {
        let ObservedStates { table, times, filled, .. } = states;
        let last = filled - 1;
        let stride = last.div_ceil(most - 1).max(1);
        let count = last.div_ceil(stride) + 1;
        for (k, time) in self.times[..count].iter_mut().enumerate() {
            *time = times[(k * stride).min(last)];
        }
        for first in (0..count).step_by(WIDTH) {
            self.fill(simd, body, table, [first, stride, last]);
        }
        [stride, count]
    }

    /// Fills eight entries from `first` on; entry k is point `stride` k, at most `last`.
    #[inline(always)]
    fn fill<S: Simd>(&mut self, simd: S, body: &Body<'_>, table: &StateTable, [first, stride, last]: [usize; 3]) {
        let mut points = [0; WIDTH];
        for (k, point) in points.iter_mut().enumerate() {
            *point = ((first + k) * stride).min(last);
        }
        let zero = Lanes::broadcast(simd, 0.0);
        let omega = [
            gathered(simd, table.column(body.rates, 0), &points),
            gathered(simd, table.column(body.rates, 1), &points),
            gathered(simd, table.column(body.rates, 2), &points),
        ];
        let own = product(constant_matrix(zero, body.inertia), omega);
        let mut wheels = zero;
        let momentum = match body.offset {
            Some(offset) => sum(own, constant(zero, offset)),
            None => {
                let mass = body.mass.expect("only a spacecraft has wheels whose momentum changes");
                let mut momentum = product(constant_matrix(zero, mass.inertia), omega);
                for (i, wheel) in mass.wheels.iter().enumerate() {
                    let rate = gathered(simd, table.column(StateField::WheelRates, i), &points);
                    let spin = Lanes::broadcast(simd, wheel.axial) * rate;
                    wheels += spin.abs();
                    momentum = sum(momentum, scaled(spin, constant(zero, wheel.axis)));
                }
                momentum
            }
        };
        let inverse = constant_matrix(zero, body.inverse);
        let tiny = Lanes::broadcast(simd, f64::MIN_POSITIVE);
        let one = Lanes::broadcast(simd, 1.0);
        let rate2 = dot(omega, omega);
        let h2 = dot(momentum, momentum).larger(tiny);
        let mu = dot(omega, momentum) / h2;
        let w = difference(omega, scaled(mu, momentum));
        let floor2 = rate2 * Lanes::broadcast(simd, LEAST * LEAST);
        let w2 = dot(w, w).larger(floor2).larger(tiny);
        let (h, across) = (h2.sqrt(), w2.sqrt());
        let v = cross(momentum, w);
        let turned = product(inverse, momentum);
        let per_h = one / h;
        let per_w2 = one / w2;
        let ww = dot(w, product(inverse, w)) * per_w2;
        let slope = product(inverse, v);
        let vv = dot(v, slope) * (per_w2 * (per_h * per_h));
        h.store(&mut self.momentum[first..]);
        h2.store(&mut self.square[first..]);
        (Lanes::broadcast(simd, 0.5) * dot(omega, own)).store(&mut self.energy[first..]);
        mu.store(&mut self.along[first..]);
        across.store(&mut self.across[first..]);
        (dot(momentum, turned) * (per_h * per_h)).store(&mut self.axial[first..]);
        (dot(w, turned) * (per_h * (per_w2 * across))).abs().store(&mut self.twist[first..]);
        (ww - vv).abs().store(&mut self.shear[first..]);
        (dot(w, slope) * per_w2).store(&mut self.widening[first..]);
        rate2.sqrt().store(&mut self.rate[first..]);
        wheels.larger(Lanes::broadcast(simd, body.wheels)).store(&mut self.wheels[first..]);
        // effect on H of relative errors of the components, of any one if a change of axes mixes them
        let [[x, ..], [_, y, _], [.., z]] = body.inertia;
        let moments = constant(zero, [x, y, z]);
        let magnitudes = if body.is_principal {
            [moments[0] * omega[0], moments[1] * omega[1], moments[2] * omega[2]]
        } else {
            scaled(rate2.sqrt() * Lanes::broadcast(simd, TURNED * PER_AXIS), moments)
        };
        (magnitudes_along(magnitudes, momentum) * per_h).store(&mut self.digits[0][first..]);
        (magnitudes_along(magnitudes, w) * (per_w2 * across)).store(&mut self.digits[1][first..]);
        (magnitudes_along(magnitudes, v) * (per_h * (per_w2 * across))).store(&mut self.digits[2][first..]);
    }

    #[inline(always)]
    fn along_curve<const NEAR: bool>(
        &self,
        body: &Body<'_>,
        count: usize,
        largest: f64,
        acting: Option<Acting<'_>>,
        local: &LocalErrors,
    ) -> (f64, f64) {
        let (inertia, duration) = (body.size, self.times[count - 1]);
        // momentum of a unit error, relative to omega
        let unit = inertia * largest;
        let is_driven = body.offset.is_none();
        let acting = acting.filter(|_| is_driven);
        let torque = acting.map_or(0.0, |acting| acting.largest_torque());
        let mut quietest = 0;
        let mut energy = 0.0_f64;
        for k in 0..count {
            quietest = if self.across[k] < self.across[quietest] { k } else { quietest };
            energy = energy.larger(self.energy[k]);
        }
        let reference = self.along[quietest];
        let balance = |k: usize| self.energy[k] - 0.5 * (reference * self.square[k]);
        // rounding of the balance
        let noise = NOISE * (energy + 0.5 * (reference * self.square[0]).abs());
        let mut even = Sums::default();
        let mut digits = Sums::default();
        let mut other = Sums::default();
        let mut measured = Sums::default();
        let (mut low, mut high, mut motion) = (f64::INFINITY, f64::NEG_INFINITY, 0.0);
        for k in 0..count {
            let (h, mu, mut w) = (self.momentum[k], self.along[k], self.across[k]);
            if torque > 0.0 && acting.is_some_and(|acting| acting.acts(self.times[k])) {
                w = w.larger(torque / (inertia * largest.larger(h / inertia)));
            }
            low = low.smaller(mu * h);
            high = high.larger(mu * h);
            motion += w;
            let step = if k == 0 { 0.0 } else { self.times[k] - self.times[k - 1] };
            let point = Here {
                step,
                since: self.times[k],
                h,
                w,
                tilt: (mu - reference).abs() * h,
                axial: self.axial[k],
                twist: self.twist[k],
                shear: self.shear[k],
                range: high - low,
                unit,
                largest,
            };
            let (parts, used) = match if NEAR && k > 0 { self.dip(k, step) } else { None } {
                Some([lasts, least]) => {
                    let share = lasts / step;
                    let bottom = Here { step: lasts, w: least, ..point };
                    ([(bottom, share), (Here { step: step - lasts, ..point }, 1.0 - share)], 2)
                }
                None => ([(point, 1.0); 2], 1),
            };
            for (here, share) in &parts[..used] {
                let share = *share;
                even.advance(here, [share * PER_AXIS; 3]);
                // rounding of a wheel's momentum changes the angle by which it turns omega
                let turned = 0.5 * self.wheels[k] * here.w * duration;
                let made = [self.digits[0][k], self.digits[1][k], self.digits[2][k] + turned];
                digits.advance(here, made.map(|made| share * made));
                if is_driven {
                    other.advance(here, [PER_AXIS * here.w; 3]);
                    continue;
                }
                if NEAR || local.feedback > 0.0 {
                    // only the part of errors across H that the balance does not show
                    let points = count as f64;
                    let truncation = if NEAR { local.truncation } else { 0.0 };
                    let [fed, cut] = [local.feedback, truncation].map(|error| share * PER_AXIS * error / points);
                    let hidden = |size: f64| fed.smaller(size / unit) + cut.smaller(size / (unit * points));
                    other.advance(here, [hidden(NOISE * h), hidden(noise / here.w), fed + cut]);
                }
                let along = ((self.square[k] - self.square[0]).abs() - NOISE * self.square[0]).larger(0.0) / (2.0 * h);
                measured.set(here, along, ((balance(k) - balance(0)).abs() - noise).larger(0.0));
            }
        }
        let other = if is_driven { other.most / motion * local.truncation } else { other.most };
        // the drift of the wheels is part of the balance of redundant states
        let shown = measured.most / unit * if local.feedback > 0.0 { 0.5 } else { 1.0 };
        let rounded = digits.most / (count as f64 * unit) * local.rounding;
        (shown + rounded + other, even.most / count as f64)
    }

    /// The dip of |w| before point `k`, `step` seconds after its predecessor.
    fn dip(&self, k: usize, step: f64) -> Option<[f64; 2]> {
        dip([self.across[k - 1], self.across[k]], [self.widening[k - 1], self.widening[k]], step)
    }

    /// Bounds of error and amplification from the growth of |eta|; weak if H turns by many radians.
    #[inline(always)]
    fn bound(&self, body: &Body<'_>, count: usize, largest: f64, local: &LocalErrors) -> (f64, f64) {
        let (mut exponent, mut fastest, mut stirred) = (0.0, 0.0_f64, 0.0);
        for k in 0..count {
            let step = if k == 0 { 0.0 } else { self.times[k] - self.times[k - 1] };
            let before = k.max(1) - 1;
            exponent += step * body.spread * self.momentum[k].larger(self.momentum[before]);
            stirred += step * (self.wheels[k] * self.rate[k]).larger(self.wheels[before] * self.rate[before]);
            fastest = fastest.larger(self.rate[k]);
        }
        let growth = if exponent < LARGEST_EXPONENT { libm::exp(exponent) } else { f64::INFINITY };
        // of omega, and the resulting angle
        let amplification = growth * (body.stiffness * body.size) * 1.0_f64.larger(largest * self.times[count - 1]);
        let shown = if body.offset.is_some() { self.shown(count) / (body.size * largest) } else { 0.0 };
        let turned = if body.is_principal { 1.0 } else { TURNED };
        let rounded = turned * local.rounding * (fastest / largest) + HALF_ROUNDING * stirred / (body.size * largest);
        (amplification * (shown + rounded + local.truncation + local.feedback), amplification)
    }

    /// Largest error of H, N m s, that constant |H| and energy show beyond rounding.
    fn shown(&self, count: usize) -> f64 {
        let mut most = 0.0_f64;
        for k in 0..count {
            let along = (self.square[k] - self.square[0]).abs() / (2.0 * self.momentum[k]);
            let across = (self.energy[k] - self.energy[0]).abs() / self.rate[k].larger(f64::MIN_POSITIVE);
            let noise =
                NOISE * (self.wheels[k] + self.momentum[k] + self.energy[0] / self.rate[k].larger(f64::MIN_POSITIVE));
            most = most.larger(along + across - noise);
        }
        most
    }

    /// Error and amplification about an equilibrium with omega along H, by the linear equations.
    fn at_equilibrium(
        &self,
        body: &Body<'_>,
        [count, stride, last]: [usize; 3],
        largest: f64,
        table: &StateTable,
        local: &LocalErrors,
    ) -> (f64, f64) {
        let duration = self.times[count - 1];
        let mut fastest = 0;
        for k in 0..count {
            fastest = if self.rate[k] > self.rate[fastest] { k } else { fastest };
        }
        let (h, mu) = (self.momentum[fastest], self.along[fastest]);
        let axis = table.at::<3>(body.rates, (fastest * stride).min(last)).map(|x| x / self.rate[fastest]);
        let mut a = body.inverse;
        let mut size = 0.0_f64;
        for (i, row) in a.iter_mut().enumerate() {
            row[i] -= mu;
            size = size.larger(dot(*row, *row).sqrt());
        }
        let square = -h * h * dot(axis, product(adjugate(a), axis));
        let drift = h * size * duration;
        let growth = if square > 0.0 {
            let exponent = square.sqrt() * duration;
            if exponent < LARGEST_EXPONENT { libm::exp(exponent) } else { MOST }
        } else {
            drift.smaller(h * size / (-square).sqrt().larger(f64::MIN_POSITIVE))
        };
        let unit = body.size * largest;
        let spread = 1.0_f64.larger((unit / h.larger(f64::MIN_POSITIVE)).smaller(largest * duration));
        let steady = 1.0 + largest * duration;
        // the states show that rounding has not grown beyond the limit of an equilibrium
        let shown = growth.smaller(STILL / f64::EPSILON);
        let amplification = steady + growth * spread;
        (local.rounding * (steady + shown * spread) + local.feedback * amplification, amplification)
    }
}

/// The smaller of an estimate and a bound; the bound for NaN.
#[inline(always)]
fn lesser(estimate: f64, bound: f64) -> f64 {
    if bound < estimate || estimate.is_nan() { bound } else { estimate }
}

#[inline(always)]
fn magnitudes_along<R: Real>(a: [R; 3], b: [R; 3]) -> R {
    (a[0] * b[0]).abs() + ((a[1] * b[1]).abs() + (a[2] * b[2]).abs())
}

#[inline(always)]
fn gathered<S: Simd>(simd: S, column: &[f64], points: &[usize; WIDTH]) -> Lanes<S> {
    let mut values = [0.0; WIDTH];
    for (value, point) in values.iter_mut().zip(points) {
        *value = column[*point];
    }
    Lanes::load(simd, &values)
}
