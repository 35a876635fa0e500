//! The motion relative to a point on a two-body orbit, by Encke's method: [`tide`] in closed form and [`OffsetSeries`] as Taylor coefficients.
//!
//! With O the point on the orbit, d the offset from it and r = O + d, the difference of both pulls is (R. Battin, *An Introduction to the Mathematics
//! and Methods of Astrodynamics*, 1999, section 8.4)
//!
//! ```text
//! tide = -mu/|O|^3 (d + w r),   w = |O|^3/|r|^3 - 1 = (1 + q)^(-3/2) - 1,   q = d . (d + 2 O)/|O|^2
//! ```
//!
//! Nothing cancels: of an offset of metres all digits count, although a distance of 7000 km has its last one at a nanometre.

use super::orbit::OrbitState;
use super::orbit_series::{OrbitSeries, next_of_power};
use crate::math::Real;
use crate::math::vector::{dot, scaled, sum};

/// What gravity accelerates at the offset `offset` (m) more than at `place` on the orbit, F_e, m/s^2; `mu` is the gravitational parameter, m^3/s^2.
#[inline(always)]
pub fn tide<R: Real>(mu: R, place: &OrbitState<R>, offset: [R; 3]) -> [R; 3] {
    let one = mu.splat(1.0);
    let inverse = one / place.distance;
    let square = inverse * inverse;
    let nearer = stronger(dot(offset, twice_and(place.position, offset)) * square);
    let [x, y, z] = sum(offset, scaled(nearer, sum(place.position, offset)));
    scaled(-(mu * (inverse * square)), [x, y, z])
}

/// w = (1 + q)^(-3/2) - 1 = -q (3 + 3 q + q^2)/((1 + u) u), u = (1 + q)^(3/2).
#[inline(always)]
fn stronger<R: Real>(q: R) -> R {
    let number = |value: f64| q.splat(value);
    let ratio = number(1.0) + q;
    let cubed = ratio * ratio.sqrt();
    let polynomial = q.mul_add(q + number(3.0), number(3.0));
    -(q * polynomial) / ((number(1.0) + cubed) * cubed)
}

/// 2 `place` + `offset`.
#[inline(always)]
fn twice_and<R: Real>(place: [R; 3], offset: [R; 3]) -> [R; 3] {
    let two = place[0].splat(2.0);
    core::array::from_fn(|i| two.mul_add(place[i], offset[i]))
}

/// The coefficients of the offset and of what it makes, of one step, in the lanes' units of time.
#[derive(Clone, Debug)]
pub struct OffsetSeries<R> {
    /// Of the orbit from which the offset is.
    orbit: OrbitSeries<R>,
    /// Of d, F_e, m.
    offset: Vec<[R; 3]>,
    /// Of 2 O + d.
    lever: Vec<[R; 3]>,
    /// Of r, m.
    place: Vec<[R; 3]>,
    /// Of 1 + q, the first without the one, and of its power -3/2.
    ratio: Vec<R>,
    power: Vec<R>,
    /// w at the start of the step.
    nearer: R,
    /// Of d + w r.
    stretched: Vec<[R; 3]>,
}

impl<R: Real> OffsetSeries<R> {
    /// Memory for series of order `order`.
    pub fn new(zero: R, order: usize) -> Self {
        let vectors = vec![[zero; 3]; order + 1];
        OffsetSeries {
            orbit: OrbitSeries::new(zero, order),
            offset: vectors.clone(),
            lever: vectors.clone(),
            place: vectors.clone(),
            ratio: vec![zero; order + 1],
            power: vec![zero; order + 1],
            nearer: zero,
            stretched: vectors,
        }
    }

    /// Starts a step where the point on the orbit is at `position` with `velocity` (m per unit of time), at the gravitational parameter `mu` (m^3 per
    /// unit squared).
    #[inline(always)]
    pub fn begin(&mut self, mu: R, position: [R; 3], velocity: [R; 3]) {
        self.orbit.begin(mu, position, velocity);
    }

