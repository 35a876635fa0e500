//! Symmetric 3x3 matrices: definiteness, and principal axes by Jacobi rotations (Golub & Van Loan, *Matrix
//! Computations*, 4th ed. (2013), section 8.5), which keep the relative accuracy of small positive eigenvalues (Demmel
//! & Veselic 1992).

use crate::math::real::Real;

/// Limit of sweeps: convergence is quadratic, five are typical.
const SWEEPS: usize = 16;

/// Off-diagonal entry, relative to the difference of its diagonal entries, that changes no bit of an eigenvalue or
/// axis, even in double-double.
const NEGLIGIBLE: f64 = 1e-36;

/// True if a symmetric matrix (lower triangle) is positive definite, by its Cholesky pivots.
pub fn is_positive_definite(m: [[f64; 3]; 3]) -> bool {
    let (a, b, c) = (m[0][0], m[1][0], m[2][0]);
    let second = m[1][1] - b * b / a;
    let off = m[2][1] - b * c / a;
    let third = m[2][2] - c * c / a - off * off / second;
    a > 0.0 && second > 0.0 && third > 0.0
}

/// Eigenvalues ("moments") of a symmetric matrix, and the rotation C_sb from its principal frame F_b to F_s: m = C_sb
/// diag(moments) C_sb^T, by cyclic Jacobi rotations.
///
/// C_sb is by rows (its columns are the principal axes), with determinant +1; for a diagonal matrix it is exactly the
/// identity, otherwise no rotation exceeds 45 degrees. Error: a few ulp of the largest moment.
pub fn principal_axes<R: Real>(m: [[R; 3]; 3]) -> ([R; 3], [[R; 3]; 3]) {
    let zero = m[0][0].zero();
    let (one, two, half) = (zero.splat(1.0), zero.splat(2.0), zero.splat(0.5));
    let mut a = m;
    for (i, j) in [(0, 1), (0, 2), (1, 2)] {
        let mean = half * (m[i][j] + m[j][i]);
        (a[i][j], a[j][i]) = (mean, mean);
    }
    let mut axes = [[one, zero, zero], [zero, one, zero], [zero, zero, one]];
    for _ in 0..SWEEPS {
        let mut rotated = false;
        for (p, q) in [(0, 1), (0, 2), (1, 2)] {
            let off = a[p][q];
            if off.lane(0) == 0.0 {
                continue;
            }
            if off.abs().lane(0) <= NEGLIGIBLE * (a[p][p] - a[q][q]).abs().lane(0) {
                (a[p][q], a[q][p]) = (zero, zero);
                continue;
            }
            rotated = true;
            // the smaller root of t^2 + 2 theta t - 1 = 0
            let theta = (a[q][q] - a[p][p]) / (two * off);
            let size = one / (theta.abs() + theta.mul_add(theta, one).sqrt());
            let t = if theta.lane(0) < 0.0 { -size } else { size };
            let cosine = one / t.mul_add(t, one).sqrt();
            let sine = t * cosine;
            // 1 - cosine without cancellation: x - sine (y + tau x) rounds once at the size of the correction
            let tau = sine / (one + cosine);
            let turned = |x: R, y: R| (x - sine * tau.mul_add(x, y), y + sine * tau.mul_add(-y, x));

            a[p][p] -= t * off;
            a[q][q] += t * off;
            (a[p][q], a[q][p]) = (zero, zero);
            let r = 3 - p - q;
            let (x, y) = turned(a[r][p], a[r][q]);
            (a[r][p], a[p][r], a[r][q], a[q][r]) = (x, x, y, y);
            for row in &mut axes {
                (row[p], row[q]) = turned(row[p], row[q]);
            }
        }
        if !rotated {
            break;
        }
    }
    ([a[0][0], a[1][1], a[2][2]], axes)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// Relative to the largest moment: a few roundings in each of five sweeps.
    const TOLERANCE: f64 = 8.0 * f64::EPSILON;

    #[test]
    fn definiteness_is_detected() {
        assert!(is_positive_definite([[2.0, 1.0, 0.0], [1.0, 2.0, 1.0], [0.0, 1.0, 2.0]]));
        assert!(!is_positive_definite([[1.0, 1.0, 0.0], [1.0, 1.0, 0.0], [0.0, 0.0, 1.0]]));
        assert!(!is_positive_definite([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, -1e-300]]));
        assert!(!is_positive_definite([[f64::NAN; 3]; 3]));
    }

    proptest! {
        #[test]
        fn principal_axes_rebuild_the_matrix(
            diagonal in prop::array::uniform3(0.1f64..10.0),
            off in prop::array::uniform3(-3.0f64..3.0),
            exponent in -12i32..1,
        ) {
            let shrink = 10f64.powi(exponent);
            let off = off.map(|x| x * shrink);
            let m = [[diagonal[0], off[0], off[1]], [off[0], diagonal[1], off[2]], [off[1], off[2], diagonal[2]]];
            let (moments, axes) = principal_axes(m);
            let scale = moments.iter().fold(0.0f64, |s, x| s.max(x.abs()));
            for i in 0..3 {
                for j in 0..3 {
                    let rebuilt: f64 = (0..3).map(|k| axes[i][k] * moments[k] * axes[j][k]).sum();
                    prop_assert!((rebuilt - m[i][j]).abs() <= TOLERANCE * scale, "{} {}", rebuilt, m[i][j]);
                    let unit: f64 = (0..3).map(|k| axes[i][k] * axes[j][k]).sum();
                    prop_assert!((unit - f64::from(i == j)).abs() <= TOLERANCE);
                }
            }
            let [x, y, z] = axes;
            let determinant = x[0] * (y[1] * z[2] - y[2] * z[1]) - x[1] * (y[0] * z[2] - y[2] * z[0])
                + x[2] * (y[0] * z[1] - y[1] * z[0]);
            prop_assert!((determinant - 1.0).abs() <= TOLERANCE);
        }
    }
}
