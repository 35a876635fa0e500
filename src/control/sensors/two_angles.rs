//! A direction measured as two angles, by a sensor with a boresight: what the Sun sensor and the horizon sensor have in
//! common.
//!
//! The third axis of the sensor, F_t, is its boresight; the others are turned with s3 to it the shortest way. With the
//! direction u in F_t the angles are atan(u1/u3) and atan(u2/u3): what two crossed slits measure (J. R. Wertz,
//! *Spacecraft Attitude Determination and Control*, 1978, section 7.1). The rotation about the direction is not seen.

use crate::control::estimators::attitude_innovation::{AttitudeInnovation, Innovation};
use crate::control::measurement::{Values, part, values};
use crate::control::rotation::from_s3_to;
use crate::control::sensors::sensor::{NormalErrors, SensorContext};
use crate::control::small_matrix::{multiplied, transposed};
use crate::control::vector::{cross, dcm_from_quaternion, dot, norm, product, transposed_product};

/// Where a sensor looks, and how exactly it measures.
#[derive(Clone, Copy, Debug)]
pub struct TwoAngles {
    /// F_t -> F_s.
    c_st: [[f64; 3]; 3],
    /// Standard deviation of each angle, rad.
    deviation: f64,
}

impl TwoAngles {
    /// Those about `boresight` in F_s, of any length, with the standard deviation `deviation`, rad.
    pub fn new(boresight: [f64; 3], deviation: f64) -> Self {
        TwoAngles { c_st: from_s3_to(boresight), deviation }
    }

    /// The direction `u_e` of F_e in F_t at the attitude `q_es`.
    pub fn in_sensor(&self, u_e: [f64; 3], q_es: [f64; 4]) -> [f64; 3] {
        transposed_product(self.c_st, transposed_product(dcm_from_quaternion(q_es), u_e))
    }

    /// The innovation of the angles `values` where the direction is estimated as `u_t` in F_t, a unit vector.
    ///
    /// It is across the measured direction m: e_i = -b_i . u for two unit vectors b across m. With u' = u x d for a
    /// small error d of the attitude, b . (u x d) = (b x u) . d; the noise of the angles moves m by b_i . dm/d(angle).
    /// Unlike the difference of the angles it has no pole where the estimate has the direction beside the sensor.
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

/// The angles as a sensor of a run measures them, with their errors, within its field of view.
#[derive(Debug)]
pub struct AnglesInView {
    /// Where it looks.
    pub angles: TwoAngles,
    /// Cosine of the largest angle from the boresight.
    least_cosine: f64,
    bias: f64,
    noise: NormalErrors<2>,
}

impl AnglesInView {
    /// Those of `angles` with a constant error of `bias` (rad), up to `half_field_of_view` (rad) from the boresight;
    /// zero: all before the sensor.
    pub fn new(context: &SensorContext<'_>, angles: TwoAngles, half_field_of_view: f64, bias: f64) -> Self {
        AnglesInView {
            angles,
            least_cosine: if half_field_of_view > 0.0 { libm::cos(half_field_of_view).max(0.0) } else { 0.0 },
            bias,
            noise: context.normal("noise", ["x", "y"]),
        }
    }

    /// What is measured as number `count` of the direction `u_e` in F_e, a unit vector, at the attitude `q_es`; `None`
    /// where it is out of view.
    pub fn measure(&mut self, count: u64, u_e: [f64; 3], q_es: [f64; 4]) -> Option<Values> {
        let [x, y, z] = self.angles.in_sensor(u_e, q_es);
        // not a number is out of view too
        if z.is_nan() || z <= self.least_cosine {
            return None;
        }
        let errors = self.noise.scaled(count, [self.angles.deviation; 2]);
        let [a, b] = [libm::atan2(x, z), libm::atan2(y, z)];
        Some(values(&[&[a + self.bias + errors[0], b + self.bias + errors[1]]]))
    }
}
