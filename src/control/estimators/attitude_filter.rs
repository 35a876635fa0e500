//! [`AttitudeFilter`]: attitude and bias of the gyro, by a multiplicative extended Kalman filter.
//!
//! E. J. Lefferts, F. L. Markley & M. D. Shuster, J. Guidance 5(5), 1982. The error of the attitude is a rotation vector in F_s, true = estimated (x) error; that
//! of the bias is true minus estimated. The gyro is a rate-integrating one ([`crate::control::sensors`]): its errors add to the rotation vector, so that they
//! turn the attitude by the right Jacobian J of that vector, and transition and noise of a step are exact for it at any rate. At zero rate J = 1, and the
//! noise is Farrenkopf's: sv^2 T + su^2 T^3/3, -su^2 T^2/2, su^2 T.
//!
//! Not here: measurements that come late ([`super::delayed`]).

use super::delayed::Filter;
use super::kalman::{Gain, NormalizedSquare, blocks, halves, normalized_square, symmetric, transported};
use crate::control::rotation::{quaternion_of, vector_of};
use crate::control::small_matrix::{added, diagonal, multiplied, transposed};
use crate::math::vector::{conjugate, cross, dcm_from_quaternion, difference, hamilton, norm, scaled, sum};

/// The noise of a gyro, as the filter believes it: Farrenkopf's sv, rad/sqrt(s), and su, rad/s/sqrt(s).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GyroNoise {
    /// Angular random walk sv.
    pub angular_random_walk: f64,
    /// Random walk of the bias su.
    pub bias_random_walk: f64,
}

/// A step by a measured rotation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GyroStep {
    /// The rotation vector as measured, with the bias, rad.
    pub rotation_s: [f64; 3],
    /// The rate as measured, with the bias, rad/s: what the rate of the estimate follows from.
    pub rate_s: [f64; 3],
    /// Its duration T, s.
    pub interval: f64,
}

/// A measured attitude.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AttitudeObservation {
    /// Attitude quaternion, F_s -> F_e, scalar first.
    pub q_es: [f64; 4],
    /// Covariance of its error in F_s, rad^2.
    pub covariance: [[f64; 3]; 3],
}

/// Attitude, gyro bias and their covariance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AttitudeFilter {
    /// Attitude quaternion, F_s -> F_e, scalar first.
    pub q_es: [f64; 4],
    /// Bias of the gyro, in F_s, rad/s.
    pub bias_s: [f64; 3],
    /// Covariance of the errors of attitude (rad) and bias (rad/s).
    pub covariance: [[f64; 6]; 6],
    /// Rate as last measured, with the bias, rad/s.
    pub rate_s: [f64; 3],
    /// The noise of the gyro.
    pub noise: GyroNoise,
}

/// What a measured attitude sees of the error.
pub(super) const ATTITUDE_ONLY: [[f64; 6]; 3] =
    [[1.0, 0.0, 0.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0, 0.0, 0.0]];

impl AttitudeFilter {
    /// Attitude `q_es` with an error of standard deviation `attitude_sigma` (rad) about each axis, no bias with one of `bias_sigma` (rad/s).
    pub fn new(q_es: [f64; 4], attitude_sigma: f64, bias_sigma: f64, noise: GyroNoise) -> Self {
        let (a, b) = (attitude_sigma * attitude_sigma, bias_sigma * bias_sigma);
        AttitudeFilter { q_es, bias_s: [0.0; 3], covariance: diagonal([a, a, a, b, b, b]), rate_s: [0.0; 3], noise }
    }

    /// Angular velocity of F_s relative to F_e, in F_s, rad/s.
    pub fn omega_se_s(&self) -> [f64; 3] {
        difference(self.rate_s, self.bias_s)
    }

    /// Covariance of the attitude, in F_s, rad^2.
    pub fn attitude_covariance(&self) -> [[f64; 3]; 3] {
        std::array::from_fn(|i| std::array::from_fn(|j| self.covariance[i][j]))
    }

    /// The normalised square of the error (NEES) of attitude and, where the true bias is known, bias.
    pub fn error_square(&self, q_es: [f64; 4], bias_s: Option<[f64; 3]>) -> Option<NormalizedSquare> {
        let [x, y, z] = vector_of(hamilton(conjugate(self.q_es), q_es));
        match bias_s {
            Some(bias) => {
                let [u, v, w] = difference(bias, self.bias_s);
                normalized_square(&self.covariance, [x, y, z, u, v, w])
            }
            None => normalized_square(&self.attitude_covariance(), [x, y, z]),
        }
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
        let [one, zero] = [diagonal([1.0; 3]), diagonal([0.0; 3])];
        let transition = blocks(dcm_from_quaternion(conjugate(turn)), of_bias, zero, one);
        let white = self.noise.angular_random_walk * self.noise.angular_random_walk;
        let walk = self.noise.bias_random_walk * self.noise.bias_random_walk;
        let across = jacobian.map(|row| scaled(-0.5 * walk * t * t, row));
        let attitude = multiplied(&jacobian, &transposed(&jacobian));
        let noise = blocks(
            attitude.map(|row| scaled(white * t + walk * t * t * t / 3.0, row)),
            across,
            transposed(&across),
            diagonal([walk * t; 3]),
        );
        self.covariance = symmetric(&added(&transported(&transition, &self.covariance), &noise));
    }

    fn update(&mut self, observation: &AttitudeObservation) -> Option<NormalizedSquare> {
        let innovation = vector_of(hamilton(conjugate(self.q_es), observation.q_es));
        let gain = Gain::of(&mut self.covariance, &ATTITUDE_ONLY, &observation.covariance)?;
        let (turn, bias) = halves(gain.correction(innovation));
        self.q_es = normalized(hamilton(self.q_es, quaternion_of(turn)));
        self.bias_s = sum(self.bias_s, bias);
        Some(gain.square(innovation))
    }
}

/// J with exp(v + e) = exp(v) exp(J e) for small e: 1 - (1 - cos v)/v^2 [v x] + (v - sin v)/v^3 [v x]^2.
pub(super) fn right_jacobian(v: [f64; 3]) -> [[f64; 3]; 3] {
    let angle = norm(v);
    let square = angle * angle;
    let (a, b) = if angle < 0.1 {
        // the first neglected terms are below 1e-16
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

/// The quaternion over its norm.
pub(super) fn normalized(q: [f64; 4]) -> [f64; 4] {
    let length = q.iter().map(|x| x * x).sum::<f64>().sqrt();
    q.map(|x| x / length)
}
