//! Laws of directions and attitudes, each one map from a fixed number of u in (0, 1): [`DirectionLaw`], [`AttitudeError`],
//! [`AboutAxis`].
//!
//! [`super::geometric_law`] defines how they are written and checked. Isotropy is a matter of solid angle: the cosine of the angle to
//! the axis is what is uniform on a sphere or in a cone, and what von Mises and Fisher's law is exponential in; a direction made of
//! uniform components, or of a uniform angle to the axis, is not (test `usual_mistakes_are_caught` in `tests/sampling_geometric.rs`).

use super::distribution::Distribution;
use crate::math::normal::quantile;
use crate::math::vector::{cross, dot, hamilton, norm, scaled};
use core::f64::consts::TAU;

/// A vector with separately dispersed direction and magnitude.
#[derive(Clone, Debug, PartialEq)]
pub struct DirectionLaw {
    /// Two unit vectors across the axis, then the axis.
    frame: [[f64; 3]; 3],
    spread: DirectionSpread,
    magnitude: Distribution,
}

/// How a direction lies about an axis; the azimuth is uniform in all.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum DirectionSpread {
    /// Uniform over the sphere.
    Sphere,
    /// Uniform over the cone of this half-angle, rad, above 0 and at most pi.
    Cone {
        /// Half-angle, rad.
        half_angle_rad: f64,
    },
    /// Von Mises and Fisher's law: density proportional to exp(kappa cos theta) (R. A. Fisher, *Dispersion on a sphere*, Proc. R.
    /// Soc. A 217, 1953).
    Fisher {
        /// kappa > 0, pure; about 1/sigma^2 of a narrow law.
        concentration: f64,
    },
}

impl DirectionSpread {
    /// 1 - cos(theta) for `u`: the quantile function, exact near the axis, where 1 less a cosine has no digits.
    #[inline]
    fn versine(self, u: f64) -> f64 {
        match self {
            DirectionSpread::Sphere => 2.0 * u,
            DirectionSpread::Cone { half_angle_rad } => {
                let sine = libm::sin(0.5 * half_angle_rad);
                2.0 * sine * sine * u
            }
            // P(1 - cos <= v) = (1 - exp(-kappa v))/(1 - exp(-2 kappa))
            DirectionSpread::Fisher { concentration } => {
                (-libm::log1p(u * libm::expm1(-2.0 * concentration)) / concentration).min(2.0)
            }
        }
    }
}

impl DirectionLaw {
    /// Directions about `axis` (any length but zero), magnitudes by `magnitude`, in the parameter's unit. A negative magnitude points
    /// backwards.
    pub fn new(axis: [f64; 3], spread: DirectionSpread, magnitude: Distribution) -> Self {
        DirectionLaw { frame: frame(axis), spread, magnitude }
    }

    /// Number of u: two for the direction, and the magnitude's.
    pub fn dimensions(&self) -> usize {
        2 + own_dimensions(&self.magnitude)
    }

    /// The vector for `u`.
    pub fn value(&self, u: &[f64]) -> [f64; 3] {
        let versine = self.spread.versine(u[0]);
        let (sine, cosine) = ((versine * (2.0 - versine)).sqrt(), 1.0 - versine);
        let (s, c) = libm::sincos(TAU * u[1]);
        let magnitude = self.magnitude.quantile(u.get(2).copied().unwrap_or(0.5));
        let [x, y, z] = self.frame;
        core::array::from_fn(|i| magnitude * (sine * (c * x[i] + s * y[i]) + cosine * z[i]))
    }

    /// The law in words.
    pub fn text(&self) -> String {
        match self.spread {
            DirectionSpread::Sphere => "direction uniform over the sphere".to_owned(),
            DirectionSpread::Cone { half_angle_rad } => format!("direction uniform in a cone of {half_angle_rad} rad"),
            DirectionSpread::Fisher { concentration } => {
                format!("direction by von Mises and Fisher, kappa {concentration}")
            }
        }
    }
}

/// An attitude near the nominal one: q = q_0 (x) exp(theta/2) with a normal rotation vector theta of mean zero, in the frame of the body.
#[derive(Clone, Debug, PartialEq)]
pub struct AttitudeError {
    nominal: [f64; 4],
    /// Lower triangular L, rad: the covariance is L L^T.
    factor: [[f64; 3]; 3],
}

