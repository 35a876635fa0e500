//! A camera on the spacecraft: attitude and rate of the debris relative to the spacecraft, within a range.

use crate::control::declared::declared;
use crate::control::measurement::{Values, values};
use crate::control::observes::Observes;
use crate::control::rotation::quaternion_of;
use crate::control::sensors::sensor::{
    AXES, MeasuredQuantity, NormalErrors, Sensor, SensorContext, SensorKind, WXYZ, XYZ, optional,
};
use crate::control::truth::Truth;
use crate::control::vector::{conjugate, dcm_from_quaternion, difference, hamilton, norm, product, sum};

pub(super) const KIND: SensorKind = SensorKind {
    name: "relative_camera",
    parameters: &PARAMETERS,
    quantities: &[
        MeasuredQuantity::new(
            "measured_q_sd",
            WXYZ,
            ["", ""],
            "Attitude quaternion of the debris measured by the camera, F_d -> F_s",
        ),
        MeasuredQuantity::new(
            "measured_omega_ds_d",
            XYZ,
            ["rad/s", "rad_s"],
            "Angular velocity of the debris relative to the spacecraft measured by the camera, in F_d",
        ),
    ],
    observes: Observes::DebrisAttitude(|table| {
        let CameraNumbers { attitude_noise, rate_noise, .. } = CameraNumbers::of(table);
        [attitude_noise, rate_noise]
    }),
    needs: None,
    replaced_by_epoch: None,
    make: |context| Box::new(RelativeCamera::new(context)),
};

declared! {
    /// Its numbers in campaign files.
    CameraNumbers = PARAMETERS {
    attitude_noise: f64 = optional(
        "attitude_noise_rad",
        "rad",
        "Standard deviation of the relative attitude about each axis of the spacecraft",
    );
    rate_noise: f64 = optional("rate_noise_rad_s", "rad/s",
        "Standard deviation of each component of the relative rate");
    max_range: f64 = optional("max_range_m", "m", "Distance between the centres of mass beyond which it delivers \
        nothing; 0: no limit");
    }
}

struct RelativeCamera {
    attitude: f64,
    rate: f64,
    max_range: f64,
    attitude_noise: NormalErrors<3>,
    rate_noise: NormalErrors<3>,
}

impl RelativeCamera {
    fn new(context: &SensorContext<'_>) -> Self {
        let numbers = CameraNumbers::of(context.parameters);
        RelativeCamera {
            attitude: numbers.attitude_noise,
            rate: numbers.rate_noise,
            max_range: numbers.max_range,
            attitude_noise: context.normal("attitude_noise", AXES),
            rate_noise: context.normal("rate_noise", AXES),
        }
    }
}

impl Sensor for RelativeCamera {
    fn measure(&mut self, count: u64, truth: &Truth) -> Option<Values> {
        let (body, debris) = (&truth.body, truth.debris?);
        if self.max_range > 0.0 && norm(difference(debris.r_gdo_e, body.r_co_e)) > self.max_range {
            return None;
        }
        let q_sd = hamilton(conjugate(body.q_es), debris.q_ed);
        let c_ds = dcm_from_quaternion(conjugate(q_sd));
        let omega_ds_d = difference(debris.omega_de_d, product(c_ds, body.omega_se_s));
        let seen = hamilton(quaternion_of(self.attitude_noise.scaled(count, [self.attitude; 3])), q_sd);
        let rate = sum(omega_ds_d, self.rate_noise.scaled(count, [self.rate; 3]));
        Some(values(&[&seen, &rate]))
    }
}

#[cfg(test)]
mod tests {
    use super::super::bench::{assert_normal, sensor, truth};
    use super::*;
    use crate::control::measurement::part;
    use crate::control::rotation::vector_of;
    use crate::control::truth::DebrisState;

    /// Law: a body that turns with the spacecraft has no relative rate; errors are normal with their deviations (4,000
    /// samples, alpha 1e-3 each, seed 5); out of range, or without debris, there is nothing.
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
            let seen = camera.measure(count, &at).expect("within range");
            turns.extend(vector_of(hamilton(part(&seen, 0), conjugate(q_sd))));
            rates.extend(part::<3>(&seen, 4));
        }
        assert_normal(&turns, 1e-3, 1e-3);
        assert_normal(&rates, 1e-4, 1e-3);
        at.debris = Some(DebrisState { r_gdo_e: [0.0, 31.0, 0.0], ..debris });
        assert!(camera.measure(0, &at).is_none());
        at.debris = None;
        assert!(camera.measure(0, &at).is_none());
    }
}
