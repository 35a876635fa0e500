//! `[[torque_rods]]`: a magnetic torque rod.

use super::rows::rows;
use crate::scene::name::Name;

rows! {
    /// A coil, with a core or without, that makes the body a magnet along its axis while a current flows.
    pub struct TorqueRodInput in TorqueRodInput [table => table] {
    axis: [f64; 3] = [0.0, 0.0, 1.0], "1", "Axis in F_s; need not have length one", Direction, required "[0, 0, 1]";
    max_dipole_a_m2: f64 = f64::NAN, "A m^2",
        "Largest dipole that can be commanded, in either direction", Positive, required "10.0";
    tilt_rad: [f64; 2] = [0.0; 2], "rad",
        "Alignment error of the axis: components of the rotation vector that turns the nominal axis into the true \
        one, along the two axes of F_s perpendicular to it (oblique axes: docs/campaign-files.md)", Finite;
    dipole_scale: f64 = 1.0, "1", "Scale factor for the commanded dipole; 0 for a dead rod", Finite;
    } others {
        /// The name.
        name: Name = Name::NONE,
    }
}
