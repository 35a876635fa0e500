//! [`Air`]: the density of the atmosphere by height, from a table or an exponential, and the velocity relative to it.
//!
//! The table is that of D. Vallado, *Fundamentals of Astrodynamics and Applications*, 4th ed., 2013, table 8-4: the US Standard Atmosphere (1976) up to
//! 25 km, and CIRA-72 above. Between two heights the density is exponential through both of its values. Vallado has rounded scale heights instead, at
//! whose ends the density jumps by up to 0.14%; those jumps would be found by every step control, and are not in nature. Above the last height
//! his scale height is used.

use super::{EARTH_RATE, each_lane};
use crate::dynamics::orbit::OrbitState;
use crate::math::{Mask, Real};

/// Heights above the Earth's surface, km, with the density there, kg/m^3.
const TABLE: [[f64; 2]; 28] = [
    [0.0, 1.225],
    [25.0, 3.899e-2],
    [30.0, 1.774e-2],
    [40.0, 3.972e-3],
    [50.0, 1.057e-3],
    [60.0, 3.206e-4],
    [70.0, 8.770e-5],
    [80.0, 1.905e-5],
    [90.0, 3.396e-6],
    [100.0, 5.297e-7],
    [110.0, 9.661e-8],
    [120.0, 2.438e-8],
    [130.0, 8.484e-9],
    [140.0, 3.845e-9],
    [150.0, 2.070e-9],
    [180.0, 5.464e-10],
    [200.0, 2.789e-10],
    [250.0, 7.248e-11],
    [300.0, 2.418e-11],
    [350.0, 9.518e-12],
    [400.0, 3.725e-12],
    [450.0, 1.585e-12],
    [500.0, 6.967e-13],
    [600.0, 1.454e-13],
    [700.0, 3.614e-14],
    [800.0, 1.170e-14],
    [900.0, 5.245e-15],
    [1000.0, 3.019e-15],
];

/// Scale height above the last height of the table, km.
const ABOVE: f64 = 268.0;

/// The base of the band below the surface, km.
const BELOW: f64 = -1e4;

/// Heights in the switch functions of the bands are in this unit, km.
const SWITCH_UNIT: f64 = 100.0;

/// The density at `height` m above the surface by the table, kg/m^3; below the surface that of the surface.
pub fn tabulated_density(height: f64) -> f64 {
    density_in(band_at(height), height)
}

/// The band of the table at `height` m: its base and its thickness, km, the density at its base, kg/m^3, and the logarithm of that at its top relative to
/// it.
fn band_at(height: f64) -> [f64; 4] {
    let height = height * 1e-3;
    let above = TABLE.partition_point(|[base, _]| *base <= height);
    let Some([base, density]) = above.checked_sub(1).map(|index| TABLE[index]) else {
        return [BELOW, TABLE[0][0] - BELOW, TABLE[0][1], 0.0];
    };
    match TABLE.get(above) {
        Some([next, thinner]) => [base, next - base, density, libm::log(thinner / density)],
        None => [base, ABOVE, density, -1.0],
    }
}

/// The density of `band` at `height` m, in the band or beyond.
fn density_in([base, thickness, density, logarithm]: [f64; 4], height: f64) -> f64 {
    density * libm::exp((height * 1e-3 - base) / thickness * logarithm)
}

/// The air about the Earth, one per lane.
#[derive(Clone, Copy, Debug)]
pub struct Air<R> {
    /// Factor of the density.
    pub scale: R,
    /// Radius of the Earth, m.
    pub surface: R,
    /// Density of an exponential atmosphere at its base, kg/m^3, the height of the base, m, and the scale height, m; a scale height of zero where the
    /// table is used.
    pub exponential: [R; 3],
    /// The band of the table that was chosen (`band_at`); a thickness of zero until then.
    band: [R; 4],
}

impl<R: Real> Air<R> {
    /// None.
    pub fn none(zero: R) -> Self {
        Air { scale: zero, surface: zero, exponential: [zero; 3], band: [zero; 4] }
    }

    /// With its density times `scale`, above a surface of the radius `surface` m; no band is chosen.
    pub fn new(scale: R, surface: R, exponential: [R; 3]) -> Self {
        Air { scale, surface, exponential, ..Self::none(scale.zero()) }
    }

    /// Puts `air` into lane `lane`.
    pub fn set_lane(&mut self, lane: usize, air: &Air<f64>) {
        self.scale.set_lane(lane, air.scale);
        self.surface.set_lane(lane, air.surface);
        for (own, number) in self.exponential.iter_mut().zip(air.exponential) {
            own.set_lane(lane, number);
        }
        for (own, number) in self.band.iter_mut().zip(air.band) {
            own.set_lane(lane, number);
        }
    }

    /// Chooses the band of the table in the lanes `lanes`, at `distance` m from the Earth's centre.
    #[inline(always)]
    pub fn choose_branches(&mut self, lanes: R::Mask, distance: R) {
        let height = distance - self.surface;
        for lane in (0..R::LANES).filter(|lane| lanes.test(*lane)) {
            for (own, number) in self.band.iter_mut().zip(band_at(height.lane(lane))) {
                own.set_lane(lane, number);
            }
        }
    }

