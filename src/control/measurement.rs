//! [`Measurement`]: what a sensor delivers at a tick; [`Observes`]: what it says of the state, for estimators.
//!
//! A measurement is numbers whose meaning its kind owns ([`super::sensors::SensorKind::quantities`]). Estimators do not ask for kinds: they take what a kind
//! observes, of which there are as many forms as an estimator has ways to use one.

use std::fmt::Debug;
use std::sync::Arc;

use super::estimators::attitude_innovation::AttitudeInnovation;
use super::sensors::rate_gyro::GyroNoise;
use crate::scene::{DeclaredTable, Scene};

/// Most numbers of a measurement.
pub const MAX_VALUES: usize = 12;

/// The numbers of a measurement, in the order of its kind's quantities; NaN beyond them, and where one is not known.
pub type Values = [f64; MAX_VALUES];

/// `parts`, one after another.
///
/// # Panics
/// Where they are more than [`MAX_VALUES`].
pub fn values(parts: &[&[f64]]) -> Values {
    let mut all = [f64::NAN; MAX_VALUES];
    let mut at = 0;
    for part in parts {
        all[at..at + part.len()].copy_from_slice(part);
        at += part.len();
    }
    all
}

/// The N numbers of `values` from `first` on.
///
/// # Panics
/// Where there are not so many.
pub fn part<const N: usize>(values: &Values, first: usize) -> [f64; N] {
    std::array::from_fn(|i| values[first + i])
}

/// What a sensor delivers at a tick.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Measurement {
    /// The sensor, by its place in the loop.
    pub sensor: usize,
    /// Its numbers.
    pub values: Values,
    /// How long ago it was measured, s.
    pub age: f64,
}

/// The last measurement that a sensor has delivered.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reading {
    /// Its numbers; NaN before the first.
    pub values: Values,
    /// When it was measured, s since the start of the run; NaN before the first.
    pub time: f64,
}

impl Reading {
    /// Nothing was delivered yet.
    pub const NONE: Reading = Reading { values: [f64::NAN; MAX_VALUES], time: f64::NAN };
}

/// Position and velocity of a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PointMotion {
    /// Position in F_e, m.
    pub r_e: [f64; 3],
    /// Velocity relative to F_e, in F_e, m/s.
    pub v_e: [f64; 3],
}

impl PointMotion {
    /// That of the six numbers of `values` from `first` on; `None` where they are not known.
    pub fn of(values: &Values, first: usize) -> Option<Self> {
        let motion = PointMotion { r_e: part(values, first), v_e: part(values, first + 3) };
        (!motion.r_e[0].is_nan()).then_some(motion)
    }
}

/// How a filter takes a measurement of the attitude: as flight software believes the sensor, by its nominal parameters.
pub trait AttitudeSensor: Debug + Send + Sync {
    /// The innovation of `values`, measured at `time` (s), where the attitude then is estimated as `q_es` (F_s -> F_e, scalar first).
    fn innovation(&self, values: &Values, q_es: [f64; 4], time: f64) -> AttitudeInnovation;
}

/// What the sensors of a kind say of the state, with how the nominal parameters of one say how exactly.
#[derive(Clone, Copy, Debug)]
pub enum Observes {
    /// The rotation vector of F_s since the sample before, in F_s, rad: the same before and after it.
    Rotation(fn(&DeclaredTable) -> GyroNoise),
    /// The attitude: quaternion F_s -> F_e, scalar first.
    Attitude(fn(&DeclaredTable) -> Arc<dyn AttitudeSensor>),
    /// A part of the attitude, as the direction of the Sun in F_s is; the scene is the nominal one.
    Direction(fn(&DeclaredTable, &Scene) -> Arc<dyn AttitudeSensor>),
    /// Position and velocity of the base point p in F_e, and of the debris's centre of mass; standard deviations in m and m/s.
    Motion(fn(&DeclaredTable) -> [f64; 2]),
    /// Attitude of the debris relative to the spacecraft F_d -> F_s, scalar first, and its rate relative to the spacecraft in F_d, rad/s; standard deviations in
    /// rad and rad/s.
    DebrisAttitude(fn(&DeclaredTable) -> [f64; 2]),
    /// Rates of the wheels relative to the body, in the order of those that turn, rad/s.
    WheelRates,
    /// The magnetic field in F_s, T: a part of the attitude, and what torque rods act in.
    Field(fn(&DeclaredTable, &Scene) -> Arc<dyn AttitudeSensor>),
}

impl Observes {
    /// What it is, in messages.
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

    /// Whether it is about the debris alone.
    pub fn needs_debris(&self) -> bool {
        matches!(self, Observes::DebrisAttitude(_))
    }

    /// Whether measurements may be delivered later, with their age: filters take the others when they come.
    pub fn has_latency(&self) -> bool {
        !matches!(self, Observes::Rotation(_) | Observes::WheelRates)
    }

    /// Whether a loop has one of it at most: estimators, and laws of torque rods, use a single one.
    pub fn at_most_one(&self) -> bool {
        matches!(self, Observes::Rotation(_) | Observes::WheelRates | Observes::Field(_))
    }
}
