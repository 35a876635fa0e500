//! Integrals of the thrust along a step, by Gauss quadrature of the attitude's own series.
//!
//! A thrust turns with omega where the quaternion turns with omega/2: as Taylor series these integrals (impulse, its own
//! integral, angular impulse, works) would need half the step, and two more Cauchy products of quaternions. But within a step the
//! attitude is known as a polynomial, exact to the tolerance, so the integrals are taken from it at the nodes of
//! Gauss-Legendre quadrature: m nodes integrate exp(i Omega t) over h to (Omega h)^2m (m!)^4/((2m+1) (2m)!^3)
//! (P. J. Davis & P. Rabinowitz, *Methods of Numerical Integration*, 2nd ed. 1984, section 2.7), and m is chosen from the
//! largest turn that a step may have. An observation point inside a step is the end of a shorter one.

use super::step::StepRule;
use crate::dynamics::gyrostat::equations::Constants;
use crate::dynamics::gyrostat::{
    ANGLE, ANGULAR_IMPULSE, ATTITUDE, IMPULSE, IMPULSE_INTEGRAL, MOTOR_WORK, THRUST_WORK, WITH_THRUST,
};
use crate::math::Real;
use crate::math::vector::{dcm_from_quaternion, dot, product};

/// Error of the quadrature, as a share of the tolerance.
const SHARE: f64 = 0.1;
/// Largest number of nodes: more than the tightest tolerance in `f64` needs.
const MOST_NODES: usize = 12;

/// Nodes and weights of Gauss-Legendre quadrature on [0, 1].
#[derive(Clone, Debug, PartialEq)]
pub struct Quadrature {
    /// Node and weight.
    nodes: Vec<(f64, f64)>,
}

impl Quadrature {
    /// The smallest number of nodes that integrates a turning vector over the largest step of `rule` to the tolerance.
    pub fn new(rule: &StepRule, tolerance: f64) -> Self {
        let turn = rule.largest_turn();
        let mut count = 2;
        while count < MOST_NODES && error(count, turn) > SHARE * tolerance {
            count += 1;
        }
        Quadrature { nodes: (0..count).map(|i| node(count, i)).collect() }
    }

    /// Number of nodes.
    pub fn count(&self) -> usize {
        self.nodes.len()
    }

    /// The increase of the components from [`MOTOR_WORK`] on from the start of a step to `x` after it, zero in the others.
    ///
    /// `jet` has at least the series of rate, attitude and angle; `start` is the whole state at the start of the step, and
    /// `angle` the increase of the angle until `x`. `constants` are those of the start of the step.
    ///
    /// Only `N` = [`WITH_THRUST`] has the components of thrust. Their work needs no quadrature of its own: Gauss collocation
    /// conserves quadratic invariants (J. M. Sanz-Serna, BIT 28, 1988), so that the sum over the nodes of force times
    /// impulse is half the change of the impulse's square.
    #[inline(always)]
    pub fn growth<R: Real, const N: usize, const J: usize>(
        &self,
        constants: &Constants<R>,
        jet: &[[R; J]],
        start: &[R; N],
        angle: [R; 3],
        x: R,
    ) -> [R; N] {
        let zero = x.zero();
        let half = x.splat(0.5);
        let mut grown = [zero; N];
        // tau_i Omega_i = tau_i h_i/J_i - tau_i a_i . omega: the first term is linear in time
        let driven = (half * constants.motor_power_rate).mul_add(x, constants.motor_power);
        grown[MOTOR_WORK] = driven.mul_add(x, -dot(constants.momentum_rate, angle));
        if N < WITH_THRUST {
            return grown;
        }
        let (mut force_sum, mut force_moment, mut torque_sum) = ([zero; 3], [zero; 3], [zero; 3]);
        for (node, weight) in &self.nodes {
            let q = attitude(jet, x.splat(*node) * x);
            let c_eb = dcm_from_quaternion(q);
            let (force_e, torque_e) = (product(c_eb, constants.force), product(c_eb, constants.torque));
            let (weight, moment) = (x.splat(*weight), x.splat(weight * (1.0 - node)));
            for i in 0..3 {
                force_sum[i] = weight.mul_add(force_e[i], force_sum[i]);
                force_moment[i] = moment.mul_add(force_e[i], force_moment[i]);
                torque_sum[i] = weight.mul_add(torque_e[i], torque_sum[i]);
            }
        }
        let mut velocity = constants.velocity;
        for i in 0..3 {
            let pushed = x * force_sum[i];
            let before = start[IMPULSE + i];
            grown[IMPULSE + i] = pushed;
            grown[IMPULSE_INTEGRAL + i] = x * x.mul_add(force_moment[i], before);
            grown[ANGULAR_IMPULSE + i] = x * torque_sum[i];
            velocity[i] = constants.inverse_mass.mul_add(half.mul_add(pushed, before), velocity[i]);
        }
        let pushed = [grown[IMPULSE], grown[IMPULSE + 1], grown[IMPULSE + 2]];
        grown[THRUST_WORK] = dot(pushed, velocity) + dot(constants.torque, angle);
        grown
    }
}

/// The attitude's series at `x`.
#[inline(always)]
fn attitude<R: Real, const J: usize>(jet: &[[R; J]], x: R) -> [R; 4] {
    let last = &jet[jet.len() - 1];
    let mut q = [last[ATTITUDE], last[ATTITUDE + 1], last[ATTITUDE + 2], last[ATTITUDE + 3]];
    for coefficients in jet[..jet.len() - 1].iter().rev() {
        for i in 0..4 {
            q[i] = q[i].mul_add(x, coefficients[ATTITUDE + i]);
        }
    }
    q
}

/// Angle components of a state.
#[inline(always)]
pub fn angle_of<R: Real, const N: usize>(state: &[R; N]) -> [R; 3] {
    [state[ANGLE], state[ANGLE + 1], state[ANGLE + 2]]
}

/// Relative error of the m-point rule for exp(i Omega t) over a step in which it turns by `turn`.
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
    // F. G. Tricomi's first guess (Ann. Mat. Pura Appl. 31, 1950)
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
                // roundings of up to sixteen terms below one; measured: 3.3e-16
                assert!((sum - exact).abs() < 3e-15, "{m} nodes, degree {degree}: {sum}");
            }
            // but not of the next degree: the test above can fail
            let sum: f64 = (0..m).map(|i| node(m, i)).map(|(x, w)| w * libm::pow(x, 2.0 * m as f64)).sum();
            assert!(m > 8 || (sum - 1.0 / (2.0 * m as f64 + 1.0)).abs() > 1e-13, "{m} nodes");
        }
    }

    #[test]
    fn the_error_of_a_turning_vector_is_the_stated_one() {
        for (m, turn) in [(3, 1.0), (5, 2.0), (6, 3.0)] {
            let rule = Quadrature { nodes: (0..m).map(|i| node(m, i)).collect() };
            let sum: f64 = rule.nodes.iter().map(|(x, w)| w * libm::cos(turn * (x - 0.5))).sum();
            let exact = 2.0 / turn * libm::sin(0.5 * turn);
            let ratio = (sum - exact).abs() / error(m, turn);
            assert!((0.5..1.1).contains(&ratio), "{m} nodes over {turn}: {ratio}");
        }
    }

    #[test]
    fn nodes_follow_the_tolerance() {
        for (tolerance, count) in [(1e-4, 4), (1e-8, 6), (1e-12, 7), (1e-16, 9)] {
            let rule = StepRule::new(tolerance);
            assert_eq!(Quadrature::new(&rule, tolerance).count(), count, "{tolerance}");
        }
    }
}
