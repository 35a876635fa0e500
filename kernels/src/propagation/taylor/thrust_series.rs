//! [`ThrustSeries`]: the integrals of the thrust within one step as Legendre series, for steps with many observation points.
//!
//! A step with a few points integrates from its start to each ([`super::thrust`]). With more of them it is cheaper to expand the force and the torque in
//! F_e in Legendre polynomials over the step, from their values at Gauss nodes, and to integrate term by term:
//! the integral of P_k over [0, 1] up to a point is (P_(k+1) - P_(k-1))/(2 (2k+1)). Within a step Gauss nodes do not integrate twice as many orders as
//! between its ends, so there are more of them: a vector that turns by `turn` in the step has coefficients (2k+1) j_k(turn/2), and the first
//! one left out is about (2k+1) (turn/2)^k/(2k+1)!! (M. Abramowitz & I. Stegun, 1964, 10.1.2 and 10.1.47).

use super::step::StepRule;
use super::thrust::{SHARE, attitude, node};
use crate::dynamics::gyrostat::IMPULSE;
use crate::dynamics::gyrostat::equations::Constants;
use crate::math::Real;
use crate::math::vector::{dcm_from_quaternion, product};

/// Points in a step from which on the series costs less than an integration to each of them.
pub const MANY: usize = 5;

/// Largest number of nodes: more than the tightest tolerance in `f64` needs.
const MOST_NODES: usize = 24;

/// The series of one step in lanes, and the rule that makes them.
#[derive(Clone, Debug)]
pub struct ThrustSeries<R> {
    /// Nodes on [0, 1], and of each the weights for the coefficients: (2k+1) P_k times the weight of the rule.
    nodes: Vec<(f64, Vec<f64>)>,
    /// One over the length of the step.
    per_length: R,
    length: R,
    /// Coefficients of the force and of the torque, in F_e.
    acting: [Vec<[R; 3]>; 2],
    /// Those of the integrals over [0, 1] up to a point: of the force, of that again, and of the torque.
    integrals: [Vec<[R; 3]>; 3],
}

impl<R: Real> ThrustSeries<R> {
    /// Memory for the steps of `rule`, whose coefficients beyond the last are far below `tolerance`.
    pub fn new(zero: R, rule: &StepRule, tolerance: f64) -> Self {
        let half = 0.5 * rule.largest_turn();
        let (mut count, mut left_out) = (0, 1.0);
        while count < MOST_NODES && (count < 3 || left_out > SHARE * tolerance) {
            count += 1;
            left_out *= half / (2 * count + 1) as f64;
        }
        let weights = |(x, weight): (f64, f64)| {
            let polynomials = legendre(2.0 * x - 1.0, count);
            (x, polynomials.iter().enumerate().map(|(k, p)| weight * (2 * k + 1) as f64 * p).collect())
        };
        ThrustSeries {
            nodes: (0..count).map(|i| weights(node(count, i))).collect(),
            per_length: zero,
            length: zero,
            acting: [vec![[zero; 3]; count], vec![[zero; 3]; count]],
            integrals: [vec![[zero; 3]; count + 2], vec![[zero; 3]; count + 2], vec![[zero; 3]; count + 2]],
        }
    }

    /// Number of nodes.
    pub fn count(&self) -> usize {
        self.nodes.len()
    }

    /// Expands force and torque of a step of length `length` along the series `jet`; `constants` are those of its start.
    #[inline(always)]
    pub fn expand<const J: usize>(&mut self, constants: &Constants<R>, jet: &[[R; J]], length: R) {
        let zero = length.zero();
        let [force, torque] = &mut self.acting;
        force.fill([zero; 3]);
        torque.fill([zero; 3]);
        for (node, weights) in &self.nodes {
            let c_eb = dcm_from_quaternion(attitude(jet, zero.splat(*node) * length));
            let (force_e, torque_e) = (product(c_eb, constants.force), product(c_eb, constants.torque));
            for ((force, torque), weight) in force.iter_mut().zip(torque.iter_mut()).zip(weights) {
                let weight = zero.splat(*weight);
                for i in 0..3 {
                    force[i] = weight.mul_add(force_e[i], force[i]);
                    torque[i] = weight.mul_add(torque_e[i], torque[i]);
                }
            }
        }
        let count = force.len();
        let [pushed, path, turned] = &mut self.integrals;
        integrate(force, &mut pushed[..=count]);
        integrate(&pushed[..=count], path);
        integrate(torque, &mut turned[..=count]);
        (self.length, self.per_length) = (length, zero.splat(1.0) / length);
    }

