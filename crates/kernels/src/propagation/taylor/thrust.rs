//! Integrals of thrust along a step, by Gauss quadrature of the attitude's series.
//!
//! Thrust turns with omega, the quaternion with omega/2: Taylor series of these integrals (impulse, its integral,
//! angular impulse, works) would need half the step and two more Cauchy products of quaternions. But the attitude is a
//! polynomial within a step: m Gauss-Legendre nodes integrate exp(i Omega t) over h to (Omega h)^2m (m!)^4/((2m+1)
//! (2m)!^3) (P. J. Davis & P. Rabinowitz, *Methods of Numerical Integration*, 2nd ed. 1984, section 2.7), with m for
//! the largest turn of a step. Force and torque are constant in B: the direction cosine matrix is integrated. A point
//! inside a step is reached from the nearer end, with the nodes for half a step.

use super::step::StepRule;
use crate::dynamics::gyrostat::equations::Constants;
use crate::dynamics::gyrostat::{
    ANGULAR_IMPULSE, ATTITUDE, IMPULSE, IMPULSE_INTEGRAL, MOTOR_WORK, THRUST_WORK, WITH_THRUST,
};
use crate::math::prelude::*;

/// Error of the quadrature, as a share of the tolerance.
const SHARE: f64 = 0.1;
/// Limit of nodes: more than the tightest tolerance in `f64` needs.
const MOST_NODES: usize = 12;

/// Nodes and weights of Gauss-Legendre quadrature on [0, 1].
#[derive(Clone, Debug, PartialEq)]
pub struct Quadrature<R> {
    /// Node and weight, for a step.
    step: Vec<(f64, f64)>,
    /// Node and weight, for half a step.
    half: Vec<(f64, f64)>,
    /// Scratch: the attitude at each node.
    attitudes: Vec<[R; 4]>,
}

/// Increments by thrust over an interval, F_e.
#[derive(Clone, Copy, Debug)]
pub struct Push<R> {
    /// Integral of the force.
    pub impulse: [R; 3],
    /// Integral of the impulse since the start of the interval.
    pub path: [R; 3],
    /// Integral of the torque.
    pub angular: [R; 3],
}

impl<R: Real> Quadrature<R> {
    /// The fewest nodes that integrate a turning vector over the largest step of `rule` to the tolerance.
    pub fn new(zero: R, rule: &StepRule, tolerance: f64) -> Self {
        let nodes = |turn: f64| -> Vec<(f64, f64)> {
            let enough = (2..MOST_NODES).find(|m| error(*m, turn) <= SHARE * tolerance).unwrap_or(MOST_NODES);
            (0..enough).map(|i| node(enough, i)).collect()
        };
        let (step, half) = (nodes(rule.largest_turn()), nodes(0.5 * rule.largest_turn()));
        let attitudes = vec![[zero; 4]; step.len()];
        Quadrature { step, half, attitudes }
    }

    /// Increments over a step of length `x` along the series `jet`.
    #[inline(always)]
    pub fn over_step<const J: usize>(&mut self, constants: &Constants<R>, jet: &[[R; J]], x: R) -> Push<R> {
        push(&self.step, &mut self.attitudes, constants, jet, [x.zero(), x])
    }

    /// Increments until `x` after the start of a step of length `length` with the increments `whole`.
    #[inline(always)]
    pub fn until<const J: usize>(
        &mut self,
        constants: &Constants<R>,
        jet: &[[R; J]],
        length: R,
        whole: &Push<R>,
        x: R,
    ) -> Push<R> {
        let rest = length - x;
        let late = rest.lt(x);
        let from = R::select(late, x, x.zero());
        let part = push(&self.half, &mut self.attitudes, constants, jet, [from, R::select(late, rest, x)]);
        let mut until = part;
        for i in 0..3 {
            let impulse = whole.impulse[i] - part.impulse[i];
            // whole.path = path + rest impulse + part.path
            let path = rest.neg_mul_add(impulse, whole.path[i] - part.path[i]);
            until.impulse[i] = R::select(late, impulse, part.impulse[i]);
            until.path[i] = R::select(late, path, part.path[i]);
            until.angular[i] = R::select(late, whole.angular[i] - part.angular[i], part.angular[i]);
        }
        until
    }
}

