//! [`Observes`]: the part of the state that a sensor observes, which estimators use instead of kinds of sensors.

use std::sync::Arc;

use super::estimators::attitude_innovation::AttitudeSensor;
use crate::scene::{DeclaredTable, Scene};

/// The noise of a gyro, as flight software believes it: Farrenkopf's sv, rad/sqrt(s), and su, rad/s/sqrt(s).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GyroNoise {
    /// Angular random walk sv.
    pub angular_random_walk: f64,
    /// Random walk of the bias su.
    pub bias_random_walk: f64,
}

/// An observed part of the state, with the function from nominal parameters to the noise or the filter's model.
#[derive(Clone, Copy, Debug)]
pub enum Observes {
    /// The rotation vector of F_s since the sample before, in F_s, rad: the same before and after it.
    Rotation(fn(&DeclaredTable) -> GyroNoise),
    /// The attitude: quaternion F_s -> F_e, scalar first.
    Attitude(fn(&DeclaredTable) -> Arc<dyn AttitudeSensor>),
    /// A part of the attitude, as the direction of the Sun in F_s is; the scene is the nominal one.
    Direction(fn(&DeclaredTable, &Scene) -> Arc<dyn AttitudeSensor>),
    /// Position and velocity of the base point p in F_e, and of the debris's centre of mass; standard deviations in m
    /// and m/s.
    Motion(fn(&DeclaredTable) -> [f64; 2]),
    /// Attitude of the debris relative to the spacecraft F_d -> F_s, scalar first, and its rate relative to the
    /// spacecraft in F_d, rad/s; standard deviations in rad and rad/s.
    DebrisAttitude(fn(&DeclaredTable) -> [f64; 2]),
    /// Rates of the wheels relative to the body, in the order of those that turn, rad/s.
    WheelRates,
    /// The magnetic field in F_s, T: a part of the attitude, and what torque rods act in.
    Field(fn(&DeclaredTable, &Scene) -> Arc<dyn AttitudeSensor>),
}

impl Observes {
    /// Its name in messages.
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

    /// True if it is about the debris alone.
    pub fn needs_debris(&self) -> bool {
        matches!(self, Observes::DebrisAttitude(_))
    }

    /// True if measurements may be delivered later, with their age; filters take the others when they arrive.
    pub fn has_latency(&self) -> bool {
        !matches!(self, Observes::Rotation(_) | Observes::WheelRates)
    }

    /// True if a loop has at most one: estimators, and laws of torque rods, use a single one.
    pub fn at_most_one(&self) -> bool {
        matches!(self, Observes::Rotation(_) | Observes::WheelRates | Observes::Field(_))
    }
}
