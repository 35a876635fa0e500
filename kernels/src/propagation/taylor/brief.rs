//! [`BriefRule`]: arcs much shorter than a step, flown in one step of lower order.
//!
//! Let rho^2 = |omega|^2 + (|h|/J)^2 + (|torque| + |h'|)/J with the smallest moment J. With u = omega/rho, s = rho t
//! the equations are bounded by u' = u^2 + (|h|/(J rho)) u + (..)/rho^2, whose series has coefficients below one, the
//! attitude's below one half. In an arc of length L the first neglected term is below y^(n+1) of rho, y = rho L; over
//! all arcs of a run the sum is below the tolerance per radian if y^n is at most the tolerance. The order is the
//! smallest such n, a function of the lane alone.
//!
//! Coefficients are computed up to the largest order of all lanes; those beyond a lane's own order are set to zero, so
//! that its sums do not depend on its neighbours.

use crate::dynamics::gyrostat::equations::Constants;
use crate::math::vector::dot;
use crate::math::{Mask, Real};

/// The smallest order.
pub(super) const LEAST: usize = 3;

/// Margin for tolerances below rounding, as in `super::step`.
const BELOW_ROUNDING: f64 = 1.0 / 4096.0;

/// Orders of brief arcs.
#[derive(Clone, Debug)]
pub(super) struct BriefRule {
    /// Largest y^2 at the orders from [`LEAST`] on.
    squares: Vec<f64>,
    /// Order of other steps.
    full: usize,
}

#[derive(Clone, Copy, Debug)]
pub(super) struct Brief<R: Real> {
    /// Lanes with a brief arc.
    pub lanes: R::Mask,
    /// Their orders.
    pub order: R,
    /// Their y.
    pub turn: R,
    /// Highest order of coefficients needed in the step.
    pub most: usize,
}

impl BriefRule {
    /// The rule for a relative tolerance, next to steps of order `full`.
    pub(super) fn new(tolerance: f64, full: usize) -> Self {
        let tolerance = if tolerance < f64::EPSILON { BELOW_ROUNDING * tolerance } else { tolerance };
        // at least two orders less, or it is not worth it
        let squares = (LEAST..full.saturating_sub(1)).map(|n| libm::pow(tolerance, 2.0 / n as f64)).collect();
        BriefRule { squares, full }
    }

    /// Orders of lanes whose arc starts now and lasts for `length`; `may` is one in lanes that may have a brief arc.
    /// `None` without brief arcs.
    #[inline(always)]
    pub(super) fn orders<R: Real>(
        &self,
        constants: &Constants<R>,
        omega: [R; 3],
        (length, time, may): (R, R, R),
    ) -> Option<Brief<R>> {
        let zero = length.zero();
        let number = |value: f64| length.splat(value);
        let square = turn_squared(constants, omega, length);
        let largest = number(*self.squares.last()?);
        let lanes = square.lt(largest) & zero.lt(may) & !zero.lt(time);
        if !lanes.any() {
            return None;
        }
        let mut order = number(LEAST as f64);
        for limit in &self.squares {
            order += order.indicator(number(*limit).lt(square));
        }
        let others = length.lt(number(f64::INFINITY)) & !lanes;
        let mut most = if others.any() { self.full } else { LEAST };
        while most < self.full && (number(most as f64).lt(order) & lanes).any() {
            most += 1;
        }
        Some(Brief { lanes, order, turn: square.sqrt(), most })
    }
}

impl<R: Real> Brief<R> {
    /// True if some lanes take a step of full order.
    #[inline(always)]
    pub(super) fn is_mixed(&self, full: usize) -> bool {
        self.most == full
    }

    /// Sets the coefficients beyond each lane's order to zero.
    #[inline(always)]
    pub(super) fn truncate<const J: usize>(&self, jet: &mut [[R; J]]) {
        let zero = self.order.zero();
        for (n, coefficients) in jet.iter_mut().enumerate().take(self.most + 1).skip(LEAST + 1) {
            let beyond = self.lanes & self.order.lt(zero.splat(n as f64));
            if beyond.any() {
                for coefficient in coefficients {
                    *coefficient = R::select(beyond, zero, *coefficient);
                }
            }
        }
    }
}

