//! [`QuaternionFeedback`]: proportional to the quaternion of the error, and to the rate.

use super::integral::{self, Integral};
use super::interface::{AttitudeLaw, KnownBody, LawInput, LawKind, LawSettings, PhaseLaw, digits};
use crate::control::declared::{declared, limit};
use crate::control::vector::{product, scaled, sum};
use crate::scene::LawParameter;
use crate::scene::schema::Limit;

/// u = -2 w^2 K (e + z_i) - 2 z w K omega_st + omega x H + K (omega_te' - omega x omega_te), with e = q_v sign(q_0) of
/// the attitude q relative to the target, omega_st the rate relative to it, z_i = Ki int e dt, for the bandwidth w and
/// the damping z of small errors. K is J less the axial inertias of free wheels, H the momentum with the wheels (B.
/// Wie, *Space Vehicle Dynamics and Control*, 2008, section 7.3; the last term follows a target that turns).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct QuaternionFeedback {
    /// Bandwidth w, rad/s.
    pub bandwidth: f64,
    /// Damping z.
    pub damping: f64,
    /// The integral of the error.
    pub integral: Integral,
}

declared! {
    /// Its numbers in campaign files.
    QuaternionNumbers = PARAMETERS {
        bandwidth: f64 = LawParameter::number("bandwidth_rad_s", "rad/s", "Natural frequency of small errors",
            Limit::Positive);
        damping: f64 = LawParameter::number("damping", "1", "Damping ratio of small errors", Limit::NotNegative);
        integral_gain: f64 = integral::GAIN;
        integral_limit: f64 = integral::LIMIT;
    }
}

pub(super) const KIND: LawKind = LawKind {
    name: "quaternion_feedback",
    parameters: &PARAMETERS,
    make: &|settings| AttitudeLaw::new(QuaternionFeedback::of(settings)),
};

impl QuaternionFeedback {
    fn of(settings: &LawSettings<'_>) -> Self {
        let QuaternionNumbers { bandwidth, damping, integral_gain, integral_limit } =
            QuaternionNumbers::of(settings.table);
        let integral = Integral::new(integral_gain, limit(integral_limit));
        QuaternionFeedback { bandwidth, damping, integral }
    }

    /// Without an integral.
    pub fn new(bandwidth: f64, damping: f64) -> Self {
        QuaternionFeedback { bandwidth, damping, integral: Integral::NONE }
    }
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
