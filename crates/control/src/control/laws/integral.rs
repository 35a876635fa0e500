//! [`Integral`]: removes the offset that a constant torque would leave.

use crate::loops::declared::{limit, number};
use crate::scene::LawParameter;

/// Key of its gain.
pub const GAIN: LawParameter =
    number("integral_1_s", "1/s", "Gain Ki of the integral of the error; zero: no integral", &[0.0]);
/// Key of its limit for an error that is the vector part of a quaternion.
pub const LIMIT: LawParameter =
    number("integral_limit", "1", "Largest magnitude of each component of Ki int q_v dt; zero: no limit", &[0.0]);
/// Key of its limit for an error that is a rate.
pub const RATE_LIMIT: LawParameter = number(
    "integral_limit_rad_s",
    "rad/s",
    "Largest magnitude of each component of Ki int omega dt; zero: no limit",
    &[0.0],
);

/// z = Ki int e dt of an error e, each component within a limit. A law uses e + z in place of e, so that z balances
/// constant torques such as wheel friction. It is zero at the start of a phase and grows by Ki T e at every later tick,
/// before use.
#[derive(Clone, Copy)]
pub struct Integral {
    gain: f64,
    limit: f64,
    sum: [f64; 3],
}

impl Integral {
    /// Ki, 1/s, and the largest magnitude of each component of z, in the error's unit; zero for no integral or limit.
    pub fn new(gain: f64, largest: f64) -> Self {
        Integral { gain, limit: limit(largest), sum: [0.0; 3] }
    }

    /// e + z, `period` seconds after the last tick (zero at the first, or to rest the integral).
    pub fn with(&mut self, error: [f64; 3], period: f64) -> [f64; 3] {
        if self.gain == 0.0 {
            return error;
        }
        for (sum, error) in self.sum.iter_mut().zip(error) {
            *sum = (*sum + self.gain * period * error).clamp(-self.limit, self.limit);
        }
        crate::loops::vector::sum(error, self.sum)
    }
}
