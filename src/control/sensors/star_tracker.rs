//! A star tracker: the attitude, with noise about the axes of the tracker; nothing above a rate of the body.
//!
//! The third axis of the tracker, F_t, is its boresight, about which a tracker measures least exactly (C. C. Liebe,
//! IEEE Transactions on Aerospace and Electronic Systems 38(2), 2002). The others are s1 and s2, turned with s3 to the
//! boresight the shortest way: they are s1 and s2 where it is s3.

use crate::control::sensors::sensor::{
    AXES, MeasuredQuantity, NormalErrors, Sensor, SensorContext, SensorKind, WXYZ, axes, optional,
};
use std::sync::Arc;

use crate::control::declared::declared;
use crate::control::estimators::attitude_innovation::WholeAttitude;
use crate::control::measurement::{Values, values};
use crate::control::observes::Observes;
use crate::control::rotation::{from_s3_to, quaternion_of};
use crate::control::small_matrix::{diagonal, multiplied, transposed};
use crate::control::truth::Truth;
use crate::control::vector::{hamilton, norm, product};
use crate::scene::DeclaredTable;
use crate::scene::schema::Limit;

pub(super) const KIND: SensorKind = SensorKind {
    name: "star_tracker",
    parameters: &PARAMETERS,
    quantities: &[MeasuredQuantity::new(
        "measured_q_es",
        WXYZ,
        ["", ""],
        "Attitude quaternion measured by a star tracker, F_s -> F_e",
    )],
    observes: Observes::Attitude(|table| Arc::new(WholeAttitude(covariance_s(table)))),
    needs: None,
    replaced_by_epoch: None,
    make: |context| Box::new(StarTracker::new(context)),
};

declared! {
    /// Its numbers in campaign files.
    TrackerNumbers = PARAMETERS {
    noise: [f64; 3] = axes(
        "noise_rad",
        "rad",
        "Standard deviation about each axis of the tracker: two across the boresight, the third about it",
        Limit::NotNegative,
    );
    boresight: [f64; 3] = axes("boresight", "1", "Direction of the boresight in F_s", Limit::Direction).or(&[0.0,
        0.0, 1.0]);
    bias: [f64; 3] = axes("bias_rad", "rad", "Constant rotation vector from the true body axes to the measured ones",
        Limit::Finite);
    max_rate: f64 = optional("max_rate_rad_s", "rad/s",
        "Rate of the body above which it delivers nothing; 0: no limit");
    }
}

/// The covariance of the noise of a tracker with the numbers of `table`, in F_s, rad^2.
fn covariance_s(table: &DeclaredTable) -> [[f64; 3]; 3] {
    let numbers = TrackerNumbers::of(table);
    let c_st = from_s3_to(numbers.boresight);
    let in_tracker = diagonal(numbers.noise.map(|sigma| sigma * sigma));
    multiplied(&multiplied(&c_st, &in_tracker), &transposed(&c_st))
}

struct StarTracker {
    /// About the axes of the tracker, rad.
    deviations: [f64; 3],
    /// F_t -> F_s.
    c_st: [[f64; 3]; 3],
    /// The constant error as a quaternion.
    bias: [f64; 4],
    max_rate: f64,
    noise: NormalErrors<3>,
}

impl StarTracker {
    fn new(context: &SensorContext<'_>) -> Self {
        let numbers = TrackerNumbers::of(context.parameters);
        StarTracker {
            deviations: numbers.noise,
            c_st: from_s3_to(numbers.boresight),
            bias: quaternion_of(numbers.bias),
            max_rate: numbers.max_rate,
            noise: context.normal("noise", AXES),
        }
    }
}

impl Sensor for StarTracker {
    fn measure(&mut self, count: u64, truth: &Truth) -> Option<Values> {
        if self.max_rate > 0.0 && norm(truth.body.omega_se_s) > self.max_rate {
            return None;
        }
        let noise_s = product(self.c_st, self.noise.scaled(count, self.deviations));
        let error = hamilton(self.bias, quaternion_of(noise_s));
        Some(values(&[&hamilton(truth.body.q_es, error)]))
    }
}

#[cfg(test)]
mod tests {
    use super::super::bench::{assert_normal, sensor, table, truth};
    use super::*;
    use crate::control::measurement::part;
    use crate::control::rotation::vector_of;
    use crate::control::vector::{conjugate, difference, dot, scaled};

    const NOISE: [f64; 3] = [1e-5, 2e-5, 2e-4];

    /// The error of sample `count` about the axes of the body.
    fn error(tracker: &mut dyn Sensor, count: u64, q: [f64; 4], rate: f64) -> Option<[f64; 3]> {
        let measured = tracker.measure(count, &truth(0.0, q, [0.0, rate, 0.0]))?;
        Some(vector_of(hamilton(conjugate(q), part(&measured, 0))))
    }

