//! Taylor coefficients of the gyrostat's motion ([`crate::dynamics::gyrostat`]) by recurrences.
//!
//! All equations are quadratic: the coefficient of order n + 1 is a Cauchy product of those up to n, divided by n + 1
//! (R. E. Moore, *Interval Analysis*, 1966, ch. 11; A. Jorba & M. Zou, Experimental Mathematics 14, 2005, section 2).
//! The recurrences of thrust serve [`super::reference_solution`] alone; integration in `f64` uses [`super::thrust`], so
//! that each tests the other. Under effects the angular impulse since the start of a step is a series in B, where it
//! needs one cross product of series: with the torque tau, a' = tau - omega x a.

use crate::dynamics::effects::ChangingSeries;
use crate::dynamics::gyrostat::equations::Constants;
use crate::dynamics::gyrostat::{
    ANGLE, ANGULAR_IMPULSE, ATTITUDE, IMPULSE, IMPULSE_INTEGRAL, MOTOR_WORK, OMEGA, THRUST_WORK, WITH_ANGLES,
    WITH_ATTITUDE, WITH_MOTORS, WITH_THRUST,
};
use crate::math::prelude::*;
use crate::math::{Mask, Real};

/// Largest order of a jet: 22 for a tolerance of 1e-16, twice that for double-double.
pub const MAX_ORDER: usize = 40;

/// 1/n as a sum of two `Real`, n = 1 ..= order. A rounded 1/n errs in the same direction in every step: the
/// quaternion's norm grew by 2e-17 per step (`tests/accuracy/round_off.rs`).
#[derive(Clone, Debug)]
pub struct Reciprocals<R>(Vec<[R; 2]>);

impl<R: Real> Reciprocals<R> {
    /// The table up to 1/(`order`); entry zero is unused.
    pub fn new(zero: R, order: usize) -> Self {
        let one = zero.splat(1.0);
        let pair = |n: usize| {
            let divisor = zero.splat(n as f64);
            let high = one / divisor;
            [high, (-high).mul_add(divisor, one) / divisor]
        };
        Reciprocals((0..=order).map(|n| if n == 0 { [zero; 2] } else { pair(n) }).collect())
    }
}

#[derive(Clone, Debug)]
pub struct Scratch<R> {
    /// q (x) F.
    turned_force: [[R; 4]; MAX_ORDER],
    /// q (x) tau.
    turned_torque: [[R; 4]; MAX_ORDER],
    force_e: [[R; 3]; MAX_ORDER],
}

impl<R: Real> Scratch<R> {
    pub fn new(zero: R) -> Self {
        Scratch {
            turned_force: [[zero; 4]; MAX_ORDER],
            turned_torque: [[zero; 4]; MAX_ORDER],
            force_e: [[zero; 3]; MAX_ORDER],
        }
    }
}

/// Fills `jet[1 ..= order]` with the Taylor coefficients of the first `N` components from the state `jet[0]`.
///
/// `constants.momentum` is the wheels' momentum *at the start of the step*, where `effects` have begun. Without
/// `FORCED`, torques, thrusts and the rate of the momentum are zero. With `effects`, [`turn_impulse`] is due.
#[inline(always)]
pub fn expand<R: Real, const N: usize, const FORCED: bool>(
    constants: &Constants<R>,
    reciprocals: &Reciprocals<R>,
    order: usize,
    scratch: &mut Scratch<R>,
    mut effects: Option<&mut ChangingSeries<R>>,
    jet: &mut [[R; N]],
) {
    let jet = &mut jet[..=order];
    let reciprocal = &reciprocals.0[..=order];
    let zero = jet[0][0].zero();
    let half = zero.splat(0.5);
    let Scratch { turned_force, turned_torque, force_e } = scratch;
    if N >= WITH_THRUST && effects.is_some() {
        jet[0][ANGULAR_IMPULSE..ANGULAR_IMPULSE + 3].fill(zero);
    }
    // without effects an arc has a force, a torque or both: effects exert torques only
    let [x, y, z] = constants.force;
    let is_pushed = effects.is_none() || zero.lt(x.abs() + (y.abs() + z.abs())).any();
    for n in 0..order {
        let [inverse, inverse_low] = reciprocal[n + 1];
        let omega = three(&jet[n], OMEGA);
        let sums = cauchy_products(jet, n);
        let mut acceleration = angular_acceleration::<R, N, FORCED>(constants, jet, n, sums.rate);
        if let Some(effects) = &mut effects {
            let (attitude, offset) = (four(&jet[n], ATTITUDE), offset_of(constants, &jet[n]));
            let torque = effects.extend(n, attitude, omega, offset, constants.torque);
            for i in 0..3 {
                acceleration[i] = constants.inverse[i].mul_add(torque[i], acceleration[i]);
            }
        }
        let mut next = [zero; N];
        for i in 0..3 {
            next[OMEGA + i] = acceleration[i].mul_add(inverse, acceleration[i] * inverse_low);
        }
        if N >= WITH_ATTITUDE {
            // q' = q (x) omega/2: multiplication by one half is exact
            let (half_inverse, half_low) = (half * inverse, half * inverse_low);
            for i in 0..4 {
                next[ATTITUDE + i] = sums.attitude[i].mul_add(half_inverse, sums.attitude[i] * half_low);
            }
        }
        if N >= WITH_ANGLES {
            for i in 0..3 {
                next[ANGLE + i] = omega[i] * inverse;
            }
        }
        if N >= WITH_MOTORS && FORCED {
            let driven = match n {
                0 => constants.motor_power,
                1 => constants.motor_power_rate,
                _ => zero,
            };
            next[MOTOR_WORK] = (driven - dot(constants.momentum_rate, omega)) * inverse;
        }
        if N >= WITH_THRUST && FORCED {
            let q = four(&jet[n], ATTITUDE);
            let (torque, spun) = match &effects {
                Some(effects) => products_of_torque(jet, effects.torque(), n),
                None => {
                    turned_torque[n] = quaternion_products(q, constants.torque, [zero; 4]);
                    (turned(jet, turned_torque, n), dot(constants.torque, omega))
                }
            };
            let (mut force, mut push) = ([zero; 3], zero);
            if is_pushed {
                turned_force[n] = quaternion_products(q, constants.force, [zero; 4]);
                force_e[n] = turned(jet, turned_force, n);
                force = force_e[n];
                push = thrust_power(constants, jet, force_e, n);
            }
            if let Some(motion) = effects.as_ref().map(|effects| &effects.motion)
                && let Some(tide) = motion.tide(n)
            {
                for i in 0..3 {
                    force[i] = constants.mass.mul_add(tide[i], force[i]);
                }
                if is_pushed {
                    push += carried_power(motion.reference().position(), force_e, n);
                }
            }
            for i in 0..3 {
                next[IMPULSE + i] = force[i] * inverse;
                next[IMPULSE_INTEGRAL + i] = jet[n][IMPULSE + i] * inverse;
                next[ANGULAR_IMPULSE + i] = torque[i] * inverse;
            }
            next[THRUST_WORK] = (push + spun) * inverse;
        }
        jet[n + 1] = next;
    }
}

