//! [`Estimate`]: what flight software believes of the state at a tick.

use super::rotation::vector_of;
use super::truth::{DebrisState, Truth};
use crate::control::vector::{conjugate, difference, hamilton, norm};
use crate::scene::MAX_WHEELS;

/// The estimated state at a tick.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Estimate {
    /// Attitude quaternion, F_s -> F_e, scalar first.
    pub q_es: [f64; 4],
    /// Angular velocity of F_s relative to F_e, in F_s, rad/s.
    pub omega_se_s: [f64; 3],
    /// Bias of the gyro, in F_s, rad/s.
    pub gyro_bias_s: [f64; 3],
    /// Position of the spacecraft's centre of mass c in F_e, m.
    pub r_co_e: [f64; 3],
    /// Velocity of c relative to F_e, in F_e, m/s.
    pub v_co_e: [f64; 3],
    /// Rates of the wheels relative to the body, rad/s.
    pub wheel_rates: [f64; MAX_WHEELS],
    /// The debris, where the nominal scene has one.
    pub debris: Option<DebrisState>,
}

/// How far an estimate is from the truth; the debris's errors are NaN where there is none.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EstimateErrors {
    /// Angle between estimated and true attitude, rad.
    pub attitude: f64,
    /// Magnitude of the error of omega_se_s, rad/s.
    pub rate: f64,
    /// Distance between estimated and true centre of mass, m.
    pub position: f64,
    /// Magnitude of the error of its velocity, m/s.
    pub velocity: f64,
    /// Magnitude of the error of its position relative to the debris, m.
    pub relative_position: f64,
    /// Magnitude of the error of its velocity relative to the debris, m/s.
    pub relative_velocity: f64,
    /// Angle between estimated and true attitude of the debris, rad.
    pub debris_attitude: f64,
    /// Magnitude of the error of omega_de_d, rad/s.
    pub debris_rate: f64,
}

impl EstimateErrors {
    /// Of perfect knowledge.
    pub const NONE: EstimateErrors = EstimateErrors {
        attitude: 0.0,
        rate: 0.0,
        position: 0.0,
        velocity: 0.0,
        relative_position: 0.0,
        relative_velocity: 0.0,
        debris_attitude: 0.0,
        debris_rate: 0.0,
    };
}

impl Estimate {
    /// The true state itself.
    pub fn perfect(truth: &Truth) -> Self {
        Estimate {
            q_es: truth.body.q_es,
            omega_se_s: truth.body.omega_se_s,
            gyro_bias_s: [0.0; 3],
            r_co_e: truth.body.r_co_e,
            v_co_e: truth.body.v_co_e,
            wheel_rates: truth.wheel_rates,
            debris: truth.debris,
        }
    }

    /// Becomes the true state itself.
    pub fn know(&mut self, truth: &Truth) {
        self.q_es = truth.body.q_es;
        self.omega_se_s = truth.body.omega_se_s;
        self.gyro_bias_s = [0.0; 3];
        self.r_co_e = truth.body.r_co_e;
        self.v_co_e = truth.body.v_co_e;
        self.wheel_rates = truth.wheel_rates;
        if self.debris.is_some() || truth.debris.is_some() {
            self.debris = truth.debris;
        }
    }

    /// Whether all of it is finite.
    pub fn is_finite(&self) -> bool {
        // a product by zero is NaN of what is not finite, and a sum cannot overflow
        let zero = |numbers: &[f64]| numbers.iter().fold(0.0, |sum, number| sum + 0.0 * number);
        let own = zero(&self.q_es) + zero(&self.omega_se_s) + zero(&self.gyro_bias_s) + zero(&self.wheel_rates);
        let of_debris = self.debris.as_ref().map_or(0.0, |debris| {
            zero(&debris.r_gdo_e) + zero(&debris.v_gdo_e) + zero(&debris.q_ed) + zero(&debris.omega_de_d)
        });
        own + zero(&self.r_co_e) + zero(&self.v_co_e) + of_debris == 0.0
    }

    /// Its errors where the state is `truth`.
    pub fn errors(&self, truth: &Truth) -> EstimateErrors {
        let angle = |a, b| norm(vector_of(hamilton(conjugate(a), b)));
        let body = &truth.body;
        let (position, velocity) = (difference(self.r_co_e, body.r_co_e), difference(self.v_co_e, body.v_co_e));
        let mut errors = EstimateErrors {
            attitude: angle(self.q_es, body.q_es),
            rate: norm(difference(self.omega_se_s, body.omega_se_s)),
            position: norm(position),
            velocity: norm(velocity),
            relative_position: f64::NAN,
            relative_velocity: f64::NAN,
            debris_attitude: f64::NAN,
            debris_rate: f64::NAN,
        };
        if let (Some(believed), Some(debris)) = (&self.debris, &truth.debris) {
            errors.relative_position = norm(difference(position, difference(believed.r_gdo_e, debris.r_gdo_e)));
            errors.relative_velocity = norm(difference(velocity, difference(believed.v_gdo_e, debris.v_gdo_e)));
            errors.debris_attitude = angle(believed.q_ed, debris.q_ed);
            errors.debris_rate = norm(difference(believed.omega_de_d, debris.omega_de_d));
        }
        errors
    }
}
