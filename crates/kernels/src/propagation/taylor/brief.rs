//! [`BriefRule`]: arcs much shorter than a step, flown in one step of lower order.
//!
//! Let rho^2 = |omega|^2 + (|h|/J)^2 + (|torque| + |h'|)/J with the smallest moment J. With u = omega/rho, s = rho t
//! the equations are bounded by u' = u^2 + (|h|/(J rho)) u + (..)/rho^2, whose series has coefficients below one, the
//! attitude's below one half. In an arc of length L the first neglected term is below y^(n+1) of rho, y = rho L; summed
//! over a run it is below the tolerance per radian if y^n is at most the tolerance. The order is the smallest such n.
//! Coefficients beyond a lane's own order are zeroed.

use crate::dynamics::gyrostat::equations::Constants;
use crate::math::vector::dot;
use crate::math::{Mask, Real};

pub const LEAST: usize = 3;

/// Margin for tolerances below rounding, as in `super::step`.
const BELOW_ROUNDING: f64 = 1.0 / 4096.0;

#[derive(Clone, Debug)]
pub struct BriefRule {
    /// Largest y^2 at the orders from [`LEAST`] on.
    squares: Vec<f64>,
    /// Order of other steps.
    full: usize,
}

#[derive(Clone, Copy, Debug)]
pub struct Brief<R: Real> {
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
    pub fn new(tolerance: f64, full: usize) -> Self {
        let tolerance = if tolerance < f64::EPSILON { BELOW_ROUNDING * tolerance } else { tolerance };
        // less than two orders saved is not worth it
        let squares = (LEAST..full.saturating_sub(1)).map(|n| libm::pow(tolerance, 2.0 / n as f64)).collect();
        BriefRule { squares, full }
    }

    /// Orders of lanes whose arc starts now and lasts for `length`; `may` is one in lanes that may have a brief arc.
    #[inline(always)]
    pub fn orders<R: Real>(
        &self,
        constants: &Constants<R>,
        omega: [R; 3],
        length: R,
        time: R,
        may: R,
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
    #[inline(always)]
    pub fn is_mixed(&self, full: usize) -> bool {
        self.most == full
    }

    /// Sets the coefficients beyond each lane's order to zero.
    #[inline(always)]
    pub fn truncate<const J: usize>(&self, jet: &mut [[R; J]]) {
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
pub fn turn_squared<R: Real>(constants: &Constants<R>, omega: [R; 3], length: R) -> R {
    let Constants { inverse, momentum, torque, momentum_rate, .. } = constants;
    let inverse = inverse[0].larger(inverse[1]).larger(inverse[2]);
    let mut acting = torque[0].abs() + momentum_rate[0].abs();
    for i in 1..3 {
        acting += torque[i].abs() + momentum_rate[i].abs();
    }
    let carried = dot(*momentum, *momentum) * (inverse * inverse);
    ((dot(omega, omega) + carried) + acting * inverse) * (length * length)
}
