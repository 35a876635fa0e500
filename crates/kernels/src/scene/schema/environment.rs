//! `[environment]`: effects of the environment on the spacecraft.

use super::rows::rows;
use crate::math::enumeration::named;

rows! {
    /// Effects of the environment on the spacecraft. An effect left out does not act.
    pub struct EnvironmentInput in EnvironmentInput [table => table] {
    body_torque_n_m: Option<[f64; 3]> = None, "N m", "Constant torque on the spacecraft, in F_s", Finite;
    magnetic_dipole_a_m2: Option<[f64; 3]> = None, "A m^2",
        "Residual magnetic dipole of the spacecraft, in F_s", Finite;
    density_scale: f64 = 1.0, "1", "Scale factor for the air density", NotNegative;
    base_density_kg_m3: Option<f64> = None, "kg/m^3",
        "Density of an exponential atmosphere at base_height_m, in place of the table", NotNegative;
    base_height_m: Option<f64> = None, "m", "Height above body_radius_m of the density base_density_kg_m3", Finite;
    scale_height_m: Option<f64> = None, "m", "Height over which the density falls by a factor of e", Positive;
    solar_pressure_n_m2: f64 = 4.56e-6, "N/m^2",
        "Pressure of sunlight at 1 au on a surface that absorbs it", NotNegative;
    area_scale: f64 = 1.0, "1", "Scale factor for the areas of all plates", NotNegative;
    } others {
        /// The torque of the gravity gradient acts; it needs an orbit.
        gravity_gradient: bool = false,
        /// The Earth's magnetic field; it needs an orbit with a date.
        magnetic_field: Option<FieldModel> = None,
        /// The torque of the air on the plates acts; it needs an orbit.
        drag: bool = false,
        /// The torque of sunlight on the plates acts; it needs an orbit with an epoch.
        solar_pressure: bool = false,
        /// The forces of air and light move the spacecraft off its orbit.
        coupled: bool = false,
        /// Heights above `body_radius_m` of given air densities, m, in place of Vallado's table
        /// ([`super::numbers::kept`]).
        air_heights_m: Option<&'static [f64]> = None,
        /// The density at each of them, kg/m^3.
        air_densities_kg_m3: Option<&'static [f64]> = None,
        /// The shape of the Earth's shadow.
        shadow: Shadow = Shadow::Cone,
    }
}

named! {
    /// The shape of the Earth's shadow.
    #[derive(Default)]
    pub enum Shadow {
        /// Full shadow and part shadow.
        #[default]
        Cone = "cone",
        /// Parallel light: full shadow behind the Earth.
        Cylinder = "cylinder",
    }
}

impl EnvironmentInput {
    /// An effect on plates acts.
    pub fn acts_on_plates(&self) -> bool {
        self.drag || self.solar_pressure
    }

    /// Forces of the environment move the centre of mass.
    pub fn moves(&self) -> bool {
        self.coupled && self.acts_on_plates()
    }

    /// Density, height and scale height of an exponential atmosphere, as far as written.
    pub fn exponential(&self) -> [Option<f64>; 3] {
        [self.base_density_kg_m3, self.base_height_m, self.scale_height_m]
    }

    /// Any effect of the environment acts; a magnetic field alone does not.
    pub fn acts(&self) -> bool {
        EnvironmentInput { magnetic_field: None, ..*self } != EnvironmentInput::DEFAULT
    }
}

named! {
    /// A model of the Earth's magnetic field.
    pub enum FieldModel {
        /// The tilted dipole: the part of degree 1 of IGRF-14.
        Dipole = "dipole",
        /// IGRF-14 to degree 13.
        Igrf = "igrf",
    }
}

impl FieldModel {
    /// The first and last year in which IGRF-14 gives the field here.
    pub const YEARS: [f64; 2] = [2020.0, 2030.0];
}
