//! A thruster torque that unloads the wheels.

use crate::loops::declared::{declared, number};
use crate::loops::vector::{norm, product, scaled};

declared! {
    /// T and h_0.
    UnloadingNumbers = UNLOADING {
        time: f64 = number("unloading_time_s", "s",
            "Time constant with which thrusters unload the wheels; 0: they do not", &[0.0]);
        dead_band: f64 = number("unloading_dead_band_n_m_s", "N m s", "Wheel momentum that need not be unloaded",
            &[0.0]);
    }
}

/// The torque -(|h| - h_0)/T h/|h| on the body for the momentum h of the wheels along axes of two-sided thruster
/// torque; none in the dead band |h| <= h_0. The attitude law takes the same torque back from the wheels, so that h
/// decays to the dead band with the time constant T. Momentum across those axes needs a turn first.
impl UnloadingNumbers {
    /// Wanted change of the wheels' momentum `wheels_s` relative to the body, sum J_i Omega_i a_i, in F_s: to the dead
    /// band.
    pub fn change(&self, wheels_s: [f64; 3]) -> [f64; 3] {
        let size = norm(wheels_s);
        if size <= self.dead_band { [0.0; 3] } else { scaled(-(size - self.dead_band) / size, wheels_s) }
    }

    /// Thruster torque on the body, F_s, within the projection `two_sided`
    /// ([`crate::control::allocation::ThrustAllocation::two_sided_torques`]).
    pub fn torque(&self, wheels_s: [f64; 3], two_sided: [[f64; 3]; 3]) -> [f64; 3] {
        scaled(1.0 / self.time, self.change(product(two_sided, wheels_s)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::loops::vector::{difference, sum};

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
            let found = UnloadingNumbers { time: 1.0, dead_band }.change(wheels);
            assert!(norm(difference(found, expected)) < 1e-12, "{found:?}");
        }
    }
}
