//! [`OrbitSeries`]: Taylor coefficients of a two-body orbit by recurrences, and of powers of the distance.
//!
//! With rho = r . r and s = mu rho^(-3/2): r'' = -s r, and for any power alpha the coefficients of rho^alpha follow from those of rho
//! (A. Jorba & M. Zou, Experimental Mathematics 14, 2005, section 2.2):
//!
//! ```text
//! (rho^alpha)_n = sum over j < n of (alpha (n - j) - j) (rho^alpha)_j rho_(n-j) / (n rho_0)
//! ```

use super::orbit::OrbitState;
use crate::math::Real;
use crate::math::vector::{norm, scaled};

/// The coefficients of one step, in the lanes' units of time.
#[derive(Clone, Debug)]
pub struct OrbitSeries<R> {
    mu: R,
    /// Of r, F_e, m.
    position: Vec<[R; 3]>,
    /// Of rho.
    square: Vec<R>,
    /// Of mu rho^(-3/2).
    pull: Vec<R>,
}

impl<R: Real> OrbitSeries<R> {
    /// Memory for series of order `order`.
    pub fn new(zero: R, order: usize) -> Self {
        OrbitSeries {
            mu: zero,
            position: vec![[zero; 3]; order + 2],
            square: vec![zero; order + 1],
            pull: vec![zero; order + 1],
        }
    }

    /// Starts at `position` with `velocity` (m per unit of time), at the gravitational parameter `mu` (m^3 per unit squared).
    #[inline(always)]
    pub fn begin(&mut self, mu: R, position: [R; 3], velocity: [R; 3]) {
        self.mu = mu;
        self.position[0] = position;
        self.position[1] = velocity;
    }

    /// Computes the coefficients n of rho and its power and n + 2 of r; call in ascending order of `n`.
    #[inline(always)]
    pub fn extend(&mut self, n: usize) {
        let zero = self.mu.zero();
        let OrbitSeries { mu, position, square, pull } = self;
        square[n] = product_with_itself(&position[..=n]);
        if n == 0 {
            let inverse = zero.splat(1.0) / square[0].sqrt();
            pull[0] = *mu * (inverse * (inverse * inverse));
        } else {
            pull[n] = next_of_power(-1.5, n, square, pull);
        }
        if n + 2 < position.len() {
            let mut sums = [zero; 3];
            for (s, r) in pull[..=n].iter().zip(position[..=n].iter().rev()) {
                for i in 0..3 {
                    sums[i] = s.neg_mul_add(r[i], sums[i]);
                }
            }
            position[n + 2] = scaled(zero.splat(1.0) / zero.splat(((n + 1) * (n + 2)) as f64), sums);
        }
    }

    /// The coefficients of r, m.
    #[inline(always)]
    pub fn position(&self) -> &[[R; 3]] {
        &self.position
    }

    /// Sets the coefficient `n` of a position that is known, and computes that of rho; call in ascending order of `n`.
    #[inline(always)]
    pub fn place(&mut self, n: usize, position: [R; 3]) {
        self.position[n] = position;
        self.square[n] = product_with_itself(&self.position[..=n]);
    }

    /// The coefficients of mu rho^(-3/2), 1 per unit squared.
    #[inline(always)]
    pub fn pull(&self) -> &[R] {
        &self.pull
    }

    /// The coefficients of rho, m^2.
    #[inline(always)]
    pub fn square(&self) -> &[R] {
        &self.square
    }

    /// The state `within` units of time after the start of the step; the velocity is per unit.
    #[inline(always)]
    pub fn at(&self, within: R) -> OrbitState<R> {
        let zero = within.zero();
        let (mut position, mut velocity) = ([zero; 3], [zero; 3]);
        for (n, coefficients) in self.position.iter().enumerate().rev() {
            for i in 0..3 {
                // of a product of polynomials: (x p)' = p + x p'
                velocity[i] = if n == 0 {
                    velocity[i]
                } else {
                    velocity[i].mul_add(within, zero.splat(n as f64) * coefficients[i])
                };
                position[i] = position[i].mul_add(within, coefficients[i]);
            }
        }
        OrbitState { position, velocity, distance: norm(position) }
    }
}

/// The last coefficient of r . r, from those of r.
#[inline(always)]
fn product_with_itself<R: Real>(position: &[[R; 3]]) -> R {
    let mut sum = position[0][0].zero();
    for (a, b) in position.iter().zip(position.iter().rev()) {
        for i in 0..3 {
            sum = a[i].mul_add(b[i], sum);
        }
    }
    sum
}

/// Coefficient `n` > 0 of rho^`alpha`, times any constant, from the coefficients of rho and those before.
#[inline(always)]
pub fn next_of_power<R: Real>(alpha: f64, n: usize, square: &[R], power: &[R]) -> R {
    let zero = square[0].zero();
    let mut sum = zero;
    for j in 0..n {
        let weight = zero.splat(alpha * (n - j) as f64 - j as f64);
        sum = (weight * power[j]).mul_add(square[n - j], sum);
    }
    sum / (square[0] * zero.splat(n as f64))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dynamics::orbit::KeplerOrbit;
    use crate::math::vector::difference;
    use crate::scene::Orbit;

    /// Law: the series of an orbit is its closed form, up to a twelfth of a period ahead of a circle and of an ellipse.
    #[test]
    fn the_series_is_the_closed_form() {
        const MU: f64 = 3.986004418e14;
        for speed in [1.0, 1.15] {
            let scene = Orbit {
                mu: MU,
                position: [7e6, 1e6, -2e5],
                velocity: [100.0, speed * 7400.0, 900.0],
                body_radius: 0.0,
                epoch: None,
            };
            let closed = KeplerOrbit::new(&scene);
            // a unit of time of 512 s
            let unit = 512.0;
            let mut series = OrbitSeries::new(0.0, 30);
            series.begin(MU * unit * unit, scene.position, scaled(unit, scene.velocity));
            (0..30).for_each(|n| series.extend(n));
            for time in [0.0, 100.0, 400.0, 500.0] {
                let (found, expected) = (series.at(time / unit), closed.state(time));
                let off = norm(difference(found.position, expected.position)) / expected.distance;
                assert!(off < 4e-15, "{speed} {time}: {off:e}");
                let velocity = scaled(1.0 / unit, found.velocity);
                let off = norm(difference(velocity, expected.velocity)) / norm(expected.velocity);
                assert!(off < 1e-14, "{speed} {time}: {off:e}");
            }
        }
    }
}
