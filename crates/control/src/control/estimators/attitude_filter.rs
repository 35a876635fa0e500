//! [`AttitudeFilter`]: attitude and gyro bias by a multiplicative extended Kalman filter (E. J. Lefferts, F. L. Markley
//! & M. D. Shuster, J. Guidance 5(5), 1982).
//!
//! The attitude error is a rotation vector in F_s, true = estimated (x) error; the bias error is true minus estimated.
//! Errors of the rate-integrating gyro ([`crate::control::sensors`]) add to the rotation vector and so enter the
//! attitude by its right Jacobian J: transition and noise of a step are exact at any rate. At zero rate J = 1, and the
//! noise is Farrenkopf's: sv^2 T + su^2 T^3/3, -su^2 T^2/2, su^2 T.

use std::sync::Arc;

use super::delayed::Filter;
use super::kalman::{NormalizedSquare, WholeAttitude, blocks, corners, halves, symmetric, updated};
use crate::loops::measurement::{Values, values};
use crate::loops::observes::{AttitudeInnovation, AttitudeSensor, GyroNoise};
use crate::loops::vector::{
    added, conjugate, cross, dcm_from_quaternion, diagonal, difference, hamilton, multiplied, norm, quaternion_of,
    scaled, sum, transposed,
};

/// A step by a measured rotation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GyroStep {
    /// Measured rotation vector, including the bias, rad.
    pub rotation_s: [f64; 3],
    /// Measured rate, including the bias, rad/s; gives the estimated rate.
    pub rate_s: [f64; 3],
    pub interval: f64,
}

#[derive(Clone, Debug)]
pub struct AttitudeObservation {
    pub values: Values,
    /// The filter's model of the sensor.
    pub sensor: Arc<dyn AttitudeSensor>,
    pub time: f64,
}

impl AttitudeObservation {
    /// The attitude `q_es` (F_s -> F_e, scalar first) with the error covariance `covariance` in F_s, rad^2.
    pub fn whole(q_es: [f64; 4], covariance: [[f64; 3]; 3]) -> Self {
        AttitudeObservation { values: values(&[&q_es]), sensor: Arc::new(WholeAttitude(covariance)), time: 0.0 }
    }

    pub fn innovation(&self, q_es: [f64; 4]) -> AttitudeInnovation {
        self.sensor.innovation(&self.values, q_es, self.time)
    }
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AttitudeFilter {
    pub q_es: [f64; 4],
    pub bias_s: [f64; 3],
    /// Covariance of the errors of attitude (rad) and bias (rad/s).
    pub covariance: [[f64; 6]; 6],
    /// Last measured rate, including the bias, rad/s.
    pub rate_s: [f64; 3],
    pub noise: GyroNoise,
}

impl AttitudeFilter {
    /// A filter at `q_es` with zero bias; standard deviations about each axis in rad and rad/s.
    pub fn new(q_es: [f64; 4], attitude_sigma: f64, bias_sigma: f64, noise: GyroNoise) -> Self {
        let (a, b) = (attitude_sigma * attitude_sigma, bias_sigma * bias_sigma);
        AttitudeFilter { q_es, bias_s: [0.0; 3], covariance: diagonal([a, a, a, b, b, b]), rate_s: [0.0; 3], noise }
    }

    pub fn omega_se_s(&self) -> [f64; 3] {
        difference(self.rate_s, self.bias_s)
    }
}

impl Filter for AttitudeFilter {
    type Step = GyroStep;
    type Observation = AttitudeObservation;

    fn propagate(&mut self, step: &GyroStep) {
        let t = step.interval;
        let rotation = difference(step.rotation_s, scaled(t, self.bias_s));
        let turn = quaternion_of(rotation);
        self.q_es = normalized(hamilton(self.q_es, turn));
        self.rate_s = step.rate_s;
        let jacobian = right_jacobian(rotation);
        let of_bias = jacobian.map(|row| scaled(-t, row));
        let of_attitude = dcm_from_quaternion(conjugate(turn));
        let white = self.noise.angular_random_walk * self.noise.angular_random_walk;
        let walk = self.noise.bias_random_walk * self.noise.bias_random_walk;
        // block by block, since the transition is [[of_attitude, of_bias], [0, 1]]: a third of the products
        let [tt, tb, bb] = corners(&self.covariance);
        let to_attitude = added(&multiplied(&of_attitude, &tt), &multiplied(&of_bias, &transposed(&tb)));
        let to_bias = added(&multiplied(&of_attitude, &tb), &multiplied(&of_bias, &bb));
        let moved =
            added(&multiplied(&to_attitude, &transposed(&of_attitude)), &multiplied(&to_bias, &transposed(&of_bias)));
        let noise = multiplied(&jacobian, &transposed(&jacobian));
        let attitude = added(&moved, &noise.map(|row| scaled(white * t + walk * t * t * t / 3.0, row)));
        let across = added(&to_bias, &jacobian.map(|row| scaled(-0.5 * walk * t * t, row)));
        self.covariance =
            blocks(symmetric(&attitude), across, transposed(&across), added(&bb, &diagonal([walk * t; 3])));
    }

