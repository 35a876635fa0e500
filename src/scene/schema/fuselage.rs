//! `[fuselage]`: geometry, overrides of what follows from it, and errors of the true distribution of mass.

use super::numbers::Numbers;
use super::rows::{row, rows};
use super::{Key, Limit, always};
use crate::scene::error::Problems;
use crate::scene::input::SceneInput;

/// Names of components.
pub(super) const SCALAR: &[&[&str]] = &[&[""]];
pub(super) const XYZ: &[&[&str]] = &[&["x", "y", "z"]];
pub(super) const WXYZ: &[&[&str]] = &[&["w", "x", "y", "z"]];
pub(super) const AXES: &[&[&str]] = &[&["1", "2", "3"]];
pub(super) const SYMMETRIC: &[&[&str]] = &[&["xx", "xy", "xz", "yy", "yz", "zz"]];
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
    pub struct FuselageInput in Fuselage ["fuselage"], fuselage, fuselage_mut {
    wall_thickness_m: f64 = 0.03, "m", "Wall thickness t_s of shell and end plates", SCALAR, Plain, Limit::Positive,
        (required "0.03"), section_acts, HIDDEN;
    outer_radius_m: f64 = 1.0, "m", "Outer radius rho_o", SCALAR, Plain, Limit::Positive,
        (required "1.0"), section_acts, HIDDEN;
    length_m: f64 = 3.0, "m", "Outer length l_s, and station of the thrusters P2 and P3", SCALAR, Plain, Limit::Positive,
        (required "3.0"), length_acts, HIDDEN;
    density_kg_m3: f64 = 2700.0, "kg/m^3", "Density sigma_s of the wall", SCALAR, Plain, Limit::Positive,
        (required "2700.0"), density_acts, HIDDEN;
    thruster_offset_m: f64 = 0.0, "m", "Distance rho_p of the thrusters P2 and P3 from the axis s3", SCALAR, Plain,
        Limit::NotNegative, (required "0.5" if is_actuated), offset_acts,
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
    pub struct MassErrors in Fuselage ["fuselage"], errors, errors_mut {
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

/// An inertia about the centre of mass by principal moments and axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PrincipalInertia {
    /// The moments.
    pub moments: PrincipalMoments,
    /// Attitude of the principal frame: quaternion that maps its components to the body's, scalar first.
    pub axes: [f64; 4],
}

/// How principal moments were written.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PrincipalMoments {
    /// Moments of inertia J_1, J_2, J_3, kg m^2: none above the sum of the other two.
    Inertia([f64; 3]),
    /// Second moments of mass P_i, the integrals of x_i^2 dm, kg m^2: J_1 = P_2 + P_3 and so on, so that any positive three are
    /// the inertia of some body.
    Second([f64; 3]),
}

impl PrincipalInertia {
    /// Along the body's axes, with moments of inertia that are not numbers yet.
    pub(in crate::scene) const BLANK: PrincipalInertia =
        PrincipalInertia { moments: PrincipalMoments::Inertia([f64::NAN; 3]), axes: [1.0, 0.0, 0.0, 0.0] };
    /// The same with second moments.
    pub(in crate::scene) const BLANK_SECOND: PrincipalInertia =
        PrincipalInertia { moments: PrincipalMoments::Second([f64::NAN; 3]), ..Self::BLANK };
}

/// The meanings of the keys of a principal inertia, which the debris has as well.
pub(super) const MOMENTS: &str = "Principal moments of inertia about the centre of mass";
pub(super) const SECOND: &str =
    "Principal second moments of mass, the integrals of x_i^2 dm about the centre of mass: J_1 = P_2 + P_3 and so on";
pub(super) const PRINCIPAL_AXES: &str =
    "Attitude of the principal frame: quaternion that maps its components to the body's, scalar first";

