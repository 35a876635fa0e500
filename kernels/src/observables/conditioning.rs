//! [`Conditioning`]: the estimated error of a run, and how much the motion amplifies small errors of its rotational
//! state.
//!
//! With H = K omega + wheels' momentum in the body's frame and A = K^-1, a small error eta of H obeys eta' = eta x
//! omega + H x A eta. Without torque, H . eta and omega . eta are constant (the changes of |H|^2/2 and of the energy T;
//! Zhukovskii's gyrostat is integrable: V. Volterra, Acta Math. 22, 1899). The error across the curve of H follows from
//! them at any time; only the shift along the curve is integrated. With w the part of omega across H, and unit vectors
//! along H, w and v = H x w, eta = X H/|H| + Y w/|w| + Z v/|v|:
//!
//! ```text
//! X constant;   |w_i| Y_i = |w_k| Y_k + (mu_k - mu_i) |H| X,   mu = omega . H/|H|^2;   Z = alpha |H| |w|,
//! alpha' = X A_wH/|w| + Y (A_ww - A_vv)/|w|      (alpha: the shift in time, s)
//! ```
//!
//! Near an unstable equilibrium |w| stays small for a long time, and the shift grows like 1/|w|^2: that is the
//! separatrix. The error of the attitude across L follows from eta, since L is constant in F_e. The error about L is
//! the integral of H . A eta/|H|, in which the part of alpha, a derivative, is integrated by parts.
//! [`super::error_sums`] has the sums.
//!
//! The sums are made of:
//! - the change of |H|^2 and of T - mu_0 |H|^2/2 since point 0 beyond rounding: the effect of truncation on the
//!   invariants, of any method. The change of the second is |w| Y. mu_0 is mu where |w| is minimal: near a separatrix
//!   the second invariant is the distance from it;
//! - rounding of each component, which the states do not show;
//! - for a kernel whose other states feed back into omega, and for truncation near a separatrix, the errors that are
//!   too small to show in the invariants, and those along the curve;
//! - rounding of the wheels' momentum, which turns omega about it;
//! - where torque acts, and there are no invariants, the truncation that the method estimates, in proportion to |w|;
//!   |w| is taken as at least what the torque makes of it within a radian of rotation.
//!
//! Where H is small - at rest, and where the wheels' momenta cancel - no curve is well conditioned, but errors hardly
//! grow either: the growth of |eta| is the symmetric part of H x A, which is at most |H| s with s the distance of A
//! from a multiple of one. So |eta| is at most e^(integral of |H| s) times all that is made, and the attitude's error
//! at most |A| times the integral of that. This bound is computed beside the sums, with errors made at the start, and
//! the smaller of both is the estimate: there is no threshold between them. What is rounded is K omega, and the wheels'
//! momenta, sum |h_i|, in H x omega.
//!
//! Magnitudes are added, not signed numbers. Errors are assumed to arise evenly along the run.
//!
//! Not here: what the method itself knows of its errors ([`crate::run::Outcome::local_errors`]).

use fearless_simd::Simd;

use super::acting::Acting;
use super::error_sums::{Here, Sums, dip};
use super::rotor::{Body, adjugate};
use super::torque_growth::{self, LARGEST_EXPONENT, MOST};
use crate::dynamics::effects::ForceModel;
use crate::math::lanes::WIDTH;
use crate::math::vector::{constant, constant_matrix, cross, difference, dot, product, scaled, sum};
use crate::math::{Lanes, Real};
use crate::run::{LocalErrors, StateField, StateTable, rate_scale};

/// Maximum number of points of a run that are examined: enough to find the closest approach to a separatrix about as
/// often as it occurs, few enough that the cost is negligible compared with the run.
const POINTS: usize = 32;

/// The same near a separatrix, where |w| is small for most of the time and grows or falls by orders of magnitude
/// between the points.
const MOST_POINTS: usize = 128;

/// |w| varies by more than this factor near a separatrix.
const NEAR: f64 = 0.1;

/// A rate across H below this fraction of |omega| is rounding: the motion is an equilibrium.
const STILL: f64 = 1e-12;

/// Minimum of a rate across H as a fraction of |omega|: a tenth of rounding.
const LEAST: f64 = 1e-17;