    /// Gives `visit` the switch functions of the band that was chosen, one for each of its ends, at `distance` m from the Earth's centre in `M` states.
    #[inline(always)]
    pub fn switches<const M: usize>(&self, distances: &[R; M], visit: &mut impl FnMut([R; M])) {
        let number = |value: f64| self.scale.splat(value);
        let is_table = !self.scale.zero().lt(self.exponential[2]);
        let [base, thickness, ..] = self.band;
        let last = !base.lt(number(TABLE[TABLE.len() - 1][0]));
        let (mut above, mut below) = (*distances, *distances);
        for (above, below) in above.iter_mut().zip(&mut below) {
            let since = (*above - self.surface).mul_add(number(1e-3), -base);
            *above = R::select(is_table, since * number(1.0 / SWITCH_UNIT), number(f64::INFINITY));
            let left = (thickness - since) * number(1.0 / SWITCH_UNIT);
            *below = R::select(is_table & !last, left, number(f64::INFINITY));
        }
        visit(above);
        visit(below);
    }

    /// The density where the distance from the Earth's centre is `distance` m, kg/m^3.
    #[inline(always)]
    pub fn density(&self, distance: R) -> R {
        let [density, base, scale_height] = self.exponential;
        let [b0, b1, b2, b3] = self.band;
        let numbers = [distance - self.surface, density, base, scale_height, b0, b1, b2, b3];
        self.scale
            * each_lane(numbers, |[height, density, base, scale_height, b0, thickness, b2, b3]| {
                if scale_height > 0.0 {
                    density * libm::exp((base - height) / scale_height)
                } else if thickness > 0.0 {
                    density_in([b0, thickness, b2, b3], height)
                } else {
                    tabulated_density(height)
                }
            })
    }

    /// The velocity of a spacecraft at `place` relative to air that turns with the Earth, F_e, m/s.
    #[inline(always)]
    pub fn relative_velocity(place: &OrbitState<R>) -> [R; 3] {
        let [x, y, _] = place.position;
        let rate = x.splat(EARTH_RATE);
        let [u, v, w] = place.velocity;
        [rate.mul_add(y, u), rate.neg_mul_add(x, v), w]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Scale heights of Vallado's table, km, in its order.
    const SCALE_HEIGHTS: [f64; 28] = [
        7.249, 6.349, 6.682, 7.554, 8.382, 7.714, 6.549, 5.799, 5.382, 5.877, 7.263, 9.473, 12.636, 16.149, 22.523,
        29.740, 37.105, 45.546, 53.628, 53.298, 58.515, 60.828, 63.822, 71.835, 88.667, 124.64, 181.05, 268.00,
    ];

    /// Truth: the density by Vallado's scale heights, at four heights of each interval.
    #[test]
    fn the_density_is_that_of_the_table() {
        let mut worst = 0.0_f64;
        for (index, scale) in SCALE_HEIGHTS.into_iter().enumerate() {
            let [base, density] = TABLE[index];
            let next = TABLE.get(index + 1).map_or(1500.0, |[next, _]| *next);
            for share in [0.0, 0.3, 0.7, 0.999_999] {
                let height = base + share * (next - base);
                let expected = density * libm::exp((base - height) / scale);
                worst = worst.max((tabulated_density(1e3 * height) / expected - 1.0).abs());
            }
        }
        println!("{worst:e}");
        assert!(worst < 2e-3, "{worst:e}");
        assert_eq!(tabulated_density(-1.0), 1.225);
    }

    /// Law: the density falls with the height, without jumps.
    #[test]
    fn the_density_is_continuous() {
        for [height, density] in TABLE {
            assert_eq!(tabulated_density(1e3 * height), density);
            let below = tabulated_density(1e3 * height - 1e-3);
            assert!(height == 0.0 || (below >= density && below / density - 1.0 < 1e-6), "{height}: {below:e}");
        }
    }

    /// Law: in a band that was chosen the density is that of the table, beyond it that of the same exponential; and the switch functions are zero at its
    /// ends, of which the last band has one.
    #[test]
    fn a_band_that_was_chosen_goes_on() {
        let surface = 6.4e6;
        for (height, [base, top]) in [(430e3, [400e3, 450e3]), (1200e3, [1000e3, f64::INFINITY])] {
            let mut air = Air::new(1.0, surface, [0.0; 3]);
            let table = air.density(surface + height);
            air.choose_branches(true, surface + height);
            assert_eq!(air.density(surface + height), table);
            let margins = |height: f64| {
                let mut found = Vec::new();
                air.switches(&[surface + height], &mut |[margin]| found.push(margin));
                found
            };
            assert!(margins(base + 1.0)[0] > 0.0 && margins(base - 1.0)[0] < 0.0);
            assert!(margins(top - 1.0)[1] > 0.0 && (top.is_infinite() || margins(top + 1.0)[1] < 0.0));
            let [low, high] = [base - 2e4, base - 1e4].map(|height| libm::log(air.density(surface + height)));
            let [near, far] = [base + 1e4, base + 2e4].map(|height| libm::log(air.density(surface + height)));
            assert!(((high - low) - (far - near)).abs() < 1e-12, "{low} {high} {near} {far}");
        }
    }

    /// Law: air at the equator moves with the ground, 465 m/s, and a spacecraft in the opposite sense feels the sum.
    #[test]
    fn the_air_turns_with_the_earth() {
        let place =
            OrbitState { position: [6_378_137.0, 0.0, 0.0], velocity: [0.0, -7000.0, 10.0], distance: 6_378_137.0 };
        let relative = Air::relative_velocity(&place);
        assert!((relative[1] + 7465.101).abs() < 1e-3 && relative[0] == 0.0 && relative[2] == 10.0, "{relative:?}");
        let exponential = Air::new(2.0, 6e6, [1e-11, 3e5, 5e4]);
        let found = exponential.density(6.35e6);
        assert!((found / (2e-11 * libm::exp(-1.0)) - 1.0).abs() < 1e-15, "{found:e}");
    }
}
