//! [`Integral`]: what a law adds to its error, so that a constant torque leaves none.

use crate::scene::LawParameter;
use crate::scene::schema::Limit;

/// The key of its gain.
pub const GAIN: LawParameter = LawParameter::number(
    "integral_1_s",
    "1/s",
    "Gain Ki of the integral of the error; zero: no integral",
    Limit::NotNegative,
)
.or(&[0.0]);
/// The key of its limit, where the error is the vector part of a quaternion.
pub const LIMIT: LawParameter = LawParameter::number(
    "integral_limit",
    "1",
    "Largest magnitude of each component of Ki int q_v dt; zero: no limit",
    Limit::NotNegative,
)
.or(&[0.0]);
/// The key of its limit, where the error is a rate.
pub const RATE_LIMIT: LawParameter = LawParameter::number(
    "integral_limit_rad_s",
    "rad/s",
    "Largest magnitude of each component of Ki int omega dt; zero: no limit",
    Limit::NotNegative,
)
.or(&[0.0]);

/// z = Ki int e dt of an error e, each component within a limit. A law has e + z in place of e: z grows until e is zero
/// (friction of wheels, a torque that the model does not have). It starts at zero with the phase; z += Ki T e at every
/// later tick, before it is used.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Integral {
    /// Ki, 1/s; zero without an integral.
    pub gain: f64,
    /// Largest magnitude of each component of z, in the unit of the error; infinite without a limit.
    pub limit: f64,
    sum: [f64; 3],
}

impl Integral {
    /// No integral.
    pub const NONE: Integral = Integral::new(0.0, f64::INFINITY);

    /// With this gain and limit.
    pub const fn new(gain: f64, limit: f64) -> Self {
        Integral { gain, limit, sum: [0.0; 3] }
    }

    /// e + z, at a tick `period` seconds after the last one (zero at the first, or where the integral is to rest).
    pub fn with(&mut self, error: [f64; 3], period: f64) -> [f64; 3] {
        if self.gain == 0.0 {
            return error;
        }
        for (sum, error) in self.sum.iter_mut().zip(error) {
            *sum = (*sum + self.gain * period * error).clamp(-self.limit, self.limit);
        }
        crate::control::vector::sum(error, self.sum)
    }
}