impl<R: Real> Push<R> {
    /// No thrust.
    #[inline(always)]
    pub fn none(zero: R) -> Self {
        Push { impulse: [zero; 3], path: [zero; 3], angular: [zero; 3] }
    }

    /// Increase of the components from [`MOTOR_WORK`] on, from the start of a step to `x` after it; zero in the others.
    ///
    /// `start` and `constants` hold at the start of the step; `angle` is the increase of the angle until `x`. The work
    /// of thrust needs no quadrature: Gauss collocation conserves quadratic invariants (J. M. Sanz-Serna, BIT 28,
    /// 1988), so that the sum of force times impulse over the nodes is half the change of the squared impulse.
    #[inline(always)]
    pub fn growth<const N: usize>(&self, constants: &Constants<R>, start: &[R; N], angle: [R; 3], x: R) -> [R; N] {
        let half = x.splat(0.5);
        let mut grown = [x.zero(); N];
        // tau_i Omega_i = tau_i h_i/J_i - tau_i a_i . omega: the first term is linear in time
        let driven = (half * constants.motor_power_rate).mul_add(x, constants.motor_power);
        grown[MOTOR_WORK] = driven.mul_add(x, -dot(constants.momentum_rate, angle));
        if N < WITH_THRUST {
            return grown;
        }
        let mut velocity = constants.velocity;
        for i in 0..3 {
            let before = start[IMPULSE + i];
            grown[IMPULSE + i] = self.impulse[i];
            grown[IMPULSE_INTEGRAL + i] = x.mul_add(before, self.path[i]);
            grown[ANGULAR_IMPULSE + i] = self.angular[i];
            velocity[i] = constants.inverse_mass.mul_add(half.mul_add(self.impulse[i], before), velocity[i]);
        }
        grown[THRUST_WORK] = dot(self.impulse, velocity) + dot(constants.torque, angle);
        grown
    }
}

/// Increments over `length` from `from` on, by the quadrature `nodes`.
#[inline(always)]
fn push<R: Real, const J: usize>(
    nodes: &[(f64, f64)],
    attitudes: &mut [[R; 4]],
    constants: &Constants<R>,
    jet: &[[R; J]],
    [from, length]: [R; 2],
) -> Push<R> {
    let zero = length.zero();
    for ((node, _), q) in nodes.iter().zip(&mut *attitudes) {
        *q = attitude(jet, length.splat(*node).mul_add(length, from));
    }
    // one after the other: the registers hold ten sums of two vectors, not twenty
    let (mut turned, mut moment) = (AttitudeProducts::none(zero), AttitudeProducts::none(zero));
    for ((_, weight), q) in nodes.iter().zip(&*attitudes) {
        turned.add(zero.splat(*weight), q);
    }
    for ((node, weight), q) in nodes.iter().zip(&*attitudes) {
        moment.add(zero.splat(weight * (1.0 - node)), q);
    }
    let (turned, moment) = (turned.dcm(), moment.dcm());
    Push {
        impulse: scaled(length, product(turned, constants.force)),
        path: scaled(length * length, product(moment, constants.force)),
        angular: scaled(length, product(turned, constants.torque)),
    }
}

/// Weighted sums of the products of a quaternion's components.
struct AttitudeProducts<R> {
    /// q0^2, q1^2, q2^2, q3^2.
    squares: [R; 4],
    /// q0 q1, q0 q2, q0 q3.
    scalar: [R; 3],
    /// q2 q3, q3 q1, q1 q2.
    vector: [R; 3],
}

impl<R: Real> AttitudeProducts<R> {
    #[inline(always)]
    fn none(zero: R) -> Self {
        AttitudeProducts { squares: [zero; 4], scalar: [zero; 3], vector: [zero; 3] }
    }

