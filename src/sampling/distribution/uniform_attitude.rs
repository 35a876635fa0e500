//! `uniform_attitude`: an attitude uniform over all rotations.

use super::target::JointTarget;
use super::traits::{Map, NumberWords, Together};
use crate::sampling::error::DispersionError;
use crate::sampling::keys::Row;
use core::f64::consts::TAU;

/// As written, and ready to be drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct UniformAttitude;

impl Together for UniformAttitude {
    const NAME: &'static str = "uniform_attitude";
    const KEYS: &'static [Row] = &[];
    type Map = UniformAttitude;

    fn map(target: &JointTarget<'_>) -> Result<UniformAttitude, DispersionError> {
        target.attitude(Self::NAME).map(|_| UniformAttitude)
    }
}

impl Map for UniformAttitude {
    fn dimensions(&self) -> usize {
        3
    }

    fn components(&self) -> usize {
        4
    }

    fn values(&self, u: &[f64], values: &mut [f64]) {
        values[..4].copy_from_slice(&uniform_attitude([u[0], u[1], u[2]]));
    }

    fn text(&self, _words: NumberWords<'_>) -> String {
        "attitude uniform over all rotations".to_owned()
    }
}

/// Unit quaternion (scalar first) uniform on the 3-sphere, and so a rotation uniform on SO(3) (K. Shoemake, *Uniform
/// random rotations*, Graphics Gems III, 1992, p. 124-132); norm 1 to rounding; test `attitudes_are_uniform`.
fn uniform_attitude(u: [f64; 3]) -> [f64; 4] {
    let (near, far) = ((1.0 - u[0]).sqrt(), u[0].sqrt());
    let ((s1, c1), (s2, c2)) = (libm::sincos(TAU * u[1]), libm::sincos(TAU * u[2]));
    [far * c2, near * s1, near * c1, far * s2]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::vector::dcm_from_quaternion;
    use crate::sampling::stream::{SampleId, Stream};

    /// H0: the rotation is uniform on SO(3), so every entry of its matrix has E[c^2] = 1/3 with variance 4/45, and the
    /// angle theta has distribution (theta - sin theta)/pi. n = 100,000 fixed draws; alpha = 1e-3 each: |z| < 3.29 for
    /// the nine means, sqrt(n) D < 1.949 for the angle. Power: quaternions of normalised uniform numbers (a known
    /// mistake) shift E[c33^2] by 0.01, ten standard deviations.
    #[test]
    fn attitudes_are_uniform() {
        const N: usize = 100_000;
        let mut streams: Vec<Stream> = ["a", "b", "c"].iter().map(|name| Stream::new(3, name)).collect();
        let (mut squares, mut angles) = ([[0.0; 3]; 3], Vec::with_capacity(N));
        for k in 0..N {
            let u: Vec<f64> = streams.iter_mut().map(|stream| stream.uniform(SampleId(k as u64))).collect();
            let mut q = [0.0; 4];
            UniformAttitude.values(&u, &mut q);
            // rounding of four squares; measured: two ulps
            assert!((q.iter().map(|x| x * x).sum::<f64>() - 1.0).abs() < 4.0 * f64::EPSILON);
            let c = dcm_from_quaternion(q);
            for i in 0..3 {
                for j in 0..3 {
                    squares[i][j] += c[i][j] * c[i][j] / N as f64;
                }
            }
            angles.push(2.0 * libm::acos(q[0].abs().min(1.0)));
        }
        let sigma = (4.0 / 45.0 / N as f64).sqrt();
        assert!(squares.iter().flatten().all(|mean| (mean - 1.0 / 3.0).abs() < 3.29 * sigma), "{squares:?}");
        angles.sort_by(f64::total_cmp);
        let far = angles.iter().enumerate().fold(0.0f64, |far, (k, theta)| {
            let p = (theta - libm::sin(*theta)) / core::f64::consts::PI;
            far.max((p - k as f64 / N as f64).abs()).max(((k + 1) as f64 / N as f64 - p).abs())
        });
        assert!(far * (N as f64).sqrt() < 1.949, "{far}");
    }
}
