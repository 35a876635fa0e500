//! [`MagneticField`]: the Earth's magnetic field by IGRF-14 to degree 13, or its dipole (degree 1, tilted by 9
//! degrees).
//!
//! The field turns with the Earth ([`super::earth_rotation`]) and is that of the date at time zero: secular variation,
//! 0.2 nT per day, is neglected. With X = a x/r^2 etc. and the reference radius a, the harmonics follow from V_00 = a/r
//! (O. Montenbruck & E. Gill, *Satellite Orbits*, 2000, eqs. 3.29 to 3.31):
//!
//! ```text
//! V_jj = (2j - 1) (X V_(j-1)(j-1) - Y W_(j-1)(j-1)),   W_jj = (2j - 1) (X W_(j-1)(j-1) + Y V_(j-1)(j-1))
//! (k - j) V_kj = (2k - 1) Z V_(k-1)j - (k + j - 1) (a/r)^2 V_(k-2)j, and likewise W_kj
//! ```

pub(crate) mod coefficients;
pub mod series;

use fearless_simd::Simd;

use self::coefficients::{DEGREE, MIDDLE, RADIUS, TABLES, Tables, index};
use super::earth_rotation::{TURNS_PER_SECOND, turns_at};
use crate::math::isa::{Isa, Work};
use crate::math::prelude::*;
use crate::math::sine::sin_cos_turns;
use crate::scene::{Epoch, FieldModel, Scene};

/// The field, one run per lane.
#[derive(Clone, Copy, Debug)]
pub struct MagneticField<R> {
    tables: &'static Tables,
    /// Largest degree of any lane.
    degree: usize,
    /// One in lanes with degrees above the first, else zero.
    higher: R,
    /// Years after 2025, and (negative) before; else zero.
    after: R,
    before: R,
    /// Rotation angle of the Earth at time zero, turns.
    turns: R,
}

impl MagneticField<f64> {
    /// The field of `scene`, if any.
    pub fn of(scene: &Scene) -> Option<Self> {
        Some(Self::new(scene.environment.magnetic_field?, scene.orbit.as_ref()?.epoch?))
    }

    /// The field by `model` at `epoch`, within [`FieldModel::YEARS`].
    pub fn new(model: FieldModel, epoch: Epoch) -> Self {
        let (degree, higher) = match model {
            FieldModel::Dipole => (1, 0.0),
            FieldModel::Igrf => (DEGREE, 1.0),
        };
        let since = epoch.decimal_year() - MIDDLE;
        let (after, before) = (since.max(0.0), since.min(0.0));
        MagneticField { tables: &TABLES, degree, higher, after, before, turns: turns_at(epoch) }
    }

    /// Numbers on which it depends.
    pub fn numbers(&self) -> [f64; 4] {
        [self.degree as f64, self.after, self.before, self.turns]
    }

    /// [`MagneticField::at`] by the best instruction set of the processor.
    pub fn at_point(&self, time: f64, position: [f64; 3]) -> [f64; 3] {
        Isa::best().run(AtPoint { field: self, time, position })
    }

    /// Broadcasts to all lanes of `zero`.
    pub fn in_lanes<R: Real>(&self, zero: R) -> MagneticField<R> {
        MagneticField {
            tables: self.tables,
            degree: self.degree,
            higher: zero.splat(self.higher),
            after: zero.splat(self.after),
            before: zero.splat(self.before),
            turns: zero.splat(self.turns),
        }
    }
}

struct AtPoint<'a> {
    field: &'a MagneticField<f64>,
    time: f64,
    position: [f64; 3],
}

impl Work for AtPoint<'_> {
    type Output = [f64; 3];

    #[inline(always)]
    fn run<S: Simd>(self, _simd: S) -> [f64; 3] {
        self.field.at(self.time, self.position)
    }
}

impl<R: Real> MagneticField<R> {
    /// No field.
    pub fn none(zero: R) -> Self {
        MagneticField { tables: &TABLES, degree: 0, higher: zero, after: zero, before: zero, turns: zero }
    }

