//! `[fuselage]`: geometry, overrides of what follows from it, and errors of the true distribution of mass.

use super::components::{AXES, SCALAR, SYMMETRIC, WXYZ, XYZ};
use super::limit::Limit;
use super::numbers::Numbers;
use super::principal::{AXES_MEANING, MOMENTS, PrincipalInertia, PrincipalMoments, SECOND};
use super::row::{Row, always, check_rows};
use super::rows::{row, rows};
use super::usage::Usage;
use crate::scene::error::Problems;

const SHEARS: &[&[&str]] = &[&["xy", "xz", "yz"]];

const HIDDEN: &str = "other keys override it: disperse those, or delete them";

/// The remedy of an override that the scene does not have.
macro_rules! given {
    ($key:literal) => {
        concat!("give fuselage.", $key, " a nominal value, or disperse the geometry that it would come from")
    };
}

rows! {
    /// The fuselage: a hollow cylinder with closed ends, axis s3, base centre at the origin p of F_s.
    ///
    /// A mass that is given scales the inertia that geometry gives; a centre of mass that is given leaves the inertia about it
    /// as it was; a tensor or principal moments replace it. The errors are applied last.
    pub struct FuselageInput in FuselageInput [table => table] {
    wall_thickness_m: f64 = 0.03, "m", "Wall thickness t_s of shell and end plates", SCALAR, Plain, Limit::Positive,
        (required "0.03"), section_acts, HIDDEN;
    outer_radius_m: f64 = 1.0, "m", "Outer radius rho_o", SCALAR, Plain, Limit::Positive,
        (required "1.0"), section_acts, HIDDEN;
    length_m: f64 = 3.0, "m", "Outer length l_s, and station of the thrusters P2 and P3", SCALAR, Plain, Limit::Positive,
        (required "3.0"), length_acts, HIDDEN;
    density_kg_m3: f64 = 2700.0, "kg/m^3", "Density sigma_s of the wall", SCALAR, Plain, Limit::Positive,
        (required "2700.0"), density_acts, HIDDEN;
    thruster_offset_m: f64 = 0.0, "m", "Distance rho_p of the thrusters P2 and P3 from the axis s3", SCALAR, Plain,
        Limit::NotNegative, (required "0.5" if is_scheduled), offset_acts,
        "fire P2 or P3 in an [[actuation]] table: nothing else depends on it";
    mass_kg: Option<f64> = None, "kg", "Mass instead of the one that geometry gives", SCALAR, Plain, Limit::Positive,
        (optional), always, given!("mass_kg");
    center_of_mass_m: Option<[f64; 3]> = None, "m",
        "Centre of mass from p, components in F_s, instead of the one that geometry gives", XYZ, Plain, Limit::Finite,
        (optional), always, given!("center_of_mass_m");
    inertia_kg_m2: Option<[[f64; 3]; 3]> = None, "kg m^2",
        "Inertia tensor about the fuselage's own centre of mass in F_s, by rows, instead of the one that geometry gives",
        SYMMETRIC, Symmetric, Limit::Inertia, (optional), always, given!("inertia_kg_m2");
    } others {
        /// The same inertia by principal moments and axes; at most one of the two is given.
        principal: Option<PrincipalInertia> = None,
        /// How the true distribution of mass differs from all of the above.
        errors: MassErrors = MassErrors::DEFAULT,
    }
}

