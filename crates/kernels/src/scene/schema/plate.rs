//! `[[plates]]`: a flat plate of the surface of the body, which air and light push.

use super::rows::rows;
use crate::scene::name::Name;

rows! {
    /// One side of a flat plate; the other side is another plate.
    pub struct PlateInput in PlateInput [table => table] {
    area_m2: f64 = 1.0, "m^2", "Area", Positive, required "1.5";
    normal: [f64; 3] = [0.0, 0.0, 1.0], "1",
        "Outward normal, in F_s; need not have length one", Direction, required "[0, 0, 1]";
    tilt_rad: [f64; 2] = [0.0; 2], "rad",
        "Alignment error: components of the rotation vector that turns the nominal normal into the true one, along \
        the two axes of F_s perpendicular to it (oblique normals: docs/campaign-files.md)", Finite;
    center_m: [f64; 3] = [0.0; 3], "m", "Centre of the area from p, in F_s", Finite, required "[0, 0, 0]";
    drag_coefficient: f64 = 2.2, "1", "Drag coefficient", NotNegative;
    specular: f64 = 0.0, "1",
        "Fraction of the light that is reflected as by a mirror; what is reflected neither this way nor diffusely is \
        absorbed", NotNegative;
    diffuse: f64 = 0.0, "1", "Fraction of the light that is reflected diffusely (Lambert)", NotNegative;
    cell_efficiency: f64 = 0.0, "1",
        "Electrical power of the solar cells on the plate over the light that falls on the plate: the efficiency of \
        the cells times their share of the area", NotNegative;
    } others {
        /// The name.
        name: Name = Name::NONE,
    }
}

/// Largest number of plates of a spacecraft.
pub const MAX_PLATES: usize = 24;