    /// Copies `own` into lane `lane`.
    pub fn set_lane(&mut self, lane: usize, own: &MagneticField<f64>) {
        self.degree = self.degree.max(own.degree);
        self.higher.set_lane(lane, own.higher);
        self.after.set_lane(lane, own.after);
        self.before.set_lane(lane, own.before);
        self.turns.set_lane(lane, own.turns);
    }

    /// The field at `position` (F_e, m) and `time` (s), F_e, T.
    #[inline(always)]
    pub fn at(&self, time: R, position: [R; 3]) -> [R; 3] {
        let zero = time.zero();
        let (sin, cos) = self.turn(time);
        let [x, y, z] = turned(cos, -sin, position);
        let square = dot(position, position);
        let radius = zero.splat(RADIUS);
        let scale = radius / square;
        let [x, y, z] = scaled(scale, [x, y, z]);
        let near = radius * scale;
        // degree 1, and all others
        let mut fields = [[zero; 3]; 2];
        let mut diagonal = [near.sqrt(), zero];
        let top = self.degree + 1;
        for j in 0..=top {
            if j > 0 {
                let [v, w] = diagonal;
                let factor = zero.splat((2 * j - 1) as f64);
                diagonal = [factor * (x * v - y * w), factor * (x * w + y * v)];
            }
            let (mut before, mut now) = ([zero; 2], diagonal);
            for k in j..=top {
                if k > j {
                    // no closures: they may be compiled without vector instructions
                    let [along, across] = factors(k, j);
                    let (along, across) = (zero.splat(along) * z, zero.splat(across) * near);
                    let next = [along * now[0] - across * before[0], along * now[1] - across * before[1]];
                    (before, now) = (now, next);
                }
                if k > 1 {
                    let weights = self.weights(index(k, j));
                    add_weighed(&mut fields[usize::from(k > 2)], &weights, now);
                }
            }
        }
        let [mut dipole, others] = fields;
        for i in 0..3 {
            dipole[i] += self.higher * others[i];
        }
        turned(cos, sin, dipole)
    }

    #[inline(always)]
    fn turn(&self, time: R) -> (R, R) {
        let turns = time.mul_add(time.splat(TURNS_PER_SECOND), self.turns);
        sin_cos_turns(turns - turns.nearest_integer())
    }

    #[inline(always)]
    fn weights(&self, index: usize) -> [R; 6] {
        let Tables { middle, after, before } = self.tables;
        let mut weights = [self.after.zero(); 6];
        for (i, weight) in weights.iter_mut().enumerate() {
            let of_middle = self.after.splat(middle[index][i]);
            let with_after = self.after.mul_add(self.after.splat(after[index][i]), of_middle);
            *weight = self.before.mul_add(self.before.splat(before[index][i]), with_after);
        }
        weights
    }
}

/// Factors of Z V_(k-1)j and (a/r)^2 V_(k-2)j in V_kj.
#[inline(always)]
fn factors(k: usize, j: usize) -> [f64; 2] {
    let difference = (k - j) as f64;
    [(2 * k - 1) as f64 / difference, (k + j - 1) as f64 / difference]
}

/// Adds the contribution of the harmonics `now`, V and W, to a field.
#[inline(always)]
fn add_weighed<R: Real>(field: &mut [R; 3], weights: &[R; 6], now: [R; 2]) {
    for i in 0..3 {
        field[i] = weights[2 * i].mul_add(now[0], weights[2 * i + 1].mul_add(now[1], field[i]));
    }
}

#[inline(always)]
fn turned<R: Real>(cos: R, sin: R, [x, y, z]: [R; 3]) -> [R; 3] {
    [cos * x - sin * y, sin * x + cos * y, z]
}

