//! A camera on the spacecraft: relative attitude and rate of the debris, within a range.

use super::sensor::{AXES, NormalErrors, Sensor, SensorMaker, WXYZ, XYZ, optional};
use crate::control::truth::Truth;
use crate::loops::declared::declared;
use crate::loops::kinds::{MeasuredQuantity, SensorKind};
use crate::loops::measurement::{Values, values};
use crate::loops::observes::Observes;
use crate::loops::vector::{conjugate, dcm_from_quaternion, difference, hamilton, norm, product, quaternion_of, sum};

pub(super) const KIND: SensorMaker = SensorMaker {
    kind: SensorKind {
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
    },
    make: |context| {
        Box::new(RelativeCamera {
            numbers: CameraNumbers::of(context.parameters),
            attitude_errors: context.normal("attitude_noise", AXES),
            rate_errors: context.normal("rate_noise", AXES),
        })
    },
};

declared! {
    CameraNumbers = PARAMETERS {
        attitude_noise: f64 = optional("attitude_noise_rad", "rad",
            "Standard deviation of the relative attitude about each axis of the spacecraft");
        rate_noise: f64 = optional("rate_noise_rad_s", "rad/s",
            "Standard deviation of each component of the relative rate");
        max_range: f64 = optional("max_range_m", "m",
            "Distance between the centres of mass beyond which it delivers nothing; 0: no limit");
    }
}

struct RelativeCamera {
    numbers: CameraNumbers,
    attitude_errors: NormalErrors<3>,
    rate_errors: NormalErrors<3>,
}

impl Sensor for RelativeCamera {
    fn measure(&mut self, count: u64, truth: &Truth) -> Option<Values> {
        let (body, debris) = (&truth.body, truth.debris?);
        let CameraNumbers { attitude_noise, rate_noise, max_range } = self.numbers;
        if max_range > 0.0 && norm(difference(debris.r_gdo_e, body.r_co_e)) > max_range {
            return None;
        }
        let q_sd = hamilton(conjugate(body.q_es), debris.q_ed);
        let c_ds = dcm_from_quaternion(conjugate(q_sd));
        let omega_ds_d = difference(debris.omega_de_d, product(c_ds, body.omega_se_s));
        let seen = hamilton(quaternion_of(self.attitude_errors.scaled(count, [attitude_noise; 3])), q_sd);
        let rate = sum(omega_ds_d, self.rate_errors.scaled(count, [rate_noise; 3]));
        Some(values(&[&seen, &rate]))
    }
}
