//! [`PrincipalInertia`]: an inertia by principal moments and axes, of the body or the debris.

/// An inertia about the centre of mass by principal moments and axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PrincipalInertia {
    /// The moments.
    pub moments: PrincipalMoments,
    /// Attitude of the principal frame: quaternion that maps its components to the body's, scalar first.
    pub axes: [f64; 4],
}

/// Principal moments, as written.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PrincipalMoments {
    /// Moments of inertia J_1, J_2, J_3, kg m^2: none above the sum of the other two.
    Inertia([f64; 3]),
    /// Second moments of mass P_i, the integrals of x_i^2 dm, kg m^2: J_1 = P_2 + P_3 and so on, for any positive
    /// three.
    Second([f64; 3]),
}

impl PrincipalInertia {
    /// Along the body's axes, with moments of inertia that are not numbers yet.
    pub(in crate::scene) const BLANK: PrincipalInertia =
        PrincipalInertia { moments: PrincipalMoments::Inertia([f64::NAN; 3]), axes: [1.0, 0.0, 0.0, 0.0] };
    /// [`PrincipalInertia::BLANK`] with second moments.
    pub(in crate::scene) const BLANK_SECOND: PrincipalInertia =
        PrincipalInertia { moments: PrincipalMoments::Second([f64::NAN; 3]), ..Self::BLANK };
}

/// Meanings of the keys of a principal inertia, of body and debris.
pub(super) const MOMENTS: &str = "Principal moments of inertia about the centre of mass";
pub(super) const SECOND: &str =
    "Principal second moments of mass, the integrals of x_i^2 dm about the centre of mass: J_1 = P_2 + P_3 and so on";
pub(super) const AXES_MEANING: &str =
    "Attitude of the principal frame: quaternion that maps its components to the body's, scalar first";