    fn update(&mut self, observation: &AttitudeObservation) -> Option<NormalizedSquare> {
        let (correction, square) = updated(&observation.innovation(self.q_es), &mut self.covariance)?;
        let (turn, bias) = halves(correction);
        self.q_es = normalized(hamilton(self.q_es, quaternion_of(turn)));
        self.bias_s = sum(self.bias_s, bias);
        Some(square)
    }
}

/// The right Jacobian J, exp(v + e) = exp(v) exp(J e) for small e: 1 - (1 - cos v)/v^2 [v x] + (v - sin v)/v^3 [v x]^2.
pub(super) fn right_jacobian(v: [f64; 3]) -> [[f64; 3]; 3] {
    let angle = norm(v);
    let square = angle * angle;
    let (a, b) = if angle < 0.1 {
        // neglected terms are below 1e-16
        let a = 0.5 - square * (1.0 / 24.0 - square * (1.0 / 720.0 - square * (1.0 / 40_320.0 - square / 3_628_800.0)));
        let b = 1.0 / 6.0 - square * (1.0 / 120.0 - square * (1.0 / 5_040.0 - square / 362_880.0));
        (a, b)
    } else {
        ((1.0 - libm::cos(angle)) / square, (angle - libm::sin(angle)) / (square * angle))
    };
    let columns: [[f64; 3]; 3] = std::array::from_fn(|j| {
        let unit: [f64; 3] = std::array::from_fn(|i| f64::from(u8::from(i == j)));
        let once = cross(v, unit);
        sum(sum(unit, scaled(-a, once)), scaled(b, cross(v, once)))
    });
    transposed(&columns)
}

pub(super) fn normalized(q: [f64; 4]) -> [f64; 4] {
    let length = q.iter().map(|x| x * x).sum::<f64>().sqrt();
    q.map(|x| x / length)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::control::estimators::delayed::Delayed;

    /// Output of tests/golden/attitude_filter.py.
    #[derive(serde::Deserialize)]
    struct Golden {
        tick_s: f64,
        angular_random_walk: f64,
        bias_random_walk: f64,
        tracker_sigmas: [f64; 3],
        start_sigmas: [f64; 2],
        start_q_es: [f64; 4],
        rotations: Vec<[f64; 3]>,
        attitudes: Vec<GoldenAttitude>,
        estimates: Vec<GoldenEstimate>,
    }

    #[derive(serde::Deserialize)]
    struct GoldenAttitude {
        taken: usize,
        age: usize,
        q_es: [f64; 4],
    }

    #[derive(serde::Deserialize)]
    struct GoldenEstimate {
        c_es: [f64; 9],
        bias_s: [f64; 3],
        covariance: Vec<f64>,
    }

    /// Law: an independent implementation (matrices, series, information form, 40 digits, no history) fed with the same
    /// rotations and the same late, unordered attitudes agrees at every tick: attitude and bias to 6e-15, covariance to
    /// 1e-14 of the diagonal (measured: 6.1e-16, 1.2e-15).
    #[test]
    fn an_independent_implementation_agrees() {
        let golden: Golden = serde_json::from_str(include_str!("../../../../../tests/golden/attitude_filter.json"))
            .expect("golden numbers");
        let noise =
            GyroNoise { angular_random_walk: golden.angular_random_walk, bias_random_walk: golden.bias_random_walk };
        let [attitude, bias] = golden.start_sigmas;
        let mut filter = Delayed::new(AttitudeFilter::new(golden.start_q_es, attitude, bias, noise), 5);
        let covariance = diagonal(golden.tracker_sigmas.map(|sigma| sigma * sigma));
        let (mut largest, mut largest_covariance) = (0.0_f64, 0.0_f64);
        for (tick, expected) in golden.estimates.iter().enumerate() {
            if tick > 0 {
                let (rotation_s, interval) = (golden.rotations[tick - 1], golden.tick_s);
                filter.propagate(GyroStep { rotation_s, rate_s: [0.0; 3], interval });
            }
            for seen in golden.attitudes.iter().filter(|seen| seen.taken + seen.age == tick) {
                filter.update(AttitudeObservation::whole(seen.q_es, covariance), seen.age);
            }
            let now = filter.at(0);
            let c_es = dcm_from_quaternion(now.q_es);
            let found = c_es.iter().flatten().chain(&now.bias_s);
            for (a, b) in found.zip(expected.c_es.iter().chain(&expected.bias_s)) {
                largest = largest.max((a - b).abs());
            }
            let upper = (0..6).flat_map(|i| (i..6).map(move |j| (i, j)));
            for ((i, j), b) in upper.zip(&expected.covariance) {
                let scale = (now.covariance[i][i] * now.covariance[j][j]).sqrt();
                largest_covariance = largest_covariance.max((now.covariance[i][j] - b).abs() / scale);
            }
        }
        assert_eq!(golden.estimates.len(), golden.rotations.len() + 1);
        assert!(largest < 6e-15 && largest_covariance < 1e-14, "{largest} and {largest_covariance}");
    }
}
