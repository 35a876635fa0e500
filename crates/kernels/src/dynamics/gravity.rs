//! [`Gravity`]: the pull of a central body, and its difference (tide) between two points.
//!
//! With k = (3/2) J2 R^2 for a body that is flattened along e3, zero for a point mass (D. Vallado, *Fundamentals of
//! Astrodynamics and Applications*, 2013, (8-29) and (9-39)):
//!
//! ```text
//! a = -mu/|r|^3 (1 + k/|r|^2 (1 - 5 z^2/|r|^2)) r - 2 mu k z/|r|^5 e3
//! U = mu/|r| + mu k (1/3 - z^2/|r|^2)/|r|^3,   a = grad U
//! ```
//!
//! The tide is a(O + d) - a(O), r = O + d (R. Battin, *An Introduction to the Mathematics and Methods of
//! Astrodynamics*, 1999, section 8.4). With q = d . (d + 2 O)/|O|^2 and w_n = (|O|/|r|)^n - 1 = (1 + q)^(-n/2) - 1:
//!
//! ```text
//! tide = -mu/|O|^3 (d + w3 r) - mu k/|O|^5 (s + 2 s_z e3) + 5 mu k/|O|^7 (O_z^2 d + (d_z (d_z + 2 O_z) + w7 r_z^2) r),
//! s = d + w5 r
//! ```
//!
//! No terms cancel: an offset of metres keeps all its digits.

use super::orbit_state::OrbitState;
use crate::math::prelude::*;
use crate::scene::Orbit;

/// Gravity of a central body, one run per lane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gravity<R> {
    /// Gravitational parameter, m^3/s^2.
    pub mu: R,
    /// k, m^2; `None` if the bodies of all lanes are point masses.
    pub oblateness: Option<R>,
}

impl<R: Real> Gravity<R> {
    /// Converts to a unit of time of `unit` seconds.
    #[inline(always)]
    pub fn in_unit(&self, unit: R) -> Self {
        Gravity { mu: self.mu * (unit * unit), oblateness: self.oblateness }
    }

    /// Acceleration at `position` (F_e, m), `distance` from the centre, m/s^2.
    #[inline(always)]
    pub fn acceleration(&self, position: [R; 3], distance: R) -> [R; 3] {
        let pull = self.mu / (distance * distance * distance);
        let mut all = scaled(-pull, position);
        if let Some(k) = self.oblateness {
            let number = |value: f64| distance.splat(value);
            let [_, _, z] = position;
            let share = k / (distance * distance);
            let height = z / distance;
            let more = number(5.0).neg_mul_add(height * height, number(1.0));
            all = sum(all, scaled(-(pull * share * more), position));
            all[2] -= number(2.0) * pull * share * z;
        }
        all
    }

    /// The oblateness term of U at `place`, J/kg; `None` for a point mass.
    #[inline(always)]
    pub fn potential_of_oblateness(&self, place: &OrbitState<R>) -> Option<R> {
        let k = self.oblateness?;
        let distance = place.distance;
        let height = place.position[2] / distance;
        let share = height.neg_mul_add(height, distance.splat(1.0 / 3.0));
        Some(self.mu * k * share / (distance * distance * distance))
    }

    /// Work on 1 kg from `start` to `place`, J.
    #[inline(always)]
    pub fn work(&self, start: &OrbitState<R>, place: &OrbitState<R>) -> R {
        let mut work = self.mu * ((start.distance - place.distance) / (start.distance * place.distance));
        if let (Some(before), Some(now)) = (self.potential_of_oblateness(start), self.potential_of_oblateness(place)) {
            work += now - before;
        }
        work
    }

    /// Work on `mass` kilograms from `start` to `place`, J.
    #[inline(always)]
    pub fn work_on(&self, mass: R, start: &OrbitState<R>, place: &OrbitState<R>) -> R {
        Gravity { mu: mass * self.mu, ..*self }.work(start, place)
    }

