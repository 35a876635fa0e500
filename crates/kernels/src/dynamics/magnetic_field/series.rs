//! [`FieldSeries`]: Taylor coefficients of the magnetic field along an orbit, by products of series.

use super::coefficients::{HARMONICS, RADIUS, index};
use super::{MagneticField, add_weighed, factors};
use crate::dynamics::earth_rotation::TURNS_PER_SECOND;
use crate::dynamics::orbit_series::{OrbitSeries, next_of_power};
use crate::math::Real;

/// Coefficients of one step, in the lanes' units of time.
#[derive(Clone, Debug)]
pub struct FieldSeries<R> {
    field: MagneticField<R>,
    /// Weights of the harmonics at the date.
    weights: Vec<[R; 6]>,
    /// The Earth's rotation, rad per unit of time.
    rate: R,
    /// Cosine and sine of the Earth's rotation angle.
    turn: Vec<[R; 2]>,
    /// 1/r^2, 1/m^2.
    inverse: Vec<R>,
    /// Position, Earth-fixed, m.
    fixed: Vec<[R; 3]>,
    /// X, Y, Z and (a/r)^2.
    over: Vec<[R; 4]>,
    /// V and W by harmonic: degrees 0 and 1, then those of the list of weights.
    harmonics: Vec<[R; 2]>,
    /// Field, Earth-fixed, T.
    own: Vec<[R; 3]>,
    /// Field, F_e, T.
    series: Vec<[R; 3]>,
}

/// Position of the harmonics of degree `k` and order `j` in `harmonics`.
#[inline(always)]
const fn place(k: usize, j: usize) -> usize {
    k * (k + 1) / 2 + j
}

impl<R: Real> FieldSeries<R> {
    /// Memory for series of order `order`.
    pub fn new(zero: R, order: usize) -> Self {
        let vectors = vec![[zero; 3]; order + 1];
        FieldSeries {
            field: MagneticField::none(zero),
            weights: vec![[zero; 6]; HARMONICS],
            rate: zero,
            turn: vec![[zero; 2]; order + 1],
            inverse: vec![zero; order + 1],
            fixed: vectors.clone(),
            over: vec![[zero; 4]; order + 1],
            harmonics: vec![[zero; 2]; (HARMONICS + 3) * (order + 1)],
            own: vectors.clone(),
            series: vectors,
        }
    }

    /// Starts a step at `time` (s) in a unit of time of `unit` seconds.
    #[inline(always)]
    pub fn begin(&mut self, field: &MagneticField<R>, time: R, unit: R) {
        let zero = time.zero();
        self.field = *field;
        self.rate = zero.splat(TURNS_PER_SECOND * core::f64::consts::TAU) * unit;
        let (sin, cos) = field.turn(time);
        self.turn[0] = [cos, sin];
        for k in 2..=field.degree + 1 {
            for j in 0..=k {
                let mut weights = field.weights(index(k, j));
                if k > 2 {
                    for weight in &mut weights {
                        *weight = *weight * field.higher;
                    }
                }
                self.weights[index(k, j)] = weights;
            }
        }
    }

    /// Coefficient n of the field, F_e, T; in ascending order of `n`, after the orbit's.
    #[inline(always)]
    pub fn extend(&mut self, n: usize, orbit: &OrbitSeries<R>) -> [R; 3] {
        let zero = self.rate.zero();
        let FieldSeries { field, weights, rate, turn, inverse, fixed, over, harmonics, own, series } = self;
        let length = turn.len();
        if n > 0 {
            let per = *rate / zero.splat(n as f64);
            let [cos, sin] = turn[n - 1];
            turn[n] = [-(per * sin), per * cos];
        }
        fixed[n] = rotated(n, turn, orbit.position(), -zero.splat(1.0));
        inverse[n] =
            if n == 0 { zero.splat(1.0) / orbit.square()[0] } else { next_of_power(-1.0, n, orbit.square(), inverse) };
        let radius = zero.splat(RADIUS);
        let mut sums = [zero; 3];
        for m in 0..=n {
            for i in 0..3 {
                sums[i] = fixed[m][i].mul_add(inverse[n - m], sums[i]);
            }
        }
        let [x, y, z] = [radius * sums[0], radius * sums[1], radius * sums[2]];
        over[n] = [x, y, z, radius * (radius * inverse[n])];
        // V_00 = (a^2/r^2)^(1/2)
        harmonics[n] = if n == 0 {
            [over[0][3].sqrt(), zero]
        } else {
            let mut sum = zero;
            for m in 0..n {
                let factor = zero.splat(0.5 * (n - m) as f64 - m as f64);
                sum = (factor * harmonics[m][0]).mul_add(over[n - m][3], sum);
            }
            [sum / (zero.splat(n as f64) * over[0][3]), zero]
        };
        let top = field.degree + 1;
        for j in 0..=top {
            if j > 0 {
                let of = &harmonics[place(j - 1, j - 1) * length..][..=n];
                let (mut v, mut w) = (zero, zero);
                for (m, [of_v, of_w]) in of.iter().enumerate() {
                    let [x, y, ..] = over[n - m];
                    v = x.mul_add(*of_v, y.neg_mul_add(*of_w, v));
                    w = x.mul_add(*of_w, y.mul_add(*of_v, w));
                }
                let factor = zero.splat((2 * j - 1) as f64);
                harmonics[place(j, j) * length + n] = [factor * v, factor * w];
            }
            for k in j + 1..=top {
                // no closures: they may be compiled without vector instructions
                let [along, across] = factors(k, j);
                let (along, across) = (zero.splat(along), zero.splat(across));
                let (mut near, mut far) = ([zero; 2], [zero; 2]);
                let of = &harmonics[place(k - 1, j) * length..][..=n];
                for (m, of) in of.iter().enumerate() {
                    let z = over[n - m][2];
                    for i in 0..2 {
                        near[i] = z.mul_add(of[i], near[i]);
                    }
                }
                if k > j + 1 {
                    let of = &harmonics[place(k - 2, j) * length..][..=n];
                    for (m, of) in of.iter().enumerate() {
                        let square = over[n - m][3];
                        for i in 0..2 {
                            far[i] = square.mul_add(of[i], far[i]);
                        }
                    }
                }
                harmonics[place(k, j) * length + n] =
                    [along * near[0] - across * far[0], along * near[1] - across * far[1]];
            }
        }
        let mut sums = [zero; 3];
        for k in 2..=top {
            for j in 0..=k {
                add_weighed(&mut sums, &weights[index(k, j)], harmonics[place(k, j) * length + n]);
            }
        }
        own[n] = sums;
        series[n] = rotated(n, turn, own, zero.splat(1.0));
        series[n]
    }

    /// The coefficients of the field, F_e, T.
    #[inline(always)]
    pub fn field(&self) -> &[[R; 3]] {
        &self.series
    }
}

/// Coefficient n of `vectors` turned about e3 by the angle of `turn`, in the sense `sense`.
#[inline(always)]
fn rotated<R: Real>(n: usize, turn: &[[R; 2]], vectors: &[[R; 3]], sense: R) -> [R; 3] {
    let zero = sense.zero();
    let [mut x, mut y] = [zero; 2];
    for m in 0..=n {
        let ([cos, sin], [a, b, _]) = (turn[m], vectors[n - m]);
        let sin = sense * sin;
        x = cos.mul_add(a, sin.neg_mul_add(b, x));
        y = sin.mul_add(a, cos.mul_add(b, y));
    }
    [x, y, vectors[n][2]]
}
