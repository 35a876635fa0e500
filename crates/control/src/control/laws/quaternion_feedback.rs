//! Feedback of the error quaternion and the rate.

use super::integral::{self, Integral};
use crate::loops::attitude_law::{AttitudeLaw, KnownBody, LawInput, LawKind, PhaseLaw, digits};
use crate::loops::declared::declared;
use crate::loops::vector::{product, scaled, sum};
use crate::scene::LawParameter;
use crate::scene::schema::Limit;

/// u = -2 w^2 K (e + z_i) - 2 z w K omega_st + omega x H + K (omega_te' - omega x omega_te), with z_i = Ki int e dt,
/// bandwidth w and damping z of small errors (B. Wie, *Space Vehicle Dynamics and Control*, 2008, section 7.3; the last
/// term tracks a turning target).
#[derive(Clone, Copy)]
struct QuaternionFeedback {
    /// w, rad/s.
    bandwidth: f64,
    /// z.
    damping: f64,
    integral: Integral,
}

declared! {
    QuaternionNumbers = PARAMETERS {
        bandwidth: f64 = LawParameter::number("bandwidth_rad_s", "rad/s", "Natural frequency of small errors",
            Limit::Positive);
        damping: f64 = LawParameter::number("damping", "1", "Damping ratio of small errors", Limit::NotNegative);
        integral_gain: f64 = integral::GAIN;
        integral_limit: f64 = integral::LIMIT;
    }
}

pub(super) fn kind() -> LawKind {
    LawKind::new("quaternion_feedback", &PARAMETERS, |settings| {
        let QuaternionNumbers { bandwidth, damping, integral_gain, integral_limit } =
            QuaternionNumbers::of(settings.table);
        let integral = Integral::new(integral_gain, integral_limit);
        QuaternionFeedback { bandwidth, damping, integral }
    })
}

impl PhaseLaw for QuaternionFeedback {
    fn torque(&mut self, craft: &KnownBody, input: &LawInput<'_>, period: f64) -> [f64; 3] {
        let error = self.integral.with(input.error_vector(), period);
        let error = scaled(-2.0 * self.bandwidth * self.bandwidth, error);
        let wanted = sum(error, scaled(-2.0 * self.damping * self.bandwidth, input.omega_st_s()));
        sum(product(craft.inertia, wanted), input.feedforward(craft))
    }

    fn weaker(&self, share: f64) -> Option<(AttitudeLaw, String)> {
        let bandwidth = share * self.bandwidth;
        let law = AttitudeLaw::new(QuaternionFeedback { bandwidth, ..*self });
        Some((law, format!("bandwidth_rad_s = {}", digits(bandwidth))))
    }
}
