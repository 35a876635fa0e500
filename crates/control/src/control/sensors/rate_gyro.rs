//! A rate-integrating gyro: the rotation vector from sample to sample, exact in a slew.
//!
//! Noise: R. L. Farrenkopf, J. Guidance and Control 1(4), 1978; F. L. Markley & J. L. Crassidis, *Fundamentals of
//! Spacecraft Attitude Determination and Control*, 2014, section 4.7. Over a period T the bias walks by N(0, su^2 T),
//! and the rotation has the variance sv^2 T + su^2 T^3/12 about the mean of the initial and final bias. A turn beyond
//! half a revolution per sample reads as the shorter one.

use super::sensor::{AXES, NormalErrors, Sensor, SensorMaker, XYZ, axes, optional};
use crate::control::truth::Truth;
use crate::loops::declared::declared;
use crate::loops::kinds::{MeasuredQuantity, SensorKind};
use crate::loops::measurement::{Values, values};
use crate::loops::observes::{GyroNoise, Observes};
use crate::loops::vector::{conjugate, hamilton, scaled, sum, turned, vector_of};
use crate::scene::LawParameter;
use crate::scene::schema::Limit;

pub(super) const KIND: SensorMaker = SensorMaker {
    kind: SensorKind {
        name: "rate_gyro",
        parameters: &PARAMETERS,
        quantities: &[MeasuredQuantity {
            is_over_period: true,
            ..MeasuredQuantity::new(
                "measured_rate_s",
                XYZ,
                ["rad/s", "rad_s"],
                "Rotation measured by a gyro over its interval, in F_s",
            )
        }],
        observes: Observes::Rotation(|table| {
            let GyroNumbers { angular_random_walk, bias_random_walk, .. } = GyroNumbers::of(table);
            GyroNoise { angular_random_walk, bias_random_walk }
        }),
        needs: None,
        replaced_by_epoch: None,
    },
    make: |context| {
        let (period, numbers) = (context.period, GyroNumbers::of(context.parameters));
        let (white, walk) = (numbers.angular_random_walk, numbers.bias_random_walk);
        Box::new(RateGyro {
            period,
            numbers,
            white_deviation: (white * white * period + walk * walk * period.powi(3) / 12.0).sqrt(),
            walk_deviation: walk * period.sqrt(),
            white: context.normal("angular_random_walk", AXES),
            walk: context.normal("bias_random_walk", AXES),
            before: None,
            rest: [0.0; 3],
        })
    },
};

declared! {
    GyroNumbers = PARAMETERS {
        angular_random_walk: f64 = optional("angular_random_walk_rad_sqrt_s", "rad/sqrt(s)",
            "Standard deviation of the angle after one second, from white noise in the rate");
        bias_random_walk: f64 = optional("bias_random_walk_rad_s_sqrt_s", "rad/s/sqrt(s)",
            "Standard deviation of the bias after one second, from its random walk");
        bias: [f64; 3] = axes("bias_rad_s", "rad/s", "Bias at the start of the run", Limit::Finite);
        scale: [f64; 3] = LawParameter::number("scale", "1", "Ratio of measured to true rotation about each axis",
            Limit::Finite).with_components(&AXES).or(&[1.0; 3]);
        misalignment: [f64; 3] = axes("misalignment_rad", "rad",
            "Rotation vector from the body to the axes of the gyro", Limit::Finite);
        count_angle: f64 = optional("quantization_rad", "rad",
            "Angle of one count; the remainder is carried to the next sample; 0: none");
        max_rate: f64 = optional("max_rate_rad_s", "rad/s",
            "Largest mean rate about each axis that it can measure; 0: no limit");
    }
}

struct RateGyro {
    period: f64,
    /// As declared, but for the bias, which walks.
    numbers: GyroNumbers,
    /// Standard deviations of the rotation about that of the mean bias, and of the bias from sample to sample.
    white_deviation: f64,
    walk_deviation: f64,
    white: NormalErrors<3>,
    walk: NormalErrors<3>,
    /// Attitude at the last sample.
    before: Option<[f64; 4]>,
    /// Angle not counted yet.
    rest: [f64; 3],
}

impl RateGyro {
    /// The measured rotation about an axis: limited, then counted.
    fn counted(&mut self, axis: usize, rotation: f64) -> f64 {
        let GyroNumbers { max_rate, count_angle, .. } = self.numbers;
        let largest = if max_rate > 0.0 { max_rate * self.period } else { f64::INFINITY };
        let limited = rotation.clamp(-largest, largest);
        if count_angle == 0.0 {
            return limited;
        }
        let total = self.rest[axis] + limited;
        let counted = count_angle * (total / count_angle).round();
        self.rest[axis] = total - counted;
        counted
    }
}

