//! [`OrbitInBody`]: Taylor coefficients of the position from the central body in the body frame, and of its products.
//!
//! In the frame B with the rate omega, position r and velocity v on a two-body orbit follow, with 15 products of series
//!
//! ```text
//! r' = v - omega x r        v' = -s r - omega x v        s = mu rho^(-3/2)        rho = r . r
//! ```
//!
//! On a circle s is constant, and with principal axes no squares of r are needed: 12 and 3 products.
//! About a flattened body or near the orbit 32 products turn a position in F_e by the quaternion, q* (x) r (x) q.

use super::effects::within_arcs::MotionSeries;
use super::orbit_series::next_of_power;
use crate::math::prelude::*;

#[derive(Clone, Debug)]
pub struct OrbitInBody<R> {
    /// r, B, m.
    position: Vec<[R; 3]>,
    /// v, B, m per unit, if r follows from it.
    velocity: Vec<[R; 3]>,
    /// s, 1 per unit squared.
    pull: Vec<R>,
    /// r (x) q, with r in F_e, if r is turned.
    turned: Vec<[R; 4]>,
    /// Last coefficients of r_x^2, r_y^2, r_z^2, r_y r_z, r_z r_x, r_x r_y.
    products: [R; 6],
    /// rho, m^2.
    square: Vec<R>,
    /// One in lanes with constant s, else zero.
    circle: R,
    /// True if s is constant in all lanes.
    is_round: bool,
    /// True if B is principal in all lanes.
    is_principal: bool,
}

impl<R: Real> OrbitInBody<R> {
    pub fn new(zero: R, order: usize) -> Self {
        let (vectors, numbers) = (vec![[zero; 3]; order + 1], vec![zero; order + 1]);
        OrbitInBody {
            position: vectors.clone(),
            velocity: vectors,
            pull: numbers.clone(),
            turned: vec![[zero; 4]; order + 1],
            products: [zero; 6],
            square: numbers,
            circle: zero,
            is_round: false,
            is_principal: false,
        }
    }

    /// Starts a step along `motion` for the levers of `inertia`.
    #[inline(always)]
    pub fn begin(&mut self, inertia: &[[R; 3]; 3], motion: &MotionSeries<R>) {
        let zero = self.circle.zero();
        self.circle = if motion.is_on_two_body_orbit() { motion.circle } else { zero };
        self.is_round = !self.circle.lt(zero.splat(1.0)).any();
        let [[_, xy, xz], [.., yz], _] = *inertia;
        self.is_principal = !zero.lt(xy.abs() + (xz.abs() + yz.abs())).any();
    }

    /// True if s is constant in all lanes.
    #[inline(always)]
    pub fn is_round(&self) -> bool {
        self.is_round
    }

    /// Computes the coefficients n from those of the motion, for ascending `n`.
    #[inline(always)]
    pub fn extend(&mut self, n: usize, motion: &MotionSeries<R>) {
        if motion.is_on_two_body_orbit() {
            self.follow(n, motion);
        } else {
            self.turn(n, motion);
        }
        let position = &self.position[..=n];
        if self.is_round && n > 0 {
            self.products = if self.is_principal { mixed_products(position) } else { products(position) };
            return;
        }
        self.products = products(position);
        let [xx, yy, zz, ..] = self.products;
        let Self { square, pull, circle, .. } = self;
        square[n] = xx + (yy + zz);
        if n == 0 {
            // from F_e: an idle lane has no attitude, and its distance must still be positive
            let [start, ..] = motion.orbit.position() else { return };
            square[0] = dot(*start, *start);
            let inverse = xx.splat(1.0) / square[0].sqrt();
            pull[0] = motion.reference().gravity().mu * (inverse * (inverse * inverse));
        } else {
            let zero = xx.zero();
            pull[n] = R::select(zero.lt(*circle), zero, next_of_power(-1.5, n, square, pull));
        }
    }