    #[inline(always)]
    fn add(&mut self, weight: R, q: &[R; 4]) {
        let weighted = [weight * q[0], weight * q[1], weight * q[2], weight * q[3]];
        for i in 0..4 {
            self.squares[i] = weighted[i].mul_add(q[i], self.squares[i]);
        }
        for i in 0..3 {
            let (a, b) = (1 + (i + 1) % 3, 1 + (i + 2) % 3);
            self.scalar[i] = weighted[0].mul_add(q[1 + i], self.scalar[i]);
            self.vector[i] = weighted[a].mul_add(q[b], self.vector[i]);
        }
    }

    /// Weighted sum of the direction cosine matrices, by rows ([`crate::math::vector::dcm_from_quaternion`]).
    #[inline(always)]
    fn dcm(&self) -> [[R; 3]; 3] {
        let [ww, xx, yy, zz] = self.squares;
        let ([wx, wy, wz], [yz, zx, xy]) = (self.scalar, self.vector);
        let two = ww.splat(2.0);
        [
            [(ww + xx) - (yy + zz), two * (xy - wz), two * (zx + wy)],
            [two * (xy + wz), (ww + yy) - (xx + zz), two * (yz - wx)],
            [two * (zx - wy), two * (yz + wx), (ww + zz) - (xx + yy)],
        ]
    }
}

#[inline(always)]
fn attitude<R: Real, const J: usize>(jet: &[[R; J]], x: R) -> [R; 4] {
    let mut q = four(&jet[jet.len() - 1], ATTITUDE);
    for coefficients in jet[..jet.len() - 1].iter().rev() {
        for i in 0..4 {
            q[i] = q[i].mul_add(x, coefficients[ATTITUDE + i]);
        }
    }
    q
}

/// Relative error of the m-point rule for exp(i Omega t) over a turn of `turn`.
fn error(m: usize, turn: f64) -> f64 {
    let factorial = |n: usize| (1..=n).map(|k| k as f64).product::<f64>();
    let power = libm::pow(turn, 2.0 * m as f64);
    let double = factorial(2 * m);
    power * libm::pow(factorial(m), 4.0) / ((2.0 * m as f64 + 1.0) * double * double * double)
}

/// Node `i` of the m-point rule on [0, 1] and its weight: Newton's method on the Legendre polynomial.
fn node(m: usize, i: usize) -> (f64, f64) {
    let legendre = |x: f64| {
        let (mut before, mut value) = (1.0, x);
        for n in 1..m {
            let next = ((2 * n + 1) as f64 * x * value - n as f64 * before) / (n + 1) as f64;
            (before, value) = (value, next);
        }
        (value, m as f64 * (before - x * value) / (1.0 - x * x))
    };
    // F. G. Tricomi's initial guess (Ann. Mat. Pura Appl. 31, 1950)
    let mut x = libm::cos(core::f64::consts::PI * (i as f64 + 0.75) / (m as f64 + 0.5));
    for _ in 0..8 {
        let (value, slope) = legendre(x);
        x -= value / slope;
    }
    let (_, slope) = legendre(x);
    (0.5 * (1.0 - x), 1.0 / ((1.0 - x * x) * slope * slope))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rules_integrate_polynomials_of_degree_2m_minus_1() {
        for m in 2..=MOST_NODES {
            for degree in 0..2 * m {
                let sum: f64 = (0..m).map(|i| node(m, i)).map(|(x, w)| w * libm::pow(x, degree as f64)).sum();
                let exact = 1.0 / (degree as f64 + 1.0);
                assert!((sum - exact).abs() < 3e-15, "{m} nodes, degree {degree}: {sum}");
            }
            // but not of the next degree: the test can fail
            let sum: f64 = (0..m).map(|i| node(m, i)).map(|(x, w)| w * libm::pow(x, 2.0 * m as f64)).sum();
            assert!(m > 8 || (sum - 1.0 / (2.0 * m as f64 + 1.0)).abs() > 1e-13, "{m} nodes");
        }
    }
}
