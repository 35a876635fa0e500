//! [`lit`]: visible share of the Sun's disc behind the Earth.
//!
//! Cone: both discs as seen from the spacecraft, with the angular radii a = asin(R_sun/d) and b = asin(R/|r|) at the
//! angle c; in penumbra the overlap of two plane circles (O. Montenbruck & E. Gill, *Satellite Orbits*, 2000, section
//! 3.4.2). Cylinder: parallel light. Switches are the edges of the shadows ([`Zone`]).

use super::each_lane;
use super::sun::{ASTRONOMICAL_UNIT, Sun};
use crate::math::prelude::*;
use crate::math::{Mask, Real};
use crate::scene::Shadow;

/// Radius of the Sun, m (IAU 2015, nominal).
const SUN_RADIUS: f64 = 6.957e8;

/// Upper bound of the tangent of the Sun's angular radius: 0.00473 at the smallest distance.
const WIDEST: f64 = 0.005;

/// Share of the Sun's disc visible from `position` (F_e, m) beyond an Earth of radius `radius`, m.
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
    R::select(edge, visible_share(edge, position, sun, radius), plain)
}

/// [`lit`] in the lanes `lanes`, by three inverse functions each.
#[inline(always)]
fn visible_share<R: Real>(lanes: R::Mask, position: [R; 3], sun: &Sun<R>, radius: R) -> R {
    let to_sun = difference(scaled(sun.distance * radius.splat(ASTRONOMICAL_UNIT), sun.direction), position);
    let numbers = [norm(to_sun), norm(position), norm(cross(position, to_sun)), -dot(position, to_sun), radius];
    each_lane(numbers, |lane, numbers| if lanes.test(lane) { visible_disc(numbers) } else { 0.0 })
}

/// Chosen zone (light, penumbra, umbra): the sides of the surfaces of penumbra and umbra, 1 outside and -1 inside.
#[derive(Clone, Copy, Debug)]
pub struct Zone<R>([R; 2]);

impl<R: Real> Zone<R> {
    /// No zone is chosen.
    pub fn none(zero: R) -> Self {
        Zone([zero; 2])
    }

    /// Copies `own` into lane `lane`.
    pub fn set_lane(&mut self, lane: usize, own: &Zone<f64>) {
        set_lanes(&mut self.0, lane, &own.0);
    }

    /// Chooses the zone in the lanes `lanes`.
    #[inline(always)]
    pub fn choose_branches(&mut self, lanes: R::Mask, shadow: Shadow, position: [R; 3], sun: &Sun<R>, radius: R) {
        for (side, edge) in self.0.iter_mut().zip(edges(shadow, position, sun, radius)) {
            let one = edge.splat(1.0);
            *side = R::select(lanes, R::select(edge.lt(one.zero()), -one, one), *side);
        }
    }

    /// The lanes in penumbra, where light is not smooth at the edges: the overlap grows with depth to the power 3/2.
    #[inline(always)]
    pub fn is_part(&self, zero: R) -> R::Mask {
        self.0[0].lt(zero) & zero.lt(self.0[1])
    }

    /// Switch functions of this zone.
    #[inline(always)]
    pub fn switches(&self, shadow: Shadow, position: [R; 3], sun: &Sun<R>, radius: R) -> [R; 2] {
        let [part, full] = edges(shadow, position, sun, radius);
        [self.0[0] * part, self.0[1] * full]
    }

    /// [`lit`] in this zone, extended beyond its edges.
    #[inline(always)]
    pub fn lit(&self, shadow: Shadow, position: [R; 3], sun: &Sun<R>, radius: R) -> R {
        let [part, full] = self.0;
        let (zero, one) = (radius.zero(), radius.splat(1.0));
        let plain = R::select(part.lt(zero), zero, one);
        let in_part = part.lt(zero) & zero.lt(full);
        let plain = match in_part.any() {
            true => R::select(in_part, visible_share(in_part, position, sun, radius), plain),
            false => plain,
        };
        let open = !(part.lt(zero) | zero.lt(part));
        if open.any() { R::select(open, lit(shadow, position, sun, radius), plain) } else { plain }
    }
}

