//! [`lit`]: the share of the Sun's disc that the Earth leaves visible.
//!
//! Cone: both discs as seen from the spacecraft, of angular radii a = asin(R_sun/d) and b = asin(R/|r|) at the angle c; where they overlap in part, the area of
//! the overlap of two plane circles (O. Montenbruck & E. Gill, *Satellite Orbits*, 2000, section 3.4.2). Cylinder: in shadow on the night side
//! within one radius of the line from the Sun through the centre.

use super::each_lane;
use super::sun::{ASTRONOMICAL_UNIT, Sun};
use crate::math::vector::{cross, difference, dot, norm, scaled};
use crate::math::{Mask, Real};
use crate::scene::Shadow;

/// Radius of the Sun, m (IAU 2015, nominal).
const SUN_RADIUS: f64 = 6.957e8;

/// The tangent of an angle that the Sun's radius is never seen under: 0.00473 at the smallest distance.
const WIDEST: f64 = 0.005;

/// The share of the Sun's disc that is visible from `position` (F_e, m), where the Earth has the radius `radius`, m: 1 in light, 0 in full shadow.
#[inline(always)]
pub fn lit<R: Real>(shadow: Shadow, position: [R; 3], sun: &Sun<R>, radius: R) -> R {
    let along = dot(position, sun.direction);
    let beside = norm(cross(position, sun.direction));
    let (zero, one) = (along.zero(), along.splat(1.0));
    let night = along.lt(zero);
    let margin = match shadow {
        Shadow::Cylinder => zero,
        Shadow::Cone => along.abs() * along.splat(WIDEST),
    };
    let dark = night & beside.lt(radius - margin);
    let plain = R::select(dark, zero, one);
    let edge = night & !beside.lt(radius - margin) & beside.lt(radius + margin);
    if !edge.any() {
        return plain;
    }
    let to_sun = difference(scaled(sun.distance * along.splat(ASTRONOMICAL_UNIT), sun.direction), position);
    let numbers = [norm(to_sun), norm(position), norm(cross(position, to_sun)), -dot(position, to_sun), radius];
    R::select(edge, each_lane(numbers, visible_disc), plain)
}

/// The visible share of a disc, from the distances of Sun and Earth, the cross and dot product of the vectors to them, and the Earth's radius.
fn visible_disc([sun, earth, cross, dot, radius]: [f64; 5]) -> f64 {
    let a = libm::asin((SUN_RADIUS / sun).min(1.0));
    let b = libm::asin((radius / earth).min(1.0));
    let c = libm::atan2(cross, dot);
    if a + b <= c {
        return 1.0;
    }
    if c <= b - a {
        return 0.0;
    }
    if c <= a - b {
        return 1.0 - (b * b) / (a * a);
    }
    let x = (c * c + a * a - b * b) / (2.0 * c);
    let y = (a * a - x * x).max(0.0).sqrt();
    let of_angle = |cosine: f64| libm::acos(cosine.clamp(-1.0, 1.0));
    let covered = a * a * of_angle(x / a) + b * b * of_angle((c - x) / b) - c * y;
    (1.0 - covered / (core::f64::consts::PI * a * a)).clamp(0.0, 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{Orbit, OrbitInput};

    const RADIUS: f64 = 6_378_136.6;

    fn share(shadow: Shadow, position: [f64; 3]) -> f64 {
        let sun = Sun { direction: [1.0, 0.0, 0.0], distance: 1.0 };
        lit(shadow, position, &sun, RADIUS)
    }

    /// Law: the cylinder is as wide as the Earth; the cone of full shadow is narrower, that of part shadow wider, both by |r| tan(0.2666 deg); half of
    /// the disc is visible near the edge of the cylinder; and the share grows from one to the other without a jump.
    #[test]
    fn the_shadows_have_their_widths() {
        let behind = 7e6;
        let width = SUN_RADIUS / ASTRONOMICAL_UNIT * behind;
        let at = |shadow, beside: f64| share(shadow, [-behind, 0.6 * beside, 0.8 * beside]);
        assert_eq!([at(Shadow::Cylinder, RADIUS - 1.0), at(Shadow::Cylinder, RADIUS + 1.0)], [0.0, 1.0]);
        assert_eq!([at(Shadow::Cone, RADIUS - 1.06 * width), at(Shadow::Cone, RADIUS + 1.06 * width)], [0.0, 1.0]);
        assert!(at(Shadow::Cone, RADIUS - 0.9 * width) > 0.0 && at(Shadow::Cone, RADIUS + 0.9 * width) < 1.0);
        assert!((at(Shadow::Cone, RADIUS) - 0.5).abs() < 0.01, "{}", at(Shadow::Cone, RADIUS));
        assert_eq!(share(Shadow::Cone, [behind, 0.0, 0.0]), 1.0);
        assert_eq!(share(Shadow::Cone, [-behind, 0.0, 0.0]), 0.0);
        let mut last = 0.0;
        for k in -1100..=1100 {
            let now = at(Shadow::Cone, RADIUS + f64::from(k) * 1e-3 * width);
            assert!(now >= last && now - last < 1e-3, "{k}: {last} {now}");
            last = now;
        }
    }

    /// Truth: Basilisk, `src/simulation/environment/eclipse/_UnitTest/test_eclipse.py`, penumbra: 500 km, i = 5, node 48.2, periapsis 0, anomaly
    /// 107.5 deg, 2021-05-04 07:47:48.965 UTC: 0.62310760206735027 with the Sun of DE430 in J2000. Its own Sun of date is turned back by the precession
    /// (IAU 1976, to first order). The disc is 0.53 deg wide: 0.01 deg of the Sun are up to 0.025 of its area, the bound; measured 0.007.
    #[test]
    fn the_penumbra_of_basilisk() {
        let days = 7_793.825_261_169_0;
        let sun = super::super::sun::sun(days);
        let centuries = days / 36_525.0;
        // the angles zeta, z and theta, rad
        let [zeta, z, theta] =
            [2306.2181, 2306.2181, 2004.3109].map(|rate| (rate * centuries / 3_600.0_f64).to_radians());
        let turn = |[x, y, w]: [f64; 3], angle: f64| {
            let (s, c) = libm::sincos(angle);
            [c * x + s * y, c * y - s * x, w]
        };
        let tilt = |[x, y, w]: [f64; 3], angle: f64| {
            let (s, c) = libm::sincos(angle);
            [c * x + s * w, y, c * w - s * x]
        };
        let direction = turn(tilt(turn(sun.direction, z), theta), zeta);
        let orbit = Orbit::of(&OrbitInput {
            semi_major_axis_m: Some(RADIUS + 500e3),
            inclination_rad: Some(5_f64.to_radians()),
            ascending_node_rad: Some(48.2_f64.to_radians()),
            true_anomaly_rad: Some(107.5_f64.to_radians()),
            ..OrbitInput::DEFAULT
        });
        let found = lit(Shadow::Cone, orbit.position, &Sun { direction, ..sun }, RADIUS);
        println!("{found}");
        assert!((found - 0.623_107_602_067_350_3).abs() < 0.025, "{found}");
    }
}
