//! [`OrbitSeries`]: Taylor coefficients of an orbit and of powers of the distance, by recurrences.
//!
//! With rho = r . r, s = mu rho^(-3/2): r'' = -s r about a point mass; r'' = -(s + f - g z^2) r - 2 f z e3 about a
//! flattened body ([`super::gravity`]), f = mu k rho^(-5/2), g = 5 mu k rho^(-7/2). Powers of rho (A. Jorba & M. Zou,
//! Experimental Mathematics 14, 2005, section 2.2):
//!
//! ```text
//! (rho^alpha)_n = sum over j < n of (alpha (n - j) - j) (rho^alpha)_j rho_(n-j) / (n rho_0)
//! ```

use super::gravity::Gravity;
use super::orbit_state::OrbitState;
use crate::math::prelude::*;

/// Coefficients of one step, in the lanes' units of time.
#[derive(Clone, Debug)]
pub struct OrbitSeries<R> {
    gravity: Gravity<R>,
    /// r, F_e, m.
    position: Vec<[R; 3]>,
    /// rho.
    square: Vec<R>,
    /// mu rho^(-3/2).
    pull: Vec<R>,
    flattened: Flattened<R>,
}

#[derive(Clone, Debug)]
pub struct Flattened<R> {
    pub five: Vec<R>,
    /// g.
    pub seven: Vec<R>,
    /// z^2.
    pub height: Vec<R>,
    /// s + f - g z^2.
    all: Vec<R>,
}

impl<R: Real> OrbitSeries<R> {
    pub fn new(zero: R, order: usize) -> Self {
        let numbers = || vec![zero; order + 1];
        OrbitSeries {
            gravity: Gravity { mu: zero, oblateness: None },
            position: vec![[zero; 3]; order + 2],
            square: numbers(),
            pull: numbers(),
            flattened: Flattened { five: numbers(), seven: numbers(), height: numbers(), all: numbers() },
        }
    }

    /// Starts at `position` with `velocity` (m per unit of time) in `gravity` (m^3 per unit squared).
    #[inline(always)]
    pub fn begin(&mut self, gravity: Gravity<R>, position: [R; 3], velocity: [R; 3]) {
        self.gravity = gravity;
        self.position[0] = position;
        self.position[1] = velocity;
    }

    /// Computes the coefficients n of rho and its power and n + 2 of r, for ascending `n`.
    #[inline(always)]
    pub fn extend(&mut self, n: usize) {
        let Gravity { mu, oblateness } = self.gravity;
        let zero = mu.zero();
        let OrbitSeries { position, square, pull, flattened, .. } = self;
        square[n] = dot_convolution(&position[..=n], &position[..=n]);
        if n == 0 {
            let inverse = zero.splat(1.0) / square[0].sqrt();
            pull[0] = mu * (inverse * (inverse * inverse));
        } else {
            pull[n] = next_of_power(-1.5, n, square, pull);
        }
        if let Some(k) = oblateness {
            flattened.extend(n, k, position, square, pull);
        }
        let strength: &[R] = if oblateness.is_some() { &flattened.all } else { pull };
        if n + 2 < position.len() {
            let mut sums = minus_convolution(&strength[..=n], &position[..=n]);
            if oblateness.is_some() {
                sums[2] -= zero.splat(2.0) * flattened.along(&position[..=n]);
            }
            position[n + 2] = scaled(zero.splat(1.0) / zero.splat(((n + 1) * (n + 2)) as f64), sums);
        }
    }

    #[inline(always)]
    pub fn gravity(&self) -> Gravity<R> {
        self.gravity
    }

    /// The oblateness terms; undefined about a point mass.
    #[inline(always)]
    pub fn flattened(&self) -> &Flattened<R> {
        &self.flattened
    }

    #[inline(always)]
    pub fn position(&self) -> &[[R; 3]] {
        &self.position
    }

    /// Sets coefficient `n` of a known position and computes that of rho, for ascending `n`.
    #[inline(always)]
    pub fn place(&mut self, n: usize, position: [R; 3]) {
        self.position[n] = position;
        self.square[n] = dot_convolution(&self.position[..=n], &self.position[..=n]);
    }

