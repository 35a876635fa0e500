//! Time scale of a gyrostat's motion, and its unit of time.

use crate::math::Real;

/// Rates below this, rad/s, are not resolved: 2^-200.
const SLOWEST: f64 = 6.223_015_277_861_142e-61;

/// The largest component in magnitude, rounded to `f64`.
#[inline(always)]
pub(super) fn largest<R: Real>(v: [R; 3]) -> f64 {
    v[0].lane(0).abs().max(v[1].lane(0).abs()).max(v[2].lane(0).abs())
}

#[inline(always)]
fn smallest<R: Real>(moments: [R; 3]) -> f64 {
    moments[0].lane(0).min(moments[1].lane(0)).min(moments[2].lane(0))
}

/// Rate of the motion due to the wheels' momentum (N m s), rad/s.
#[inline(always)]
pub(super) fn rate_of_momentum<R: Real>(moments: [R; 3], momentum_b: [R; 3]) -> f64 {
    largest(momentum_b) / smallest(moments)
}

/// Rate after one radian of acceleration by the larger of two torques (N m), rad/s.
#[inline(always)]
pub(super) fn rate_of_torques<R: Real>(moments: [R; 3], [first, second]: [[R; 3]; 2]) -> f64 {
    (largest(first).max(largest(second)) / smallest(moments)).sqrt()
}

/// A power of two near 1/`rate`, s.
#[inline(always)]
pub(super) fn time_unit(rate: f64) -> f64 {
    if rate.is_nan() || rate <= SLOWEST {
        return 1.0 / SLOWEST;
    }
    // the exponent alone: 2^-floor(log2 rate)
    let exponent = (rate.to_bits() >> 52) & 0x7ff;
    f64::from_bits((2046 - exponent) << 52)
}
