//! [`RateDamping`]: a torque against the rate.

use super::{AttitudeLaw, LawInput, LawKind, number};
use crate::scene::LawParameter;
use crate::scene::schema::Limit;

/// The torque u = -gain omega against the rate relative to F_e. The energy of rotation falls at -gain |omega|^2.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RateDamping {
    /// Gain, N m s.
    pub gain: f64,
}

/// Its keys in campaign files.
pub static PARAMETERS: [LawParameter; 1] =
    [LawParameter::number("gain_n_m_s", "N m s", "Torque against a rate of 1 rad/s", Limit::Positive)];

/// Its place in the list of laws.
pub const KIND: LawKind = LawKind {
    name: "rate_damping",
    parameters: &PARAMETERS,
    make: |table| AttitudeLaw::RateDamping(RateDamping { gain: number(table, "gain_n_m_s") }),
};

impl RateDamping {
    /// The torque on the body, F_s, N m.
    pub fn torque(&self, input: &LawInput) -> [f64; 3] {
        input.omega_se_s.map(|rate| -self.gain * rate)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::control::laws::plant::Body;
    use crate::control::vector::{dot, product};

    /// Law: the energy falls at -gain |omega|^2, to first order in the period.
    #[test]
    fn energy_falls_as_the_law_says() {
        let start = Body { inertia: [30.0, 36.0, 24.0], q_es: [1.0, 0.0, 0.0, 0.0], omega: [0.05, -0.03, 0.08] };
        let energy = |body: &Body| 0.5 * dot(body.omega, product(body.matrix(), body.omega));
        for period in [0.1, 0.01] {
            let mut body = start;
            body.step(RateDamping { gain: 4.0 }.torque(&body.input()), period, 4);
            let (slope, law) = ((energy(&body) - energy(&start)) / period, -4.0 * dot(start.omega, start.omega));
            assert!((slope / law - 1.0).abs() < 0.2 * period, "{slope} for {law}");
        }
    }
}