    /// r and v by their equations in B.
    #[inline(always)]
    fn follow(&mut self, n: usize, motion: &MotionSeries<R>) {
        let Self { position, velocity, pull, .. } = self;
        if n == 0 {
            let [start, speed, ..] = motion.orbit.position() else { return };
            let c_eb = dcm_from_quaternion(motion.attitude[0]);
            position[0] = transposed_product(c_eb, *start);
            velocity[0] = transposed_product(c_eb, *speed);
            return;
        }
        let zero = pull[0].zero();
        let (mut of_position, mut of_velocity) = (velocity[n - 1], scaled(-pull[0], position[n - 1]));
        let later = position[..n].iter().rev().zip(velocity[..n].iter().rev());
        for (rate, (r, v)) in motion.rate[..n].iter().zip(later) {
            of_position = minus_cross(*rate, *r, of_position);
            of_velocity = minus_cross(*rate, *v, of_velocity);
        }
        if !self.is_round {
            for (pull, r) in pull[1..n].iter().zip(position[..n - 1].iter().rev()) {
                for i in 0..3 {
                    of_velocity[i] = pull.neg_mul_add(r[i], of_velocity[i]);
                }
            }
        }
        let share = zero.splat(1.0) / zero.splat(n as f64);
        position[n] = scaled(share, of_position);
        velocity[n] = scaled(share, of_velocity);
    }

    /// r by the attitude: the vector part of q* (x) r (x) q.
    #[inline(always)]
    fn turn(&mut self, n: usize, motion: &MotionSeries<R>) {
        let MotionSeries { attitude, orbit, .. } = motion;
        let zero = attitude[0][0].zero();
        let (mut of_turned, mut of_position) = ([zero; 4], [zero; 4]);
        for m in 0..=n {
            let [x, y, z] = orbit.position()[m];
            of_turned = added(of_turned, hamilton([zero, x, y, z], attitude[n - m]));
        }
        self.turned[n] = of_turned;
        for (q, turned) in attitude[..=n].iter().zip(self.turned[..=n].iter().rev()) {
            of_position = added(of_position, hamilton(conjugate(*q), *turned));
        }
        self.position[n] = [of_position[1], of_position[2], of_position[3]];
    }

    /// Coefficient n of s/rho, from the lower ones.
    #[inline(always)]
    pub fn pull_over_square(&self, n: usize, before: &[R]) -> R {
        let Self { pull, square, .. } = self;
        let mut left = pull[n];
        for (quotient, square) in before[..n].iter().zip(square[1..=n].iter().rev()) {
            left = quotient.neg_mul_add(*square, left);
        }
        let quotient = left / square[0];
        if n == 0 { quotient } else { R::select(left.zero().lt(self.circle), left.zero(), quotient) }
    }

    /// Last coefficient of r x (J r) for a symmetric `inertia` in B.
    #[inline(always)]
    pub fn lever(&self, inertia: &[[R; 3]; 3]) -> [R; 3] {
        let [xx, yy, zz, yz, zx, xy] = self.products;
        let [[j_xx, j_xy, j_xz], [_, j_yy, j_yz], [.., j_zz]] = *inertia;
        [
            (j_zz - j_yy).mul_add(yz, j_yz.mul_add(yy - zz, j_xz.mul_add(xy, -(j_xy * zx)))),
            (j_xx - j_zz).mul_add(zx, j_xz.mul_add(zz - xx, j_xy.mul_add(yz, -(j_yz * xy)))),
            (j_yy - j_xx).mul_add(xy, j_xy.mul_add(xx - yy, j_yz.mul_add(zx, -(j_xz * yz)))),
        ]
    }
}

/// Last coefficients of the products of the components of r.
#[inline(always)]
fn products<R: Real>(r: &[[R; 3]]) -> [R; 6] {
    let zero = r[0][0].zero();
    let (mut squares, mut others) = ([zero; 3], [zero; 3]);
    for (a, b) in r.iter().zip(r.iter().rev()) {
        for i in 0..3 {
            squares[i] = a[i].mul_add(b[i], squares[i]);
        }
        others = [a[1].mul_add(b[2], others[0]), a[2].mul_add(b[0], others[1]), a[0].mul_add(b[1], others[2])];
    }
    let [[xx, yy, zz], [yz, zx, xy]] = [squares, others];
    [xx, yy, zz, yz, zx, xy]
}

/// Those of unlike components of r, with zero in place of the squares.
#[inline(always)]
fn mixed_products<R: Real>(r: &[[R; 3]]) -> [R; 6] {
    let zero = r[0][0].zero();
    let [mut yz, mut zx, mut xy] = [zero; 3];
    for (a, b) in r.iter().zip(r.iter().rev()) {
        [yz, zx, xy] = [a[1].mul_add(b[2], yz), a[2].mul_add(b[0], zx), a[0].mul_add(b[1], xy)];
    }
    [zero, zero, zero, yz, zx, xy]
}

#[inline(always)]
fn added<R: Real>(a: [R; 4], b: [R; 4]) -> [R; 4] {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2], a[3] + b[3]]
}
