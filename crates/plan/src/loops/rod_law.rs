//! [`RodLaw`]: the dipole of torque rods from the measured magnetic field. The torque m x B is never along B: momentum
//! along it waits until the field has turned.

use super::declared::declared;
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
}
