//! Orientation of the Earth at a date: the angle from e1, towards the vernal equinox, to the Greenwich meridian.
//!
//! With a date, F_e is the frame of the mean equator and equinox of the epoch, and Earth-fixed axes are turned about e3
//! by Greenwich mean sidereal time: Earth rotation angle (N. Capitaine, B. Guinot, D. McCarthy, 2000, Astronomy and
//! Astrophysics 355, 398, eq. 14) plus precession since J2000 (N. Capitaine, P. Wallace, J. Chapront, 2003, Astronomy
//! and Astrophysics 412, 567, eq. 42; IAU 2006).
//!
//! Neglected, below 0.01 deg in all: UT1 - UTC (0.004 deg), nutation (0.008 deg), polar motion (0.0002 deg), precession
//! since the epoch (0.00004 deg per day).

use crate::scene::epoch::Epoch;

/// Rotation rate relative to the equinox of the epoch, turns/s: 1.00273781191135448 turns per day (Capitaine et al.,
/// 2000) plus precession in right ascension, 4612.156534 arcsec per Julian century.
pub const TURNS_PER_SECOND: f64 = (1.002_737_811_911_354_6 + 4_612.156_534 / (1_296_000.0 * 36_525.0)) / 86_400.0;

/// Greenwich mean sidereal time at `epoch`, turns, from 0 to 1.
pub fn turns_at(epoch: Epoch) -> f64 {
    let [_, part] = epoch.julian_date();
    let days = epoch.days_since_j2000();
    let centuries = days / 36_525.0;
    // without whole turns: days = n + part + 1/2
    let rotation = 0.779_057_273_264 + 0.5 + part + 0.002_737_811_911_354_48 * days;
    let precession = 0.014_506 + (4_612.156_534 + (1.391_581_7 - 0.000_000_44 * centuries) * centuries) * centuries;
    let turns = rotation + precession / 1_296_000.0;
    turns - libm::floor(turns)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Truth: SOFA's `gmst06` (`erfa.gmst06(jd1, jd2, jd1, jd2 + 69/86400)`, pyerfa 2.0.1.5), rad.
    #[test]
    fn sidereal_time_is_that_of_sofa() {
        for (text, expected) in [
            ("2000-01-01T12:00:00Z", 4.894_961_283_639_734),
            ("2026-11-24T00:00:00Z", 1.098_990_764_010_523_2),
            ("2024-02-29T23:59:59.5Z", 2.780_123_945_703_739),
            ("1960-07-01T06:30:15.25Z", 0.294_582_785_957_502_26),
            ("2030-12-31T18:00:00Z", 0.178_137_532_102_100_87),
        ] {
            let found = core::f64::consts::TAU * turns_at(Epoch::parse(text).expect(text));
            assert!((found - expected).abs() < 1e-9, "{text}: {found} {expected}");
        }
    }
}
