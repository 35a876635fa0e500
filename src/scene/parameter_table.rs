//! The table behind [`super::Parameter`]: name, unit, components and place in [`SceneInput`] of every key that can be dispersed.

use super::input::{
    ActuatorsInput, DebrisInput, FuselageInput, InitialInput, MassErrors, PrincipalInertia, PrincipalMoments,
    SceneInput, WheelInput,
};
use super::parameter::Kind;

/// A line of the table.
pub(super) struct Entry {
    pub(super) name: &'static str,
    pub(super) unit: &'static str,
    pub(super) components: &'static [&'static str],
    pub(super) kind: Kind,
    /// What makes the key exist where it does not.
    pub(super) remedy: &'static str,
    pub(super) read: fn(&SceneInput) -> Option<&[f64]>,
    pub(super) write: fn(&mut SceneInput) -> Option<&mut [f64]>,
}

const SCALAR: &[&str] = &[""];
const XY: &[&str] = &["x", "y"];
const XZ: &[&str] = &["x", "z"];
const XYZ: &[&str] = &["x", "y", "z"];
const WXYZ: &[&str] = &["w", "x", "y", "z"];
const WHEELS: &[&str] = &["1", "2"];
const THRUSTERS: &[&str] = &["1", "2", "3"];
const AXES: &[&str] = THRUSTERS;
const SHEARS: &[&str] = &["xy", "xz", "yz"];
const SYMMETRIC: &[&str] = &["xx", "xy", "xz", "yy", "yz", "zz"];

/// A value seen as plain numbers.
trait Numbers {
    fn numbers(&self) -> &[f64];
    fn numbers_mut(&mut self) -> &mut [f64];
}

impl Numbers for f64 {
    fn numbers(&self) -> &[f64] {
        std::slice::from_ref(self)
    }
    fn numbers_mut(&mut self) -> &mut [f64] {
        std::slice::from_mut(self)
    }
}

impl<const N: usize> Numbers for [f64; N] {
    fn numbers(&self) -> &[f64] {
        self
    }
    fn numbers_mut(&mut self) -> &mut [f64] {
        self
    }
}

impl Numbers for [[f64; 3]; 3] {
    fn numbers(&self) -> &[f64] {
        self.as_flattened()
    }
    fn numbers_mut(&mut self) -> &mut [f64] {
        self.as_flattened_mut()
    }
}

/// One line of the table: the pattern binds the value where the key exists, by shared or by mutable reference.
macro_rules! entry {
    ($table:literal, $key:ident, $unit:literal, $components:expr, $kind:ident, $remedy:expr,
        $pattern:pat $(if $guard:expr)? => $value:ident) => {
        Entry {
            name: concat!($table, ".", stringify!($key)),
            unit: $unit,
            components: $components,
            kind: Kind::$kind,
            remedy: $remedy,
            #[allow(unreachable_patterns, reason = "keys that always exist have a pattern that always matches")]
            read: |scene| match scene {
                $pattern $(if $guard)? => Some($value.numbers()),
                _ => None,
            },
            #[allow(unreachable_patterns, reason = "keys that always exist have a pattern that always matches")]
            write: |scene| match scene {
                $pattern $(if $guard)? => Some($value.numbers_mut()),
                _ => None,
            },
        }
    };
}

macro_rules! fuselage {
    ($key:ident, $unit:literal, $hidden:ident) => {
        entry!("fuselage", $key, $unit, SCALAR, Plain, "other keys override it: disperse those, or delete them",
            SceneInput { actuation, fuselage: FuselageInput {
                $key: value, mass_kg, center_of_mass_m, inertia_kg_m2, principal, .. }, .. }
            if !$hidden(!actuation.is_empty(), mass_kg.is_some(), center_of_mass_m.is_some(),
                inertia_kg_m2.is_some() || principal.is_some()) => value)
    };
    ($key:ident, $unit:literal, $components:expr, $kind:ident, given) => {
        entry!("fuselage", $key, $unit, $components, $kind,
            concat!("give fuselage.", stringify!($key), " a nominal value, or disperse the geometry that it would come from"),
            SceneInput { fuselage: FuselageInput { $key: Some(value), .. }, .. } => value)
    };
}