    /// Acceleration at `place` + `offset` (m) minus that at `place`, F_e, m/s^2.
    #[inline(always)]
    pub fn tide(&self, place: &OrbitState<R>, offset: [R; 3]) -> [R; 3] {
        let number = |value: f64| self.mu.splat(value);
        let inverse = number(1.0) / place.distance;
        let square = inverse * inverse;
        let q = dot(offset, twice_and(place.position, offset)) * square;
        let nearer = stronger(q);
        let position = sum(place.position, offset);
        let pull = self.mu * (inverse * square);
        let mut all = scaled(-pull, sum(offset, scaled(nearer, position)));
        if let Some(k) = self.oblateness {
            let [w5, w7] = stronger_powers(q, nearer);
            let five = pull * (k * square);
            let stretched = sum(offset, scaled(w5, position));
            let ([_, _, d], [_, _, o], [_, _, z]) = (offset, place.position, position);
            let change = (w7 * z).mul_add(z, d * number(2.0).mul_add(o, d));
            let seven = number(5.0) * five * square;
            let bent = sum(scaled(o * o, offset), scaled(change, position));
            all = sum(all, sum(scaled(-five, stretched), scaled(seven, bent)));
            all[2] -= number(2.0) * five * stretched[2];
        }
        all
    }
}

impl Gravity<f64> {
    /// Gravity of the central body of `orbit`.
    pub fn of(orbit: &Orbit) -> Self {
        Gravity { mu: orbit.mu, oblateness: orbit.oblateness() }
    }

    /// Broadcasts to all lanes of `zero`.
    #[inline(always)]
    pub fn in_lanes<R: Real>(&self, zero: R) -> Gravity<R> {
        Gravity { mu: zero.splat(self.mu), oblateness: self.oblateness.map(|k| zero.splat(k)) }
    }
}

impl<R: Real> Gravity<R> {
    /// Copies `own` into lane `lane`.
    #[inline(always)]
    pub fn set_lane(&mut self, lane: usize, own: &Gravity<f64>) {
        self.mu.set_lane(lane, own.mu);
        if own.oblateness.is_some() || self.oblateness.is_some() {
            let zero = self.mu.zero();
            self.oblateness.get_or_insert(zero).set_lane(lane, own.oblateness.unwrap_or(0.0));
        }
    }
}

/// w3 = (1 + q)^(-3/2) - 1 = -q (3 + 3 q + q^2)/((1 + u) u), u = (1 + q)^(3/2).
#[inline(always)]
pub(super) fn stronger<R: Real>(q: R) -> R {
    let number = |value: f64| q.splat(value);
    let ratio = number(1.0) + q;
    let cubed = ratio * ratio.sqrt();
    let polynomial = q.mul_add(q + number(3.0), number(3.0));
    -(q * polynomial) / ((number(1.0) + cubed) * cubed)
}

/// w5 and w7 from q and w3.
#[inline(always)]
pub(super) fn stronger_powers<R: Real>(q: R, w3: R) -> [R; 2] {
    // 1/(1 + q) - 1
    let w2 = -(q / (q.splat(1.0) + q));
    let w5 = w3.mul_add(w2, w3 + w2);
    [w5, w5.mul_add(w2, w5 + w2)]
}

#[inline(always)]
pub(super) fn twice_and<R: Real>(place: [R; 3], offset: [R; 3]) -> [R; 3] {
    let two = place[0].splat(2.0);
    core::array::from_fn(|i| two.mul_add(place[i], offset[i]))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::double_double::DoubleDouble;

    fn gravities() -> [Gravity<f64>; 3] {
        let k = 1.5 * 1.08262668e-3 * 6_378_137.0 * 6_378_137.0;
        [None, Some(k), Some(100.0 * k)].map(|oblateness| Gravity { mu: 3.986004418e14, oblateness })
    }

    /// Law: the tide is the difference of two pulls in double-double, from millimetres to thousands of kilometres.
    #[test]
    fn the_tide_is_a_difference_of_pulls() {
        for gravity in gravities() {
            for position in [[4.1e6, -5.2e6, 1.7e6], [7e6, 0.0, 0.0], [1e5, 2e5, -6.9e6]] {
                let exact = |v: [f64; 3]| v.map(DoubleDouble::exact);
                let pull =
                    |r: [DoubleDouble; 3]| gravity.in_lanes(DoubleDouble::exact(0.0)).acceleration(r, dot(r, r).sqrt());
                for (size, direction) in
                    [(1e-3, [1.0, 2.0, -1.0]), (10.0, [5.2, 4.1, 0.0]), (1e4, [0.0, 1.0, 3.0]), (2e6, [-1.0, 0.5, 0.5])]
                {
                    let offset = scaled(size, direction);
                    let found = gravity.tide(&OrbitState::at_rest(position), offset);
                    let expected = difference(pull(sum(exact(position), exact(offset))), pull(exact(position)));
                    let off = norm(difference(found, expected.map(|x| x.high)));
                    assert!(off < 4e-15 * norm(found), "{size}: {off:e} of {:e}", norm(found));
                }
            }
        }
    }
}