rows! {
    /// How a distribution of mass differs from the nominal one: the same matter, moved by a linear map about the centre of
    /// mass, with another mass, at another place.
    ///
    /// The second moments of mass about the centre become S' = k A S A^T with k = `mass_scale` times `inertia_scale` and A lower triangular,
    /// exp(`stretch_log`) on its diagonal and `shear` below: positive definite whatever the numbers, as the inertia of a body
    /// always is. If S = L L^T then S' = k (A L)(A L)^T: these are the coordinates of the log-Cholesky form (C. Rucker & P. M.
    /// Wensing, *Smooth Parameterization of Rigid-Body Inertia*, IEEE Robotics and Automation Letters 7(2), 2022) about the
    /// nominal body; with mass and centre of mass they couple all ten numbers of a rigid body.
    pub struct MassErrors in FuselageInput [table => table.errors] {
    mass_scale: f64 = 1.0, "1", "Factor of all masses", SCALAR, Plain, Limit::Positive, (optional), always, "";
    inertia_scale: f64 = 1.0, "1", "Further factor of the inertia about the centre of mass, at the same mass", SCALAR, Plain,
        Limit::Positive, (optional), always, "";
    stretch_log: [f64; 3] = [0.0; 3], "1", "Logarithms of the linear scale factors of the mass distribution along s1, s2, s3",
        XYZ, Plain, Limit::Finite, (optional), always, "";
    shear: [f64; 3] = [0.0; 3], "1",
        "Shears xy, xz, yz: matter at x moves by xy x along s2 and by xz x along s3, matter at y by yz y along s3", SHEARS,
        Plain, Limit::Finite, (optional), always, "";
    center_offset_m: [f64; 3] = [0.0; 3], "m", "Offset of the centre of mass, components in F_s", XYZ, Plain,
        Limit::Finite, (optional), always, "";
    } others {}
}

impl MassErrors {
    /// No difference.
    pub const NONE: MassErrors = MassErrors::DEFAULT;
}

const PRINCIPAL: &[Row<FuselageInput>] = &[
    row!(principal_moments_kg_m2, "kg m^2", MOMENTS, AXES, Plain,
        Limit::PrincipalMoments, (optional), "describe the fuselage's inertia by fuselage.principal_moments_kg_m2",
        |fuselage| { fuselage.principal.get_or_insert(PrincipalInertia::BLANK); },
        FuselageInput { principal: Some(PrincipalInertia { moments: PrincipalMoments::Inertia(value), .. }), .. } => value),
    row!(principal_second_moments_kg_m2, "kg m^2", SECOND, AXES, Plain,
        Limit::Positive, (optional), "describe the fuselage's inertia by fuselage.principal_second_moments_kg_m2",
        |fuselage| { fuselage.principal.get_or_insert(PrincipalInertia::BLANK_SECOND); },
        FuselageInput { principal: Some(PrincipalInertia { moments: PrincipalMoments::Second(value), .. }), .. } => value),
    row!(principal_axes, "1", AXES_MEANING, WXYZ, Quaternion,
        Limit::UnitQuaternion, (optional), "describe the fuselage's inertia by fuselage.principal_axes",
        |_| {},
        FuselageInput { principal: Some(PrincipalInertia { axes: value, .. }), .. } => value),
];

impl FuselageInput {
    /// All rows of `[fuselage]`, in parts.
    pub const PARTS: &'static [&'static [Row<FuselageInput>]] = &[FuselageInput::ROWS, PRINCIPAL, MassErrors::ROWS];

    /// Notes what violates its limit in the whole table.
    #[inline(always)]
    pub(in crate::scene) fn check_all(&self, problems: &mut Problems) {
        let name = |key: &'static str| format!("fuselage.{key}").into();
        self.check(false, problems, name);
        if self.principal.is_some() {
            check_rows(PRINCIPAL, self, problems, name);
        }
        self.errors.check(false, problems, name);
    }

    fn has_inertia(&self) -> bool {
        self.inertia_kg_m2.is_some() || self.principal.is_some()
    }
}

fn is_scheduled(usage: &Usage) -> bool {
    usage.is_scheduled
}

/// Whether the schedule ever fires a thruster away from p: P2 or P3.
fn offset_acts(usage: &Usage, _: &FuselageInput, _: usize, _: usize) -> bool {
    usage.fires[1] || usage.fires[2]
}

/// Density: a mass that is given scales what geometry gives, and replaces the density.
fn density_acts(_: &Usage, fuselage: &FuselageInput, _: usize, _: usize) -> bool {
    fuselage.mass_kg.is_none()
}

/// Wall and radius give mass and inertia.
fn section_acts(_: &Usage, fuselage: &FuselageInput, _: usize, _: usize) -> bool {
    fuselage.mass_kg.is_none() || !fuselage.has_inertia()
}

/// The length also gives the centre of mass and the station of the thrusters.
fn length_acts(usage: &Usage, fuselage: &FuselageInput, instance: usize, component: usize) -> bool {
    let gives_center = fuselage.center_of_mass_m.is_none();
    section_acts(usage, fuselage, instance, component)
        || gives_center
        || offset_acts(usage, fuselage, instance, component)
}
