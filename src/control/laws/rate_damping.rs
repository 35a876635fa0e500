//! [`rate_damping`]: a torque against the rate.

/// The torque u = -gain omega against the rate `omega` (rad/s, F_s); `gain` in N m s. The energy of rotation falls at -gain |omega|^2.
pub fn rate_damping(gain: f64, omega: [f64; 3]) -> [f64; 3] {
    omega.map(|rate| -gain * rate)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::control::laws::plant::Body;
    use crate::math::vector::{dot, product};

    /// Law: the energy falls at -gain |omega|^2, to first order in the period.
    #[test]
    fn energy_falls_as_the_law_says() {
        let start = Body { inertia: [30.0, 36.0, 24.0], q_es: [1.0, 0.0, 0.0, 0.0], omega: [0.05, -0.03, 0.08] };
        let energy = |body: &Body| 0.5 * dot(body.omega, product(body.matrix(), body.omega));
        for period in [0.1, 0.01] {
            let mut body = start;
            body.step(rate_damping(4.0, body.omega), period, 4);
            let (slope, law) = ((energy(&body) - energy(&start)) / period, -4.0 * dot(start.omega, start.omega));
            assert!((slope / law - 1.0).abs() < 0.2 * period, "{slope} for {law}");
        }
    }
}
