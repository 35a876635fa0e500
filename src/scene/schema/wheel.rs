//! `[wheel1]`, `[wheel2]`: a wheel, one instance of the table each.

use super::components::{SCALAR, XY};
use super::limit::Limit;
use super::numbers::Numbers;
use super::row::always;
use super::rows::rows;

/// Across the nominal axes of the wheels: s2 of W1, s3 of W2.
const ACROSS: &[&[&str]] = &[&["x", "z"], &["x", "y"]];

/// What makes the keys of a wheel exist; `Parameter::remedy` names the table.
const REMEDY: &str = "add a [wheel] table";

rows! {
    /// A wheel: a solid balanced cylinder that spins about an axis through its centre, which is fixed in the fuselage.
    pub struct WheelInput in WheelInput [table => table] {
    radius_m: f64 = 0.25, "m", "Radius", SCALAR, Plain, Limit::Positive, (required "0.25"), always, REMEDY;
    length_m: f64 = 0.1, "m", "Length along the spin axis", SCALAR, Plain, Limit::Positive, (required "0.1"), always,
        REMEDY;
    station_m: f64 = 1.0, "m", "Station z of the wheel's centre along s3, from p", SCALAR, Plain, Limit::Finite,
        (required "1.0"), always, REMEDY;
    density_kg_m3: f64 = 2700.0, "kg/m^3", "Density", SCALAR, Plain, Limit::Positive, (required "2700.0"), always, REMEDY;
    offset_m: [f64; 2] = [0.0; 2], "m", "Offset of the wheel's centre from the axis s3, along s1 and s2", XY, Plain,
        Limit::Finite, (optional), always, REMEDY;
    tilt_rad: [f64; 2] = [0.0; 2], "rad",
        "Alignment error of the spin axis: the rotation vector, in F_s, that turns the nominal axis (s2 of W1, s3 of W2) into the true one; its two components across the nominal axis, (s1, s3) of W1, (s1, s2) of W2",
        ACROSS, Plain, Limit::Finite, (optional), always, REMEDY;
    } others {
        /// What the wheel does when no torque is scheduled for it.
        mode: WheelMode = WheelMode::Free,
    }
}

/// What a wheel does when no torque is scheduled for it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum WheelMode {
    /// It turns freely in its bearing: its absolute axial momentum h_i is constant, and J* resists a change of omega.
    #[default]
    Free,
    /// Its motor keeps its rate relative to the fuselage at the initial value with whatever torque that takes: its momentum
    /// relative to the fuselage, J_i Omega_i, is constant, and its axial inertia resists a change of omega with the rest.
    SpeedHeld,
}

impl WheelMode {
    /// All values.
    pub const ALL: [WheelMode; 2] = [WheelMode::Free, WheelMode::SpeedHeld];

    /// The name in campaign files.
    pub const fn name(self) -> &'static str {
        match self {
            WheelMode::Free => "free",
            WheelMode::SpeedHeld => "speed_held",
        }
    }

    /// The mode called `name`.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|mode| mode.name() == name)
    }
}
