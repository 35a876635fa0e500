//! [`MeasuredField`]: the dipole of torque rods from the measured magnetic field.

use crate::loops::rod_law::RodLaw;
use crate::loops::vector::{cross, difference, dot, scaled};

/// The last two measurements of the magnetic field.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MeasuredField {
    /// The last one, F_s, T; zero before.
    pub field_s: [f64; 3],
    /// Time of the last one, s.
    time: f64,
    /// Change between both, T, and interval, s; zero before.
    change: ([f64; 3], f64),
}

impl MeasuredField {
    pub const NONE: MeasuredField = MeasuredField { field_s: [0.0; 3], time: f64::NAN, change: ([0.0; 3], 0.0) };

    /// Adds the field `field_s` measured at `time`, in order.
    pub fn take(&mut self, time: f64, field_s: [f64; 3]) {
        if !self.time.is_nan() && time > self.time {
            self.change = (difference(field_s, self.field_s), time - self.time);
        }
        (self.field_s, self.time) = (field_s, time);
    }

    /// dB/dt in F_s, T/s, between both; zero before.
    pub fn rate_s(&self) -> [f64; 3] {
        let (change, interval) = self.change;
        if interval > 0.0 { scaled(1.0 / interval, change) } else { [0.0; 3] }
    }

    /// Wanted dipole, F_s, A m^2, of `law` with the wheel momentum `stored_s` relative to the
    /// body, N m s.
    pub fn dipole(&self, law: RodLaw, stored_s: [f64; 3]) -> [f64; 3] {
        match law {
            RodLaw::None => [0.0; 3],
            RodLaw::BDot { gain } => scaled(-gain, self.rate_s()),
            RodLaw::Unloading { time_constant } => {
                let size2 = dot(self.field_s, self.field_s);
                if size2 > 0.0 {
                    scaled(1.0 / (time_constant * size2), cross(stored_s, self.field_s))
                } else {
                    [0.0; 3]
                }
            }
        }
    }
}
