//! [`unit_quaternion`]: normalisation that keeps recorded numbers.

/// Tolerance of |q|^2 for numbers divided by their norm: 6 rounding units by the usual bounds, measured 3.
const ROUNDED_UNIT: f64 = 8.0 * f64::EPSILON;

/// True if the norm of `q` is one to rounding.
#[inline]
pub(super) fn is_unit(q: &[f64]) -> bool {
    let square = q.iter().map(|x| x * x).sum::<f64>();
    (square - 1.0).abs() <= ROUNDED_UNIT
}

/// `q` divided by its norm; unchanged if its norm is one to rounding, so that recorded numbers keep their bits.
#[inline]
pub fn unit_quaternion(q: [f64; 4]) -> [f64; 4] {
    if is_unit(&q) {
        return q;
    }
    let norm = q.iter().map(|x| x * x).sum::<f64>().sqrt();
    q.map(|x| x / norm)
}
