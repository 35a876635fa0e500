//! `uniform_attitude`: an attitude uniform over all rotations.

use super::prelude::*;
use core::f64::consts::TAU;

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct UniformAttitude;

impl Together for UniformAttitude {
    const NAME: &'static str = "uniform_attitude";
    const KEYS: &'static [Row] = &[];

    fn map(target: &Target<'_>) -> Result<UniformAttitude> {
        target.attitude(Self::NAME).map(|_| UniformAttitude)
    }
}

impl Map for UniformAttitude {
    fn dimensions(&self) -> usize {
        3
    }

    fn values(&self, u: &[f64], values: &mut [f64]) {
        values[..4].copy_from_slice(&uniform_attitude([u[0], u[1], u[2]]));
    }

    fn text(&self, _words: NumberWords<'_>) -> String {
        "attitude uniform over all rotations".to_owned()
    }
}

/// Unit quaternion (scalar first), uniform on the 3-sphere and so a rotation uniform on SO(3) (K. Shoemake, *Uniform
/// random rotations*, Graphics Gems III, 1992, p. 124-132); norm 1 to rounding; tested in
/// `tests/sampling/geometric.rs`.
fn uniform_attitude(u: [f64; 3]) -> [f64; 4] {
    let (near, far) = ((1.0 - u[0]).sqrt(), u[0].sqrt());
    let ((s1, c1), (s2, c2)) = (libm::sincos(TAU * u[1]), libm::sincos(TAU * u[2]));
    [far * c2, near * s1, near * c1, far * s2]
}