    /// Law: noise about the boresight is about that direction of the body, whichever it is, and of unit length or not;
    /// across it there is none where the noise across is zero. The covariance that a filter believes is that of the
    /// errors.
    #[test]
    fn the_noise_is_about_the_axes_of_the_tracker() {
        const ABOUT: f64 = 2e-4;
        for boresight in [[0.0, 0.0, 1.0], [0.0, 0.0, -2.0], [1.0, 0.0, 0.0], [0.0, -3.0, 0.0], [0.4, -0.5, -0.9]] {
            let values: [(&str, &[f64]); 2] = [("noise_rad", &[0.0, 0.0, ABOUT]), ("boresight", &boresight)];
            let mut tracker = sensor("star_tracker", &values, 0.5, 6);
            let unit = boresight.map(|x| x / norm(boresight));
            let errors: Vec<[f64; 3]> =
                (0..4_000).filter_map(|count| error(&mut *tracker, count, [1.0, 0.0, 0.0, 0.0], 0.0)).collect();
            let along: Vec<f64> = errors.iter().map(|error| dot(*error, unit)).collect();
            assert_normal(&along, ABOUT, 1e-3);
            for (error, along) in errors.iter().zip(&along) {
                let across = difference(*error, scaled(*along, unit));
                assert!(norm(across) < 4e-15 * ABOUT.max(along.abs()) + 1e-18, "{boresight:?}: {across:?}");
            }
            let covariance = covariance_s(&table("unit", &PARAMETERS, &values));
            for (row, a) in covariance.iter().zip(unit) {
                for (found, b) in row.iter().zip(unit) {
                    assert!((found - ABOUT * ABOUT * a * b).abs() < 4e-15 * ABOUT * ABOUT, "{boresight:?}");
                }
            }
        }
        // with noise about all axes: the sample covariance of 4,000 errors is that of the filter, to six standard
        // errors (H0: they agree)
        let values: [(&str, &[f64]); 2] = [("noise_rad", &NOISE), ("boresight", &[0.6, 0.0, 0.8])];
        let mut tracker = sensor("star_tracker", &values, 0.5, 6);
        let covariance = covariance_s(&table("unit", &PARAMETERS, &values));
        let errors: Vec<[f64; 3]> =
            (0..4_000).filter_map(|count| error(&mut *tracker, count, quaternion_of([0.3, 0.2, 0.1]), 0.0)).collect();
        for i in 0..3 {
            for j in 0..3 {
                let found = errors.iter().map(|error| error[i] * error[j]).sum::<f64>() / 4_000.0;
                let error = ((covariance[i][i] * covariance[j][j] + covariance[i][j].powi(2)) / 4_000.0).sqrt();
                assert!((found - covariance[i][j]).abs() < 6.0 * error, "{i} {j}: {found} {}", covariance[i][j]);
            }
        }
        // R = C diag C^T of a boresight in the plane of s1 and s3, written out
        let expected = 0.48 * (NOISE[2].powi(2) - NOISE[0].powi(2));
        assert!((covariance[0][2] - expected).abs() < 1e-14 * expected, "{} {expected}", covariance[0][2]);
    }

    /// Law: the error about each axis of the body is normal with its deviation, at any attitude, and axes are
    /// independent: 4,000 samples, alpha 1e-3 each, seed 5.
    #[test]
    fn the_noise_is_about_the_axes_of_the_body() {
        let mut tracker = sensor("star_tracker", &[("noise_rad", &NOISE)], 0.5, 6);
        let all: Vec<[f64; 3]> = (0..4_000)
            .filter_map(|count| error(&mut *tracker, count, quaternion_of([0.01 * count as f64, 0.4, -0.3]), 0.0))
            .collect();
        assert_eq!(all.len(), 4_000);
        for axis in 0..3 {
            assert_normal(&all.iter().map(|error| error[axis]).collect::<Vec<_>>(), NOISE[axis], 1e-3);
            let next = (axis + 1) % 3;
            let both: Vec<f64> =
                all.iter().map(|error| error[axis] / NOISE[axis] + error[next] / NOISE[next]).collect();
            assert_normal(&both, std::f64::consts::SQRT_2, 1e-3);
        }
    }

    /// Law: above the largest rate nothing is measured; the noise of later samples is that without the loss. The
    /// nominal run has the bias alone.
    #[test]
    fn a_fast_body_is_not_seen() {
        let values: [(&str, &[f64]); 2] = [("noise_rad", &NOISE), ("max_rate_rad_s", &[0.03])];
        let (mut lost, mut all) = (sensor("star_tracker", &values, 0.5, 6), sensor("star_tracker", &values, 0.5, 6));
        let q = quaternion_of([0.2, 0.1, 0.0]);
        for count in 0..10 {
            let is_fast = count % 3 == 1;
            let seen = error(&mut *lost, count, q, if is_fast { 0.031 } else { 0.029 });
            let expected = error(&mut *all, count, q, 0.0);
            assert_eq!(seen, if is_fast { None } else { expected });
        }
        let mut nominal = sensor("star_tracker", &[("noise_rad", &NOISE), ("bias_rad", &[1e-3, 0.0, -2e-3])], 0.5, 0);
        let bias = error(&mut *nominal, 4, q, 0.0).expect("a measurement");
        assert!(bias.iter().zip([1e-3, 0.0, -2e-3]).all(|(a, b)| (a - b).abs() < 4e-16), "{bias:?}");
    }
}
