//! `[environment]`: effects of the environment on the spacecraft.

use super::components::{SCALAR, XYZ};
use super::limit::Limit;
use super::numbers::Numbers;
use super::rows::rows;

rows! {
    /// Effects of the environment on the spacecraft. An effect that is not written does not act.
    pub struct EnvironmentInput in EnvironmentInput [table => table] {
    body_torque_n_m: Option<[f64; 3]> = None, "N m", "Constant torque on the spacecraft, in F_s", XYZ, Plain,
        Limit::Finite,
        (optional);
    magnetic_dipole_a_m2: Option<[f64; 3]> = None, "A m^2", "Residual magnetic dipole of the spacecraft, in F_s",
        XYZ, Plain,
        Limit::Finite, (optional);
    density_scale: f64 = 1.0, "1", "Scale factor for the air density", SCALAR, Plain, Limit::NotNegative, (optional);
    base_density_kg_m3: Option<f64> = None, "kg/m^3",
        "Density of an exponential atmosphere at base_height_m, in place of the table",
        SCALAR, Plain, Limit::NotNegative, (optional);
    base_height_m: Option<f64> = None, "m", "Height above body_radius_m of the density base_density_kg_m3", SCALAR,
        Plain,
        Limit::Finite, (optional);
    scale_height_m: Option<f64> = None, "m", "Height over which the density falls by a factor of e", SCALAR, Plain,
        Limit::Positive, (optional);
    solar_pressure_n_m2: f64 = 4.56e-6, "N/m^2", "Pressure of sunlight at 1 au on a surface that absorbs it", SCALAR,
        Plain,
        Limit::NotNegative, (optional);
    area_scale: f64 = 1.0, "1", "Scale factor for the areas of all plates", SCALAR, Plain, Limit::NotNegative,
        (optional);
    } others {
        /// Whether the torque of the gravity gradient acts; it needs an orbit.
        gravity_gradient: bool = false,
        /// The Earth's magnetic field; it needs an orbit with a date.
        magnetic_field: Option<FieldModel> = None,
        /// Whether the torque of the air on the plates acts; it needs an orbit.
        drag: bool = false,
        /// Whether the torque of sunlight on the plates acts; it needs an orbit with an epoch.
        solar_pressure: bool = false,
        /// Whether the forces of air and light move the spacecraft, which leaves its orbit by them.
        coupled: bool = false,
        /// Heights above `body_radius_m` at which the density of the air is given, m, in place of Vallado's table; kept
        /// for good ([`super::numbers::kept`]).
        air_heights_m: Option<&'static [f64]> = None,
        /// The density at each of them, kg/m^3.
        air_densities_kg_m3: Option<&'static [f64]> = None,
        /// The shape of the Earth's shadow.
        shadow: Shadow = Shadow::Cone,
    }
}

/// The shape of the Earth's shadow.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Shadow {
    /// Full shadow and part shadow.
    #[default]
    Cone,
    /// Parallel light: full shadow behind the Earth.
    Cylinder,
}

impl Shadow {
    /// All shapes.
    pub const ALL: [Shadow; 2] = [Shadow::Cone, Shadow::Cylinder];

    /// The name in campaign files.
    pub const fn name(self) -> &'static str {
        match self {
            Shadow::Cone => "cone",
            Shadow::Cylinder => "cylinder",
        }
    }

    /// The shape called `name`.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|shadow| shadow.name() == name)
    }
}

impl EnvironmentInput {
    /// Whether an effect acts that plates feel.
    pub fn acts_on_plates(&self) -> bool {
        self.drag || self.solar_pressure
    }

    /// Whether its forces move the centre of mass.
    pub fn moves(&self) -> bool {
        self.coupled && self.acts_on_plates()
    }

    /// Density, height and scale height of an exponential atmosphere, where one of them is written.
    pub fn exponential(&self) -> [Option<f64>; 3] {
        [self.base_density_kg_m3, self.base_height_m, self.scale_height_m]
    }

    /// Whether any effect of the environment acts: whether any key is written; a magnetic field alone does not act.
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