/// y^2 of an arc of length `length` from the rate `omega` on, in the lane's unit of time.
#[inline(always)]
pub(super) fn turn_squared<R: Real>(constants: &Constants<R>, omega: [R; 3], length: R) -> R {
    let Constants { inverse, momentum, torque, momentum_rate, .. } = constants;
    let inverse = inverse[0].larger(inverse[1]).larger(inverse[2]);
    let mut acting = torque[0].abs() + momentum_rate[0].abs();
    for i in 1..3 {
        acting += torque[i].abs() + momentum_rate[i].abs();
    }
    let carried = dot(*momentum, *momentum) * (inverse * inverse);
    ((dot(omega, omega) + carried) + acting * inverse) * (length * length)
}

#[cfg(test)]
mod tests {
    use super::super::jet::{Reciprocals, Scratch, expand};
    use super::*;
    use crate::dynamics::gyrostat::{ATTITUDE, WITH_ATTITUDE};
    use crate::math::vector::norm;

    /// Law: the neglected terms of a brief arc are below y times the tolerance; two orders less are not enough.
    #[test]
    fn the_order_is_what_the_arc_needs() {
        const N: usize = WITH_ATTITUDE;
        const FULL: usize = 22;
        let scene = [
            ([0.9, -0.4, 0.5], [0.0; 3], [0.0; 3], [0.0; 3]),
            ([0.3, -0.4, 0.1], [0.7, 0.2, -0.9], [0.0; 3], [0.4, 0.1, 0.0]),
            ([0.0, 0.0, 0.0], [0.0; 3], [1.0, -0.5, 0.7], [0.0; 3]),
            ([0.1, 1.4, -0.1], [2.0, 0.0, 1.0], [3.0, 0.0, 0.0], [0.0, 0.0, -2.0]),
        ];
        let (mut brief, mut spared) = (0, 0);
        for (omega, momentum, torque, momentum_rate) in scene {
            let mut constants = Constants { momentum, torque, momentum_rate, ..Constants::zero(0.0) };
            constants.ratio = [0.8, -0.9, 0.4];
            constants.inverse = [1.0, 0.8, 1.0];
            for tolerance in [1e-6, 1e-10, 1e-13] {
                let rule = BriefRule::new(tolerance, FULL);
                for length in [1e-4, 1e-3, 0.01, 0.03, 0.1] {
                    let Some(found) = rule.orders(&constants, omega, (length, 0.0, 1.0)) else { continue };
                    let (reciprocals, mut scratch) = (Reciprocals::new(0.0, FULL), Scratch::new(0.0));
                    let mut jet = vec![[0.0; N]; FULL + 1];
                    jet[0][..3].copy_from_slice(&omega);
                    jet[0][ATTITUDE] = 1.0;
                    expand::<f64, N, true>(&constants, &reciprocals, FULL, &mut scratch, None, &mut jet);
                    let rest = |order: usize| {
                        let terms = jet.iter().enumerate().skip(order + 1);
                        let of = |first: usize| {
                            let size = |c: &[f64; N]| norm([c[first], c[first + 1], c[first + 2]]);
                            terms.clone().map(|(n, c)| size(c) * libm::pow(length, n as f64)).sum::<f64>()
                        };
                        (of(0) / (found.turn / length)).max(of(ATTITUDE + 1))
                    };
                    let order = found.order as usize;
                    assert!(found.lanes && found.most == order);
                    assert!(rest(order) <= found.turn * tolerance, "{order}: {} for {}", rest(order), found.turn);
                    brief += 1;
                    spared += usize::from(order > LEAST + 2 && rest(order - 3) <= found.turn * tolerance);
                }
            }
        }
        assert!(brief > 30 && spared * 3 < brief, "{brief} arcs, {spared} with three orders too many");
    }

    #[test]
    fn long_arcs_and_those_in_progress_are_left_alone() {
        let constants = Constants::zero(0.0);
        let rule = BriefRule::new(1e-10, 13);
        let orders = |length, time, may| rule.orders(&constants, [0.1, 0.0, 0.0], (length, time, may));
        assert!(orders(0.1, 0.0, 1.0).is_some());
        assert!(orders(10.0, 0.0, 1.0).is_none() && orders(f64::INFINITY, 0.0, 1.0).is_none());
        assert!(orders(0.1, 1e-3, 1.0).is_none() && orders(0.1, 0.0, 0.0).is_none());
        assert!(BriefRule::new(1e-1, 3).orders(&constants, [0.0; 3], (0.1, 0.0, 1.0)).is_none());
    }
}
