//! [`TranslationFilter`]: position and velocity of a point in F_e, by a linear Kalman filter with known acceleration.
//!
//! Noise is alike along all axes, so one covariance of position and velocity serves all three. Unknown acceleration is
//! a random walk of the velocity (Y. Bar-Shalom, X. R. Li & T. Kirubarajan, *Estimation with Applications to Tracking
//! and Navigation*, 2001, section 6.2.2).
//!
//! On an orbit the central body's pull at the estimate is added by the Runge-Kutta-Nyström method of order 4 (E.
//! Hairer, S. Norsett & G. Wanner, *Solving Ordinary Differential Equations I*, 1993, table II.14.2). The covariance
//! neglects the gravity gradient: (n t)^2, 1e-6 between measurements.

use super::delayed::Filter;
use super::kalman::{Gain, NormalizedSquare, symmetric, transported};
use crate::dynamics::gravity::Gravity;
use crate::loops::measurement::PointMotion;
use crate::loops::vector::{added, diagonal, difference, norm, scaled, sum};

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TranslationStep {
    /// Acceleration in F_e, constant over the step, m/s^2.
    pub acceleration_e: [f64; 3],
    pub interval: f64,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MotionObservation {
    pub motion: PointMotion,
    /// Standard deviations of each component of position (m) and velocity (m/s).
    pub sigmas: [f64; 2],
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TranslationFilter {
    pub motion: PointMotion,
    /// Covariance of position (m) and velocity (m/s) along each axis.
    pub covariance: [[f64; 2]; 2],
    pub velocity_random_walk: f64,
    /// Gravity of the central body at the origin of F_e, if any.
    pub gravity: Option<Gravity<f64>>,
}

/// The motion of `point` after `t` seconds under `gravity` of a central body at the origin and the constant
/// acceleration `acceleration_e` (F_e, m/s^2).
pub fn falling(point: &PointMotion, gravity: &Gravity<f64>, acceleration_e: [f64; 3], t: f64) -> PointMotion {
    let PointMotion { r_e, v_e } = *point;
    let pull = |r: [f64; 3]| sum(acceleration_e, gravity.acceleration(r, norm(r)));
    let first = pull(r_e);
    let middle = pull(sum(r_e, sum(scaled(0.5 * t, v_e), scaled(0.125 * t * t, first))));
    let last = pull(sum(r_e, sum(scaled(t, v_e), scaled(0.5 * t * t, middle))));
    let moved = sum(scaled(t, v_e), scaled(t * t / 6.0, sum(first, scaled(2.0, middle))));
    PointMotion { r_e: sum(r_e, moved), v_e: sum(v_e, scaled(t / 6.0, sum(sum(first, last), scaled(4.0, middle)))) }
}

impl TranslationFilter {
    /// A filter at `motion` with the standard deviations `sigmas` (m, m/s) along each axis.
    pub fn new(
        motion: PointMotion,
        sigmas: [f64; 2],
        velocity_random_walk: f64,
        gravity: Option<Gravity<f64>>,
    ) -> Self {
        let covariance = diagonal(sigmas.map(|sigma| sigma * sigma));
        TranslationFilter { motion, covariance, velocity_random_walk, gravity }
    }
}

fn errors(a: &PointMotion, b: &PointMotion) -> [[f64; 3]; 2] {
    [difference(a.r_e, b.r_e), difference(a.v_e, b.v_e)]
}

impl Filter for TranslationFilter {
    type Step = TranslationStep;
    type Observation = MotionObservation;

    fn propagate(&mut self, step: &TranslationStep) {
        let (t, PointMotion { r_e, v_e }) = (step.interval, self.motion);
        self.motion = match &self.gravity {
            Some(gravity) => falling(&self.motion, gravity, step.acceleration_e, t),
            None => {
                let moved = sum(scaled(t, v_e), scaled(0.5 * t * t, step.acceleration_e));
                PointMotion { r_e: sum(r_e, moved), v_e: sum(v_e, scaled(t, step.acceleration_e)) }
            }
        };
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
        NormalizedSquare::sum((0..3).map(|axis| Some(gain.square([r[axis], v[axis]]))))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dynamics::orbit::KeplerOrbit;
    use crate::scene::Orbit;

    /// Law: a falling point stays on its Kepler orbit to fourth order in the step, and a known acceleration adds t^2/2
    /// of itself.
    #[test]
    fn a_falling_point_is_on_its_orbit() {
        let orbit = Orbit {
            mu: 3.986004418e14,
            position: [7e6, 1e6, -2e5],
            velocity: [100.0, 7100.0, 2900.0],
            body_radius: 0.0,
            j2: None,
            epoch: None,
        };
        let start = PointMotion { r_e: orbit.position, v_e: orbit.velocity };
        let truth = KeplerOrbit::new(&orbit).state(600.0);
        let gravity = Gravity::of(&orbit);
        let off = |step: f64, steps: u32| {
            let end = (0..steps).fold(start, |at, _| falling(&at, &gravity, [0.0; 3], step));
            [norm(difference(end.r_e, truth.position)), norm(difference(end.v_e, truth.velocity))]
        };
        let [near, far] = [off(10.0, 60), off(20.0, 30)];
        assert!(near[0] < 1e-3 && near[1] < 1e-5, "{near:?}");
        assert!((12.0..20.0).contains(&(far[0] / near[0])), "{near:?} {far:?}");
        let [pushed, free] = [[1e-3, 0.0, 0.0], [0.0; 3]].map(|push| falling(&start, &gravity, push, 2.0));
        assert!(norm(difference(difference(pushed.r_e, free.r_e), [2e-3, 0.0, 0.0])) < 1e-8);
        // bound: gravity gradient 2e-6/s^2 at 2e-3 m, over two seconds
        assert!(norm(difference(difference(pushed.v_e, free.v_e), [2e-3, 0.0, 0.0])) < 8e-9);
    }
}
