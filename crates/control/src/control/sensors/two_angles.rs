//! A direction, of the Sun or of nadir, measured as two angles from a boresight.
//!
//! The sensor's third axis in F_t is its boresight; the others are turned with s3 to it the shortest way. The direction
//! u in F_t has the angles atan(u1/u3) and atan(u2/u3), as by two crossed slits (J. R. Wertz, *Spacecraft Attitude
//! Determination and Control*, 1978, section 7.1). The rotation about it is not observed.

use super::sensor::{NormalErrors, Sensor, SensorContext, axes, optional};
use crate::control::truth::Truth;
use crate::dynamics::environment::shadow::lit;
use crate::dynamics::environment::sun::sun_after;
use crate::dynamics::orbit_path::OrbitPath;
use crate::loops::measurement::{Values, part, values};
use crate::loops::observes::{AttitudeInnovation, AttitudeSensor, Innovation};
use crate::loops::vector::{
    cross, dcm_from_quaternion, dot, from_s3_to, multiplied, norm, product, scaled, transposed, transposed_product,
};
use crate::scene::schema::Limit;
use crate::scene::{Epoch, LawParameter, Shadow};

/// Keys of noise, boresight and bias.
pub const NOISE: LawParameter = optional("noise_rad", "rad", "Standard deviation of each angle");
pub const BORESIGHT: LawParameter =
    axes("boresight", "1", "Direction of the boresight in F_s", Limit::Direction).or(&[0.0, 0.0, 1.0]);
pub const BIAS: LawParameter =
    LawParameter::number("bias_rad", "rad", "Constant error of both angles", Limit::Finite).or(&[0.0]);

/// Visible share of the Sun's disc that a sensor needs: its centre is then in sight.
const LEAST_LIT: f64 = 0.5;

/// The direction of an object.
#[derive(Debug)]
pub enum Direction {
    /// Along this unit vector in F_e.
    Fixed([f64; 3]),
    /// The Sun of a date; radius of the Earth and shape of its shadow.
    Sun(Epoch, f64, Shadow),
    /// Nadir; filters expect that of the nominal orbit.
    Nadir(Option<OrbitPath>),
}

/// Unit vector of nadir at the position `r_e`, F_e.
fn nadir(r_e: [f64; 3]) -> [f64; 3] {
    scaled(-1.0 / norm(r_e), r_e)
}

impl Direction {
    /// Unit vector in F_e at `time` as filters expect it; zero if unknown, which gives no information.
    fn expected(&self, time: f64) -> [f64; 3] {
        match self {
            Direction::Fixed(direction) => *direction,
            Direction::Sun(epoch, ..) => sun_after(*epoch, time).direction,
            Direction::Nadir(orbit) => orbit.as_ref().map_or([0.0; 3], |orbit| nadir(orbit.state(time).position)),
        }
    }

    /// Unit vector in F_e at `truth`; `None` if hidden.
    fn actual(&self, truth: &Truth) -> Option<[f64; 3]> {
        match self {
            Direction::Fixed(direction) => Some(*direction),
            Direction::Sun(epoch, radius, shadow) => {
                let sun = sun_after(*epoch, truth.time);
                (lit(*shadow, truth.body.r_co_e, &sun, *radius) >= LEAST_LIT).then_some(sun.direction)
            }
            Direction::Nadir(_) => Some(nadir(truth.body.r_co_e)),
        }
    }
}

/// A direction measured as two angles, as filters know it.
#[derive(Debug)]
pub struct TwoAngles {
    /// F_t -> F_s.
    c_st: [[f64; 3]; 3],
    /// Standard deviation of each angle.
    deviation: f64,
    direction: Direction,
}

impl TwoAngles {
    /// Angles of `direction` from `boresight` in F_s, of any length.
    pub fn new(boresight: [f64; 3], deviation: f64, direction: Direction) -> Self {
        TwoAngles { c_st: from_s3_to(boresight), deviation, direction }
    }

    /// The direction `u_e` of F_e in F_t at the attitude `q_es`.
    fn in_sensor(&self, u_e: [f64; 3], q_es: [f64; 4]) -> [f64; 3] {
        transposed_product(self.c_st, transposed_product(dcm_from_quaternion(q_es), u_e))
    }
}

impl AttitudeSensor for TwoAngles {
    /// It is across the measured direction m: e_i = -b_i . u for the expected u and two unit vectors b across m. With
    /// u' = u x d for a small attitude error d, b . (u x d) = (b x u) . d; noise of the angles moves m by b_i .
    /// dm/d(angle). Unlike a difference of angles it has no pole for an estimate across the boresight.
    fn innovation(&self, values: &Values, q_es: [f64; 4], time: f64) -> AttitudeInnovation {
        let u_t = self.in_sensor(self.direction.expected(time), q_es);
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

/// A sensor of a direction in a run.
pub struct DirectionSensor {
    angles: TwoAngles,
    /// Cosine of the largest angle from the boresight.
    least_cosine: f64,
    bias: f64,
    noise: NormalErrors<2>,
}

impl DirectionSensor {
    /// A sensor with the constant error `bias`, up to `half_field_of_view` from the boresight; zero for the half-space
    /// ahead.
    pub fn new(context: &SensorContext<'_>, angles: TwoAngles, [half_field_of_view, bias]: [f64; 2]) -> Self {
        DirectionSensor {
            angles,
            least_cosine: if half_field_of_view > 0.0 { libm::cos(half_field_of_view).max(0.0) } else { 0.0 },
            bias,
            noise: context.normal("noise", ["x", "y"]),
        }
    }
}

impl Sensor for DirectionSensor {
    fn measure(&mut self, count: u64, truth: &Truth) -> Option<Values> {
        let [x, y, z] = self.angles.in_sensor(self.angles.direction.actual(truth)?, truth.body.q_es);
        // NaN is out of view too
        if z.is_nan() || z <= self.least_cosine {
            return None;
        }
        let errors = self.noise.scaled(count, [self.angles.deviation; 2]);
        let [a, b] = [libm::atan2(x, z), libm::atan2(y, z)];
        Some(values(&[&[a + self.bias + errors[0], b + self.bias + errors[1]]]))
    }
}
