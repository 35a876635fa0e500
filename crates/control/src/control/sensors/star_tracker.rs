//! A star tracker: the attitude with noise about the tracker's axes F_t, up to a largest rate.
//!
//! The third axis is the boresight, about which a tracker is least accurate (C. C. Liebe, IEEE Transactions on
//! Aerospace and Electronic Systems 38(2), 2002); the others are s1 and s2, turned with s3 to the boresight the
//! shortest way.

use super::sensor::{AXES, NormalErrors, Sensor, SensorMaker, WXYZ, axes, optional};
use crate::loops::kinds::{MeasuredQuantity, SensorKind};
use std::sync::Arc;

use crate::control::estimators::kalman::WholeAttitude;
use crate::control::truth::Truth;
use crate::loops::declared::declared;
use crate::loops::measurement::{Values, values};
use crate::loops::observes::Observes;
use crate::loops::vector::{diagonal, from_s3_to, hamilton, multiplied, norm, product, quaternion_of, transposed};
use crate::scene::schema::Limit;

pub(super) const KIND: SensorMaker = SensorMaker {
    kind: SensorKind {
        name: "star_tracker",
        parameters: &PARAMETERS,
        quantities: &[MeasuredQuantity::new(
            "measured_q_es",
            WXYZ,
            ["", ""],
            "Attitude quaternion measured by a star tracker, F_s -> F_e",
        )],
        observes: Observes::Attitude(|table| {
            let numbers = TrackerNumbers::of(table);
            let c_st = from_s3_to(numbers.boresight);
            let in_tracker = diagonal(numbers.noise.map(|sigma| sigma * sigma));
            Arc::new(WholeAttitude(multiplied(&multiplied(&c_st, &in_tracker), &transposed(&c_st))))
        }),
        needs: None,
        replaced_by_epoch: None,
    },
    make: |context| {
        let numbers = TrackerNumbers::of(context.parameters);
        Box::new(StarTracker {
            numbers,
            c_st: from_s3_to(numbers.boresight),
            bias: quaternion_of(numbers.bias),
            noise: context.normal("noise", AXES),
        })
    },
};

declared! {
    TrackerNumbers = PARAMETERS {
        noise: [f64; 3] = axes("noise_rad", "rad",
            "Standard deviation about each axis of the tracker: two across the boresight, the third about it",
            Limit::NotNegative);
        boresight: [f64; 3] = axes("boresight", "1", "Direction of the boresight in F_s", Limit::Direction).or(&[0.0,
            0.0, 1.0]);
        bias: [f64; 3] = axes("bias_rad", "rad",
            "Constant rotation vector from the true body axes to the measured ones", Limit::Finite);
        max_rate: f64 = optional("max_rate_rad_s", "rad/s",
            "Rate of the body above which it delivers nothing; 0: no limit");
    }
}

struct StarTracker {
    numbers: TrackerNumbers,
    /// F_t -> F_s.
    c_st: [[f64; 3]; 3],
    bias: [f64; 4],
    noise: NormalErrors<3>,
}

impl Sensor for StarTracker {
    fn measure(&mut self, count: u64, truth: &Truth) -> Option<Values> {
        let TrackerNumbers { noise, max_rate, .. } = self.numbers;
        if max_rate > 0.0 && norm(truth.body.omega_se_s) > max_rate {
            return None;
        }
        let noise_s = product(self.c_st, self.noise.scaled(count, noise));
        let error = hamilton(self.bias, quaternion_of(noise_s));
        Some(values(&[&hamilton(truth.body.q_es, error)]))
    }
}
