//! [`MassErrors`]: the difference of a true distribution of mass from the nominal one.

use super::rows::rows;

const SHEARS: &[&str] = &["xy", "xz", "yz"];

rows! {
    /// The difference of a distribution of mass from the nominal one: the same matter, moved by a linear map about the
    /// centre of mass, with another mass, at another place.
    ///
    /// The second moments of mass about the centre become S' = k A S A^T with k = `mass_scale` times `inertia_scale`
    /// and A lower triangular, exp(`stretch_log`) on its diagonal and `shear` below: positive definite whatever the
    /// numbers. With S = L L^T, S' = k (A L)(A L)^T: the coordinates of the log-Cholesky form (C. Rucker & P. M.
    /// Wensing, IEEE Robotics and Automation Letters 7(2), 2022) about the nominal body.
    pub struct MassErrors in MassErrors [table => table] {
    mass_scale: f64 = 1.0, "1", "Scale factor for all masses", Positive;
    inertia_scale: f64 = 1.0, "1",
        "Further scale factor for the inertia about the centre of mass; the mass does not change", Positive;
    stretch_log: [f64; 3] = [0.0; 3], "1",
        "Logarithms of the linear scale factors of the mass distribution along s1, s2, s3", Finite;
    shear: [f64; 3] = [0.0; 3], "1",
        "Shears xy, xz, yz: matter at x moves by xy x along s2 and by xz x along s3, matter at y by yz y along s3",
        Finite of SHEARS;
    center_offset_m: [f64; 3] = [0.0; 3], "m",
        "Offset of the centre of mass, in F_s (for a part: in the frame of the part)", Finite;
    } others {}
}
