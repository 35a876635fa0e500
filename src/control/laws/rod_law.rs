//! [`RodLaw`]: the dipole of torque rods from the measured magnetic field. The torque m x B is never along B: momentum
//! along it waits until the field has turned.

use crate::control::declared::declared;
use crate::control::vector::{cross, difference, dot, scaled};
use crate::scene::schema::Limit;
use crate::scene::{DeclaredTable, LawParameter};

declared! {
    BDotNumbers = B_DOT {
        gain: f64 = LawParameter::number("b_dot_gain_a_m2_s_t", "A m^2 s/T",
            "Dipole opposing a change in the field of 1 T/s", Limit::Positive);
    }
}

declared! {
    RodUnloadingNumbers = ROD_UNLOADING {
        time: f64 = LawParameter::number("rod_unloading_time_s", "s",
            "Time constant with which torque rods unload the wheels of momentum perpendicular to the field",
            Limit::Positive);
    }
}

/// The law of torque rods in a phase.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum RodLaw {
    None,
    /// m = -k dB/dt with B in F_s (A. C. Stickler & K. T. Alfriend, Journal of Spacecraft and Rockets 13, 282, 1976): a
    /// body that turns much faster than the field along its orbit sees dB/dt = B x omega and loses energy at k |B x
    /// omega|^2.
    BDot {
        /// k, A m^2 s/T.
        gain: f64,
    },
    /// m = (h x B)/(T |B|^2) (P. J. Camillo & F. L. Markley, Journal of Guidance and Control 3, 563, 1980): the torque
    /// is -1/T times the wheel momentum h across B.
    Unloading {
        /// T, s.
        time_constant: f64,
    },
}

/// Names of the laws in campaign files; their numbers are parameters.
pub const ROD_LAWS: [(&str, RodLaw); 3] = [
    ("none", RodLaw::None),
    ("b_dot", RodLaw::BDot { gain: 0.0 }),
    ("unloading", RodLaw::Unloading { time_constant: 0.0 }),
];

impl RodLaw {
    pub fn parameters(self) -> &'static [LawParameter] {
        match self {
            RodLaw::None => &[],
            RodLaw::BDot { .. } => &B_DOT,
            RodLaw::Unloading { .. } => &ROD_UNLOADING,
        }
    }

    /// The law with the numbers of `table`.
    #[must_use]
    pub fn with(self, table: &DeclaredTable) -> Self {
        match self {
            RodLaw::None => RodLaw::None,
            RodLaw::BDot { .. } => RodLaw::BDot { gain: BDotNumbers::of(table).gain },
            RodLaw::Unloading { .. } => RodLaw::Unloading { time_constant: RodUnloadingNumbers::of(table).time },
        }
    }

    /// True if wheels compensate its torque, so that the body gets that of its attitude law.
    pub fn unloads(&self) -> bool {
        matches!(self, RodLaw::Unloading { .. })
    }

    /// Wanted dipole, F_s, A m^2, in the measured field `field` and with the wheel momentum `stored_s` relative to the
    /// body, N m s.
    pub fn dipole(&self, field: &MeasuredField, stored_s: [f64; 3]) -> [f64; 3] {
        match self {
            RodLaw::None => [0.0; 3],
            RodLaw::BDot { gain } => scaled(-gain, field.rate_s()),
            RodLaw::Unloading { time_constant } => {
                let size2 = dot(field.field_s, field.field_s);
                if size2 > 0.0 {
                    scaled(1.0 / (time_constant * size2), cross(stored_s, field.field_s))
                } else {
                    [0.0; 3]
                }
            }
        }
    }
}

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
}
