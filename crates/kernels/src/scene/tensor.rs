//! Inertia tensors by rows: point mass, symmetrisation, sum.

use crate::math::Real;
use crate::math::vector::sum;

/// m (r^2 1 - r r^T), without differences on the diagonal.
pub(super) fn point_inertia<R: Real>(mass: R, r: [R; 3]) -> [[R; 3]; 3] {
    let square = [mass * (r[0] * r[0]), mass * (r[1] * r[1]), mass * (r[2] * r[2])];
    let off = |i: usize, j: usize| -(mass * (r[i] * r[j]));
    [
        [square[1] + square[2], off(0, 1), off(0, 2)],
        [off(0, 1), square[0] + square[2], off(1, 2)],
        [off(0, 2), off(1, 2), square[0] + square[1]],
    ]
}

/// Makes a tensor that is symmetric to rounding exactly symmetric.
pub(super) fn symmetric<R: Real>(tensor: [[f64; 3]; 3], one: R) -> [[R; 3]; 3] {
    let k = |value: f64| one.splat(value);
    std::array::from_fn(|i| std::array::from_fn(|j| k(0.5) * (k(tensor[i][j]) + k(tensor[j][i]))))
}

pub(super) fn matrix_sum<R: Real>(a: [[R; 3]; 3], b: [[R; 3]; 3]) -> [[R; 3]; 3] {
    std::array::from_fn(|i| sum(a[i], b[i]))
}
