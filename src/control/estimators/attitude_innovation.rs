//! [`AttitudeInnovation`]: the innovation of a measurement of the attitude, or of a part of it, in a filter of attitude
//! and three more numbers.

use std::fmt::Debug;

use super::kalman::{Gain, NormalizedSquare};
use crate::control::measurement::{Values, part};
use crate::control::rotation::vector_of;
use crate::control::vector::{conjugate, hamilton};

/// An innovation of M numbers: e = H d + n, where d is the error of the attitude, true = estimated (x) d as a rotation
/// vector in F_s, and n has the covariance R.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Innovation<const M: usize> {
    /// e.
    pub value: [f64; M],
    /// H, at the estimate.
    pub sensitivity: [[f64; 3]; M],
    /// R.
    pub covariance: [[f64; M]; M],
}

/// An innovation by its number of components.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum AttitudeInnovation {
    /// A direction.
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
    /// The correction of a state whose first three errors are d, and the normalised square; `covariance`, that of the
    /// state, becomes the one after it. `None`, and nothing changes, where the filter is already certain.
    pub fn update(&self, covariance: &mut [[f64; 6]; 6]) -> Option<([f64; 6], NormalizedSquare)> {
        match self {
            AttitudeInnovation::Two(innovation) => innovation.update(covariance),
            AttitudeInnovation::Three(innovation) => innovation.update(covariance),
        }
    }
}

/// A sensor of the attitude as filters believe it, by its nominal parameters.
pub trait AttitudeSensor: Debug + Send + Sync {
    /// The innovation of `values`, measured at `time` (s), where the attitude then is estimated as `q_es` (F_s -> F_e,
    /// scalar first).
    fn innovation(&self, values: &Values, q_es: [f64; 4], time: f64) -> AttitudeInnovation;
}

/// A sensor that measures the whole attitude, as a quaternion; the covariance of its error in F_s, rad^2.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WholeAttitude(pub [[f64; 3]; 3]);

/// A measured rotation is the error itself.
const IDENTITY: [[f64; 3]; 3] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

impl AttitudeSensor for WholeAttitude {
    fn innovation(&self, values: &Values, q_es: [f64; 4], _time: f64) -> AttitudeInnovation {
        let value = vector_of(hamilton(conjugate(q_es), part(values, 0)));
        AttitudeInnovation::Three(Innovation { value, sensitivity: IDENTITY, covariance: self.0 })
    }
}
