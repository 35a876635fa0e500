//! [`OffsetSeries`]: motion relative to a point on an orbit by Encke's method, from Taylor coefficients of the tide
//! ([`super::gravity`]).

use super::gravity::{Gravity, stronger, stronger_powers, twice_and};
use super::orbit_series::{OrbitSeries, convolution, dot_convolution, minus_convolution, next_of_power};
use crate::math::prelude::*;

/// Coefficients of the offset and its products in one step, in the lanes' units of time.
#[derive(Clone, Debug)]
pub struct OffsetSeries<R> {
    orbit: OrbitSeries<R>,
    /// d, F_e, m.
    offset: Vec<[R; 3]>,
    /// 2 O + d.
    lever: Vec<[R; 3]>,
    /// r, m.
    place: Vec<[R; 3]>,
    /// 1 + q (without the one in the first coefficient), and its power -3/2.
    ratio: Vec<R>,
    power: Vec<R>,
    /// w at the start of the step.
    nearer: R,
    /// d + w r.
    stretched: Vec<[R; 3]>,
    flattened: Flattened<R>,
}

#[derive(Clone, Debug)]
struct Flattened<R> {
    /// Powers -5/2 and -7/2 of 1 + q.
    five: Vec<R>,
    seven: Vec<R>,
    /// w5 and w7 at the start of the step.
    nearer: [R; 2],
    /// s = d + w5 r.
    stretched: Vec<[R; 3]>,
    /// r_z^2 - O_z^2, and r_z^2.
    change: Vec<R>,
    height: Vec<R>,
    /// r_z^2 (1 + w7) - O_z^2.
    bent: Vec<R>,
    /// O_z^2 d + bent r.
    lifted: Vec<[R; 3]>,
}

impl<R: Real> OffsetSeries<R> {
    pub fn new(zero: R, order: usize) -> Self {
        let vectors = vec![[zero; 3]; order + 1];
        let numbers = vec![zero; order + 1];
        let flattened = Flattened {
            five: numbers.clone(),
            seven: numbers.clone(),
            nearer: [zero; 2],
            stretched: vectors.clone(),
            change: numbers.clone(),
            height: numbers.clone(),
            bent: numbers.clone(),
            lifted: vectors.clone(),
        };
        OffsetSeries {
            orbit: OrbitSeries::new(zero, order),
            offset: vectors.clone(),
            lever: vectors.clone(),
            place: vectors.clone(),
            ratio: numbers.clone(),
            power: numbers,
            nearer: zero,
            stretched: vectors,
            flattened,
        }
    }

    /// Starts a step, as [`OrbitSeries::begin`].
    #[inline(always)]
    pub fn begin(&mut self, gravity: Gravity<R>, position: [R; 3], velocity: [R; 3]) {
        self.orbit.begin(gravity, position, velocity);
    }

    /// Coefficient n of the tide, m per unit squared, from that of the offset, for ascending `n`.
    #[inline(always)]
    pub fn extend(&mut self, n: usize, of_offset: [R; 3]) -> [R; 3] {
        let OffsetSeries { orbit, offset, lever, place, ratio, power, nearer, stretched, flattened } = self;
        let zero = of_offset[0].zero();
        orbit.extend(n);
        offset[n] = of_offset;
        place[n] = sum(orbit.position()[n], of_offset);
        lever[n] = twice_and(orbit.position()[n], of_offset);
        let mut sum_q = dot_convolution(&offset[..=n], &lever[..=n]);
        let square = orbit.square();
        // q |O|^2 = d . (d + 2 O), coefficient by coefficient
        for (j, known) in ratio[..n].iter().enumerate() {
            sum_q = known.neg_mul_add(square[n - j], sum_q);
        }
        ratio[n] = sum_q / square[0];
        if n == 0 {
            *nearer = stronger(ratio[0]);
            power[0] = zero.splat(1.0) + *nearer;
        } else {
            power[n] = power_of_ratio(-1.5, n, ratio, power);
        }
        stretched[n] = stretched_offset(of_offset, *nearer, power, &place[..=n]);
        let mut tide = minus_convolution(&orbit.pull()[..=n], &stretched[..=n]);
        if orbit.gravity().oblateness.is_some() {
            tide = sum(tide, flattened.extend(n, orbit, [offset, lever, place], ratio, *nearer));
        }
        tide
    }

    #[inline(always)]
    pub fn orbit(&self) -> &OrbitSeries<R> {
        &self.orbit
    }

    #[inline(always)]
    pub fn place(&self) -> &[[R; 3]] {
        &self.place
    }
}

impl<R: Real> Flattened<R> {
    /// Coefficient n of the oblateness terms of the tide, from those of the orbit, d, 2 O + d, r and q, and w3 at the
    /// start of the step.
    #[inline(always)]
    fn extend(
        &mut self,
        n: usize,
        orbit: &OrbitSeries<R>,
        [offset, lever, place]: [&[[R; 3]]; 3],
        ratio: &mut [R],
        w3: R,
    ) -> [R; 3] {
        let zero = w3.zero();
        let Flattened { five, seven, nearer, stretched, change, height, bent, lifted } = self;
        if n == 0 {
            *nearer = stronger_powers(ratio[0], w3);
            [five[0], seven[0]] = nearer.map(|w| zero.splat(1.0) + w);
        } else {
            five[n] = power_of_ratio(-2.5, n, ratio, five);
            seven[n] = power_of_ratio(-3.5, n, ratio, seven);
        }
        let of_orbit = orbit.flattened();
        stretched[n] = stretched_offset(offset[n], nearer[0], five, &place[..=n]);
        change[n] = zero;
        for (d, l) in offset[..=n].iter().zip(lever[..=n].iter().rev()) {
            change[n] = d[2].mul_add(l[2], change[n]);
        }
        height[n] = of_orbit.height[n] + change[n];
        bent[n] = nearer[1].mul_add(height[n], change[n]);
        if n > 0 {
            // the power of order zero is w7, not 1 + w7
            bent[n] += convolution(&seven[1..=n], &height[..n]);
        }
        lifted[n] = [zero; 3];
        for m in 0..=n {
            let own = sum(scaled(of_orbit.height[m], offset[n - m]), scaled(bent[m], place[n - m]));
            lifted[n] = sum(lifted[n], own);
        }
        let mut all = [zero; 3];
        for m in 0..=n {
            let [x, y, z] = stretched[n - m];
            let three = zero.splat(3.0);
            let pulled = scaled(of_orbit.five[m], [x, y, three * z]);
            all = sum(all, sum(scaled(of_orbit.seven[m], lifted[n - m]), scaled(-zero.splat(1.0), pulled)));
        }
        all
    }
}

/// Coefficient n > 0 of the power `alpha` of 1 + q, from those of q and the lower ones.
#[inline(always)]
fn power_of_ratio<R: Real>(alpha: f64, n: usize, ratio: &mut [R], power: &[R]) -> R {
    let first = ratio[0];
    ratio[0] = first.splat(1.0) + first;
    let next = next_of_power(alpha, n, ratio, power);
    ratio[0] = first;
    next
}

/// Last coefficient of d + w r, from those of d, r and 1 + w; the first of 1 + w is `nearer`, without the one.
#[inline(always)]
fn stretched_offset<R: Real>(offset: [R; 3], nearer: R, power: &[R], place: &[[R; 3]]) -> [R; 3] {
    let n = place.len() - 1;
    let mut own = sum(offset, scaled(nearer, place[n]));
    if n > 0 {
        own = sum(own, scaled(power[n], place[0]));
    }
    for m in 1..n {
        own = sum(own, scaled(power[m], place[n - m]));
    }
    own
}
