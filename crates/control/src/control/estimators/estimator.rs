//! [`Estimator`] and [`EstimatorKind`]: the interface of estimators.

use super::delayed::Innovations;
use crate::loops::estimate::{DebrisState, Estimate};
use crate::loops::kinds::EstimatorKind;
use crate::loops::measurement::{Measurement, PointMotion};
use crate::loops::observes::Observes;
use crate::loops::vector::{cross, dcm_from_quaternion, product, sum};
use crate::scene::{DeclaredTable, MAX_WHEELS, Scene};

#[derive(Clone, Copy, Debug)]
pub struct Update<'a> {
    /// Time since the last tick, s; 0 at the first.
    pub interval: f64,
    pub measurements: &'a [Measurement],
    /// Mean acceleration of the commanded thrust since the last tick, in F_s, m/s^2.
    pub acceleration_s: [f64; 3],
    /// Mean torque on the body commanded since the last tick (thrusters and motor reactions), in F_s, N m.
    pub torque_s: [f64; 3],
    /// Motor torques on the wheels commanded since the last tick, N m.
    pub motor_torques: [f64; MAX_WHEELS],
    pub state: Option<&'a Estimate>,
}

pub const FILTERS: usize = 4;

/// Confidence of each filter, if it exists: attitude, motion, and those of the debris, motion and attitude.
pub type Filters = [Option<Confidence>; FILTERS];

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Confidence {
    pub covariance: Covariance,
    pub innovations: Innovations,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Covariance {
    AttitudeAndBias {
        covariance: [[f64; 6]; 6],
        /// Variance of the measured rate about its bias, rad^2/s^2.
        rate_variance: f64,
    },
    AttitudeAndRate([[f64; 6]; 6]),
    /// Position (m) and velocity (m/s), alike along each axis.
    Motion([[f64; 2]; 2]),
}

pub trait Estimator: Send {
    /// Moves `estimate` from the last tick to this one; called once per tick.
    fn update(&mut self, update: &Update<'_>, estimate: &mut Estimate);

    fn filters(&self) -> Filters {
        [None; FILTERS]
    }
}

/// A sensor as an estimator knows it.
#[derive(Clone, Copy, Debug)]
pub struct KnownSensor<'a> {
    pub observes: Observes,
    pub period: f64,
    pub latency: f64,
    pub parameters: &'a DeclaredTable,
}

#[derive(Clone, Copy, Debug)]
pub struct EstimatorContext<'a> {
    pub nominal: &'a Scene,
    pub parameters: &'a DeclaredTable,
    pub sensors: &'a [KnownSensor<'a>],
    pub tick: f64,
}

impl EstimatorContext<'_> {
    pub fn start(&self) -> Estimate {
        let initial = &self.nominal.initial;
        let base = PointMotion { r_e: initial.r_po_e, v_e: initial.v_po_e };
        let center = center_of(base, self.nominal.mass.center, initial.q_es, initial.omega_se_s);
        Estimate {
            q_es: initial.q_es,
            omega_se_s: initial.omega_se_s,
            gyro_bias_s: [0.0; 3],
            r_co_e: center.r_e,
            v_co_e: center.v_e,
            wheel_rates: initial.wheel_rates,
            debris: self.nominal.mass.debris.as_ref().map(|_| DebrisState::start(initial)),
        }
    }
}

/// Motion of the centre of mass, at `center` from p in F_s (m), for the motion `base` of p.
pub(super) fn center_of(base: PointMotion, center: [f64; 3], q_es: [f64; 4], omega_se_s: [f64; 3]) -> PointMotion {
    let c_es = dcm_from_quaternion(q_es);
    PointMotion {
        r_e: sum(base.r_e, product(c_es, center)),
        v_e: sum(base.v_e, product(c_es, cross(omega_se_s, center))),
    }
}

#[derive(Debug)]
pub struct EstimatorMaker {
    pub kind: EstimatorKind,
    pub make: fn(&EstimatorContext<'_>) -> Box<dyn Estimator>,
}
