//! A torque against the rate.

use super::integral::{self, Integral};
use crate::loops::attitude_law::{AttitudeLaw, KnownBody, LawInput, LawKind, PhaseLaw, digits};
use crate::loops::declared::declared;
use crate::scene::LawParameter;
use crate::scene::schema::Limit;

/// u = -gain (omega + z), omega relative to F_e, z = Ki int omega dt. Without the integral the rotational energy falls
/// at gain |omega|^2.
#[derive(Clone, Copy)]
struct RateDamping {
    /// N m s.
    gain: f64,
    integral: Integral,
}

declared! {
    RateDampingNumbers = PARAMETERS {
        gain: f64 = LawParameter::number("gain_n_m_s", "N m s", "Torque opposing a rate of 1 rad/s", Limit::Positive);
        integral_gain: f64 = integral::GAIN;
        integral_limit: f64 = integral::RATE_LIMIT;
    }
}

pub(super) fn kind() -> LawKind {
    LawKind::new("rate_damping", &PARAMETERS, |settings| {
        let RateDampingNumbers { gain, integral_gain, integral_limit } = RateDampingNumbers::of(settings.table);
        RateDamping { gain, integral: Integral::new(integral_gain, integral_limit) }
    })
}

impl PhaseLaw for RateDamping {
    fn torque(&mut self, _body: &KnownBody, input: &LawInput<'_>, period: f64) -> [f64; 3] {
        self.integral.with(input.omega_se_s, period).map(|rate| -self.gain * rate)
    }

    fn weaker(&self, share: f64) -> Option<(AttitudeLaw, String)> {
        let gain = share * self.gain;
        Some((AttitudeLaw::new(RateDamping { gain, ..*self }), format!("gain_n_m_s = {}", digits(gain))))
    }
}