/// The component along each of three axes of an error of magnitude one in a random direction: 1/sqrt(3).
const PER_AXIS: f64 = 0.577_350_269_189_625_8;

/// Safety factor on the sum of the contributions, from the runs of `tests/accuracy/error_estimate.rs`: with 1 the
/// estimate is below the true error in up to half of the runs of a family (mostly by a third), with 2 in less than one
/// of twenty.
const SAFETY: f64 = 2.0;

/// An estimate of half a turn means that nothing is known.
const LOST: f64 = core::f64::consts::PI;

/// Relative rounding of the energy of a state and of |H|^2.
const NOISE: f64 = 4.0 * f64::EPSILON;

/// Relative rounding of a wheel's momentum.
const HALF_ROUNDING: f64 = 0.5 * f64::EPSILON;

/// Factor on the rounding of a component where principal axes are computed first.
const TURNED: f64 = 4.0;

/// What is known of the errors of a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct ErrorEstimate {
    /// The estimated largest error of the rotational state: of omega over its [`rate_scale`], or of the attitude in
    /// rad.
    pub(super) error: f64,
    /// The largest factor by which relative errors of omega, made evenly along the run and in every direction, grow; at
    /// least one, at most 1e200.
    pub(super) amplification: f64,
}

impl ErrorEstimate {
    /// Of a run that was not observed.
    pub(super) const UNKNOWN: ErrorEstimate = ErrorEstimate { error: f64::NAN, amplification: f64::NAN };
}

/// The quantities that the sums use, at each examined point.
#[derive(Clone, Debug)]
pub(super) struct Conditioning {
    times: [f64; MOST_POINTS],
    /// The rate that errors of omega are relative to, rad/s.
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
    /// Magnitudes along H, w and v of the error of H that relative errors of omega's components cause, N m s.
    digits: [[f64; MOST_POINTS]; 3],
}

