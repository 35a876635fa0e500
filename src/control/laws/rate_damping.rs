//! [`RateDamping`]: a torque against the rate.

use super::integral::{self, Integral};
use super::interface::{LawInput, LawSettings};
use crate::control::declared::{declared, limit};
use crate::scene::LawParameter;
use crate::scene::schema::Limit;

/// u = -gain (omega + z) against the rate omega relative to F_e, with z = Ki int omega dt. The energy of rotation falls
/// at -gain |omega|^2 without the integral.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RateDamping {
    /// Gain, N m s.
    pub gain: f64,
    /// The integral of the rate.
    pub integral: Integral,
}

declared! {
    /// Its numbers in campaign files.
    RateDampingNumbers = PARAMETERS {
        gain: f64 = LawParameter::number("gain_n_m_s", "N m s", "Torque opposing a rate of 1 rad/s", Limit::Positive);
        integral_gain: f64 = integral::GAIN;
        integral_limit: f64 = integral::RATE_LIMIT;
    }
}

/// What campaign files call it.
pub const NAME: &str = "rate_damping";

impl RateDamping {
    /// The law of a phase.
    pub fn of(settings: &LawSettings<'_>) -> Self {
        let RateDampingNumbers { gain, integral_gain, integral_limit } = RateDampingNumbers::of(settings.table);
        RateDamping { gain, integral: Integral::new(integral_gain, limit(integral_limit)) }
    }

    /// The torque on the body, F_s, N m, at a tick `period` seconds after the last one (zero at the first).
    pub fn torque(&mut self, input: &LawInput, period: f64) -> [f64; 3] {
        self.integral.with(input.omega_se_s, period).map(|rate| -self.gain * rate)
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
            let torque = RateDamping { gain: 4.0, integral: Integral::NONE }.torque(&body.input(), 0.0);
            body.step(torque, period, 4);
            let (slope, law) = ((energy(&body) - energy(&start)) / period, -4.0 * dot(start.omega, start.omega));
            assert!((slope / law - 1.0).abs() < 0.2 * period, "{slope} for {law}");
        }
    }
}