    /// The coefficients of mu rho^(-3/2), 1 per unit squared.
    #[inline(always)]
    pub fn pull(&self) -> &[R] {
        &self.pull
    }

    #[inline(always)]
    pub fn square(&self) -> &[R] {
        &self.square
    }

    /// The state `within` units after the start of the step; the velocity is per unit.
    #[inline(always)]
    pub fn at(&self, within: R) -> OrbitState<R> {
        let zero = within.zero();
        let (mut position, mut velocity) = ([zero; 3], [zero; 3]);
        for (n, coefficients) in self.position.iter().enumerate().rev() {
            for i in 0..3 {
                // derivative of a product of polynomials: (x p)' = p + x p'
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

impl<R: Real> Flattened<R> {
    /// Computes the coefficients n for the oblateness `k` (m^2) from those of r, rho and s.
    #[inline(always)]
    fn extend(&mut self, n: usize, k: R, position: &[[R; 3]], square: &[R], pull: &[R]) {
        let zero = k.zero();
        if n == 0 {
            let inverse = zero.splat(1.0) / square[0];
            self.five[0] = pull[0] * (k * inverse);
            self.seven[0] = zero.splat(5.0) * self.five[0] * inverse;
        } else {
            self.five[n] = next_of_power(-2.5, n, square, &self.five);
            self.seven[n] = next_of_power(-3.5, n, square, &self.seven);
        }
        let mut height = zero;
        for (a, b) in position[..=n].iter().zip(position[..=n].iter().rev()) {
            height = a[2].mul_add(b[2], height);
        }
        self.height[n] = height;
        let bent = convolution(&self.seven[..=n], &self.height[..=n]);
        self.all[n] = pull[n] + (self.five[n] - bent);
    }

    /// Last coefficient of f z, from those of r.
    #[inline(always)]
    fn along(&self, position: &[[R; 3]]) -> R {
        let mut sum = self.five[0].zero();
        for (f, r) in self.five.iter().zip(position.iter().rev()) {
            sum = f.mul_add(r[2], sum);
        }
        sum
    }
}

/// Last coefficient of the product of two series.
#[inline(always)]
pub fn convolution<R: Real>(a: &[R], b: &[R]) -> R {
    let mut sum = a[0].zero();
    for (a, b) in a.iter().zip(b.iter().rev()) {
        sum = a.mul_add(*b, sum);
    }
    sum
}

/// Last coefficient of the scalar product of two series.
#[inline(always)]
pub fn dot_convolution<R: Real>(a: &[[R; 3]], b: &[[R; 3]]) -> R {
    let mut sum = a[0][0].zero();
    for (a, b) in a.iter().zip(b.iter().rev()) {
        for i in 0..3 {
            sum = a[i].mul_add(b[i], sum);
        }
    }
    sum
}

/// Last coefficient of minus the product of the series of a number and a vector.
#[inline(always)]
pub fn minus_convolution<R: Real>(numbers: &[R], vectors: &[[R; 3]]) -> [R; 3] {
    let mut sums = [numbers[0].zero(); 3];
    for (number, vector) in numbers.iter().zip(vectors.iter().rev()) {
        for i in 0..3 {
            sums[i] = number.neg_mul_add(vector[i], sums[i]);
        }
    }
    sums
}

/// Coefficient `n` > 0 of rho^`alpha`, times any constant, from those of rho and the lower ones.
#[inline(always)]
pub fn next_of_power<R: Real>(alpha: f64, n: usize, square: &[R], power: &[R]) -> R {
    let zero = square[0].zero();
    let mut sum = zero;
    // alpha (n - j) - j, a multiple of one half: exact
    let (mut weight, step) = (zero.splat(alpha * n as f64), zero.splat(alpha + 1.0));
    for (power, square) in power[..n].iter().zip(square[1..=n].iter().rev()) {
        sum = (weight * *power).mul_add(*square, sum);
        weight -= step;
    }
    sum / (square[0] * zero.splat(n as f64))
}
