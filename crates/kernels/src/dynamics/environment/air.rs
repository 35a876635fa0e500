//! [`Air`]: atmospheric density by height, from a table or an exponential, and the velocity relative to the air.
//!
//! Between two heights of an [`AirTable`] the density is exponential; the outermost layers extend beyond the table.
//! [`AirTable::VALLADO`]: D. Vallado, *Fundamentals of Astrodynamics and Applications*, 4th ed., 2013, table 8-4 (US
//! Standard Atmosphere 1976 up to 25 km, CIRA-72 above), without its rounded scale heights, by which the density would
//! jump by up to 0.14% between layers.

use super::{EARTH_RATE, each_lane};
use crate::dynamics::orbit_state::OrbitState;
use crate::math::lanes::WIDEST;
use crate::math::power::exp2;
use crate::math::vector::{lane_of, set_lanes};
use crate::math::{Mask, Real};
use crate::scene::EnvironmentInput;

/// Heights with known densities; the density never rises with height.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AirTable {
    /// Heights above the Earth's surface, m, ascending; two or more.
    pub heights: &'static [f64],
    /// The density at each, kg/m^3.
    pub densities: &'static [f64],
}

/// Density a scale height above the last height of Vallado's table, kg/m^3.
const OUTERMOST: f64 = 3.019e-15 / core::f64::consts::E;

/// Unit of height in the switch functions of the layers, km.
pub(crate) const SWITCH_UNIT: f64 = 100.0;

/// A layer: base and thickness, km; density at its base, kg/m^3; slope of the binary logarithm of the density, 1/km;
/// for base and top, infinity if the layer extends beyond.
type Layer<R> = [R; 6];

impl AirTable {
    /// Vallado's table, continued above 1000 km by its scale height of 268 km.
    pub const VALLADO: AirTable = AirTable {
        heights: &[
            0.0, 25e3, 30e3, 40e3, 50e3, 60e3, 70e3, 80e3, 90e3, 100e3, 110e3, 120e3, 130e3, 140e3, 150e3, 180e3,
            200e3, 250e3, 300e3, 350e3, 400e3, 450e3, 500e3, 600e3, 700e3, 800e3, 900e3, 1000e3, 1268e3,
        ],
        densities: &[
            1.225, 3.899e-2, 1.774e-2, 3.972e-3, 1.057e-3, 3.206e-4, 8.770e-5, 1.905e-5, 3.396e-6, 5.297e-7, 9.661e-8,
            2.438e-8, 8.484e-9, 3.845e-9, 2.070e-9, 5.464e-10, 2.789e-10, 7.248e-11, 2.418e-11, 9.518e-12, 3.725e-12,
            1.585e-12, 6.967e-13, 1.454e-13, 3.614e-14, 1.170e-14, 5.245e-15, 3.019e-15, OUTERMOST,
        ],
    };

    /// The table of `environment`, by default Vallado's.
    pub fn of(environment: &EnvironmentInput) -> Self {
        match (environment.air_heights_m, environment.air_densities_kg_m3) {
            (Some(heights), Some(densities)) => AirTable { heights, densities },
            _ => Self::VALLADO,
        }
    }

    /// Density at `height` m above the surface, kg/m^3.
    pub fn density(&self, height: f64) -> f64 {
        density_in(&self.layer_at(height), height * 1e-3)
    }

    fn layer_at(&self, height: f64) -> Layer<f64> {
        let km = |height: f64| height / 1e3;
        let last = self.heights.len() - 2;
        let below = self.heights.partition_point(|base| km(*base) <= height * 1e-3);
        let layer = below.saturating_sub(1).min(last);
        let base = km(self.heights[layer]);
        let [density, thinner] = [self.densities[layer], self.densities[layer + 1]];
        let beyond = |is_outermost: bool| if is_outermost { f64::INFINITY } else { 0.0 };
        let thickness = km(self.heights[layer + 1]) - base;
        let slope = libm::log2(thinner / density) / thickness;
        [base, thickness, density, slope, beyond(layer == 0), beyond(layer == last)]
    }
}

/// Density of a layer at a height in km, extrapolated outside the layer.
#[inline(always)]
fn density_in<R: Real>([base, _, density, slope, ..]: &Layer<R>, height: R) -> R {
    *density * exp2((height - *base) * *slope)
}

/// The Earth's atmosphere, one run per lane.
#[derive(Clone, Copy, Debug)]
pub struct Air<R> {
    /// Density scale.
    pub scale: R,
    /// Radius of the Earth, m.
    pub surface: R,
    tables: [AirTable; WIDEST],
    /// Chosen layer of the table; its thickness is zero before the choice.
    layer: Layer<R>,
}

impl<R: Real> Air<R> {
    /// No air.
    pub fn none(zero: R) -> Self {
        let tables = [AirTable::VALLADO; WIDEST];
        Air { scale: zero, surface: zero, tables, layer: [zero; 6] }
    }