macro_rules! fuselage_error {
    ($key:ident, $unit:literal, $components:expr) => {
        entry!("fuselage", $key, $unit, $components, Plain, "",
            SceneInput { fuselage: FuselageInput { errors: MassErrors { $key: value, .. }, .. }, .. } => value)
    };
}

macro_rules! fuselage_principal {
    ($key:ident, $unit:literal, $components:expr, $kind:ident, $pattern:pat => $value:ident) => {
        entry!("fuselage", $key, $unit, $components, $kind,
            concat!("describe the fuselage's inertia by fuselage.", stringify!($key)),
            SceneInput { fuselage: FuselageInput { principal: Some($pattern), .. }, .. } => $value)
    };
}

macro_rules! debris {
    ($key:ident, $unit:literal, $components:expr, $kind:ident, $pattern:pat => $value:ident) => {
        entry!("debris", $key, $unit, $components, $kind,
            concat!("describe the debris by debris.", stringify!($key)),
            SceneInput { debris: Some($pattern), .. } => $value)
    };
}

macro_rules! actuators {
    ($key:ident, $unit:literal, $components:expr, $kind:ident) => {
        entry!("actuators", $key, $unit, $components, $kind, "add [[actuation]] tables, or the wheel's",
            SceneInput { actuation, actuators: ActuatorsInput { $key: value, .. }, .. } if !actuation.is_empty() => value)
    };
}

macro_rules! wheel1 {
    ($key:ident, $unit:literal) => {
        wheel1!($key, $unit, SCALAR)
    };
    ($key:ident, $unit:literal, $components:expr) => {
        entry!("wheel1", $key, $unit, $components, Plain, "add a [wheel1] table",
            SceneInput { wheels: [Some(WheelInput { $key: value, .. }), _], .. } => value)
    };
}

macro_rules! wheel2 {
    ($key:ident, $unit:literal) => {
        wheel2!($key, $unit, SCALAR)
    };
    ($key:ident, $unit:literal, $components:expr) => {
        entry!("wheel2", $key, $unit, $components, Plain, "add a [wheel2] table",
            SceneInput { wheels: [_, Some(WheelInput { $key: value, .. })], .. } => value)
    };
}

macro_rules! initial {
    ($key:ident, $unit:literal, $components:expr, $kind:ident) => {
        entry!("initial", $key, $unit, $components, $kind, "add the wheel's table",
            SceneInput { initial: InitialInput { $key: value, .. }, .. } => value)
    };
    ($key:ident, $unit:literal, $components:expr, $kind:ident, debris) => {
        entry!("initial", $key, $unit, $components, $kind, "add a [debris] table",
            SceneInput { debris: Some(_), initial: InitialInput { $key: value, .. }, .. } => value)
    };
}

/// Whether the overrides that are given hide the fuselage's density: a mass alone scales what geometry gives.
fn hides_density(_actuated: bool, mass: bool, _center: bool, _inertia: bool) -> bool {
    mass
}

/// Whether they hide its wall and radius, from which mass and inertia come.
fn hides_section(_actuated: bool, mass: bool, _center: bool, inertia: bool) -> bool {
    mass && inertia
}

/// Whether they hide its length, which is also where the centre of mass and the thrusters are.
fn hides_length(actuated: bool, mass: bool, center: bool, inertia: bool) -> bool {
    mass && inertia && center && !actuated
}

