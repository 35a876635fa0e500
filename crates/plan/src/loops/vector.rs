//! Vectors, matrices by rows, quaternions (Hamilton, scalar first), rotation vectors and modified Rodrigues parameters
//! of plain numbers, without fused operations.
//!
//! [`crate::math::vector`] is for functions compiled for an instruction set: elsewhere each fused operation is a
//! library call, a seventh of a loop's instructions. IEEE 754 operations give the same bits everywhere.

#[inline]
pub fn conjugate(q: [f64; 4]) -> [f64; 4] {
    [q[0], -q[1], -q[2], -q[3]]
}

#[inline]
pub fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

#[inline]
pub fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

#[inline]
pub fn sum(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

#[inline]
pub fn difference(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

#[inline]
pub fn scaled(s: f64, a: [f64; 3]) -> [f64; 3] {
    [s * a[0], s * a[1], s * a[2]]
}

#[inline]
pub fn norm(a: [f64; 3]) -> f64 {
    dot(a, a).sqrt()
}

#[inline]
pub fn product(m: [[f64; 3]; 3], a: [f64; 3]) -> [f64; 3] {
    [dot(m[0], a), dot(m[1], a), dot(m[2], a)]
}

#[inline]
pub fn transposed_product(m: [[f64; 3]; 3], a: [f64; 3]) -> [f64; 3] {
    sum(sum(scaled(a[0], m[0]), scaled(a[1], m[1])), scaled(a[2], m[2]))
}

#[inline]
pub fn hamilton(p: [f64; 4], q: [f64; 4]) -> [f64; 4] {
    [
        p[0] * q[0] - p[1] * q[1] - p[2] * q[2] - p[3] * q[3],
        p[0] * q[1] + p[1] * q[0] + p[2] * q[3] - p[3] * q[2],
        p[0] * q[2] + p[2] * q[0] + p[3] * q[1] - p[1] * q[3],
        p[0] * q[3] + p[3] * q[0] + p[1] * q[2] - p[2] * q[1],
    ]
}

#[inline]
pub fn dcm_from_quaternion(q: [f64; 4]) -> [[f64; 3]; 3] {
    let [w, x, y, z] = q;
    let (ww, xx, yy, zz) = (w * w, x * x, y * y, z * z);
    [
        [(ww + xx) - (yy + zz), 2.0 * (x * y - w * z), 2.0 * (x * z + w * y)],
        [2.0 * (x * y + w * z), (ww + yy) - (xx + zz), 2.0 * (y * z - w * x)],
        [2.0 * (x * z - w * y), 2.0 * (y * z + w * x), (ww + zz) - (xx + yy)],
    ]
}

/// The quaternion of the rotation vector `v` (angle times axis, rad).
#[inline]
pub fn quaternion_of(v: [f64; 3]) -> [f64; 4] {
    let half = 0.5 * norm(v);
    // sin(x)/x, regular at zero
    let sinc = if half < 1e-4 { 1.0 - half * half / 6.0 } else { libm::sin(half) / half };
    let [x, y, z] = scaled(0.5 * sinc, v);
    [libm::cos(half), x, y, z]
}

/// The rotation vector of `q`, rad, the short way: at most pi long.
#[inline]
pub fn vector_of(q: [f64; 4]) -> [f64; 3] {
    let [w, x, y, z] = if q[0] < 0.0 { q.map(|component| -component) } else { q };
    let sine = norm([x, y, z]);
    let angle = 2.0 * libm::atan2(sine, w);
    let factor = if sine < 1e-8 { 2.0 } else { angle / sine };
    scaled(factor, [x, y, z])
}

/// The modified Rodrigues parameters tan(angle/4) times axis of `q`, the short way (the shadow set beyond half a turn):
/// at most one long (H. Schaub & J. L. Junkins, *Analytical Mechanics of Space Systems*, 2018, section 3.5).
#[inline]
pub fn mrp_of(q: [f64; 4]) -> [f64; 3] {
    let [w, x, y, z] = if q[0] < 0.0 { q.map(|component| -component) } else { q };
    scaled(1.0 / (1.0 + w), [x, y, z])
}

/// `v` rotated by the rotation vector `by`, by Rodrigues's formula; components in the rotated frame need the opposite
/// vector.
#[inline]
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
#[inline]
pub fn from_s3_to(direction: [f64; 3]) -> [[f64; 3]; 3] {
    let [x, y, z] = direction;
    let across = [-y, x, 0.0];
    let sine = norm(across);
    let angle = libm::atan2(sine, z);
    let axis = if sine > 0.0 { scaled(1.0 / sine, across) } else { [1.0, 0.0, 0.0] };
    dcm_from_quaternion(quaternion_of(scaled(angle, axis)))
}

#[inline]
pub fn inverse(m: [[f64; 3]; 3]) -> [[f64; 3]; 3] {
    let minor = |i: usize, j: usize| {
        let (a, b, c, d) = ((i + 1) % 3, (i + 2) % 3, (j + 1) % 3, (j + 2) % 3);
        m[a][c] * m[b][d] - m[a][d] * m[b][c]
    };
    let determinant: f64 = (0..3).map(|j| m[0][j] * minor(0, j)).sum();
    std::array::from_fn(|i| std::array::from_fn(|j| minor(j, i) / determinant))
}

#[inline]
pub fn multiplied<const N: usize, const K: usize, const M: usize>(
    a: &[[f64; K]; N],
    b: &[[f64; M]; K],
) -> [[f64; M]; N] {
    // row loops vectorise; closures of from_fn become calls
    let mut product = [[0.0; M]; N];
    for (row, of_a) in product.iter_mut().zip(a) {
        for (factor, of_b) in of_a.iter().zip(b) {
            for (entry, b) in row.iter_mut().zip(of_b) {
                *entry += factor * b;
            }
        }
    }
    product
}

#[inline]
pub fn transposed<const N: usize, const M: usize>(a: &[[f64; M]; N]) -> [[f64; N]; M] {
    let mut turned = [[0.0; N]; M];
    for (j, row) in a.iter().enumerate() {
        for (turned, entry) in turned.iter_mut().zip(row) {
            turned[j] = *entry;
        }
    }
    turned
}

#[inline]
pub fn added<const N: usize, const M: usize>(a: &[[f64; M]; N], b: &[[f64; M]; N]) -> [[f64; M]; N] {
    let mut sum = *a;
    for (row, of_b) in sum.iter_mut().zip(b) {
        row.iter_mut().zip(of_b).for_each(|(entry, b)| *entry += b);
    }
    sum
}

#[inline]
pub fn diagonal<const N: usize>(entries: [f64; N]) -> [[f64; N]; N] {
    std::array::from_fn(|i| std::array::from_fn(|j| if i == j { entries[i] } else { 0.0 }))
}

/// The lower factor L of a = L L^T; `None` unless `a` is positive definite.
#[inline]
pub fn cholesky<const N: usize>(a: &[[f64; N]; N]) -> Option<[[f64; N]; N]> {
    let mut l = [[0.0; N]; N];
    for i in 0..N {
        for j in 0..=i {
            let rest = a[i][j] - (0..j).map(|k| l[i][k] * l[j][k]).sum::<f64>();
            if i == j {
                if rest.is_nan() || rest <= 0.0 {
                    return None;
                }
                l[i][i] = rest.sqrt();
            } else {
                l[i][j] = rest / l[j][j];
            }
        }
    }
    Some(l)
}

/// Solves a x = b by the Cholesky factor `l` of `a`.
#[inline]
pub fn solved<const N: usize>(l: &[[f64; N]; N], b: [f64; N]) -> [f64; N] {
    let mut y = b;
    for i in 0..N {
        y[i] = (y[i] - (0..i).map(|k| l[i][k] * y[k]).sum::<f64>()) / l[i][i];
    }
    for i in (0..N).rev() {
        y[i] = (y[i] - (i + 1..N).map(|k| l[k][i] * y[k]).sum::<f64>()) / l[i][i];
    }
    y
}
