//! [`AttitudeInnovation`]: the innovation of a measurement of all or part of the attitude.

use std::fmt::Debug;

use super::kalman::{Gain, NormalizedSquare};
use crate::control::measurement::{Values, part};
use crate::control::vector::{conjugate, hamilton, vector_of};

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

impl<const M: usize> Innovation<M> {
    fn update(&self, covariance: &mut [[f64; 6]; 6]) -> Option<([f64; 6], NormalizedSquare)> {
        let sensitivity = self.sensitivity.map(|[x, y, z]| [x, y, z, 0.0, 0.0, 0.0]);
        let gain = Gain::of(covariance, &sensitivity, &self.covariance)?;
        Some((gain.correction(self.value), gain.square(self.value)))
    }
}

impl AttitudeInnovation {
    /// Updates `covariance`, whose first three errors are d; the correction of the state and the normalised square.
    /// `None`, with no change, if the innovation's covariance is singular to rounding.
    pub fn update(&self, covariance: &mut [[f64; 6]; 6]) -> Option<([f64; 6], NormalizedSquare)> {
        match self {
            AttitudeInnovation::Two(innovation) => innovation.update(covariance),
            AttitudeInnovation::Three(innovation) => innovation.update(covariance),
        }
    }
}

/// A filter's model of a sensor that measures all or part of the attitude.
pub trait AttitudeSensor: Debug + Send + Sync {
    /// The innovation of `values`, measured at `time` (s), at the estimate `q_es` (F_s -> F_e, scalar first).
    fn innovation(&self, values: &Values, q_es: [f64; 4], time: f64) -> AttitudeInnovation;
}

/// A sensor of the whole attitude as a quaternion, with its error covariance in F_s, rad^2.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WholeAttitude(pub [[f64; 3]; 3]);

const IDENTITY: [[f64; 3]; 3] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

impl AttitudeSensor for WholeAttitude {
    fn innovation(&self, values: &Values, q_es: [f64; 4], _time: f64) -> AttitudeInnovation {
        let value = vector_of(hamilton(conjugate(q_es), part(values, 0)));
        AttitudeInnovation::Three(Innovation { value, sensitivity: IDENTITY, covariance: self.0 })
    }
}