    /// The increase from the start of the step, where the state is `start`, to `x` after it: of the impulse, of its integral, and of the angular impulse.
    #[inline(always)]
    pub fn growth<const N: usize>(&self, start: &[R; N], x: R) -> [[R; 3]; 3] {
        let zero = x.zero();
        let one = x.splat(1.0);
        let share = x * self.per_length;
        let z = share + (share - one);
        let (mut before, mut polynomial) = (zero, one);
        let mut sums = [[zero; 3]; 3];
        for k in 0..self.count() + 2 {
            for (sum, series) in sums.iter_mut().zip(&self.integrals) {
                for i in 0..3 {
                    sum[i] = series[k][i].mul_add(polynomial, sum[i]);
                }
            }
            let (rise, fall) = ((2 * k + 1) as f64 / (k + 1) as f64, k as f64 / (k + 1) as f64);
            let next = (x.splat(rise) * z).mul_add(polynomial, -(x.splat(fall) * before));
            (before, polynomial) = (polynomial, next);
        }
        let square = self.length * self.length;
        for i in 0..3 {
            sums[0][i] = sums[0][i] * self.length;
            sums[1][i] = x.mul_add(start[IMPULSE + i], sums[1][i] * square);
            sums[2][i] = sums[2][i] * self.length;
        }
        sums
    }
}

/// The coefficients of the integral, from zero on, of the series `of` on [0, 1].
#[inline(always)]
fn integrate<R: Real>(of: &[[R; 3]], integral: &mut [[R; 3]]) {
    for (k, coefficient) in integral.iter_mut().enumerate() {
        for i in 0..3 {
            let zero = coefficient[i].zero();
            let half = |n: usize| zero.splat(0.5 / n as f64);
            // P_0 is its own predecessor: its integral is (P_1 + P_0)/2
            let rising = of[k.saturating_sub(1)][i] * half(if k == 0 { 1 } else { 2 * k - 1 });
            coefficient[i] = match of.get(k + 1) {
                Some(next) => (-next[i]).mul_add(half(2 * k + 3), rising),
                None => rising,
            };
        }
    }
}

/// P_0 ... P_(count-1) at `z`.
fn legendre(z: f64, count: usize) -> Vec<f64> {
    let (mut before, mut value) = (0.0, 1.0);
    let mut list = Vec::with_capacity(count);
    for k in 0..count {
        list.push(value);
        let next = ((2 * k + 1) as f64 * z * value - k as f64 * before) / (k + 1) as f64;
        (before, value) = (value, next);
    }
    list
}

#[cfg(test)]
mod tests {
    use super::super::jet::{Reciprocals, Scratch, expand};
    use super::super::thrust::Quadrature;
    use super::*;
    use crate::dynamics::gyrostat::{ANGULAR_IMPULSE, ATTITUDE, IMPULSE_INTEGRAL, WITH_ANGLES, WITH_THRUST};

    #[test]
    fn nodes_follow_the_tolerance() {
        for (tolerance, count) in [(1e-4, 6), (1e-8, 10), (1e-12, 13), (1e-16, 17)] {
            let rule = StepRule::new(tolerance);
            assert_eq!(ThrustSeries::new(0.0, &rule, tolerance).count(), count, "{tolerance}");
        }
    }

    /// Law: at every point of the longest step the integrals are those of Gauss quadrature up to there, within the tolerance.
    #[test]
    fn points_within_a_step_have_their_own_quadrature() {
        let mut constants = Constants::zero(0.0);
        constants.force = [0.3, -0.2, 0.9];
        constants.torque = [0.5, 0.1, -0.4];
        for tolerance in [1e-6, 1e-10, 1e-13] {
            let rule = StepRule::in_f64(tolerance);
            let order = rule.order;
            let mut jet = vec![[0.0; WITH_ANGLES]; order + 1];
            jet[0][..3].copy_from_slice(&[0.6, 0.0, -0.8]);
            jet[0][ATTITUDE..ATTITUDE + 4].copy_from_slice(&[0.5, 0.5, -0.5, 0.5]);
            let (reciprocals, mut scratch) = (Reciprocals::new(0.0, order), Scratch::new(0.0));
            expand::<f64, WITH_ANGLES, true>(&Constants::zero(0.0), &reciprocals, order, &mut scratch, &mut jet);
            let length = rule.largest_turn();
            let mut series = ThrustSeries::new(0.0, &rule, tolerance);
            series.expand(&constants, &jet, length);
            let quadrature = Quadrature::new(&rule, tolerance);
            let mut worst = 0.0_f64;
            for k in 0..=20 {
                let x = length * f64::from(k) / 20.0;
                let [pushed, path, turned] = series.growth(&[0.0; WITH_THRUST], x);
                let direct: [f64; WITH_THRUST] = quadrature.growth(&constants, &jet, &[0.0; WITH_THRUST], [0.0; 3], x);
                for i in 0..3 {
                    worst = worst.max((pushed[i] - direct[IMPULSE + i]).abs());
                    worst = worst.max((path[i] - direct[IMPULSE_INTEGRAL + i]).abs());
                    worst = worst.max((turned[i] - direct[ANGULAR_IMPULSE + i]).abs());
                }
            }
            // force and torque are about one
            assert!(worst < tolerance.max(1e-14), "{tolerance}: {worst}");
            assert!(worst > 0.0, "two ways to the same integrals");
        }
    }
}