    /// Copies `air` into lane `lane`.
    pub fn set_lane(&mut self, lane: usize, air: &Air<f64>) {
        self.scale.set_lane(lane, air.scale);
        self.surface.set_lane(lane, air.surface);
        self.tables[lane] = air.tables[0];
        set_lanes(&mut self.layer, lane, &air.layer);
    }

    /// Chooses the layer in the lanes `lanes` at `distance` m from the Earth's centre.
    #[inline(always)]
    pub fn choose_branches(&mut self, lanes: R::Mask, distance: R) {
        let height = distance - self.surface;
        for lane in (0..R::LANES).filter(|lane| lanes.test(*lane)) {
            let (km, [base, thickness, .., below, above]) = (height.lane(lane) * 1e-3, lane_of(&self.layer, lane));
            // a layer extends to its top
            if !(base <= km + below && km < base + thickness + above) {
                set_lanes(&mut self.layer, lane, &self.tables[lane].layer_at(height.lane(lane)));
            }
        }
    }

    /// Calls `visit` with the switch functions of both ends of the layer at `M` distances, m.
    #[inline(always)]
    pub fn switches<const M: usize>(&self, distances: &[R; M], visit: &mut impl FnMut([R; M])) {
        let number = |value: f64| self.scale.splat(value);
        let [base, thickness, .., below_it, above_it] = self.layer;
        let (mut above, mut below) = (*distances, *distances);
        for (above, below) in above.iter_mut().zip(&mut below) {
            let since = (*above - self.surface).mul_add(number(1e-3), -base);
            let left = thickness - since;
            *above = since.mul_add(number(1.0 / SWITCH_UNIT), below_it);
            *below = left.mul_add(number(1.0 / SWITCH_UNIT), above_it);
        }
        visit(above);
        visit(below);
    }

    /// Density at `distance` m from the Earth's centre, kg/m^3.
    #[inline(always)]
    pub fn density(&self, distance: R) -> R {
        let height = distance - self.surface;
        let density = density_in(&self.layer, height * height.splat(1e-3));
        let chosen = height.zero().lt(self.layer[1]);
        let by_table = match (!chosen).any() {
            true => each_lane([height], |lane, [height]| self.tables[lane].density(height)),
            false => density,
        };
        self.scale * R::select(chosen, density, by_table)
    }

    /// Velocity relative to air that rotates with the Earth, F_e, m/s.
    #[inline(always)]
    pub fn relative_velocity(place: &OrbitState<R>) -> [R; 3] {
        let [x, y, _] = place.position;
        let rate = x.splat(EARTH_RATE);
        let [u, v, w] = place.velocity;
        [rate.mul_add(y, u), rate.neg_mul_add(x, v), w]
    }
}

impl Air<f64> {
    /// Air above a surface of radius `surface` m, its density times `scale`: by `table`, of which no layer is chosen,
    /// or exponential, with density at the base (kg/m^3), height of the base and scale height (m), if that is not zero.
    pub fn new(scale: f64, surface: f64, [density, base, scale_height]: [f64; 3], table: AirTable) -> Self {
        let infinite = f64::INFINITY;
        let slope = -core::f64::consts::LOG2_E / (1e-3 * scale_height);
        let layer = match scale_height > 0.0 {
            true => [1e-3 * base, infinite, density, slope, infinite, infinite],
            false => [0.0; 6],
        };
        Air { scale, surface, tables: [table; WIDEST], layer }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SCALE_HEIGHTS: [f64; 28] = [
        7.249, 6.349, 6.682, 7.554, 8.382, 7.714, 6.549, 5.799, 5.382, 5.877, 7.263, 9.473, 12.636, 16.149, 22.523,
        29.740, 37.105, 45.546, 53.628, 53.298, 58.515, 60.828, 63.822, 71.835, 88.667, 124.64, 181.05, 268.00,
    ];

    /// Truth: the density by Vallado's scale heights, at four heights of each interval.
    #[test]
    fn the_density_is_that_of_the_table() {
        let mut worst = 0.0_f64;
        for (index, scale) in SCALE_HEIGHTS.into_iter().enumerate() {
            let [base, density] = vallado(index);
            let next = if index == 27 { 1500.0 } else { vallado(index + 1)[0] };
            for share in [0.0, 0.3, 0.7, 0.999_999] {
                let height = base + share * (next - base);
                let expected = density * libm::exp((base - height) / scale);
                worst = worst.max((AirTable::VALLADO.density(1e3 * height) / expected - 1.0).abs());
            }
        }
        assert!(worst < 2e-3, "{worst:e}");
    }

    fn vallado(index: usize) -> [f64; 2] {
        [AirTable::VALLADO.heights[index] / 1e3, AirTable::VALLADO.densities[index]]
    }
}
