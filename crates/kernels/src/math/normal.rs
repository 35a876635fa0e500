//! Probability and quantile of the standard normal distribution, in portable arithmetic.
//!
//! Quantile: M. J. Wichura, *Algorithm AS 241: The Percentage Points of the Normal Distribution*, Applied Statistics 37
//! (1988) 477-484, routine PPND16 (relative error about 1e-16). No fused operations, which may be library calls.

// The digits are those that the paper prints.
#![allow(clippy::excessive_precision)]

/// Numerator and denominator about p = 1/2, in 0.425^2 - (p - 1/2)^2; lowest power first.
const CENTER: [[f64; 8]; 2] = [
    [
        3.387_132_872_796_366_608_0e0,
        1.331_416_678_917_843_774_5e2,
        1.971_590_950_306_551_442_7e3,
        1.373_169_376_550_946_112_5e4,
        4.592_195_393_154_987_145_7e4,
        6.726_577_092_700_870_085_3e4,
        3.343_057_558_358_812_810_5e4,
        2.509_080_928_730_122_672_7e3,
    ],
    [
        1.0,
        4.231_333_070_160_091_125_2e1,
        6.871_870_074_920_579_083_0e2,
        5.394_196_021_424_751_107_7e3,
        2.121_379_430_158_659_586_7e4,
        3.930_789_580_009_271_061_0e4,
        2.872_908_573_572_194_267_4e4,
        5.226_495_278_852_854_561_0e3,
    ],
];
/// Near tail, in sqrt(-ln p) - 1.6.
const NEAR: [[f64; 8]; 2] = [
    [
        1.423_437_110_749_683_577_34e0,
        4.630_337_846_156_545_295_90e0,
        5.769_497_221_460_691_405_50e0,
        3.647_848_324_763_204_605_04e0,
        1.270_458_252_452_368_382_58e0,
        2.417_807_251_774_506_117_70e-1,
        2.272_384_498_926_918_458_33e-2,
        7.745_450_142_783_414_076_40e-4,
    ],
    [
        1.0,
        2.053_191_626_637_758_821_87e0,
        1.676_384_830_183_803_849_40e0,
        6.897_673_349_851_000_045_50e-1,
        1.481_039_764_274_800_745_90e-1,
        1.519_866_656_361_645_719_66e-2,
        5.475_938_084_995_344_946_00e-4,
        1.050_750_071_644_416_843_24e-9,
    ],
];
/// Far tail, in sqrt(-ln p) - 5.
const FAR: [[f64; 8]; 2] = [
    [
        6.657_904_643_501_103_777_20e0,
        5.463_784_911_164_114_369_90e0,
        1.784_826_539_917_291_335_80e0,
        2.965_605_718_285_048_912_30e-1,
        2.653_218_952_657_612_309_30e-2,
        1.242_660_947_388_078_438_60e-3,
        2.711_555_568_743_487_578_15e-5,
        2.010_334_399_292_288_132_65e-7,
    ],
    [
        1.0,
        5.998_322_065_558_879_376_90e-1,
        1.369_298_809_227_358_053_10e-1,
        1.487_536_129_085_061_485_25e-2,
        7.868_691_311_456_132_591_00e-4,
        1.846_318_317_510_054_681_80e-5,
        1.421_511_758_316_445_888_70e-7,
        2.044_263_103_389_939_785_64e-15,
    ],
];

#[inline]
fn ratio([numerator, denominator]: &[[f64; 8]; 2], x: f64) -> f64 {
    let horner =
        |c: &[f64; 8]| ((((((c[7] * x + c[6]) * x + c[5]) * x + c[4]) * x + c[3]) * x + c[2]) * x + c[1]) * x + c[0];
    horner(numerator) / horner(denominator)
}

/// z with probability `p` below it, 0 < p < 1; relative error below 4e-16.
#[inline]
pub fn quantile(p: f64) -> f64 {
    let q = p - 0.5;
    if q.abs() <= CENTRAL { q * ratio(&CENTER, 0.180_625 - q * q) } else { tail_quantile(p) }
}

/// [`quantile`] of eight numbers, bit for bit: vectorised about 1/2, one by one in the tails.
#[inline]
pub fn quantiles(p: &[f64; 8], z: &mut [f64; 8]) {
    for (z, p) in z.iter_mut().zip(p) {
        let q = p - 0.5;
        *z = q * ratio(&CENTER, 0.180_625 - q * q);
    }
    for (z, p) in z.iter_mut().zip(p) {
        if (p - 0.5).abs() > CENTRAL {
            *z = tail_quantile(*p);
        }
    }
}

/// Half-width of the interval about 1/2 without a logarithm.
const CENTRAL: f64 = 0.425;

/// [`quantile`] beyond [`CENTRAL`] from 1/2.
fn tail_quantile(p: f64) -> f64 {
    let q = p - 0.5;
    let tail = (-libm::log(if q < 0.0 { p } else { 1.0 - p })).sqrt();
    let z = if tail <= 5.0 { ratio(&NEAR, tail - 1.6) } else { ratio(&FAR, tail - 5.0) };
    if q < 0.0 { -z } else { z }
}

/// Probability below `z`; accurate in the lower tail.
pub fn probability(z: f64) -> f64 {
    0.5 * libm::erfc(-z * std::f64::consts::FRAC_1_SQRT_2)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Quantiles for the doubles nearest to p, solved in 40 digits from the complementary error function.
    const TRUTH: [(f64, f64); 13] = [
        (1e-300, -37.047096299361199237),
        (1e-20, -9.2623400897984075796),
        (1e-10, -6.3613409024040561991),
        (0.001, -3.0902323061678135354),
        (0.01, -2.3263478740408410931),
        (0.07499, -1.4396021182393162092),
        (0.0751, -1.4388253927525399824),
        (0.25, -0.6744897501960817432),
        (0.4, -0.25334710313579974132),
        (0.49999, -0.000025066282748960008527),
        (0.5000001, 2.5066282733116483012e-7),
        (0.925, 1.4395314709384562291),
        (0.9999, 3.7190164854557083867),
    ];
    /// Two units in the last place: the paper's 1e-16 and rounding.
    const ERROR: f64 = 4.5e-16;

    #[test]
    fn the_quantile_is_that_of_forty_digits() {
        for (p, z) in TRUTH {
            let error = (quantile(p) / z - 1.0).abs();
            assert!(error <= ERROR, "p {p}: {} against {z}, relative error {error:e}", quantile(p));
        }
        assert_eq!(quantile(0.5), 0.0);
    }

    #[test]
    fn eight_at_a_time_have_the_bits_of_one() {
        for k in 0..1000 {
            let p: [f64; 8] = std::array::from_fn(|i| (f64::from(8 * k) + i as f64 + 0.5) / 8000.0);
            let mut z = [0.0; 8];
            quantiles(&p, &mut z);
            assert_eq!(z.map(f64::to_bits), p.map(|p| quantile(p).to_bits()), "{p:?}");
        }
    }
}