impl AttitudeError {
    /// About `nominal` (a unit quaternion), with the covariance `covariance`, rad^2, symmetric and positive semidefinite; `None` where it
    /// is not (to 1e-12 of its trace).
    pub fn new(nominal: [f64; 4], covariance: [[f64; 3]; 3]) -> Option<Self> {
        Some(AttitudeError { nominal, factor: factor(covariance)? })
    }

    /// The quaternion for three `u`.
    pub fn value(&self, u: &[f64]) -> [f64; 4] {
        let z = [quantile(u[0]), quantile(u[1]), quantile(u[2])];
        let theta = core::array::from_fn(|i| (0..=i).map(|j| self.factor[i][j] * z[j]).sum());
        hamilton(self.nominal, rotation(theta))
    }
}

/// An attitude turned from the nominal one about an axis of the body: q = q_0 (x) exp(angle axis/2).
#[derive(Clone, Debug, PartialEq)]
pub struct AboutAxis {
    nominal: [f64; 4],
    axis: [f64; 3],
    angle: Distribution,
}

impl AboutAxis {
    /// About `axis` (any length but zero, components in the frame of the body) by `angle`, rad.
    pub fn new(nominal: [f64; 4], axis: [f64; 3], angle: Distribution) -> Self {
        AboutAxis { nominal, axis: scaled(1.0 / norm(axis), axis), angle }
    }

    /// Number of u.
    pub fn dimensions(&self) -> usize {
        own_dimensions(&self.angle)
    }

    /// The quaternion for `u`.
    pub fn value(&self, u: &[f64]) -> [f64; 4] {
        let (sine, cosine) = libm::sincos(0.5 * self.angle.quantile(u.first().copied().unwrap_or(0.5)));
        let [x, y, z] = scaled(sine, self.axis);
        hamilton(self.nominal, [cosine, x, y, z])
    }
}

/// Number of u that a law of one number takes.
fn own_dimensions(law: &Distribution) -> usize {
    if matches!(law, Distribution::Fixed(_)) { 0 } else { 1 }
}

/// The unit quaternion of the rotation vector `theta`, rad.
pub fn rotation(theta: [f64; 3]) -> [f64; 4] {
    let half = 0.5 * norm(theta);
    let (sine, cosine) = libm::sincos(half);
    // sin(x)/x is 1 to the last bit below 1e-8
    let share = if half < 1e-8 { 0.5 } else { 0.5 * sine / half };
    let [x, y, z] = scaled(share, theta);
    [cosine, x, y, z]
}

/// Two unit vectors across `axis` and the unit vector along it, right-handed.
fn frame(axis: [f64; 3]) -> [[f64; 3]; 3] {
    let z = scaled(1.0 / norm(axis), axis);
    let least = (1..3).fold(0, |least, i| if z[i].abs() < z[least].abs() { i } else { least });
    let mut other = [0.0; 3];
    other[least] = 1.0;
    let x = cross(other, z);
    let x = scaled(1.0 / norm(x), x);
    [x, cross(z, x), z]
}