pub(super) static TABLE: [Entry; 53] = [
    fuselage!(wall_thickness_m, "m", hides_section),
    fuselage!(outer_radius_m, "m", hides_section),
    fuselage!(length_m, "m", hides_length),
    fuselage!(density_kg_m3, "kg/m^3", hides_density),
    entry!("fuselage", thruster_offset_m, "m", SCALAR, Plain, "add [[actuation]] tables: nothing else depends on it",
        SceneInput { actuation, fuselage: FuselageInput { thruster_offset_m: value, .. }, .. } if !actuation.is_empty() => value),
    fuselage!(mass_kg, "kg", SCALAR, Plain, given),
    fuselage!(center_of_mass_m, "m", XYZ, Plain, given),
    fuselage!(inertia_kg_m2, "kg m^2", SYMMETRIC, Symmetric, given),
    fuselage_principal!(principal_moments_kg_m2, "kg m^2", AXES, Plain,
        PrincipalInertia { moments: PrincipalMoments::Inertia(value), .. } => value),
    fuselage_principal!(principal_second_moments_kg_m2, "kg m^2", AXES, Plain,
        PrincipalInertia { moments: PrincipalMoments::Second(value), .. } => value),
    fuselage_principal!(principal_axes, "1", WXYZ, Quaternion, PrincipalInertia { axes: value, .. } => value),
    fuselage_error!(mass_scale, "1", SCALAR),
    fuselage_error!(stretch_log, "1", XYZ),
    fuselage_error!(shear, "1", SHEARS),
    fuselage_error!(center_offset_m, "m", XYZ),
    wheel1!(radius_m, "m"),
    wheel1!(length_m, "m"),
    wheel1!(station_m, "m"),
    wheel1!(density_kg_m3, "kg/m^3"),
    wheel1!(offset_m, "m", XY),
    wheel1!(tilt_rad, "rad", XZ),
    wheel2!(radius_m, "m"),
    wheel2!(length_m, "m"),
    wheel2!(station_m, "m"),
    wheel2!(density_kg_m3, "kg/m^3"),
    wheel2!(offset_m, "m", XY),
    wheel2!(tilt_rad, "rad", XY),
    debris!(side_m, "m", SCALAR, Plain, DebrisInput::Cube { side_m: value, .. } => value),
    debris!(size_m, "m", XYZ, Plain, DebrisInput::Box { size_m: value, .. } => value),
    debris!(density_kg_m3, "kg/m^3", SCALAR, Plain,
        DebrisInput::Cube { density_kg_m3: value, .. } | DebrisInput::Box { density_kg_m3: value, .. } => value),
    debris!(mass_kg, "kg", SCALAR, Plain,
        DebrisInput::Tensor { mass_kg: value, .. } | DebrisInput::Principal { mass_kg: value, .. } => value),
    debris!(inertia_kg_m2, "kg m^2", SYMMETRIC, Symmetric, DebrisInput::Tensor { inertia_kg_m2: value, .. } => value),
    debris!(principal_moments_kg_m2, "kg m^2", AXES, Plain,
        DebrisInput::Principal { principal: PrincipalInertia { moments: PrincipalMoments::Inertia(value), .. }, .. } => value),
    debris!(principal_second_moments_kg_m2, "kg m^2", AXES, Plain,
        DebrisInput::Principal { principal: PrincipalInertia { moments: PrincipalMoments::Second(value), .. }, .. } => value),
    debris!(principal_axes, "1", WXYZ, Quaternion,
        DebrisInput::Principal { principal: PrincipalInertia { axes: value, .. }, .. } => value),
    actuators!(thrust_scale, "1", THRUSTERS, Plain),
    actuators!(thruster1_tilt_rad, "rad", XY, Plain),
    actuators!(thruster2_tilt_rad, "rad", XY, Plain),
    actuators!(thruster3_tilt_rad, "rad", XY, Plain),
    actuators!(switch_on_delay_s, "s", SCALAR, Plain),
    actuators!(switch_off_delay_s, "s", SCALAR, Plain),
    actuators!(torque_scale, "1", WHEELS, PerWheel),
    actuators!(torque_bias_n_m, "N m", WHEELS, PerWheel),
    initial!(position_m, "m", XYZ, Plain),
    initial!(velocity_m_s, "m/s", XYZ, Plain),
    initial!(attitude, "1", WXYZ, Quaternion),
    initial!(angular_velocity_rad_s, "rad/s", XYZ, Plain),
    initial!(wheel_angles_rad, "rad", WHEELS, PerWheel),
    initial!(wheel_rates_rad_s, "rad/s", WHEELS, PerWheel),
    initial!(debris_position_m, "m", XYZ, Plain, debris),
    initial!(debris_velocity_m_s, "m/s", XYZ, Plain, debris),
    initial!(debris_attitude, "1", WXYZ, Quaternion, debris),
    initial!(debris_relative_angular_velocity_rad_s, "rad/s", XYZ, Plain, debris),
];