/// Distances of `position` from the surfaces of penumbra and umbra, in Earth radii, positive outside; on the day side
/// from a sphere that touches both. The surfaces are cones tangent to Sun and Earth, with half angles of the sines
/// (R_sun + R)/d and (R_sun - R)/d, or a cylinder.
#[inline(always)]
fn edges<R: Real>(shadow: Shadow, position: [R; 3], sun: &Sun<R>, radius: R) -> [R; 2] {
    let zero = radius.zero();
    let behind = -dot(position, sun.direction);
    let beside = R::select(zero.lt(behind), norm(cross(position, sun.direction)), norm(position));
    let depth = behind.larger(zero);
    let one = radius.splat(1.0);
    let sines = match shadow {
        Shadow::Cylinder => [zero; 2],
        Shadow::Cone => {
            let per = one / (sun.distance * radius.splat(ASTRONOMICAL_UNIT));
            let size = radius.splat(SUN_RADIUS);
            [(size + radius) * per, (radius - size) * per]
        }
    };
    let mut edges = sines;
    for (edge, sine) in edges.iter_mut().zip(sines) {
        *edge = (beside * sine.neg_mul_add(sine, one).sqrt() - sine.mul_add(depth, radius)) / radius;
    }
    edges
}

/// Visible share of a disc, from the distances of Sun and Earth, cross and dot product of the vectors to them, and the
/// Earth's radius.
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
    use crate::testing::close;

    const RADIUS: f64 = 6_378_136.6;

    fn share(shadow: Shadow, position: [f64; 3]) -> f64 {
        let sun = Sun { direction: [1.0, 0.0, 0.0], distance: 1.0 };
        lit(shadow, position, &sun, RADIUS)
    }

    /// Law: the cylinder is as wide as the Earth; umbra and penumbra differ from it by |r| tan(0.2666 deg); half of the
    /// disc is visible near its edge; the share never jumps.
    #[test]
    fn the_shadows_have_their_widths() {
        let behind = 7e6;
        let width = SUN_RADIUS / ASTRONOMICAL_UNIT * behind;
        let at = |shadow, beside: f64| share(shadow, [-behind, 0.6 * beside, 0.8 * beside]);
        assert_eq!([at(Shadow::Cylinder, RADIUS - 1.0), at(Shadow::Cylinder, RADIUS + 1.0)], [0.0, 1.0]);
        assert_eq!([at(Shadow::Cone, RADIUS - 1.06 * width), at(Shadow::Cone, RADIUS + 1.06 * width)], [0.0, 1.0]);
        assert!(at(Shadow::Cone, RADIUS - 0.9 * width) > 0.0 && at(Shadow::Cone, RADIUS + 0.9 * width) < 1.0);
        close(at(Shadow::Cone, RADIUS), 0.5, 0.01);
        assert_eq!(share(Shadow::Cone, [behind, 0.0, 0.0]), 1.0);
        assert_eq!(share(Shadow::Cone, [-behind, 0.0, 0.0]), 0.0);
        let mut last = 0.0;
        for k in -1100..=1100 {
            let now = at(Shadow::Cone, RADIUS + f64::from(k) * 1e-3 * width);
            assert!(now >= last && now - last < 1e-3, "{k}: {last} {now}");
            last = now;
        }
    }

    /// Truth: Basilisk, `src/simulation/environment/eclipse/_UnitTest/test_eclipse.py`, penumbra: 500 km, i = 5, node
    /// 48.2, periapsis 0, anomaly 107.5 deg, 2021-05-04 07:47:48.965 UTC: 0.62310760206735027 with the Sun of DE430 in
    /// J2000. The Sun of date is turned back by precession (IAU 1976, first order). 0.01 deg of the disc's 0.53 deg are
    /// up to 0.025 of its area, the bound; measured 0.007.
    #[test]
    fn the_penumbra_of_basilisk() {
        let days = 7_793.825_261_169_0;
        let sun = super::super::sun::sun(days);
        let centuries = days / 36_525.0;
        let [zeta, z, theta] =
            [2306.2181, 2306.2181, 2004.3109].map(|rate| (rate * centuries / 3_600.0_f64).to_radians());
        let turn = |[x, y, w]: [f64; 3], angle: f64| {
            let (s, c) = libm::sincos(angle);
            [c * x + s * y, c * y - s * x, w]
        };
        let tilt = |[x, y, w]: [f64; 3], angle: f64| {
            let [x, w, y] = turn([x, w, y], angle);
            [x, y, w]
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
        close(found, 0.623_107_602_067_350_3, 0.025);
    }
}
