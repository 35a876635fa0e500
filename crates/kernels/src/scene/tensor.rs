//! Inertia tensors by rows.

use crate::math::prelude::*;

/// m (r^2 1 - r r^T), without differences on the diagonal.
pub(super) fn point_inertia<R: Real>(mass: R, r: [R; 3]) -> [[R; 3]; 3] {
    let product = |i: usize, j: usize| mass * (r[i] * r[j]);
    let own = [product(1, 1) + product(2, 2), product(0, 0) + product(2, 2), product(0, 0) + product(1, 1)];
    symmetric_of(|i, j| if i == j { own[i] } else { -product(i, j) })
}

/// The symmetric tensor of the entries on and above the diagonal.
pub(super) fn symmetric_of<R: Real>(entry: impl Fn(usize, usize) -> R) -> [[R; 3]; 3] {
    let (xy, xz, yz) = (entry(0, 1), entry(0, 2), entry(1, 2));
    [[entry(0, 0), xy, xz], [xy, entry(1, 1), yz], [xz, yz, entry(2, 2)]]
}

/// `scale` A J A^T of a symmetric `j`.
pub(super) fn symmetric_product<R: Real>(scale: R, a: [[R; 3]; 3], j: [[R; 3]; 3]) -> [[R; 3]; 3] {
    let rows = [product(j, a[0]), product(j, a[1]), product(j, a[2])];
    symmetric_of(|i, k| scale * dot(rows[i], a[k]))
}

pub(super) fn extremes([a, b, c]: [f64; 3]) -> [f64; 2] {
    [a.min(b).min(c), a.max(b).max(c)]
}

pub(super) fn symmetric<R: Real>(tensor: [[f64; 3]; 3], one: R) -> [[R; 3]; 3] {
    let k = |value: f64| one.splat(value);
    std::array::from_fn(|i| std::array::from_fn(|j| k(0.5) * (k(tensor[i][j]) + k(tensor[j][i]))))
}

pub(super) fn matrix_sum<R: Real>(a: [[R; 3]; 3], b: [[R; 3]; 3]) -> [[R; 3]; 3] {
    std::array::from_fn(|i| sum(a[i], b[i]))
}