/// The lower Cholesky factor of a symmetric positive semidefinite matrix; `None` where it is not one. A pivot that is zero to rounding
/// has a column of zeros.
fn factor(m: [[f64; 3]; 3]) -> Option<[[f64; 3]; 3]> {
    /// Entries come from files: twelve digits of them are meant.
    const SLACK: f64 = 1e-12;
    let slack = SLACK * (m[0][0].abs() + m[1][1].abs() + m[2][2].abs());
    let symmetric = [(0, 1), (0, 2), (1, 2)].into_iter().all(|(i, j)| (m[i][j] - m[j][i]).abs() <= slack);
    if !symmetric || !m.iter().flatten().all(|x| x.is_finite()) {
        return None;
    }
    let mut l = [[0.0; 3]; 3];
    for j in 0..3 {
        let pivot = m[j][j] - dot(l[j], l[j]);
        if pivot < -slack {
            return None;
        }
        let root = pivot.max(0.0).sqrt();
        for i in j..3 {
            let rest = m[i][j] - dot(l[i], l[j]);
            if pivot > slack {
                l[i][j] = rest / root;
            } else if i > j && rest.abs() > slack.max((slack * m[i][i].abs()).sqrt()) {
                return None;
            }
        }
    }
    Some(l)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn frames_are_orthonormal_and_right_handed() {
        for axis in [[0.0, 0.0, 2.0], [1.0, 0.0, 0.0], [0.0, -3.0, 0.0], [1.0, 2.0, 3.0], [1e-200, 1.0, -1.0]] {
            let [x, y, z] = frame(axis);
            for (a, b, expected) in [(x, x, 1.0), (y, y, 1.0), (z, z, 1.0), (x, y, 0.0), (x, z, 0.0), (y, z, 0.0)] {
                assert!((dot(a, b) - expected).abs() < 4.0 * f64::EPSILON, "{axis:?}");
            }
            assert!((dot(cross(x, y), z) - 1.0).abs() < 4.0 * f64::EPSILON);
            assert!(dot(z, axis) > 0.0);
        }
    }

    #[test]
    fn directions_have_length_one_even_where_cones_are_needles() {
        for spread in [
            DirectionSpread::Sphere,
            DirectionSpread::Cone { half_angle_rad: 1e-9 },
            DirectionSpread::Cone { half_angle_rad: core::f64::consts::PI },
            DirectionSpread::Fisher { concentration: 1e-3 },
            DirectionSpread::Fisher { concentration: 1e12 },
        ] {
            let law = DirectionLaw::new([1.0, -2.0, 0.5], spread, Distribution::Fixed(3.0));
            assert_eq!(law.dimensions(), 2);
            for u in [[1e-16, 0.1], [0.3, 0.9], [1.0 - 1e-16, 0.5]] {
                assert!((norm(law.value(&u)) / 3.0 - 1.0).abs() < 4.0 * f64::EPSILON, "{spread:?} {u:?}");
            }
        }
        let needle = DirectionLaw::new(
            [0.0, 0.0, 1.0],
            DirectionSpread::Cone { half_angle_rad: 1e-9 },
            Distribution::Fixed(1.0),
        );
        let [x, y, _] = needle.value(&[0.25, 0.125]);
        assert!(((x * x + y * y).sqrt() / 0.5e-9 - 1.0).abs() < 1e-12, "angle = half-angle times sqrt(u)");
    }

    #[test]
    fn a_covariance_is_factored_or_refused() {
        let m = [[4.0, 2.0, -2.0], [2.0, 5.0, 1.0], [-2.0, 1.0, 6.0]];
        let l = factor(m).expect("positive definite");
        for i in 0..3 {
            for j in 0..3 {
                assert!((dot(l[i], l[j]) - m[i][j]).abs() < 1e-14);
            }
        }
        assert_eq!(factor([[0.0; 3]; 3]), Some([[0.0; 3]; 3]));
        let flat = factor([[1.0, 1.0, 0.0], [1.0, 1.0, 0.0], [0.0, 0.0, 0.0]]).expect("semidefinite");
        assert_eq!(flat, [[1.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 0.0]]);
        for wrong in [
            [[1.0, 2.0, 0.0], [2.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
            [[1.0, 0.5, 0.0], [0.4, 1.0, 0.0], [0.0, 0.0, 1.0]],
            [[0.0, 0.5, 0.0], [0.5, 1.0, 0.0], [0.0, 0.0, 1.0]],
            [[-1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
            [[f64::NAN, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
        ] {
            assert_eq!(factor(wrong), None, "{wrong:?}");
        }
    }

    #[test]
    fn small_rotations_do_not_lose_digits() {
        for size in [1e-300, 1e-12, 0.99e-8, 1.01e-8, 0.1, 3.0] {
            let q = rotation([0.0, 0.6 * size, 0.8 * size]);
            assert!((q.iter().map(|x| x * x).sum::<f64>() - 1.0).abs() < 4.0 * f64::EPSILON);
            assert!((q[3] / (0.8 * libm::sin(0.5 * size)) - 1.0).abs() < 4.0 * f64::EPSILON, "{size}");
        }
    }
}
