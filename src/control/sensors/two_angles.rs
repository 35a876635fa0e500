//! A direction, of the Sun or of nadir, measured as two angles from a boresight.
//!
//! The sensor's third axis in F_t is its boresight; the others are turned with s3 to it the shortest way. The direction
//! u in F_t has the angles atan(u1/u3) and atan(u2/u3), as by two crossed slits (J. R. Wertz, *Spacecraft Attitude
//! Determination and Control*, 1978, section 7.1). The rotation about it is not observed.

use super::sensor::{NormalErrors, Sensor, SensorContext};
use crate::control::estimators::attitude_innovation::{AttitudeInnovation, AttitudeSensor, Innovation};
use crate::control::measurement::{Values, part, values};
use crate::control::rotation::from_s3_to;
use crate::control::small_matrix::{multiplied, transposed};
use crate::control::truth::Truth;
use crate::control::vector::{cross, dcm_from_quaternion, dot, norm, product, transposed_product};

/// The direction of an object.
pub trait Direction: std::fmt::Debug + Send + Sync {
    /// Unit vector in F_e at `time` as filters expect it; zero if unknown, which gives no information.
    fn expected(&self, time: f64) -> [f64; 3];

    /// Unit vector in F_e at `truth`; `None` if hidden.
    fn actual(&self, truth: &Truth) -> Option<[f64; 3]>;
}

/// A boresight, and the angles' noise.
#[derive(Clone, Copy, Debug)]
pub struct TwoAngles {
    /// F_t -> F_s.
    c_st: [[f64; 3]; 3],
    /// Standard deviation of each angle.
    deviation: f64,
}

impl TwoAngles {
    /// Angles about `boresight` in F_s, of any length.
    pub fn new(boresight: [f64; 3], deviation: f64) -> Self {
        TwoAngles { c_st: from_s3_to(boresight), deviation }
    }

    /// The direction `u_e` of F_e in F_t at the attitude `q_es`.
    pub fn in_sensor(&self, u_e: [f64; 3], q_es: [f64; 4]) -> [f64; 3] {
        transposed_product(self.c_st, transposed_product(dcm_from_quaternion(q_es), u_e))
    }

    /// The innovation of the angles `values` for the estimated unit vector `u_t` in F_t.
    ///
    /// It is across the measured direction m: e_i = -b_i . u for two unit vectors b across m. With u' = u x d for a
    /// small attitude error d, b . (u x d) = (b x u) . d; noise of the angles moves m by b_i . dm/d(angle). Unlike a
    /// difference of angles it has no pole for an estimate across the boresight.
    pub fn innovation(&self, values: &Values, u_t: [f64; 3]) -> AttitudeInnovation {
        let tangents = part::<2>(values, 0).map(libm::tan);
        let seen = [tangents[0], tangents[1], 1.0];
        let length = norm(seen);
        let [across, other, _] = transposed(&from_s3_to(seen));
        let across = [across, other];
        let slopes: [[f64; 2]; 2] =
            across.map(|b| std::array::from_fn(|i| b[i] * (1.0 + tangents[i] * tangents[i]) / length));
        let variance = self.deviation * self.deviation;
        AttitudeInnovation::Two(Innovation {
            value: across.map(|b| -dot(b, u_t)),
            sensitivity: across.map(|b| product(self.c_st, cross(b, u_t))),
            covariance: multiplied(&slopes, &transposed(&slopes)).map(|row: [f64; 2]| row.map(|x| variance * x)),
        })
    }
}

/// A filter's sensor of the direction `D`.
#[derive(Debug)]
pub struct Believed<D>(pub TwoAngles, pub D);

impl<D: Direction> AttitudeSensor for Believed<D> {
    fn innovation(&self, values: &Values, q_es: [f64; 4], time: f64) -> AttitudeInnovation {
        let Believed(angles, direction) = self;
        angles.innovation(values, angles.in_sensor(direction.expected(time), q_es))
    }
}

/// A sensor of the direction `D` in a run.
#[derive(Debug)]
pub struct DirectionSensor<D> {
    angles: TwoAngles,
    direction: D,
    /// Cosine of the largest angle from the boresight.
    least_cosine: f64,
    bias: f64,
    noise: NormalErrors<2>,
}

impl<D> DirectionSensor<D> {
    /// A sensor with the constant error `bias`, up to `half_field_of_view` from the boresight; zero for the half-space
    /// ahead.
    pub fn new(
        context: &SensorContext<'_>,
        Believed(angles, direction): Believed<D>,
        [half_field_of_view, bias]: [f64; 2],
    ) -> Self {
        DirectionSensor {
            angles,
            direction,
            least_cosine: if half_field_of_view > 0.0 { libm::cos(half_field_of_view).max(0.0) } else { 0.0 },
            bias,
            noise: context.normal("noise", ["x", "y"]),
        }
    }
}

impl<D: Direction> Sensor for DirectionSensor<D> {
    fn measure(&mut self, count: u64, truth: &Truth) -> Option<Values> {
        let [x, y, z] = self.angles.in_sensor(self.direction.actual(truth)?, truth.body.q_es);
        // NaN is out of view too
        if z.is_nan() || z <= self.least_cosine {
            return None;
        }
        let errors = self.noise.scaled(count, [self.angles.deviation; 2]);
        let [a, b] = [libm::atan2(x, z), libm::atan2(y, z)];
        Some(values(&[&[a + self.bias + errors[0], b + self.bias + errors[1]]]))
    }
}
