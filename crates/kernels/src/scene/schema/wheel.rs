//! `[[wheels]]`: a wheel.

use super::rows::rows;
use crate::math::enumeration::named;
use crate::scene::name::Name;

rows! {
    /// A balanced axisymmetric wheel with its spin axis fixed in the body: a solid cylinder by radius, length and
    /// density, otherwise by mass and inertias.
    pub struct WheelInput in WheelInput [table => table] {
    axis: [f64; 3] = [0.0, 0.0, 1.0], "1",
        "Spin axis in F_s; need not have length one", Direction, required "[0, 0, 1]";
    position_m: [f64; 3] = [0.0; 3], "m", "Centre of the wheel from p, in F_s", Finite;
    radius_m: Option<f64> = None, "m", "Radius", Positive;
    length_m: Option<f64> = None, "m", "Length along the spin axis", Positive;
    density_kg_m3: Option<f64> = None, "kg/m^3", "Density", Positive;
    mass_kg: Option<f64> = None, "kg", "Mass", Positive;
    axial_inertia_kg_m2: Option<f64> = None, "kg m^2", "Moment of inertia about the spin axis", Positive;
    transverse_inertia_kg_m2: Option<f64> = None, "kg m^2",
        "Moment of inertia about any axis through the centre perpendicular to the spin axis", Positive;
    tilt_rad: [f64; 2] = [0.0; 2], "rad",
        "Alignment error of the spin axis: components of the rotation vector that turns the nominal axis into the \
        true one, along the two axes of F_s perpendicular to it (oblique axes: docs/campaign-files.md)", Finite;
    rate_rad_s: f64 = 0.0, "rad/s", "Rate relative to the body at the start", Finite;
    angle_rad: f64 = 0.0, "rad", "Angle relative to the body at the start", Finite;
    torque_scale: f64 = 1.0, "1", "Scale factor for the commanded motor torque", Finite;
    torque_bias_n_m: f64 = 0.0, "N m",
        "Torque added to the scaled torque whenever the commanded torque is not zero", Finite;
    torque_limit_n_m: Option<f64> = None, "N m",
        "Largest motor torque in either direction, under a control loop", Positive;
    speed_limit_rad_s: Option<f64> = None, "rad/s",
        "Largest rate relative to the body, in either direction, to which a control loop drives the wheel", Positive;
    coulomb_friction_n_m: Option<f64> = None, "N m",
        "Bearing friction that does not depend on the rate, under a control loop", NotNegative;
    viscous_friction_n_m_s: Option<f64> = None, "N m s",
        "Bearing friction proportional to the rate, under a control loop", NotNegative;
    } others {
        /// The name.
        name: Name = Name::NONE,
        /// Motion of the wheel when no torque is scheduled for it.
        mode: WheelMode = WheelMode::Free,
    }
}

impl WheelInput {
    /// The keys of the sizes of a solid cylinder.
    pub const SIZES: [&'static str; 3] = ["radius_m", "length_m", "density_kg_m3"];
    /// The keys of mass and inertias.
    pub const MASSES: [&'static str; 3] = ["mass_kg", "axial_inertia_kg_m2", "transverse_inertia_kg_m2"];

    /// The keys that act under a control loop alone.
    pub const DRIVE: [&'static str; 4] =
        ["torque_limit_n_m", "speed_limit_rad_s", "coulomb_friction_n_m", "viscous_friction_n_m_s"];

    /// Berdoz's wheel (Table II: 0.25 m, 0.1 m, 2700 kg/m^3) called `name` about `axis` with its centre at
    /// `position_m`.
    ///
    /// # Panics
    /// If `name` is no name.
    pub fn named(name: &str, axis: [f64; 3], position_m: [f64; 3]) -> Self {
        WheelInput {
            name: Name::of(name),
            axis,
            position_m,
            radius_m: Some(0.25),
            length_m: Some(0.1),
            density_kg_m3: Some(2700.0),
            ..WheelInput::DEFAULT
        }
    }
}

named! {
    /// Motion of a wheel when no torque is scheduled for it.
    #[derive(Default)]
    pub enum WheelMode {
        /// It turns freely: its absolute axial momentum h_i is constant, and J* resists a change of omega.
        #[default]
        Free = "free",
        /// Its motor keeps its rate relative to the body with any torque: its momentum relative to the body, J_i
        /// Omega_i, is constant, and its axial inertia resists a change of omega with the rest.
        SpeedHeld = "speed_held",
        /// It does not turn relative to the body: a part of it.
        Locked = "locked",
    }
}
