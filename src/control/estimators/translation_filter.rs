//! [`TranslationFilter`]: position and velocity of a point in F_e, by a linear Kalman filter with known acceleration.
//!
//! Noise is the same along all axes, and so the axes are independent: one covariance of position and velocity serves all three. What is not known of the
//! acceleration is white noise, a random walk of the velocity (Y. Bar-Shalom, X. R. Li & T. Kirubarajan, *Estimation with Applications to Tracking and
//! Navigation*, 2001, section 6.2.2).

use super::delayed::Filter;
use super::kalman::{Gain, NormalizedSquare, normalized_square, symmetric, transported};
use crate::control::measurement::PointMotion;
use crate::control::small_matrix::{added, diagonal};
use crate::control::vector::{difference, scaled, sum};

/// A step with known acceleration.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TranslationStep {
    /// Acceleration in F_e, constant over the step, m/s^2.
    pub acceleration_e: [f64; 3],
    /// Its duration, s.
    pub interval: f64,
}

/// A measured motion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MotionObservation {
    /// Position and velocity.
    pub motion: PointMotion,
    /// Standard deviations of each component of the position, m, and of the velocity, m/s.
    pub sigmas: [f64; 2],
}

/// Position, velocity and their covariance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TranslationFilter {
    /// Position and velocity.
    pub motion: PointMotion,
    /// Covariance of position (m) and velocity (m/s) along each axis.
    pub covariance: [[f64; 2]; 2],
    /// Random walk of the velocity, m/s/sqrt(s).
    pub velocity_random_walk: f64,
}

impl TranslationFilter {
    /// `motion` with errors of the standard deviations `sigmas`, m and m/s, along each axis.
    pub fn new(motion: PointMotion, sigmas: [f64; 2], velocity_random_walk: f64) -> Self {
        TranslationFilter { motion, covariance: diagonal(sigmas.map(|sigma| sigma * sigma)), velocity_random_walk }
    }

    /// The normalised square of the error (NEES).
    pub fn error_square(&self, motion: &PointMotion) -> Option<NormalizedSquare> {
        let [r, v] = errors(motion, &self.motion);
        summed((0..3).map(|axis| normalized_square(&self.covariance, [r[axis], v[axis]])))
    }
}

/// `a` minus `b`.
fn errors(a: &PointMotion, b: &PointMotion) -> [[f64; 3]; 2] {
    [difference(a.r_e, b.r_e), difference(a.v_e, b.v_e)]
}

/// The sum of squares that are independent.
fn summed(mut squares: impl Iterator<Item = Option<NormalizedSquare>>) -> Option<NormalizedSquare> {
    squares.try_fold(NormalizedSquare { value: 0.0, degrees: 0 }, |sum, square| {
        let square = square?;
        Some(NormalizedSquare { value: sum.value + square.value, degrees: sum.degrees + square.degrees })
    })
}

impl Filter for TranslationFilter {
    type Step = TranslationStep;
    type Observation = MotionObservation;

    fn propagate(&mut self, step: &TranslationStep) {
        let (t, PointMotion { r_e, v_e }) = (step.interval, self.motion);
        let moved = sum(scaled(t, v_e), scaled(0.5 * t * t, step.acceleration_e));
        self.motion = PointMotion { r_e: sum(r_e, moved), v_e: sum(v_e, scaled(t, step.acceleration_e)) };
        let walk = self.velocity_random_walk * self.velocity_random_walk * t;
        let noise = [[walk * t * t / 3.0, 0.5 * walk * t], [0.5 * walk * t, walk]];
        self.covariance = symmetric(&added(&transported(&[[1.0, t], [0.0, 1.0]], &self.covariance), &noise));
    }

    fn update(&mut self, observation: &MotionObservation) -> Option<NormalizedSquare> {
        let [r, v] = errors(&observation.motion, &self.motion);
        let noise = diagonal(observation.sigmas.map(|sigma| sigma * sigma));
        let gain = Gain::of(&mut self.covariance, &diagonal([1.0; 2]), &noise)?;
        let corrections: [[f64; 2]; 3] = std::array::from_fn(|axis| gain.correction([r[axis], v[axis]]));
        self.motion.r_e = sum(self.motion.r_e, corrections.map(|[of_position, _]| of_position));
        self.motion.v_e = sum(self.motion.v_e, corrections.map(|[_, of_velocity]| of_velocity));
        summed((0..3).map(|axis| Some(gain.square([r[axis], v[axis]]))))
    }
}