impl Conditioning {
    /// Memory for a run.
    pub(super) fn new() -> Self {
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

    /// The estimate for a run on which `acting` acts; `local` are the errors that the method estimates. `times` are
    /// those of the table's points; the first `filled` >= 1 have states.
    #[inline(always)]
    pub(super) fn estimate<S: Simd>(
        &mut self,
        simd: S,
        acting: Acting<'_>,
        table: &StateTable,
        times: &[f64],
        filled: usize,
        local: &LocalErrors,
    ) -> ErrorEstimate {
        let body = Body::of(acting, table, times[filled - 1]);
        let Some(growth) = torque_growth::growth(acting.scene(), table, times, filled) else {
            return self.estimate_of(simd, &body, Some(acting), table, times, filled, local);
        };
        let stirred = HALF_ROUNDING * growth.stirred;
        let local = LocalErrors { rounding: local.rounding + stirred, ..*local };
        let found = self.estimate_of(simd, &body, Some(acting), table, times, filled, &local);
        let Some(followed) = growth.followed else {
            let error = lesser(found.error * growth.beside, LOST);
            return ErrorEstimate { error, amplification: lesser(found.amplification * growth.beside, MOST) };
        };
        // a torque that pulls back is not relied upon
        let amplification = followed.larger(found.amplification);
        let made = local.truncation / self.scale + local.attitude + TURNED * local.rounding;
        ErrorEstimate { error: lesser(followed * made, LOST).larger(found.error), amplification }
    }

    /// The estimate for the debris, whose inertia is `inertia`; the rest as in [`Conditioning::estimate`].
    #[inline(always)]
    pub(super) fn estimate_debris<S: Simd>(
        &mut self,
        simd: S,
        inertia: [[f64; 3]; 3],
        table: &StateTable,
        times: &[f64],
        filled: usize,
        local: &LocalErrors,
    ) -> ErrorEstimate {
        self.estimate_of(simd, &Body::debris(inertia), None, table, times, filled, local)
    }

    #[expect(clippy::too_many_arguments, reason = "what both estimates have in common")]
    #[inline(always)]
    fn estimate_of<S: Simd>(
        &mut self,
        simd: S,
        body: &Body<'_>,
        acting: Option<Acting<'_>>,
        table: &StateTable,
        times: &[f64],
        filled: usize,
        local: &LocalErrors,
    ) -> ErrorEstimate {
        let last = filled - 1;
        let [mut stride, mut count] = self.examine(simd, body, (table, times), [POINTS, last]);
        let (mut largest, mut widest, mut narrowest) = (0.0_f64, 0.0_f64, f64::INFINITY);
        for k in 0..count {
            largest = largest.larger(self.rate[k]);
            widest = widest.larger(self.across[k]);
            narrowest = narrowest.smaller(self.across[k]);
        }
        let is_near = narrowest < NEAR * widest && widest > STILL * largest;
        if is_near && stride > 1 {
            [stride, count] = self.examine(simd, body, (table, times), [MOST_POINTS, last]);
        }
        if largest == 0.0 {
            return ErrorEstimate { error: SAFETY * (local.rounding + local.attitude), amplification: 1.0 };
        }
        let scale = rate_scale(largest, self.times[count - 1]);
        self.scale = scale;
        // relative to that, as all errors are from here on
        let local = LocalErrors { truncation: local.truncation / scale, feedback: local.feedback / scale, ..*local };
        // where the torque follows the attitude, a motion in a plane is none: what a step leaves out turns the body
        // further and further
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

    /// Fills entries for at most so many of the points up to `last`: the stride between them, and their number.
    #[inline(always)]
    fn examine<S: Simd>(
        &mut self,
        simd: S,
        body: &Body<'_>,
        (table, times): (&StateTable, &[f64]),
        [most, last]: [usize; 2],
    ) -> [usize; 2] {
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

    /// Fills eight entries from entry `first` on; entry k is the point `stride` k, at most `last`.
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
        // the effect of relative errors of the components on H: in the axes of integration, or of any component where
        // these axes are computed first
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

    /// Error and amplification of a motion along a curve.
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
        // errors are relative to omega: the momentum that corresponds to an error of one
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
                // a wheel's momentum turns omega by an angle that its rounding changes
                let turned = 0.5 * self.wheels[k] * here.w * duration;
                let made = [self.digits[0][k], self.digits[1][k], self.digits[2][k] + turned];
                digits.advance(here, made.map(|made| share * made));
                if is_driven {
                    other.advance(here, [PER_AXIS * here.w; 3]);
                    continue;
                }
                if NEAR || local.feedback > 0.0 {
                    // of errors across H only the part that the balance does not show
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

    /// The dip of |w| before the point `k`, which follows its predecessor by `step` seconds.
    fn dip(&self, k: usize, step: f64) -> Option<[f64; 2]> {
        dip([self.across[k - 1], self.across[k]], [self.widening[k - 1], self.widening[k]], step)
    }

    /// Bounds of error and amplification of any motion, from the growth of |eta|; of little use where H turns by many
    /// radians.
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
        // of omega, and the angle that it adds up to
        let amplification = growth * (body.stiffness * body.size) * 1.0_f64.larger(largest * self.times[count - 1]);
        let shown = if body.offset.is_some() { self.shown(count) / (body.size * largest) } else { 0.0 };
        let turned = if body.is_principal { 1.0 } else { TURNED };
        let rounded = turned * local.rounding * (fastest / largest) + HALF_ROUNDING * stirred / (body.size * largest);
        (amplification * (shown + rounded + local.truncation + local.feedback), amplification)
    }

    /// The largest error of H, N m s, that |H| and the energy show beyond their rounding where both are constant.
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

    /// Error and amplification about an equilibrium, where omega is along H and stays there: from the linear equations.
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
        // eta' = H x (A - mu) eta across H, whose determinant is that of A - mu restricted to this plane
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

/// The smaller of an estimate and a bound; the bound where the estimate is not a number.
#[inline(always)]
fn lesser(estimate: f64, bound: f64) -> f64 {
    if bound < estimate || estimate.is_nan() { bound } else { estimate }
}

/// sum |a_i b_i|.
#[inline(always)]
fn magnitudes_along<R: Real>(a: [R; 3], b: [R; 3]) -> R {
    (a[0] * b[0]).abs() + ((a[1] * b[1]).abs() + (a[2] * b[2]).abs())
}

/// The values of a column at eight points.
#[inline(always)]
fn gathered<S: Simd>(simd: S, column: &[f64], points: &[usize; WIDTH]) -> Lanes<S> {
    let mut values = [0.0; WIDTH];
    for (value, point) in values.iter_mut().zip(points) {
        *value = column[*point];
    }
    Lanes::load(simd, &values)
}
