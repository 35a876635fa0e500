//! `[[body.parts]]`: a rigid part of the body: a cylinder, hollow or solid, a box, a sphere, or a point mass.

use super::components::{SCALAR, WXYZ, XYZ};
use super::limit::Limit;
use super::mass_errors::MassErrors;
use super::numbers::Numbers;
use super::rows::rows;
use crate::scene::name::Name;

rows! {
    /// A rigid homogeneous part of the body, with its centre of mass at `position_m`.
    pub struct PartInput in PartInput [table => table] {
    outer_radius_m: Option<f64> = None, "m", "Outer radius of a hollow cylinder", SCALAR, Plain, Limit::Positive,
        (optional);
    wall_thickness_m: Option<f64> = None, "m", "Thickness of the shell and the end plates of a hollow cylinder",
        SCALAR, Plain,
        Limit::Positive, (optional);
    radius_m: Option<f64> = None, "m", "Radius of a solid cylinder or a sphere", SCALAR, Plain, Limit::Positive,
        (optional);
    length_m: Option<f64> = None, "m", "Outer length of a cylinder, along the third axis of the part's frame",
        SCALAR, Plain,
        Limit::Positive, (optional);
    size_m: Option<[f64; 3]> = None, "m", "Sides of a box along the axes of its frame", XYZ, Plain, Limit::Positive,
        (optional);
    density_kg_m3: Option<f64> = None, "kg/m^3", "Density", SCALAR, Plain, Limit::Positive, (optional);
    mass_kg: Option<f64> = None, "kg", "Mass, instead of the density", SCALAR, Plain, Limit::Positive, (optional);
    position_m: [f64; 3] = [0.0; 3], "m", "Centre of the part from p, in F_s", XYZ, Plain, Limit::Finite, (optional);
    attitude: [f64; 4] = [1.0, 0.0, 0.0, 0.0], "1",
        "Attitude of the part's frame: quaternion that maps its components to those of F_s, scalar first", WXYZ,
            Quaternion,
        Limit::UnitQuaternion, (optional);
    } others {
        /// The name.
        name: Name = Name::NONE,
        /// The shape, which says which sizes it has.
        shape: PartShape = PartShape::Box,
        /// How the true distribution of mass differs from all of the above.
        errors: MassErrors = MassErrors::NONE,
    }
}

/// The shape of a part.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PartShape {
    /// A hollow cylinder with closed ends.
    HollowCylinder,
    /// A solid cylinder.
    SolidCylinder,
    /// A solid box.
    Box,
    /// A solid sphere.
    Sphere,
    /// A mass at a point.
    PointMass,
}

impl PartShape {
    /// All shapes.
    pub const ALL: [PartShape; 5] =
        [PartShape::HollowCylinder, PartShape::SolidCylinder, PartShape::Box, PartShape::Sphere, PartShape::PointMass];

    /// The name in campaign files.
    pub const fn name(self) -> &'static str {
        match self {
            PartShape::HollowCylinder => "hollow_cylinder",
            PartShape::SolidCylinder => "solid_cylinder",
            PartShape::Box => "box",
            PartShape::Sphere => "sphere",
            PartShape::PointMass => "point_mass",
        }
    }

    /// The shape called `name`.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|shape| shape.name() == name)
    }

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
