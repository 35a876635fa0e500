//! `[[body.parts]]`: a rigid part of the body: a cylinder, hollow or solid, a box, a sphere, or a point mass.

use super::mass_errors::MassErrors;
use super::rows::rows;
use crate::math::enumeration::named;
use crate::scene::name::Name;

rows! {
    /// A rigid homogeneous part of the body, with its centre of mass at `position_m`.
    pub struct PartInput in PartInput [table => table] {
    outer_radius_m: Option<f64> = None, "m", "Outer radius of a hollow cylinder", Positive;
    wall_thickness_m: Option<f64> = None, "m",
        "Thickness of the shell and the end plates of a hollow cylinder", Positive;
    radius_m: Option<f64> = None, "m", "Radius of a solid cylinder or a sphere", Positive;
    length_m: Option<f64> = None, "m", "Outer length of a cylinder, along the third axis of the part's frame", Positive;
    size_m: Option<[f64; 3]> = None, "m", "Sides of a box along the axes of its frame", Positive;
    density_kg_m3: Option<f64> = None, "kg/m^3", "Density", Positive;
    mass_kg: Option<f64> = None, "kg", "Mass, instead of the density", Positive;
    position_m: [f64; 3] = [0.0; 3], "m", "Centre of the part from p, in F_s", Finite;
    attitude: [f64; 4] = [1.0, 0.0, 0.0, 0.0], "1",
        "Attitude of the part's frame: quaternion that maps its components to those of F_s, scalar first",
        UnitQuaternion;
    } others {
        /// The name.
        name: Name = Name::NONE,
        /// The shape, which decides its sizes.
        shape: PartShape = PartShape::Box,
        /// Errors of this distribution of mass.
        errors: MassErrors = MassErrors::DEFAULT,
    }
}

named! {
    /// The shape of a part.
    pub enum PartShape {
        /// A hollow cylinder with closed ends.
        HollowCylinder = "hollow_cylinder",
        /// A solid cylinder.
        SolidCylinder = "solid_cylinder",
        /// A solid box.
        Box = "box",
        /// A solid sphere.
        Sphere = "sphere",
        /// A mass at a point.
        PointMass = "point_mass",
    }
}

impl PartShape {
    /// The keys of its sizes.
    pub const fn sizes(self) -> &'static [&'static str] {
        match self {
            PartShape::HollowCylinder => &["outer_radius_m", "wall_thickness_m", "length_m"],
            PartShape::SolidCylinder => &["radius_m", "length_m"],
            PartShape::Box => &["size_m"],
            PartShape::Sphere => &["radius_m"],
            PartShape::PointMass => &[],
        }
    }
}
