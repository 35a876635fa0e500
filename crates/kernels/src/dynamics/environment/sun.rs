//! [`sun`]: position of the Sun by the low-precision series of the *Astronomical Almanac* (page C5; also J. Meeus,
//! *Astronomical Algorithms*, 1998, chapter 25).
//!
//! With n days since J2000.0, mean longitude L = 280.460 + 0.9856474 n, mean anomaly g = 357.528 + 0.9856003 n, in
//! degrees:
//!
//! ```text
//! lambda = L + 1.915 sin g + 0.020 sin 2g,   epsilon = 23.439 - 0.0000004 n,
//! R = 1.00014 - 0.01671 cos g - 0.00014 cos 2g  (au)
//! ```
//!
//! Apparent direction in the mean equator and equinox of date, good to 0.01 deg from 1950 to 2050.

use fearless_simd::Simd;

use crate::math::Real;
use crate::math::isa::{Isa, Work};
use crate::math::sine::sin_cos_turns;
use crate::scene::Epoch;

/// An astronomical unit, m (IAU 2012).
pub const ASTRONOMICAL_UNIT: f64 = 149_597_870_700.0;

/// Position of the Sun from the Earth's centre.
#[derive(Clone, Copy, Debug)]
pub struct Sun<R> {
    /// Unit vector to the Sun, F_e.
    pub direction: [R; 3],
    /// Distance, au.
    pub distance: R,
}

impl<R: Real> Sun<R> {
    /// No Sun.
    #[inline(always)]
    pub fn none(zero: R) -> Self {
        Sun { direction: [zero; 3], distance: zero.splat(1.0) }
    }
}

/// The Sun `days` days after J2000.0 (2000-01-01 12:00; UTC for terrestrial time costs 8e-4 deg).
#[inline(always)]
pub fn sun<R: Real>(days: R) -> Sun<R> {
    let number = |value: f64| days.splat(value);
    let (sin_g, cos_g) = sin_cos_turns(turns(days, 357.528, 0.985_600_3));
    let two = number(2.0);
    let (sin_2g, cos_2g) = (two * sin_g * cos_g, number(1.0) - two * sin_g * sin_g);
    let longitude =
        sin_2g.mul_add(number(0.020 / 360.0), sin_g.mul_add(number(1.915 / 360.0), turns(days, 280.460, 0.985_647_4)));
    let (sin_l, cos_l) = sin_cos_turns(longitude - longitude.nearest_integer());
    let (sin_e, cos_e) = sin_cos_turns(days.mul_add(number(-0.000_000_4 / 360.0), number(23.439 / 360.0)));
    Sun {
        direction: [cos_l, cos_e * sin_l, sin_e * sin_l],
        distance: cos_2g.mul_add(number(-0.000_14), cos_g.mul_add(number(-0.016_71), number(1.000_14))),
    }
}

/// The Sun `time` seconds after a date `epoch` days after J2000.0.
#[inline(always)]
pub fn sun_at<R: Real>(epoch: R, time: R) -> Sun<R> {
    sun(time.mul_add(time.splat(1.0 / 86_400.0), epoch))
}

/// The Sun `time` seconds after `epoch`.
pub fn sun_after(epoch: Epoch, time: f64) -> Sun<f64> {
    Isa::best().run(SunAfter(epoch.days_since_j2000() + time / 86_400.0))
}

struct SunAfter(f64);

impl Work for SunAfter {
    type Output = Sun<f64>;

    #[inline(always)]
    fn run<S: Simd>(self, _simd: S) -> Sun<f64> {
        sun(self.0)
    }
}

/// An angle of `start` degrees growing by `rate` degrees per day, in turns without whole turns.
#[inline(always)]
fn turns<R: Real>(days: R, start: f64, rate: f64) -> R {
    let all = days.mul_add(days.splat(rate / 360.0), days.splat(start / 360.0));
    all - all.nearest_integer()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::vector::{cross, dot, norm};
    use crate::testing::close;

    /// Truth: astropy 8.0.2, `t = Time(2451545.0, n, format="jd", scale="utc")`,
    /// `get_sun(t).transform_to(PrecessedGeocentric(equinox=t, obstime=t))`: n, unit vector, distance in au.
    const ASTROPY: [(f64, [f64; 3], f64); 12] = [
        (-18000.25, [-0.998_352_160, 0.052_647_105, 0.022_830_819], 1.0041826),
        (-5000.0, [0.828_884_621, 0.513_250_759, 0.222_539_755], 1.0057953),
        (-37.5, [-0.465_456_741, -0.812_036_560, -0.352_060_574], 0.9871816),
        (0.0, [0.180_052_064, -0.902_489_390, -0.391_272_482], 0.9833277),
        (3287.4, [0.183_854_563, -0.901_849_865, -0.390_978_671], 0.9833068),
        (7_793.825_261_169, [0.718_406_960, 0.638_235_495, 0.276_671_091], 1.0083603),
        (9000.0, [-0.865_005_532, 0.460_368_921, 0.199_564_240], 1.0113251),
        (9461.25, [-0.426_799_839, -0.829_742_317, -0.359_679_836], 0.9868887),
        (9533.5, [0.745_542_722, -0.611_478_155, -0.265_067_002], 0.9862157),
        (9720.75, [-0.771_911_715, 0.583_285_616, 0.252_844_210], 1.0132037),
        (12345.678, [-0.890_293_391, -0.417_823_739, -0.181_110_465], 0.9958669),
        (18000.0, [0.913_580_234, 0.373_121_479, 0.161_714_309], 1.0026807),
    ];

    #[test]
    fn the_sun_is_where_astropy_has_it() {
        let mut worst = 0.0_f64;
        for (days, direction, distance) in ASTROPY {
            let found = sun(days);
            close(norm(found.direction), 1.0, 1e-15);
            let off =
                libm::atan2(norm(cross(found.direction, direction)), dot(found.direction, direction)).to_degrees();
            worst = worst.max(off);
            close(found.distance, distance, 2e-4);
        }
        assert!(worst < 0.011, "{worst} deg");
    }
}