/// Upper bound of the field beyond `distance` m, T: 70,000 nT at the reference radius (IGRF-14: 67,000 nT).
pub fn largest(distance: f64) -> f64 {
    let ratio = RADIUS / distance;
    let dipole = ratio * ratio * ratio;
    7e-5 * if ratio > 1.0 { libm::pow(ratio, (DEGREE + 2) as f64) } else { dipole }
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use crate::math::vector::{difference, norm};

    /// Dates, times in s, positions in m, and fields in nT in F_e: `pyIGRF14` 1.0.4 (`calculate.igrf12syn(year, 2, r,
    /// lat, lon)`, same length of years), `ppigrf` 2.1.0 (`igrf_gc(r, colatitude, lon, date)`, interpolated in days: up
    /// to 0.2 nT apart) and its degree 1 (`max_degree=1`), turned to F_e by `gmst06` of pyerfa 2.0.1.5.
    #[expect(clippy::type_complexity, reason = "rows of a table")]
    pub const TRUTH: [(&str, f64, [f64; 3], [f64; 3], [f64; 3], [f64; 3]); 5] = [
        (
            "2026-11-24T00:00:00Z",
            0.0,
            [7e6, 1e5, -2e5],
            [-2_420.534_412_283_717_8, -4_723.863_173_791_567, 19_053.978_206_694_46],
            [-2_420.652_093_001_966_5, -4_723.831_341_247_773, 19_054.019_998_173_746],
            [-5_066.674_952_130_375_5, -730.671_453_172_754_4, 22_322.682_305_041_23],
        ),
        (
            "2026-11-24T00:00:00Z",
            5000.0,
            [-3.1e6, 4.7e6, 4.2e6],
            [17_831.068_764_590_305, -30_036.070_428_607_345, -761.519_585_685_675_7],
            [17_831.059_416_707_867, -30_036.037_649_479, -761.504_552_488_953_8],
            [19_355.557_115_406_027, -23_437.221_052_631_11, 338.677_338_069_963_3],
        ),
        (
            "2022-03-01T06:00:00Z",
            80_000.0,
            [1e5, -2e5, -6.8e6],
            [-11_692.975_904_371_553, -4_042.897_397_240_257_3, -42_561.310_444_524_9],
            [-11_692.980_879_798_828, -4_042.884_884_011_437_4, -42_561.294_226_361_766],
            [-2_382.298_375_718_761_7, -188.824_992_646_329_75, -48_497.940_124_834_76],
        ),
        (
            "2029-12-31T12:00:00Z",
            123.5,
            [2e7, -3e7, 1.5e7],
            [-84.613_403_212_083_55, 98.344_158_273_288_12, 76.020_200_669_814_5],
            [-84.613_403_131_947_34, 98.344_158_305_583_28, 76.020_200_649_774_15],
            [-89.941_901_119_490_55, 98.767_203_564_469_21, 73.107_033_609_320_18],
        ),
        (
            "2020-01-01T00:00:00Z",
            0.0,
            [-4e6, -5e6, 1e6],
            [4_425.157_191_635_203, 6_313.626_661_412_165, 35_864.319_722_200_95],
            [4_425.157_191_635_201, 6_313.626_661_412_161, 35_864.319_722_220_92],
            [4_345.592_901_216_121, 2_428.813_132_082_863, 27_878.646_383_029_18],
        ),
    ];

    pub fn epoch(text: &str) -> Epoch {
        Epoch::parse(text).expect(text)
    }

    /// Law: the field of two independent packages, to the Earth's angle (1e-10), or to 0.2 nT if their dates differ.
    #[test]
    fn the_field_is_that_of_two_packages() {
        for (date, time, position, field, other, dipole) in TRUTH {
            let found = |model| scaled(1e9, MagneticField::new(model, epoch(date)).at(time, position));
            let off = |model, expected| norm(difference(found(model), expected));
            let size = norm(field);
            assert!(off(FieldModel::Igrf, field) < 3e-9 * size, "{date}: {:?} {field:?}", found(FieldModel::Igrf));
            assert!(off(FieldModel::Igrf, other) < 0.2, "{date}: {:?} {other:?}", found(FieldModel::Igrf));
            assert!(off(FieldModel::Dipole, dipole) < 0.2, "{date}: {:?} {dipole:?}", found(FieldModel::Dipole));
            assert!(off(FieldModel::Dipole, field) > 0.02 * size, "{date}: a dipole is not the field");
            assert!(1e-9 * size < largest(norm(position)));
        }
    }
}
