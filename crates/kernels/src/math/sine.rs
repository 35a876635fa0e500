//! Sine and cosine of an angle in turns from [`Real`] operations alone.

use super::power::polynomial;
use crate::math::real::Real;

/// sin and cos of 2 pi `turns` for |turns| <= 1/2 (slightly more is allowed), each within 2 ulp of 1.
///
/// Exact reduction to |angle| <= pi/4 by quarter turns; polynomials of fdlibm (Sun Microsystems, 1993: `__kernel_sin`,
/// `__kernel_cos`; minimax on [-pi/4, pi/4], error below 2^-58).
#[inline(always)]
pub fn sin_cos_turns<R: Real>(turns: R) -> (R, R) {
    let quarters = (turns.splat(4.0) * turns).nearest_integer();
    let rest = quarters.mul_add(turns.splat(-0.25), turns);
    // 2 pi as a sum of two
    let x = rest.mul_add(turns.splat(core::f64::consts::TAU), rest * turns.splat(2.449_293_598_294_706_4e-16));
    let z = x * x;
    let sine = [
        -0.166_666_666_666_666_32,
        0.008_333_333_333_322_49,
        -0.000_198_412_698_298_579_5,
        2.755_731_370_707_006_8e-6,
        -2.505_076_025_340_686_3e-8,
        1.589_690_995_211_55e-10,
    ];
    let cosine = [
        0.041_666_666_666_666_6,
        -0.001_388_888_888_887_411,
        2.480_158_728_947_673e-5,
        -2.755_731_435_139_066_3e-7,
        2.087_572_321_298_175e-9,
        -1.135_964_755_778_819_5e-11,
    ];
    let sin = (x * z).mul_add(polynomial(&sine, z), x);
    let cos = z.mul_add(z.mul_add(polynomial(&cosine, z), turns.splat(-0.5)), turns.splat(1.0));
    // quarters in {-2, ..., 2}: swapped on odd ones, then signs
    let even = turns.splat(0.5).lt((quarters.abs() - turns.splat(1.0)).abs());
    let (s, k) = (R::select(even, sin, cos), R::select(even, cos, sin));
    let two = turns.splat(1.5).lt(quarters.abs());
    let minus_one = quarters.lt(turns.splat(-0.5));
    let plus_one = turns.splat(0.5).lt(quarters);
    // sin: q = 0 s, 1 cos, 2 -s, -1 -cos, -2 -s; cos: q = 0 c, 1 -sin, 2 -c, -1 sin, -2 -c
    let negative_sin = R::select(two, -s, R::select(minus_one, -s, s));
    let negative_cos = R::select(two, -k, R::select(plus_one, -k, k));
    (negative_sin, negative_cos)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn agrees_with_the_library_over_a_turn() {
        let mut worst = 0.0_f64;
        for k in -10_000..=10_000 {
            let turns = f64::from(k) / 20_000.0;
            let (s, c) = sin_cos_turns(turns);
            // rounding of the library's argument costs up to pi eps/2
            let angle = core::f64::consts::TAU * turns;
            worst = worst.max((s - libm::sin(angle)).abs()).max((c - libm::cos(angle)).abs());
        }
        // an ulp of one, and the rounded angle; measured: 3.6e-16
        assert!(worst < 3.0 * f64::EPSILON, "{worst:e}");
    }

    #[test]
    fn quarter_turns_are_exact() {
        assert_eq!(sin_cos_turns(0.25), (1.0, 0.0));
        assert_eq!(sin_cos_turns(-0.25), (-1.0, 0.0));
        assert_eq!(sin_cos_turns(0.5).1, -1.0);
        assert_eq!(sin_cos_turns(0.0), (0.0, 1.0));
    }
}
