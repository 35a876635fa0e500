//! Three-vectors, 3x3 matrices and quaternions (Hamilton, scalar first) of plain numbers, without fused operations.
//!
//! [`crate::math::vector`] is for functions compiled for an instruction set: elsewhere each fused operation is a
//! library call, a seventh of a loop's instructions. IEEE 754 operations give the same bits everywhere.

pub fn conjugate(q: [f64; 4]) -> [f64; 4] {
    [q[0], -q[1], -q[2], -q[3]]
}

pub fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

pub fn sum(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

pub fn difference(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

pub fn scaled(s: f64, a: [f64; 3]) -> [f64; 3] {
    [s * a[0], s * a[1], s * a[2]]
}

pub fn norm(a: [f64; 3]) -> f64 {
    dot(a, a).sqrt()
}

pub fn product(m: [[f64; 3]; 3], a: [f64; 3]) -> [f64; 3] {
    [dot(m[0], a), dot(m[1], a), dot(m[2], a)]
}

pub fn transposed_product(m: [[f64; 3]; 3], a: [f64; 3]) -> [f64; 3] {
    sum(sum(scaled(a[0], m[0]), scaled(a[1], m[1])), scaled(a[2], m[2]))
}

pub fn hamilton(p: [f64; 4], q: [f64; 4]) -> [f64; 4] {
    [
        p[0] * q[0] - p[1] * q[1] - p[2] * q[2] - p[3] * q[3],
        p[0] * q[1] + p[1] * q[0] + p[2] * q[3] - p[3] * q[2],
        p[0] * q[2] + p[2] * q[0] + p[3] * q[1] - p[1] * q[3],
        p[0] * q[3] + p[3] * q[0] + p[1] * q[2] - p[2] * q[1],
    ]
}

pub fn dcm_from_quaternion(q: [f64; 4]) -> [[f64; 3]; 3] {
    let [w, x, y, z] = q;
    let (ww, xx, yy, zz) = (w * w, x * x, y * y, z * z);
    [
        [(ww + xx) - (yy + zz), 2.0 * (x * y - w * z), 2.0 * (x * z + w * y)],
        [2.0 * (x * y + w * z), (ww + yy) - (xx + zz), 2.0 * (y * z - w * x)],
        [2.0 * (x * z - w * y), 2.0 * (y * z + w * x), (ww + zz) - (xx + yy)],
    ]
}
