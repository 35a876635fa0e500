//! `[environment]`: effects of the environment on the spacecraft.

use super::components::XYZ;
use super::limit::Limit;
use super::numbers::Numbers;
use super::rows::rows;

rows! {
    /// Effects of the environment on the spacecraft. An effect that is not written does not act.
    pub struct EnvironmentInput in EnvironmentInput [table => table] {
    body_torque_n_m: Option<[f64; 3]> = None, "N m", "Constant torque on the spacecraft, in F_s", XYZ, Plain, Limit::Finite,
        (optional);
    magnetic_dipole_a_m2: Option<[f64; 3]> = None, "A m^2", "Residual magnetic dipole of the spacecraft, in F_s", XYZ, Plain,
        Limit::Finite, (optional);
    } others {
        /// Whether the torque of the gravity gradient acts; it needs an orbit.
        gravity_gradient: bool = false,
        /// The Earth's magnetic field; it needs an orbit with a date.
        magnetic_field: Option<FieldModel> = None,
    }
}

impl EnvironmentInput {
    /// Whether any effect of the environment acts: a magnetic field alone does not.
    pub fn acts(&self) -> bool {
        EnvironmentInput { magnetic_field: None, ..*self } != EnvironmentInput::DEFAULT
    }
}

/// A model of the Earth's magnetic field.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FieldModel {
    /// The tilted dipole: the part of degree 1 of IGRF-14.
    Dipole,
    /// IGRF-14 to degree 13.
    Igrf,
}

impl FieldModel {
    /// The years for which IGRF-14 gives the field here, from the first to the last.
    pub const YEARS: [f64; 2] = [2020.0, 2030.0];

    /// All values.
    pub const ALL: [FieldModel; 2] = [FieldModel::Dipole, FieldModel::Igrf];

    /// The name in campaign files.
    pub const fn name(self) -> &'static str {
        match self {
            FieldModel::Dipole => "dipole",
            FieldModel::Igrf => "igrf",
        }
    }

    /// The model called `name`.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|model| model.name() == name)
    }
}
