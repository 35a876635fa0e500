//! Rotation vectors and modified Rodrigues parameters, besides the quaternions of [`super::vector`].

use super::vector::{cross, dcm_from_quaternion, dot, norm, scaled, sum};

/// The quaternion of the rotation vector `v` (angle times axis, rad).
pub fn quaternion_of(v: [f64; 3]) -> [f64; 4] {
    let half = 0.5 * norm(v);
    // sin(x)/x, regular at zero
    let sinc = if half < 1e-4 { 1.0 - half * half / 6.0 } else { libm::sin(half) / half };
    let [x, y, z] = scaled(0.5 * sinc, v);
    [libm::cos(half), x, y, z]
}

/// The rotation vector of `q`, rad, the short way: at most pi long.
pub fn vector_of(q: [f64; 4]) -> [f64; 3] {
    let [w, x, y, z] = if q[0] < 0.0 { q.map(|component| -component) } else { q };
    let sine = norm([x, y, z]);
    let angle = 2.0 * libm::atan2(sine, w);
    let factor = if sine < 1e-8 { 2.0 } else { angle / sine };
    scaled(factor, [x, y, z])
}

/// The modified Rodrigues parameters tan(angle/4) times axis of `q`, the short way (the shadow set beyond half a turn):
/// at most one long (H. Schaub & J. L. Junkins, *Analytical Mechanics of Space Systems*, 2018, section 3.5).
pub fn mrp_of(q: [f64; 4]) -> [f64; 3] {
    let [w, x, y, z] = if q[0] < 0.0 { q.map(|component| -component) } else { q };
    scaled(1.0 / (1.0 + w), [x, y, z])
}

/// `v` rotated by the rotation vector `by`, by Rodrigues's formula; components in the rotated frame need the opposite
/// vector.
pub fn turned(v: [f64; 3], by: [f64; 3]) -> [f64; 3] {
    let angle = norm(by);
    if angle == 0.0 {
        return v;
    }
    let axis = scaled(1.0 / angle, by);
    let (sine, cosine) = (libm::sin(angle), libm::cos(angle));
    let along = scaled((1.0 - cosine) * dot(axis, v), axis);
    sum(sum(scaled(cosine, v), scaled(sine, cross(axis, v))), along)
}

/// The rotation matrix that turns s3 to `direction` (any length but zero) the shortest way, about s1 if they are
/// opposite.
pub fn from_s3_to(direction: [f64; 3]) -> [[f64; 3]; 3] {
    let [x, y, z] = direction;
    let across = [-y, x, 0.0];
    let sine = norm(across);
    let angle = libm::atan2(sine, z);
    let axis = if sine > 0.0 { scaled(1.0 / sine, across) } else { [1.0, 0.0, 0.0] };
    dcm_from_quaternion(quaternion_of(scaled(angle, axis)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::control::vector::{dcm_from_quaternion, difference, hamilton, product};

    /// Law: s3 turns to the direction, whatever its length, by an orthonormal, right-handed matrix; s3 itself stays bit
    /// for bit.
    #[test]
    fn s3_turns_to_a_direction() {
        let cases = [
            [0.0, 0.0, 1.0],
            [0.0, 0.0, 7.0],
            [0.0, 0.0, -1.0],
            [1.0, 0.0, 0.0],
            [0.0, -2.0, 0.0],
            [0.3, 0.4, -0.5],
            [1e-9, 0.0, -1.0],
        ];
        for direction in cases {
            let c = from_s3_to(direction);
            let columns: [[f64; 3]; 3] = std::array::from_fn(|j| c.map(|row| row[j]));
            let unit = scaled(1.0 / norm(direction), direction);
            assert!(norm(difference(columns[2], unit)) < 4e-15, "{direction:?}: {columns:?}");
            assert!(norm(difference(cross(columns[0], columns[1]), columns[2])) < 4e-15, "{direction:?}");
            assert!(columns.iter().all(|column| (norm(*column) - 1.0).abs() < 4e-15), "{direction:?}");
        }
        assert_eq!(from_s3_to([0.0, 0.0, 3.0]), [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]);
    }

    #[test]
    fn a_rotation_has_one_meaning() {
        let axis = scaled(1.0 / norm([1.0, -2.0, 0.5]), [1.0, -2.0, 0.5]);
        for angle in [0.0, 1e-12, 1e-5, 0.3, 1.7, 3.1] {
            let v = scaled(angle, axis);
            let q = quaternion_of(v);
            assert!((q.iter().map(|x| x * x).sum::<f64>() - 1.0).abs() < 4e-16);
            assert!(norm(difference(vector_of(q), v)) <= 1e-15 * (1.0 + angle), "{angle}");
            // the other sign of the quaternion is the same rotation
            assert_eq!(vector_of(q.map(|x| -x)), vector_of(q));
            assert!((norm(mrp_of(q)) - libm::tan(0.25 * angle)).abs() < 1e-15);
            let u = [0.3, 0.1, -2.0];
            let by_matrix = product(dcm_from_quaternion(q), u);
            assert!(norm(difference(turned(u, v), by_matrix)) < 2e-15, "{angle}");
        }
        // beyond half a turn: the shadow set, and the short way
        let q = quaternion_of(scaled(4.0, axis));
        assert!((norm(mrp_of(q)) - libm::tan(0.25 * (2.0 * core::f64::consts::PI - 4.0))).abs() < 1e-15);
        assert!(norm(sum(vector_of(q), scaled(2.0 * core::f64::consts::PI - 4.0, axis))) < 1e-14);
        // rotations about one axis add
        let both = hamilton(quaternion_of(scaled(0.4, axis)), quaternion_of(scaled(0.7, axis)));
        assert!(norm(difference(vector_of(both), scaled(1.1, axis))) < 1e-15);
    }
}