#[inline(always)]
fn offset_of<R: Real, const N: usize>(constants: &Constants<R>, coefficients: &[R; N]) -> [R; 3] {
    if N < WITH_THRUST {
        return [constants.inverse_mass.zero(); 3];
    }
    scaled(constants.inverse_mass, three(coefficients, IMPULSE_INTEGRAL))
}

/// Coefficients n of tau - omega x a and tau . omega, with the torque tau in B.
#[inline(always)]
fn products_of_torque<R: Real, const N: usize>(jet: &[[R; N]], torque: &[[R; 3]], n: usize) -> ([R; 3], R) {
    let (mut all, mut spun) = (torque[n], [jet[0][0].zero(); 3]);
    for ((torque, later), earlier) in torque[..=n].iter().zip(&jet[..=n]).zip(jet[..=n].iter().rev()) {
        let omega = three(earlier, OMEGA);
        all = minus_cross(omega, three(later, ANGULAR_IMPULSE), all);
        for i in 0..3 {
            spun[i] = torque[i].mul_add(omega[i], spun[i]);
        }
    }
    (all, spun[0] + (spun[1] + spun[2]))
}

/// Turns the angular impulse since the start of a step from B to F_e at the attitude `q_eb`.
#[inline(always)]
pub fn turn_impulse<R: Real, const N: usize>(q_eb: [R; 4], components: &mut [R; N]) {
    let turned = product(dcm_from_quaternion(q_eb), three(components, ANGULAR_IMPULSE));
    components[ANGULAR_IMPULSE..ANGULAR_IMPULSE + 3].copy_from_slice(&turned);
}

/// Coefficient n of omega' = ratio omega omega + (h x omega + torque - h')/J, from the products of two rates.
#[inline(always)]
fn angular_acceleration<R: Real, const N: usize, const FORCED: bool>(
    constants: &Constants<R>,
    jet: &[[R; N]],
    n: usize,
    products: [R; 3],
) -> [R; 3] {
    let zero = jet[0][0].zero();
    let omega = three(&jet[n], OMEGA);
    let mut linear = cross(constants.momentum, omega);
    if FORCED {
        if n == 0 {
            for i in 0..3 {
                linear[i] += constants.torque[i] - constants.momentum_rate[i];
            }
        } else {
            let turning = cross(constants.momentum_rate, three(&jet[n - 1], OMEGA));
            for i in 0..3 {
                linear[i] += turning[i];
            }
        }
    }
    let mut acceleration = [zero; 3];
    for i in 0..3 {
        acceleration[i] = constants.ratio[i].mul_add(products[i], constants.inverse[i] * linear[i]);
    }
    acceleration
}

/// Coefficients of products of series.
struct Sums<R> {
    /// omega_2 omega_3 and cyclic.
    rate: [R; 3],
    /// q (x) omega.
    attitude: [R; 4],
}

