//! Symmetric 3x3 matrices: positive definiteness, and principal axes by cyclic Jacobi rotations.
//!
//! C. G. J. Jacobi, J. reine angew. Math. 30, 1846; the rotation as in G. H. Golub & C. F. Van Loan, *Matrix Computations*,
//! 4th ed., section 8.5.2. Only IEEE operations, so the bits are the same everywhere; any [`Real`] of one lane.

use super::Real;

/// Sweeps after which the off-diagonals are zero for every matrix tried (convergence is quadratic: 5 to 6 are usual).
const SWEEPS: usize = 12;

/// Principal moments and axes of a symmetric matrix `m` (by rows; only the upper triangle is read).
///
/// Returns the moments and the DCM `c` by rows, of determinant +1, that maps components in the principal frame to the given
/// one: `m = c diag(moments) c^T`. A diagonal matrix comes back as it is, with `c` the exact identity; the order of the
/// moments is the one that needs the smallest turn, not ascending.
pub fn principal_axes<R: Real>(m: [[R; 3]; 3]) -> ([R; 3], [[R; 3]; 3]) {
    let zero = m[0][0].zero();
    let one = zero.splat(1.0);
    let two = zero.splat(2.0);
    let mut a = [[m[0][0], m[0][1], m[0][2]], [m[0][1], m[1][1], m[1][2]], [m[0][2], m[1][2], m[2][2]]];
    let mut c = [[one, zero, zero], [zero, one, zero], [zero, zero, one]];
    for _ in 0..SWEEPS {
        for (p, q, r) in [(0, 1, 2), (0, 2, 1), (1, 2, 0)] {
            let off = a[p][q];
            if off.lane(0) == 0.0 {
                continue;
            }
            // tangent of the smaller angle that zeroes a[p][q]
            let theta = (a[q][q] - a[p][p]) / (two * off);
            let root = theta.mul_add(theta, one).sqrt();
            let t = if theta.lane(0) < 0.0 { -(one / (root - theta)) } else { one / (theta + root) };
            let cos = one / t.mul_add(t, one).sqrt();
            let sin = t * cos;
            // below half an ulp of both moments: drop it, so that the sweeps end
            let (app, aqq) = (a[p][p] - t * off, a[q][q] + t * off);
            a[p][p] = app;
            a[q][q] = aqq;
            (a[p][q], a[q][p]) = (zero, zero);
            let (arp, arq) = (a[r][p], a[r][q]);
            let (new_rp, new_rq) = (cos * arp - sin * arq, sin.mul_add(arp, cos * arq));
            (a[r][p], a[p][r]) = (new_rp, new_rp);
            (a[r][q], a[q][r]) = (new_rq, new_rq);
            for row in &mut c {
                let (cp, cq) = (row[p], row[q]);
                row[p] = cos * cp - sin * cq;
                row[q] = sin.mul_add(cp, cos * cq);
            }
        }
    }
    ([a[0][0], a[1][1], a[2][2]], c)
}

/// Whether a symmetric matrix is positive definite, by the pivots of its Cholesky factor. Reads the lower triangle.
pub fn is_positive_definite(m: [[f64; 3]; 3]) -> bool {
    let (a, b, c) = (m[0][0], m[1][0], m[2][0]);
    let second = m[1][1] - b * b / a;
    let off = m[2][1] - b * c / a;
    let third = m[2][2] - c * c / a - off * off / second;
    a > 0.0 && second > 0.0 && third > 0.0
}

#[cfg(test)]
mod tests {
    use super::*;

    const EPS: f64 = f64::EPSILON;

    #[test]
    fn a_diagonal_matrix_is_its_own_principal_frame() {
        let m = [[3.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 2.0]];
        let (moments, c) = principal_axes(m);
        assert_eq!(moments, [3.0, 1.0, 2.0]);
        assert_eq!(c, [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]);
    }

    #[test]
    fn the_factors_give_the_matrix_back() {
        for m in [
            [[3.0, 0.5, -0.25], [0.5, 4.0, 0.125], [-0.25, 0.125, 5.0]],
            [[1.0, 1e-9, 0.0], [1e-9, 1.0, 1e-12], [0.0, 1e-12, 1.0]],
            [[1e6, 1.0, 2.0], [1.0, 1e-3, 1e-4], [2.0, 1e-4, 1.0]],
        ] {
            let (moments, c) = principal_axes(m);
            let scale = moments.iter().fold(0.0_f64, |s, x| s.max(x.abs()));
            for i in 0..3 {
                for j in 0..3 {
                    let back: f64 = (0..3).map(|k| c[i][k] * moments[k] * c[j][k]).sum();
                    assert!((back - m[i][j]).abs() <= 8.0 * EPS * scale, "{i}{j}: {back} against {}", m[i][j]);
                    let unit: f64 = (0..3).map(|k| c[i][k] * c[j][k]).sum();
                    assert!((unit - f64::from(i == j)).abs() <= 8.0 * EPS);
                }
            }
        }
    }

    #[test]
    fn definiteness_is_told_apart() {
        assert!(is_positive_definite([[2.0, 1.0, 0.0], [1.0, 2.0, 1.0], [0.0, 1.0, 2.0]]));
        assert!(!is_positive_definite([[1.0, 1.0, 0.0], [1.0, 1.0, 0.0], [0.0, 0.0, 1.0]]));
        assert!(!is_positive_definite([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, -1e-300]]));
        assert!(!is_positive_definite([[f64::NAN; 3]; 3]));
    }
}