const PRINCIPAL: &[Key] = &[
    row!(Fuselage ["fuselage"] principal_moments_kg_m2, "kg m^2", MOMENTS, AXES, Plain,
        Limit::PrincipalMoments, (optional), "describe the fuselage's inertia by fuselage.principal_moments_kg_m2",
        |scene, _| { scene.fuselage.principal.get_or_insert(PrincipalInertia::BLANK); },
        SceneInput { fuselage: FuselageInput {
            principal: Some(PrincipalInertia { moments: PrincipalMoments::Inertia(value), .. }), .. }, .. } => value),
    row!(Fuselage ["fuselage"] principal_second_moments_kg_m2, "kg m^2", SECOND, AXES, Plain,
        Limit::Positive, (optional), "describe the fuselage's inertia by fuselage.principal_second_moments_kg_m2",
        |scene, _| { scene.fuselage.principal.get_or_insert(PrincipalInertia::BLANK_SECOND); },
        SceneInput { fuselage: FuselageInput {
            principal: Some(PrincipalInertia { moments: PrincipalMoments::Second(value), .. }), .. }, .. } => value),
    row!(Fuselage ["fuselage"] principal_axes, "1", PRINCIPAL_AXES, WXYZ, Quaternion,
        Limit::UnitQuaternion, (optional), "describe the fuselage's inertia by fuselage.principal_axes",
        |_, _| {},
        SceneInput { fuselage: FuselageInput { principal: Some(PrincipalInertia { axes: value, .. }), .. }, .. } => value),
];

/// The rows of `[fuselage]`.
pub(super) const KEYS: &[&[Key]] = &[FuselageInput::ROWS, PRINCIPAL, MassErrors::ROWS];

impl FuselageInput {
    /// Notes what violates its limit in the whole table.
    #[inline(always)]
    pub(in crate::scene) fn check_all(&self, scene: &SceneInput, problems: &mut Problems) {
        self.check(scene, problems, |_, names| names[0].into());
        if self.principal.is_some() {
            super::check_rows(PRINCIPAL, scene, problems);
        }
        self.errors.check(scene, problems, |_, names| names[0].into());
    }
}

fn fuselage(scene: &SceneInput, _: usize) -> Option<&FuselageInput> {
    Some(&scene.fuselage)
}

fn fuselage_mut(scene: &mut SceneInput, _: usize) -> Option<&mut FuselageInput> {
    Some(&mut scene.fuselage)
}

fn errors(scene: &SceneInput, _: usize) -> Option<&MassErrors> {
    Some(&scene.fuselage.errors)
}

fn errors_mut(scene: &mut SceneInput, _: usize) -> Option<&mut MassErrors> {
    Some(&mut scene.fuselage.errors)
}

fn is_actuated(scene: &SceneInput) -> bool {
    !scene.actuation.is_empty()
}

/// Whether the schedule ever fires a thruster away from p: P2 or P3.
fn fires_p2_or_p3(scene: &SceneInput) -> bool {
    scene.actuation.iter().any(|arc| arc.thrust_n[1] != 0.0 || arc.thrust_n[2] != 0.0)
}

fn offset_acts(scene: &SceneInput, _: usize, _: usize) -> bool {
    fires_p2_or_p3(scene)
}

fn has_inertia(fuselage: &FuselageInput) -> bool {
    fuselage.inertia_kg_m2.is_some() || fuselage.principal.is_some()
}

/// Density: a mass that is given scales what geometry gives, and replaces the density.
fn density_acts(scene: &SceneInput, _: usize, _: usize) -> bool {
    scene.fuselage.mass_kg.is_none()
}

/// Wall and radius give mass and inertia.
fn section_acts(scene: &SceneInput, _: usize, _: usize) -> bool {
    scene.fuselage.mass_kg.is_none() || !has_inertia(&scene.fuselage)
}

/// The length also gives the centre of mass and the station of the thrusters.
fn length_acts(scene: &SceneInput, instance: usize, component: usize) -> bool {
    section_acts(scene, instance, component) || scene.fuselage.center_of_mass_m.is_none() || fires_p2_or_p3(scene)
}
