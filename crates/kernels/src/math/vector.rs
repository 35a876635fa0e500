//! Three-vectors, 3x3 matrices and quaternions (Hamilton, scalar first) as plain arrays of [`Real`], without `map`,
//! whose closures lack the caller's vector instructions (measured: twenty times slower).

use crate::math::real::Real;

/// The constant vector `v` in the type of `like`.
#[inline(always)]
pub fn constant<R: Real>(like: R, v: [f64; 3]) -> [R; 3] {
    [like.splat(v[0]), like.splat(v[1]), like.splat(v[2])]
}

/// The constant quaternion `q` in the type of `like`.
#[inline(always)]
pub fn constant_quaternion<R: Real>(like: R, q: [f64; 4]) -> [R; 4] {
    [like.splat(q[0]), like.splat(q[1]), like.splat(q[2]), like.splat(q[3])]
}

/// The constant matrix `m`, by rows, in the type of `like`.
#[inline(always)]
pub fn constant_matrix<R: Real>(like: R, m: [[f64; 3]; 3]) -> [[R; 3]; 3] {
    [constant(like, m[0]), constant(like, m[1]), constant(like, m[2])]
}

/// Three numbers of `all` from `first` on.
#[inline(always)]
pub fn three<R: Copy, const N: usize>(all: &[R; N], first: usize) -> [R; 3] {
    [all[first], all[first + 1], all[first + 2]]
}

/// Four numbers of `all` from `first` on.
#[inline(always)]
pub fn four<R: Copy, const N: usize>(all: &[R; N], first: usize) -> [R; 4] {
    [all[first], all[first + 1], all[first + 2], all[first + 3]]
}

/// q*.
#[inline(always)]
pub fn conjugate<R: Real>(q: [R; 4]) -> [R; 4] {
    [q[0], -q[1], -q[2], -q[3]]
}

/// `a . b`.
#[inline(always)]
pub fn dot<R: Real>(a: [R; 3], b: [R; 3]) -> R {
    a[0].mul_add(b[0], a[1].mul_add(b[1], a[2] * b[2]))
}

/// `sum` - a x b.
#[inline(always)]
pub fn minus_cross<R: Real>(a: [R; 3], b: [R; 3], sum: [R; 3]) -> [R; 3] {
    let [x, y, z] = [a[2].mul_add(b[1], sum[0]), a[0].mul_add(b[2], sum[1]), a[1].mul_add(b[0], sum[2])];
    [a[1].neg_mul_add(b[2], x), a[2].neg_mul_add(b[0], y), a[0].neg_mul_add(b[1], z)]
}

/// `a x b`.
#[inline(always)]
pub fn cross<R: Real>(a: [R; 3], b: [R; 3]) -> [R; 3] {
    [a[1].mul_add(b[2], -(a[2] * b[1])), a[2].mul_add(b[0], -(a[0] * b[2])), a[0].mul_add(b[1], -(a[1] * b[0]))]
}

