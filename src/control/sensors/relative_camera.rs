//! A camera on the spacecraft: relative attitude and rate of the debris, within a range.

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