/// Coefficient n of the products needed by the first `N` components, in one pass: ten loads feed fifteen fused
/// operations. Products with the latest coefficient come last, so that the others need not wait for it.
#[inline(always)]
fn cauchy_products<R: Real, const N: usize>(jet: &[[R; N]], n: usize) -> Sums<R> {
    let zero = jet[0][0].zero();
    let mut even = [zero; 3];
    let mut odd = [zero; 3];
    let mut attitude = [zero; 4];
    let middle = &jet[n.min(1)..n];
    let mut pairs = middle.iter().zip(middle.iter().rev());
    while let Some((a, b)) = pairs.next() {
        odd = rate_products(a, b, odd);
        attitude = attitude_products(a, b, attitude);
        if let Some((a, b)) = pairs.next() {
            even = rate_products(a, b, even);
            attitude = attitude_products(a, b, attitude);
        }
    }
    let (first, last) = (&jet[0], &jet[n]);
    even = rate_products(first, last, even);
    attitude = attitude_products(first, last, attitude);
    if n > 0 {
        odd = rate_products(last, first, odd);
        attitude = attitude_products(last, first, attitude);
    }
    Sums { rate: [even[0] + odd[0], even[1] + odd[1], even[2] + odd[2]], attitude }
}

/// `sum` plus products of unlike components of two rates.
#[inline(always)]
fn rate_products<R: Real, const N: usize>(a: &[R; N], b: &[R; N], sum: [R; 3]) -> [R; 3] {
    [a[1].mul_add(b[2], sum[0]), a[2].mul_add(b[0], sum[1]), a[0].mul_add(b[1], sum[2])]
}

/// `sum` plus q (x) omega, q from `a`, omega from `b`.
#[inline(always)]
fn attitude_products<R: Real, const N: usize>(a: &[R; N], b: &[R; N], sum: [R; 4]) -> [R; 4] {
    if N < WITH_ATTITUDE {
        return sum;
    }
    quaternion_products(four(a, ATTITUDE), three(b, OMEGA), sum)
}

/// `sum` plus q (x) v.
#[inline(always)]
fn quaternion_products<R: Real>([q0, q1, q2, q3]: [R; 4], [o1, o2, o3]: [R; 3], sum: [R; 4]) -> [R; 4] {
    let [mut w, mut x, mut y, mut z] = sum;
    w = q1.neg_mul_add(o1, w);
    x = q0.mul_add(o1, x);
    y = q0.mul_add(o2, y);
    z = q0.mul_add(o3, z);
    w = q2.neg_mul_add(o2, w);
    x = q2.mul_add(o3, x);
    y = q3.mul_add(o1, y);
    z = q1.mul_add(o2, z);
    w = q3.neg_mul_add(o3, w);
    x = q3.neg_mul_add(o2, x);
    y = q1.neg_mul_add(o3, y);
    z = q2.neg_mul_add(o1, z);
    [w, x, y, z]
}

/// Coefficient n of the vector part of g (x) q* with g = q (x) v: the vector v of B in F_e.
#[inline(always)]
fn turned<R: Real, const N: usize>(jet: &[[R; N]], g: &[[R; 4]; MAX_ORDER], n: usize) -> [R; 3] {
    let zero = jet[0][0].zero();
    let (mut a, mut b, mut c) = (zero, zero, zero);
    for (coefficient, g) in jet[..=n].iter().zip(g[..=n].iter().rev()) {
        let [q0, q1, q2, q3] = four(coefficient, ATTITUDE);
        a = q0.mul_add(g[1], a);
        b = q0.mul_add(g[2], b);
        c = q0.mul_add(g[3], c);
        a = q1.neg_mul_add(g[0], a);
        b = q1.neg_mul_add(g[3], b);
        c = q1.mul_add(g[2], c);
        a = q2.mul_add(g[3], a);
        b = q2.neg_mul_add(g[0], b);
        c = q2.neg_mul_add(g[1], c);
        a = q3.neg_mul_add(g[2], a);
        b = q3.mul_add(g[1], b);
        c = q3.neg_mul_add(g[0], c);
    }
    [a, b, c]
}

/// Coefficient n of force times velocity of the point on the orbit, whose position is `orbit`.
#[inline(always)]
fn carried_power<R: Real>(orbit: &[[R; 3]], force_e: &[[R; 3]; MAX_ORDER], n: usize) -> R {
    let zero = orbit[0][0].zero();
    (0..=n).fold(zero, |sum, m| zero.splat((n - m + 1) as f64).mul_add(dot(force_e[m], orbit[n - m + 1]), sum))
}

/// Coefficient n of F_e . v_c, with the velocity relative to the point on an orbit.
#[inline(always)]
fn thrust_power<R: Real, const N: usize>(
    constants: &Constants<R>,
    jet: &[[R; N]],
    force_e: &[[R; 3]; MAX_ORDER],
    n: usize,
) -> R {
    let zero = jet[0][0].zero();
    // impulse . force first, then the constant initial velocity
    let mut sums = [zero; 3];
    for m in 0..=n {
        for i in 0..3 {
            sums[i] = force_e[m][i].mul_add(jet[n - m][IMPULSE + i], sums[i]);
        }
    }
    let pushed = sums[0] + sums[1] + sums[2];
    constants.inverse_mass.mul_add(pushed, dot(constants.velocity, force_e[n]))
}
