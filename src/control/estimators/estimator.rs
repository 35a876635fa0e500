//! [`Estimator`]: from measurements to an estimate; [`EstimatorKind`]: a kind of it.

use super::kalman::NormalizedSquare;
use crate::control::estimate::{DebrisState, Estimate};
use crate::control::measurement::{Measurement, PointMotion};
use crate::control::observes::Observes;
use crate::control::vector::{cross, dcm_from_quaternion, product, sum};
use crate::scene::{DeclaredTable, LawParameter, MAX_WHEELS, Scene};

/// The input of an estimator at a tick.
#[derive(Clone, Copy, Debug)]
pub struct Update<'a> {
    /// Time since the tick before, s; 0 at the first.
    pub interval: f64,
    /// The measurements delivered at this tick.
    pub measurements: &'a [Measurement],
    /// Mean acceleration by the thrust that was commanded since the tick before, in F_s, m/s^2.
    pub acceleration_s: [f64; 3],
    /// Mean torque on the body that was commanded since the tick before, by thrusters and by the reaction of motors, in
    /// F_s, N m.
    pub torque_s: [f64; 3],
    /// Torques of the motors on the wheels that were commanded since the tick before, N m.
    pub motor_torques: [f64; MAX_WHEELS],
    /// The measurement of an ideal sensor of the whole state; `None` without one.
    pub state: Option<&'a Estimate>,
}

/// The filters of an estimator, by their places in [`Filters`]: those of the debris come last.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FilterPlace {
    /// The attitude of the spacecraft.
    Attitude,
    /// Position and velocity of its centre of mass.
    Motion,
    /// Position and velocity of the debris.
    DebrisMotion,
    /// The attitude of the debris.
    DebrisAttitude,
}

/// The number of filters.
pub const FILTERS: usize = 4;

/// The confidence of each filter; `None` of one that there is not.
pub type Filters = [Option<Confidence>; FILTERS];

/// The belief of a filter in its own errors.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Confidence {
    /// The covariance of its errors.
    pub covariance: Covariance,
    /// The normalised square of the innovations of this tick; `None` where nothing was measured.
    pub innovation: Option<NormalizedSquare>,
    /// The mean since the start of those squares, each over its degrees of freedom.
    pub mean_innovation: Option<f64>,
}

/// The covariance of the errors of a filter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Covariance {
    /// Attitude, rad, and gyro bias, rad/s.
    AttitudeAndBias {
        /// Covariance of both.
        covariance: [[f64; 6]; 6],
        /// The variance of the measured rate about its bias, rad^2/s^2.
        rate_variance: f64,
    },
    /// Attitude, rad, and rate, rad/s.
    AttitudeAndRate([[f64; 6]; 6]),
    /// Position, m, and velocity, m/s, along each axis.
    Motion([[f64; 2]; 2]),
}

/// An estimator in one run.
pub trait Estimator: Send {
    /// Moves `estimate`, that of the tick before, to this tick. Called once for each tick, in order.
    fn update(&mut self, update: &Update<'_>, estimate: &mut Estimate);

    /// The confidence of its filters after the update of this tick.
    fn filters(&self) -> Filters {
        [None; FILTERS]
    }
}

/// A sensor as an estimator knows it.
#[derive(Clone, Copy, Debug)]
pub struct KnownSensor<'a> {
    /// The part of the state that it observes.
    pub observes: Observes,
    /// Time from sample to sample, s.
    pub period: f64,
    /// Time from a measurement to its delivery, s.
    pub latency: f64,
    /// Its nominal parameters.
    pub parameters: &'a DeclaredTable,
}

/// The settings of an estimator in one run.
#[derive(Clone, Copy, Debug)]
pub struct EstimatorContext<'a> {
    /// The scene without dispersions.
    pub nominal: &'a Scene,
    /// Its own parameters.
    pub parameters: &'a DeclaredTable,
    /// The sensors, in their order.
    pub sensors: &'a [KnownSensor<'a>],
    /// Time from tick to tick, s.
    pub tick: f64,
}

impl EstimatorContext<'_> {
    /// The nominal state at the start.
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
            debris: self.nominal.mass.debris.as_ref().map(|_| DebrisState {
                r_gdo_e: initial.r_gdo_e,
                v_gdo_e: initial.v_gdo_e,
                q_ed: initial.q_ed,
                omega_de_d: initial.omega_de_d,
            }),
        }
    }
}

/// The motion of the centre of mass, at `center` from p in F_s (m), where that of p is `base`.
pub(super) fn center_of(base: PointMotion, center: [f64; 3], q_es: [f64; 4], omega_se_s: [f64; 3]) -> PointMotion {
    let c_es = dcm_from_quaternion(q_es);
    PointMotion {
        r_e: sum(base.r_e, product(c_es, center)),
        v_e: sum(base.v_e, product(c_es, cross(omega_se_s, center))),
    }
}

/// A kind of estimator.
#[derive(Debug)]
pub struct EstimatorKind {
    /// As in `estimator` of `[control]`.
    pub name: &'static str,
    /// True if an ideal sensor delivers the state to it.
    pub knows_the_truth: bool,
    /// True if it has filters, whose covariances can be compared with their errors.
    pub has_filter: bool,
    /// True if it uses such observations.
    pub uses: fn(&Observes) -> bool,
    /// Its keys.
    pub parameters: &'static [LawParameter],
    /// The estimator of a run.
    pub make: fn(&EstimatorContext<'_>) -> Box<dyn Estimator>,
}
