//! [`Observes`]: the part of the state that a sensor observes. Estimators depend on it, not on kinds of sensors.

use std::fmt::Debug;
use std::sync::Arc;

use super::measurement::Values;
use crate::scene::{DeclaredTable, Scene};

/// Flight software's model of gyro noise: Farrenkopf's sv, rad/sqrt(s), and su, rad/s/sqrt(s).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GyroNoise {
    pub angular_random_walk: f64,
    pub bias_random_walk: f64,
}

/// An observed part of the state, with the function from nominal parameters to its noise or filter model.
#[derive(Clone, Copy, Debug)]
pub enum Observes {
    /// The rotation vector of F_s since the last sample, rad.
    Rotation(fn(&DeclaredTable) -> GyroNoise),
    /// The attitude: quaternion F_s -> F_e, scalar first.
    Attitude(fn(&DeclaredTable) -> Arc<dyn AttitudeSensor>),
    /// A direction in F_s, such as that of the Sun; the scene is the nominal one.
    Direction(fn(&DeclaredTable, &Scene) -> Arc<dyn AttitudeSensor>),
    /// Position and velocity in F_e of the base point p and of the debris's centre of mass; standard deviations in m
    /// and m/s.
    Motion(fn(&DeclaredTable) -> [f64; 2]),
    /// Attitude of the debris relative to the spacecraft F_d -> F_s, scalar first, and its relative rate in F_d, rad/s;
    /// standard deviations in rad and rad/s.
    DebrisAttitude(fn(&DeclaredTable) -> [f64; 2]),
    /// Rates of the turning wheels relative to the body, rad/s.
    WheelRates,
    /// The magnetic field in F_s, T: a direction, and the field in which torque rods act.
    Field(fn(&DeclaredTable, &Scene) -> Arc<dyn AttitudeSensor>),
}

impl Observes {
    pub fn text(&self) -> &'static str {
        match self {
            Observes::Rotation(_) => "the rotation of the body",
            Observes::Attitude(_) => "the attitude",
            Observes::Direction(_) => "a direction",
            Observes::Motion(_) => "positions and velocities",
            Observes::DebrisAttitude(_) => "attitude and rate of the debris",
            Observes::WheelRates => "rates of wheels",
            Observes::Field(_) => "the magnetic field",
        }
    }

    /// True if only debris can be observed this way.
    pub fn needs_debris(&self) -> bool {
        matches!(self, Observes::DebrisAttitude(_))
    }

    /// True if measurements may arrive late, with their age; filters apply the others on arrival.
    pub fn has_latency(&self) -> bool {
        !matches!(self, Observes::Rotation(_) | Observes::WheelRates)
    }

    /// True if a loop may have only one: estimators and rod laws use a single one.
    pub fn at_most_one(&self) -> bool {
        matches!(self, Observes::Rotation(_) | Observes::WheelRates | Observes::Field(_))
    }
}

/// An innovation of M components, e = H d + n: d is the attitude error, true = estimated (x) d, a rotation vector in
/// F_s; n has the covariance R.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Innovation<const M: usize> {
    pub value: [f64; M],
    /// H at the estimate.
    pub sensitivity: [[f64; 3]; M],
    pub covariance: [[f64; M]; M],
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub enum AttitudeInnovation {
    Two(Innovation<2>),
    /// An attitude, or a direction with its length.
    Three(Innovation<3>),
}

/// A filter's model of a sensor that measures all or part of the attitude.
pub trait AttitudeSensor: Debug + Send + Sync {
    /// The innovation of `values`, measured at `time` (s), at the estimate `q_es` (F_s -> F_e, scalar first).
    fn innovation(&self, values: &Values, q_es: [f64; 4], time: f64) -> AttitudeInnovation;
}
