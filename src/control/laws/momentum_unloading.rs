//! [`MomentumUnloading`]: a torque of thrusters that takes momentum out of the wheels.

use crate::control::vector::{norm, product, scaled};

/// The torque -(|h| - h_0)/T h/|h| on the body for the momentum h of the wheels along the axes on which thrusters have
/// torque; none where |h| is within the dead band h_0. The law of attitude then asks the wheels for as much less, so
/// that they give their momentum to it: h decays to the dead band with the time constant T. Momentum across those axes
/// stays: it needs a turn first.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MomentumUnloading {
    /// Momentum h_0 that may stay in the wheels, N m s.
    pub dead_band: f64,
    /// Time constant T, s.
    pub time_constant: f64,
}

impl MomentumUnloading {
    /// The wanted change of the momentum `wheels_s` of the wheels relative to the body, sum J_i Omega_i a_i, both in
    /// F_s, N m s: to the dead band.
    pub fn change(&self, wheels_s: [f64; 3]) -> [f64; 3] {
        let size = norm(wheels_s);
        if size <= self.dead_band { [0.0; 3] } else { scaled(-(size - self.dead_band) / size, wheels_s) }
    }

    /// The torque on the body that thrusters are to give, F_s, N m. `two_sided` is the projection onto the torques that
    /// they can give in both directions ([`crate::control::allocation::ThrustAllocation::two_sided_torques`]).
    pub fn torque(&self, wheels_s: [f64; 3], two_sided: [[f64; 3]; 3]) -> [f64; 3] {
        scaled(1.0 / self.time_constant, self.change(product(two_sided, wheels_s)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::control::vector::{difference, sum};

    /// Basilisk babdff7, src/fswAlgorithms/attControl/thrMomentumManagement/_UnitTest/test_thrMomentumManagement.py, to
    /// its tolerance.
    #[test]
    fn changes_are_those_of_basilisk() {
        let fourth = scaled(0.1 * 100.0, [0.5773502691896258; 3]);
        let wheels = sum([0.1 * 10.0, 0.1 * -25.0, 0.1 * 50.0], fourth);
        let cases = [
            (100.0 / 6000.0 * 100.0, [-5.914369484146579, -2.858300248464629, -9.407020039211664]),
            (1000.0 / 6000.0 * 100.0, [0.0; 3]),
        ];
        for (dead_band, expected) in cases {
            let found = MomentumUnloading { dead_band, time_constant: 1.0 }.change(wheels);
            assert!(norm(difference(found, expected)) < 1e-12, "{found:?}");
        }
    }
}
