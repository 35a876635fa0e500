//! [`RigidBodyFilter`]: attitude and rate of a rigid body of known inertia by a multiplicative extended Kalman filter,
//! for the debris and for a spacecraft without gyro.
//!
//! The body follows K omega' = H x omega + u, H = K omega + h, with known torque u and wheel momentum h; unknown torque
//! is a random walk of the rate. Errors are a rotation vector in the body frame, as in [`super::attitude_filter`], and
//! true minus estimated rate.

use super::attitude_filter::{AttitudeObservation, normalized};
use super::delayed::Filter;
use super::kalman::{Gain, NormalizedSquare, blocks, halves, symmetric, transported, updated};
use crate::loops::vector::{
    added, conjugate, cross, dcm_from_quaternion, diagonal, difference, hamilton, inverse, multiplied, norm, product,
    quaternion_of, scaled, sum, vector_of,
};

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BodyStep {
    /// Torque on the body in its frame, constant over the step, N m.
    pub torque: [f64; 3],
    /// Momentum of its wheels in its frame, constant over the step, N m s.
    pub momentum: [f64; 3],
    pub interval: f64,
}

#[derive(Clone, Debug)]
pub enum BodyObservation {
    Attitude(AttitudeObservation),
    AttitudeAndRate(MeasuredMotion),
}

/// Measured attitude and rate, with error covariances in the body frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MeasuredMotion {
    pub q: [f64; 4],
    pub attitude_covariance: [[f64; 3]; 3],
    pub omega: [f64; 3],
    pub rate_covariance: [[f64; 3]; 3],
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RigidBodyFilter {
    pub q: [f64; 4],
    pub omega: [f64; 3],
    /// Covariance of the errors of attitude (rad) and rate (rad/s).
    pub covariance: [[f64; 6]; 6],
    inertia: [[f64; 3]; 3],
    inverse: [[f64; 3]; 3],
    rate_random_walk: f64,
}

/// Largest turn |omega| h of an integration step, rad (error of a step: some 0.05^5/100 rad), and most steps in a tick.
const LARGEST_TURN: f64 = 0.05;
const MOST_STEPS: f64 = 64.0;

impl RigidBodyFilter {
    /// A body of inertia K (kg m^2, about its centre of mass, in its frame); `sigmas` are the standard deviations of
    /// attitude (rad) and rate (rad/s) about each axis.
    pub fn new(inertia: [[f64; 3]; 3], q: [f64; 4], omega: [f64; 3], sigmas: [f64; 2], rate_random_walk: f64) -> Self {
        let [a, b] = sigmas.map(|sigma| sigma * sigma);
        let covariance = diagonal([a, a, a, b, b, b]);
        RigidBodyFilter { q, omega, covariance, inertia, inverse: inverse(inertia), rate_random_walk }
    }

    fn acceleration(&self, omega: [f64; 3], step: &BodyStep) -> [f64; 3] {
        let momentum = sum(product(self.inertia, omega), step.momentum);
        product(self.inverse, sum(cross(momentum, omega), step.torque))
    }

    /// d omega'/d omega = K^-1 ([H x] - [omega x] K).
    fn slope(&self, omega: [f64; 3], step: &BodyStep) -> [[f64; 3]; 3] {
        let momentum = sum(product(self.inertia, omega), step.momentum);
        let columns: [[f64; 3]; 3] = std::array::from_fn(|j| {
            let of_rate: [f64; 3] = std::array::from_fn(|i| f64::from(u8::from(i == j)));
            let of_momentum: [f64; 3] = std::array::from_fn(|i| self.inertia[i][j]);
            product(self.inverse, sum(cross(momentum, of_rate), cross(of_momentum, omega)))
        });
        crate::loops::vector::transposed(&columns)
    }

    /// Steps by `h` seconds: the rate by the classical Runge-Kutta method, the attitude by a rotation vector of fourth
    /// order, the covariance by the exact attitude transition, a rate transition of second order and the trapezoidal
    /// rule across.
    fn step(&mut self, h: f64, step: &BodyStep) {
        let before = self.omega;
        let k1 = self.acceleration(before, step);
        let k2 = self.acceleration(sum(before, scaled(0.5 * h, k1)), step);
        let k3 = self.acceleration(sum(before, scaled(0.5 * h, k2)), step);
        let k4 = self.acceleration(sum(before, scaled(h, k3)), step);
        let after = sum(before, scaled(h / 6.0, sum(sum(k1, k4), scaled(2.0, sum(k2, k3)))));
        let bend = difference(k1, self.acceleration(after, step));
        let middle = sum(scaled(0.5, sum(before, after)), scaled(0.125 * h, bend));
        let mean = scaled(1.0 / 6.0, sum(sum(before, after), scaled(4.0, middle)));
        let turn = quaternion_of(sum(scaled(h, mean), scaled(h * h / 12.0, cross(before, after))));
        self.q = normalized(hamilton(self.q, turn));
        self.omega = after;

        let attitude = dcm_from_quaternion(conjugate(turn));
        let slope = self.slope(middle, step).map(|row| scaled(h, row));
        let second = multiplied(&slope, &slope).map(|row| scaled(0.5, row));
        let rate = added(&diagonal([1.0; 3]), &added(&slope, &second));
        let across = added(&attitude, &rate).map(|row| scaled(0.5 * h, row));
        let transition = blocks(attitude, across, diagonal([0.0; 3]), rate);
        let walk = self.rate_random_walk * self.rate_random_walk * h;
        let both = diagonal([0.5 * walk * h; 3]);
        let noise = blocks(diagonal([walk * h * h / 3.0; 3]), both, both, diagonal([walk; 3]));
        self.covariance = symmetric(&added(&transported(&transition, &self.covariance), &noise));
    }
}

impl Filter for RigidBodyFilter {
    type Step = BodyStep;
    type Observation = BodyObservation;

    fn propagate(&mut self, step: &BodyStep) {
        let steps = (norm(self.omega) * step.interval / LARGEST_TURN).ceil().clamp(1.0, MOST_STEPS);
        let h = step.interval / steps;
        for _ in 0..steps as usize {
            self.step(h, step);
        }
    }

    fn update(&mut self, observation: &BodyObservation) -> Option<NormalizedSquare> {
        let (correction, square) = match observation {
            BodyObservation::Attitude(attitude) => updated(&attitude.innovation(self.q), &mut self.covariance)?,
            BodyObservation::AttitudeAndRate(seen) => {
                let [x, y, z] = vector_of(hamilton(conjugate(self.q), seen.q));
                let [u, v, w] = difference(seen.omega, self.omega);
                let zero = diagonal([0.0; 3]);
                let noise = blocks(seen.attitude_covariance, zero, zero, seen.rate_covariance);
                let gain = Gain::of(&mut self.covariance, &diagonal([1.0; 6]), &noise)?;
                let innovation = [x, y, z, u, v, w];
                (gain.correction(innovation), gain.square(innovation))
            }
        };
        let (turn, rate) = halves(correction);
        self.q = normalized(hamilton(self.q, quaternion_of(turn)));
        self.omega = sum(self.omega, rate);
        Some(square)
    }
}