    /// Coefficient n of the tide, m per unit squared, given that of the offset; call in ascending order of `n`.
    #[inline(always)]
    pub fn extend(&mut self, n: usize, of_offset: [R; 3]) -> [R; 3] {
        let OffsetSeries { orbit, offset, lever, place, ratio, power, nearer, stretched } = self;
        let zero = of_offset[0].zero();
        orbit.extend(n);
        offset[n] = of_offset;
        place[n] = sum(orbit.position()[n], of_offset);
        lever[n] = twice_and(orbit.position()[n], of_offset);
        let mut sum_q = zero;
        for (d, l) in offset[..=n].iter().zip(lever[..=n].iter().rev()) {
            for i in 0..3 {
                sum_q = d[i].mul_add(l[i], sum_q);
            }
        }
        let square = orbit.square();
        // q |O|^2 = d . (d + 2 O), coefficient by coefficient
        for (j, known) in ratio[..n].iter().enumerate() {
            sum_q = known.neg_mul_add(square[n - j], sum_q);
        }
        ratio[n] = sum_q / square[0];
        let of_nearer = if n == 0 {
            *nearer = stronger(ratio[0]);
            power[0] = zero.splat(1.0) + *nearer;
            *nearer
        } else {
            let first = ratio[0];
            ratio[0] = zero.splat(1.0) + first;
            power[n] = next_of_power(-1.5, n, ratio, power);
            ratio[0] = first;
            power[n]
        };
        let mut own = sum(of_offset, scaled(*nearer, place[n]));
        if n > 0 {
            own = sum(own, scaled(of_nearer, place[0]));
        }
        for m in 1..n {
            own = sum(own, scaled(power[m], place[n - m]));
        }
        stretched[n] = own;
        let mut tide = [zero; 3];
        for (pull, own) in orbit.pull()[..=n].iter().zip(stretched[..=n].iter().rev()) {
            for i in 0..3 {
                tide[i] = pull.neg_mul_add(own[i], tide[i]);
            }
        }
        tide
    }

    /// The orbit from which the offset is.
    #[inline(always)]
    pub fn orbit(&self) -> &OrbitSeries<R> {
        &self.orbit
    }

    /// The coefficients of r, m.
    #[inline(always)]
    pub fn place(&self) -> &[[R; 3]] {
        &self.place
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::double_double::DoubleDouble;
    use crate::math::vector::{difference, norm};

    const MU: f64 = 3.986004418e14;

    /// Law: the tide is the difference of two pulls, which double-double has with ten digits to spare, from millimetres to thousands of kilometres.
    #[test]
    fn the_tide_is_a_difference_of_pulls() {
        let position = [4.1e6, -5.2e6, 1.7e6];
        let exact = |v: [f64; 3]| v.map(DoubleDouble::exact);
        let pull = |r: [DoubleDouble; 3]| {
            let square = dot(r, r);
            scaled(-(DoubleDouble::exact(MU) / (square * square.sqrt())), r)
        };
        for (size, direction) in
            [(1e-3, [1.0, 2.0, -1.0]), (10.0, [5.2, 4.1, 0.0]), (1e4, [0.0, 1.0, 3.0]), (2e6, [-1.0, 0.5, 0.5])]
        {
            let offset = scaled(size, direction);
            let place = OrbitState { position, velocity: [0.0; 3], distance: norm(position) };
            let found = tide(MU, &place, offset);
            let expected = difference(pull(sum(exact(position), exact(offset))), pull(exact(position)));
            let off = norm(difference(found, expected.map(|x| x.high)));
            assert!(off < 1e-15 * norm(found), "{size}: {off:e} of {:e}", norm(found));
        }
    }

    /// Law: the first coefficient of the series is the closed form, and the second is its slope along the motion.
    #[test]
    fn the_series_begins_with_the_closed_form() {
        let (position, velocity) = ([4.1e6, -5.2e6, 1.7e6], [3e3, 4e3, 5e3]);
        let (offset, moving) = ([20.0, -7.0, 4.0], [0.3, 0.2, -0.1]);
        let mut series = OffsetSeries::new(0.0, 3);
        series.begin(MU, position, velocity);
        let first = series.extend(0, offset);
        let at = |time: f64| {
            let position = sum(position, scaled(time, velocity));
            let place = OrbitState { position, velocity, distance: norm(position) };
            tide(MU, &place, sum(offset, scaled(time, moving)))
        };
        let closed = at(0.0);
        assert!(norm(difference(first, closed)) < 1e-15 * norm(closed), "{first:?} {closed:?}");
        let second = series.extend(1, moving);
        let slope = scaled(0.5 / 0.01, difference(at(0.01), at(-0.01)));
        assert!(norm(difference(second, slope)) < 1e-9 * norm(slope), "{second:?} {slope:?}");
        let third = series.extend(2, [0.0; 3]);
        // the orbit itself bends, which `at` leaves out: r'' times the gradient
        let bent = |time: f64| {
            let pull = scaled(-MU / (norm(position) * norm(position) * norm(position)), position);
            let position = sum(sum(position, scaled(time, velocity)), scaled(0.5 * time * time, pull));
            let place = OrbitState { position, velocity, distance: norm(position) };
            tide(MU, &place, sum(offset, scaled(time, moving)))
        };
        let second_order = scaled(0.5, difference(sum(bent(1.0), bent(-1.0)), scaled(2.0, bent(0.0))));
        assert!(norm(difference(third, second_order)) < 1e-5 * norm(third), "{third:?} {second_order:?}");
    }
}
