//! [`Estimator`]: from measurements to an estimate; [`EstimatorKind`]: a kind of it.

use super::kalman::NormalizedSquare;
use crate::control::estimate::Estimate;
use crate::control::measurement::{Measurement, PointMotion};
use crate::control::observes::Observes;
use crate::control::truth::{DebrisState, Truth};
use crate::control::vector::{cross, dcm_from_quaternion, product, sum};
use crate::scene::{DeclaredTable, LawParameter, MAX_WHEELS, Scene};

/// What an estimator is told at a tick.
#[derive(Clone, Copy, Debug)]
pub struct Update<'a> {
    /// Time since the tick before, s; 0 at the first.
    pub interval: f64,
    /// What was delivered.
    pub measurements: &'a [Measurement],
    /// Mean acceleration by the thrust that was commanded since the tick before, in F_s, m/s^2.
    pub acceleration_s: [f64; 3],
    /// Mean torque on the body that was commanded since the tick before, by thrusters and by the reaction of motors, in
    /// F_s, N m.
    pub torque_s: [f64; 3],
    /// Torques of the motors on the wheels that were commanded since the tick before, N m.
    pub motor_torques: [f64; MAX_WHEELS],
    /// The true state, where the loop has perfect knowledge.
    pub perfect: Option<&'a Estimate>,
}

/// How well the errors of a filter agree with its covariance: normalised squares of errors (NEES) and of the
/// innovations of this tick; `None` where the filter does not have it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Consistency {
    /// NEES of the attitude and, where it is estimated and known, the gyro's bias or the rate.
    pub attitude: Option<NormalizedSquare>,
    /// Innovation of the attitude.
    pub attitude_innovation: Option<NormalizedSquare>,
    /// NEES of position and velocity of the spacecraft's centre of mass.
    pub motion: Option<NormalizedSquare>,
    /// Innovation of them.
    pub motion_innovation: Option<NormalizedSquare>,
    /// NEES of position and velocity of the debris.
    pub debris_motion: Option<NormalizedSquare>,
    /// Innovation of them.
    pub debris_motion_innovation: Option<NormalizedSquare>,
    /// NEES of attitude and rate of the debris.
    pub debris: Option<NormalizedSquare>,
    /// Innovation of them.
    pub debris_innovation: Option<NormalizedSquare>,
    /// Means since the start of the normalised squares of the innovations, each over its degrees of freedom, in the
    /// order above; `None` where nothing was measured.
    pub mean_innovations: [Option<f64>; 4],
    /// What the covariance says of the errors.
    pub expected: ExpectedErrors,
}

/// Root mean squares that the covariance of a filter gives to the magnitudes of its errors: the root of the sum of the
/// variances of three components; `None` where the filter does not have it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ExpectedErrors {
    /// Of the attitude, rad.
    pub attitude: Option<f64>,
    /// Of the angular velocity, rad/s.
    pub rate: Option<f64>,
    /// Of the position relative to the debris, m.
    pub relative_position: Option<f64>,
    /// Of the velocity relative to the debris, m/s.
    pub relative_velocity: Option<f64>,
}

/// An estimator in one run.
pub trait Estimator: Send {
    /// Moves `estimate`, that of the tick before, to this tick. Called once for each tick, in order.
    fn update(&mut self, update: &Update<'_>, estimate: &mut Estimate);

    /// How well its errors agree with its covariance, after the update of the same tick; `gyro_bias_s` is the true
    /// bias, where there is a gyro, rad/s.
    fn consistency(&self, _truth: &Truth, _gyro_bias_s: Option<[f64; 3]>) -> Consistency {
        Consistency::default()
    }
}

/// What an estimator knows of a sensor.
#[derive(Clone, Copy, Debug)]
pub struct KnownSensor<'a> {
    /// What it says of the state.
    pub observes: Observes,
    /// Time from sample to sample, s.
    pub period: f64,
    /// Time from a measurement to its delivery, s.
    pub latency: f64,
    /// Its nominal parameters.
    pub parameters: &'a DeclaredTable,
}

/// What the estimator of one run is made from.
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
    /// Whether it is told the true state, and reads no sensor.
    pub knows_the_truth: bool,
    /// Whether it has filters, whose covariances can be compared with their errors.
    pub has_filter: bool,
    /// Whether it uses what a sensor observes.
    pub uses: fn(&Observes) -> bool,
    /// Its keys.
    pub parameters: &'static [LawParameter],
    /// The estimator of a run.
    pub make: fn(&EstimatorContext<'_>) -> Box<dyn Estimator>,
}
