//! `[debris]`: a cube, a box, or any rigid body by mass and inertia.

use super::components::{AXES, SCALAR, SYMMETRIC, WXYZ, XYZ};
use super::principal::{AXES_MEANING, MOMENTS, PrincipalInertia, PrincipalMoments, SECOND};
use super::row::{Row, check_rows};
use super::rows::row;
use crate::scene::error::Problems;

/// The debris: a solid homogeneous cube or box, or any rigid body; its centre of mass is the origin of F_d.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum DebrisInput {
    /// A cube, by its side.
    Cube {
        /// Side l_d, m.
        side_m: f64,
        /// Density, kg/m^3.
        density_kg_m3: f64,
    },
    /// A box, by its three sides along d1, d2, d3.
    Box {
        /// Sides, m.
        size_m: [f64; 3],
        /// Density, kg/m^3.
        density_kg_m3: f64,
    },
    /// An irregular body, by its inertia tensor.
    Tensor {
        /// Mass, kg.
        mass_kg: f64,
        /// Inertia tensor about the centre of mass in F_d, kg m^2, by rows.
        inertia_kg_m2: [[f64; 3]; 3],
    },
    /// An irregular body, by its principal moments and axes.
    Principal {
        /// Mass, kg.
        mass_kg: f64,
        /// Moments, and the attitude of the principal frame in F_d.
        principal: PrincipalInertia,
    },
}

const NAN: f64 = f64::NAN;
const BOX: DebrisInput = DebrisInput::Box { size_m: [NAN; 3], density_kg_m3: NAN };
const TENSOR: DebrisInput = DebrisInput::Tensor { mass_kg: NAN, inertia_kg_m2: [[NAN; 3]; 3] };

fn is_irregular(debris: &DebrisInput) -> bool {
    matches!(debris, DebrisInput::Tensor { .. } | DebrisInput::Principal { .. })
}

const ROWS: &[Row<DebrisInput>] = &[
    row!(side_m, "m", "Side of a cube", SCALAR, Plain, Positive required "0.2",
        |debris| *debris = DebrisInput::BLANK,
        DebrisInput::Cube { side_m: value, .. } => value),
    row!(size_m, "m", "Sides of a box along d1, d2, d3", XYZ, Plain, Positive,
        |debris| *debris = BOX,
        DebrisInput::Box { size_m: value, .. } => value),
    row!(density_kg_m3, "kg/m^3", "Density of a cube or box", SCALAR, Plain, Positive required "2700.0",
        |_| {},
        DebrisInput::Cube { density_kg_m3: value, .. } | DebrisInput::Box { density_kg_m3: value, .. } => value),
    row!(mass_kg, "kg", "Mass of an irregular body", SCALAR, Plain, Positive required "21.6",
        |debris| if !is_irregular(debris) { *debris = TENSOR },
        DebrisInput::Tensor { mass_kg: value, .. } | DebrisInput::Principal { mass_kg: value, .. } => value),
    row!(inertia_kg_m2, "kg m^2", "Inertia tensor about the centre of mass in F_d, by rows", SYMMETRIC, Symmetric,
        Inertia,
        |debris| *debris = TENSOR,
        DebrisInput::Tensor { inertia_kg_m2: value, .. } => value),
    row!(principal_moments_kg_m2, "kg m^2", MOMENTS, AXES, Plain, PrincipalMoments,
        |debris| *debris = DebrisInput::Principal { mass_kg: NAN, principal: PrincipalInertia::BLANK },
        DebrisInput::Principal { principal: PrincipalInertia { moments: PrincipalMoments::Inertia(value), .. },
            .. } => value),
    row!(principal_second_moments_kg_m2, "kg m^2", SECOND, AXES, Plain, Positive,
        |debris| *debris = DebrisInput::Principal { mass_kg: NAN, principal: PrincipalInertia::BLANK_SECOND },
        DebrisInput::Principal { principal: PrincipalInertia { moments: PrincipalMoments::Second(value), .. },
            .. } => value),
    row!(principal_axes, "1", AXES_MEANING, WXYZ, Quaternion, UnitQuaternion, |_| {},
        DebrisInput::Principal { principal: PrincipalInertia { axes: value, .. }, .. } => value),
];

impl DebrisInput {
    /// A cube whose numbers are not read yet: none is a number.
    pub const BLANK: DebrisInput = DebrisInput::Cube { side_m: NAN, density_kg_m3: NAN };

    /// The rows of the schema.
    pub const ROWS: &'static [Row<DebrisInput>] = ROWS;

    /// Notes violated limits.
    pub(in crate::scene) fn check(&self, problems: &mut Problems) {
        check_rows(ROWS, self, problems, |key| format!("debris.{key}").into());
    }
}
