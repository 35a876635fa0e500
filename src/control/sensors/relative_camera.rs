//! A camera on the spacecraft: attitude and rate of the debris relative to the spacecraft, within a range.

use super::{AXES, NormalErrors, Sensor, SensorContext, SensorKind, optional};
use crate::control::measurement::Measurement;
use crate::control::rotation::quaternion_of;
use crate::control::truth::Truth;
use crate::control::vector::{conjugate, dcm_from_quaternion, difference, hamilton, norm, product, sum};
use crate::scene::LawParameter;

pub(super) const KIND: SensorKind = SensorKind {
    name: "relative_camera",
    has_latency: true,
    at_most_one: false,
    parameters: &PARAMETERS,
    make: |context| Box::new(RelativeCamera::new(context)),
};

static PARAMETERS: [LawParameter; 3] = [
    optional(
        "attitude_noise_rad",
        "rad",
        "Standard deviation of the relative attitude about each axis of the spacecraft",
    ),
    optional("rate_noise_rad_s", "rad/s", "Standard deviation of each component of the relative rate"),
    optional("max_range_m", "m", "Distance of the centres of mass beyond which it gives nothing; 0: no limit"),
];

struct RelativeCamera {
    attitude: f64,
    rate: f64,
    max_range: f64,
    attitude_noise: NormalErrors<3>,
    rate_noise: NormalErrors<3>,
}

impl RelativeCamera {
    fn new(context: &SensorContext<'_>) -> Self {
        RelativeCamera {
            attitude: context.number("attitude_noise_rad"),
            rate: context.number("rate_noise_rad_s"),
            max_range: context.number("max_range_m"),
            attitude_noise: context.normal("attitude_noise", AXES),
            rate_noise: context.normal("rate_noise", AXES),
        }
    }
}

impl Sensor for RelativeCamera {
    fn measure(&mut self, count: u64, truth: &Truth) -> Option<Measurement> {
        let (body, debris) = (&truth.body, truth.debris?);
        if self.max_range > 0.0 && norm(difference(debris.r_gdo_e, body.r_co_e)) > self.max_range {
            return None;
        }
        let q_sd = hamilton(conjugate(body.q_es), debris.q_ed);
        let c_ds = dcm_from_quaternion(conjugate(q_sd));
        let omega_ds_d = difference(debris.omega_de_d, product(c_ds, body.omega_se_s));
        Some(Measurement::Camera {
            q_sd: hamilton(quaternion_of(self.attitude_noise.scaled(count, [self.attitude; 3])), q_sd),
            omega_ds_d: sum(omega_ds_d, self.rate_noise.scaled(count, [self.rate; 3])),
            age: 0.0,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::super::bench::{assert_normal, sensor, truth};
    use super::*;
    use crate::control::rotation::vector_of;
    use crate::control::truth::DebrisState;

    /// Law: a body that turns with the spacecraft has no relative rate; errors are normal with their deviations (4,000 samples, alpha 1e-3 each, seed 5);
    /// out of range, or without debris, there is nothing.
    #[test]
    fn the_debris_is_seen_from_the_spacecraft() {
        let (q_es, q_sd, omega) =
            (quaternion_of([0.3, -1.0, 0.2]), quaternion_of([1.0, 0.5, 2.0]), [0.01, 0.02, -0.03]);
        let mut at = truth(0.0, q_es, omega);
        let omega_de_d = product(dcm_from_quaternion(conjugate(q_sd)), omega);
        let debris =
            DebrisState { r_gdo_e: [0.0, 30.0, 0.0], v_gdo_e: [0.0; 3], q_ed: hamilton(q_es, q_sd), omega_de_d };
        at.debris = Some(debris);
        let values: [(&str, &[f64]); 3] =
            [("attitude_noise_rad", &[1e-3]), ("rate_noise_rad_s", &[1e-4]), ("max_range_m", &[30.5])];
        let mut camera = sensor("relative_camera", &values, 1.0, 8);
        let (mut turns, mut rates) = (Vec::new(), Vec::new());
        for count in 0..4_000 {
            let Some(Measurement::Camera { q_sd: seen, omega_ds_d, .. }) = camera.measure(count, &at) else {
                panic!("within range")
            };
            turns.extend(vector_of(hamilton(seen, conjugate(q_sd))));
            rates.extend(omega_ds_d);
        }
        assert_normal(&turns, 1e-3, 1e-3);
        assert_normal(&rates, 1e-4, 1e-3);
        at.debris = Some(DebrisState { r_gdo_e: [0.0, 31.0, 0.0], ..debris });
        assert_eq!(camera.measure(0, &at), None);
        at.debris = None;
        assert_eq!(camera.measure(0, &at), None);
    }
}
