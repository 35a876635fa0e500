//! [`unit_quaternion`]: the quaternion that is used where four numbers are written.

/// How far the sum of the squares of four numbers that were divided by their norm may be from one: 6 rounding units by
/// the usual bounds (two for the sum, one and a half for root and division, counted twice in a square; two for the sum
/// again), measured 3.
const ROUNDED_UNIT: f64 = 8.0 * f64::EPSILON;

/// Whether the norm of `q` is one to rounding.
#[inline]
pub(super) fn is_unit(q: &[f64]) -> bool {
    let square = q.iter().map(|x| x * x).sum::<f64>();
    (square - 1.0).abs() <= ROUNDED_UNIT
}

/// `q` divided by its norm; unchanged where its norm is one to rounding, so that numbers which this function or
/// [`super::Parameter::normalise`] returned, and were recorded and written again, keep their bits.
#[inline]
pub fn unit_quaternion(q: [f64; 4]) -> [f64; 4] {
    if is_unit(&q) {
        return q;
    }
    let norm = q.iter().map(|x| x * x).sum::<f64>().sqrt();
    q.map(|x| x / norm)
}