/// `a + b`.
#[inline(always)]
pub fn sum<R: Real>(a: [R; 3], b: [R; 3]) -> [R; 3] {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

/// `a - b`.
#[inline(always)]
pub fn difference<R: Real>(a: [R; 3], b: [R; 3]) -> [R; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

/// `s a`.
#[inline(always)]
pub fn scaled<R: Real>(s: R, a: [R; 3]) -> [R; 3] {
    [s * a[0], s * a[1], s * a[2]]
}

/// `|a|`.
#[inline(always)]
pub fn norm<R: Real>(a: [R; 3]) -> R {
    dot(a, a).sqrt()
}

/// `m a` for a matrix stored by rows.
#[inline(always)]
pub fn product<R: Real>(m: [[R; 3]; 3], a: [R; 3]) -> [R; 3] {
    [dot(m[0], a), dot(m[1], a), dot(m[2], a)]
}

/// `m^T a` for a matrix stored by rows.
#[inline(always)]
pub fn transposed_product<R: Real>(m: [[R; 3]; 3], a: [R; 3]) -> [R; 3] {
    [dot([m[0][0], m[1][0], m[2][0]], a), dot([m[0][1], m[1][1], m[2][1]], a), dot([m[0][2], m[1][2], m[2][2]], a)]
}

/// The Hamilton product `p (x) q`.
#[inline(always)]
pub fn hamilton<R: Real>(p: [R; 4], q: [R; 4]) -> [R; 4] {
    [
        p[0].mul_add(q[0], -p[1].mul_add(q[1], p[2].mul_add(q[2], p[3] * q[3]))),
        p[0].mul_add(q[1], p[1].mul_add(q[0], p[2].mul_add(q[3], -(p[3] * q[2])))),
        p[0].mul_add(q[2], p[2].mul_add(q[0], p[3].mul_add(q[1], -(p[1] * q[3])))),
        p[0].mul_add(q[3], p[3].mul_add(q[0], p[1].mul_add(q[2], -(p[2] * q[1])))),
    ]
}

/// DCM of a quaternion, by rows, in homogeneous form: `|q|^2` times a rotation.
#[inline(always)]
pub fn dcm_from_quaternion<R: Real>(q: [R; 4]) -> [[R; 3]; 3] {
    let [w, x, y, z] = q;
    let two = w.splat(2.0);
    let (ww, xx, yy, zz) = (w * w, x * x, y * y, z * z);
    let (wx, wy, wz) = (w * x, w * y, w * z);
    [
        [(ww + xx) - (yy + zz), two * x.mul_add(y, -wz), two * x.mul_add(z, wy)],
        [two * x.mul_add(y, wz), (ww + yy) - (xx + zz), two * y.mul_add(z, -wx)],
        [two * x.mul_add(z, -wy), two * y.mul_add(z, wx), (ww + zz) - (xx + yy)],
    ]
}

/// A multiple of the quaternion of a DCM by rows (no lanes) by Shepperd's method (J. Guidance and Control 1(3), 1978),
/// and the index of its largest component, whose positive value times four is the factor: nothing is divided, nothing
/// cancels. The caller normalises, which distributes deviations from orthonormality.
#[inline(always)]
pub fn scaled_quaternion_from_dcm<R: Real>(c: [[R; 3]; 3]) -> (usize, [R; 4]) {
    let (one, two) = (c[0][0].splat(1.0), c[0][0].splat(2.0));
    let trace = c[0][0] + c[1][1] + c[2][2];
    let d = [c[2][1] - c[1][2], c[0][2] - c[2][0], c[1][0] - c[0][1]];
    let s = [c[2][1] + c[1][2], c[0][2] + c[2][0], c[1][0] + c[0][1]];
    let (w, x, y, z) = (trace.lane(0), c[0][0].lane(0), c[1][1].lane(0), c[2][2].lane(0));
    if w >= x && w >= y && w >= z {
        (0, [one + trace, d[0], d[1], d[2]])
    } else if x >= y && x >= z {
        (1, [d[0], one + two * c[0][0] - trace, s[2], s[1]])
    } else if y >= z {
        (2, [d[1], s[2], one + two * c[1][1] - trace, s[0]])
    } else {
        (3, [d[2], s[1], s[0], one + two * c[2][2] - trace])
    }
}

/// Quaternion of a DCM by [`scaled_quaternion_from_dcm`]; scalar part >= 0.
pub fn quaternion_from_dcm<R: Real>(c: [[R; 3]; 3]) -> [R; 4] {
    let half = c[0][0].splat(0.5);
    let (largest, scaled) = scaled_quaternion_from_dcm(c);
    // twice the component, the root of four times its square
    let root = scaled[largest].sqrt();
    let mut q = scaled.map(|component| half / root * component);
    q[largest] = half * root;
    if q[0].lane(0) < 0.0 { q.map(|x| -x) } else { q }
}

#[inline(always)]
pub(crate) fn set_lanes<R: Real, const K: usize>(lanes: &mut [R; K], lane: usize, values: &[f64; K]) {
    for (own, value) in lanes.iter_mut().zip(values) {
        own.set_lane(lane, *value);
    }
}

#[inline(always)]
pub(crate) fn lane_of<R: Real, const K: usize>(lanes: &[R; K], lane: usize) -> [f64; K] {
    let mut values = [0.0; K];
    for (value, own) in values.iter_mut().zip(lanes) {
        *value = own.lane(lane);
    }
    values
}