impl Sensor for RateGyro {
    /// The rotation since the last sample; none at the first.
    fn measure(&mut self, count: u64, truth: &Truth) -> Option<Values> {
        let now = truth.body.q_es;
        let before = self.before.replace(now)?;
        let GyroNumbers { bias, scale, misalignment, .. } = self.numbers;
        let rotation = turned(vector_of(hamilton(conjugate(before), now)), misalignment.map(|angle| -angle));
        let after = sum(bias, self.walk.scaled(count, [self.walk_deviation; 3]));
        let of_bias = scaled(0.5 * self.period, sum(bias, after));
        self.numbers.bias = after;
        let noise = self.white.scaled(count, [self.white_deviation; 3]);
        let errors = sum(of_bias, noise);
        let rotation_s: [f64; 3] = std::array::from_fn(|i| self.counted(i, scale[i] * rotation[i] + errors[i]));
        Some(values(&[&rotation_s]))
    }

    fn bias_s(&self) -> Option<[f64; 3]> {
        Some(self.numbers.bias)
    }
}

#[cfg(test)]
mod tests {
    use super::super::bench::{assert_normal, sensor, truth};
    use super::*;
    use crate::loops::measurement::part;
    use crate::loops::vector::{difference, quaternion_of};

    /// Rotations measured in a turn at the constant rate `omega`, with the bias after each.
    fn measured(values: &[(&str, &[f64])], sample: u64, omega: [f64; 3], samples: u64) -> Vec<([f64; 3], [f64; 3])> {
        let period = 0.1;
        let mut gyro = sensor("rate_gyro", values, period, sample);
        let mut q = [1.0, 0.0, 0.0, 0.0];
        let mut all = Vec::new();
        for count in 0..=samples {
            match gyro.measure(count, &truth(period * count as f64, q, omega)) {
                Some(measured) => {
                    let rotation_s = part(&measured, 0);
                    all.push((rotation_s, gyro.bias_s().expect("a bias")));
                }
                None => assert_eq!(count, 0, "a rotation at every sample but the first"),
            }
            q = hamilton(q, quaternion_of(scaled(period, omega)));
        }
        all
    }

    const WHITE: f64 = 1e-4;
    const WALK: f64 = 4e-3;
    const SLEW: [f64; 3] = [0.3, -0.2, 0.1];

    /// Law: rotation and bias have Farrenkopf's statistics, in a slew too: means and variances of 4,000 samples, alpha
    /// 1e-3 each, seed 5. The walk equals the white noise, so that su^2 T^3/12 matters: without it the variance is 12%
    /// too small.
    #[test]
    fn the_noise_is_farrenkopfs() {
        let (period, values): (f64, [(&str, &[f64]); 2]) =
            (0.1, [("angular_random_walk_rad_sqrt_s", &[WHITE]), ("bias_random_walk_rad_s_sqrt_s", &[WALK])]);
        let all = measured(&values, 9, SLEW, 4_000);
        let deviation = (WHITE * WHITE * period + WALK * WALK * period.powi(3) / 12.0).sqrt();
        for axis in 0..3 {
            let (mut bias, mut rotations, mut walks) = (0.0, Vec::new(), Vec::new());
            for (rotation, after) in &all {
                let mean = 0.5 * (bias + after[axis]);
                rotations.push(rotation[axis] - period * SLEW[axis] - period * mean);
                walks.push(after[axis] - bias);
                bias = after[axis];
            }
            assert_normal(&rotations, deviation, 1e-3);
            assert_normal(&walks, WALK * period.sqrt(), 1e-3);
            let both: Vec<f64> =
                rotations.iter().zip(&walks).map(|(a, b)| a / deviation + b / (WALK * period.sqrt())).collect();
            assert_normal(&both, std::f64::consts::SQRT_2, 1e-3);
        }
    }

    /// Law: rotations are whole counts and add up to the true angle within half a count; above the largest rate the
    /// gyro reads that rate.
    #[test]
    fn counts_add_up_and_rates_saturate() {
        let count = 7e-4;
        let mut sums = [0.0; 3];
        for (k, (rotation, _)) in measured(&[("quantization_rad", &[count])], 2, SLEW, 60).iter().enumerate() {
            sums = sum(sums, *rotation);
            let total = scaled(0.1 * (k + 1) as f64, SLEW);
            assert!(difference(sums, total).iter().all(|error| error.abs() <= 0.5 * count + 1e-12));
            assert!(rotation.iter().all(|angle| ((angle / count) - (angle / count).round()).abs() < 1e-12));
        }
        for (rotation, _) in measured(&[("max_rate_rad_s", &[0.15])], 2, SLEW, 3) {
            for (angle, expected) in rotation.iter().zip([0.015, -0.015, 0.01]) {
                assert!((angle - expected).abs() < 2e-16, "{angle}");
            }
        }
    }
}
