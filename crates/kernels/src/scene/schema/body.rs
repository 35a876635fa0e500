//! `[body]`: the body's mass properties, given directly or by its parts, and their errors.

use super::components::{AXES, WXYZ};
use super::mass_errors::MassErrors;
use super::principal::{AXES_MEANING, MOMENTS, PrincipalInertia, PrincipalMoments, SECOND};
use super::row::{Row, check_rows};
use super::rows::{row, rows};
use crate::scene::error::Problems;

rows! {
    /// The body: everything of the spacecraft but the wheels that turn. A given mass scales the inertia of the parts
    /// ([`super::PartInput`]), a centre of mass moves the body as it is, and a tensor or principal moments replace the
    /// inertia. Errors come last.
    pub struct BodyInput in BodyInput [table => table] {
    mass_kg: Option<f64> = None, "kg", "Mass, in place of that of the parts", Positive;
    center_of_mass_m: Option<[f64; 3]> = None, "m",
        "Centre of mass from p in F_s, in place of that of the parts", Finite;
    inertia_kg_m2: Option<[[f64; 3]; 3]> = None, "kg m^2",
        "Inertia tensor about the centre of mass in F_s, by rows, in place of that of the parts", Inertia;
    } others {
        /// That inertia by principal moments and axes; at most one of the two is given.
        principal: Option<PrincipalInertia> = None,
        /// The mass properties are given for the whole spacecraft with its wheels, at rest relative to it.
        includes_wheels: bool = false,
        /// Errors of this distribution of mass.
        errors: MassErrors = MassErrors::DEFAULT,
    }
}

const PRINCIPAL: &[Row<BodyInput>] = &[
    row!(principal_moments_kg_m2, "kg m^2", MOMENTS, AXES, Plain,
        PrincipalMoments,
        |body| { body.principal.get_or_insert(PrincipalInertia::BLANK); },
        BodyInput { principal: Some(PrincipalInertia { moments: PrincipalMoments::Inertia(value), .. }), .. } => value),
    row!(principal_second_moments_kg_m2, "kg m^2", SECOND, AXES, Plain,
        Positive,
        |body| { body.principal.get_or_insert(PrincipalInertia::BLANK_SECOND); },
        BodyInput { principal: Some(PrincipalInertia { moments: PrincipalMoments::Second(value), .. }), .. } => value),
    row!(principal_axes, "1", AXES_MEANING, WXYZ, Quaternion,
        UnitQuaternion,
        |_| {},
        BodyInput { principal: Some(PrincipalInertia { axes: value, .. }), .. } => value),
];

impl BodyInput {
    /// All rows of `[body]` but its errors, in parts.
    pub const PARTS: &'static [&'static [Row<BodyInput>]] = &[BodyInput::ROWS, PRINCIPAL];

    /// Notes violated limits in the whole table.
    #[inline(always)]
    pub(in crate::scene) fn check_all(&self, problems: &mut Problems) {
        let name = |key: &'static str| format!("body.{key}").into();
        self.check(false, problems, name);
        if self.principal.is_some() {
            check_rows(PRINCIPAL, self, problems, name);
        }
        self.errors.check(false, problems, name);
    }
}
