//! [`FittedTorque`]: a polynomial in time in place of a torque that has no Taylor series, for the reference solution.
//!
//! Along a step the torque of such effects is interpolated at Chebyshev nodes of the motion found so far, and the motion is found again under the
//! polynomial, until both agree (Picard's iteration; L. N. Trefethen, *Approximation Theory and Approximation Practice*, 2013, chapters 3 and 8). The step
//! is as long as the interpolation holds to the rounding of the torque: where a plate turns on or light goes off, it ends just before, and a step follows
//! that is too short for what it misses to count. So a step is never across such a point, whose place need not be known to the effect.
//!
//! The torque itself is evaluated in `f64`: light is good to some 1e-16 of itself, drag to 5e-14 (the rounding of the height); the fit to 1e-12 of the largest torque,
//! and what it does to the motion with it. Everything else has all digits.

use crate::dynamics::effects::within_arcs::Motion;
use crate::dynamics::effects::{ChangingEffects, largest_changing_torque};
use crate::dynamics::gyrostat::{ATTITUDE, Gyrostat, OMEGA};
use crate::dynamics::orbit::OrbitState;
use crate::dynamics::orbit_series::OrbitSeries;
use crate::math::double_double::{DoubleDouble, two_product};
use crate::math::vector::norm;
use crate::scene::Scene;

/// Nodes of the interpolation: its polynomial has one order less.
const NODES: usize = 20;

/// Last coefficients that say whether the interpolation holds.
const TAIL: usize = 3;

/// Error of the torque, relative to the largest that may act, that does not count. A distance of 7,000 km is known to some 3e-9 m, and the density, which falls by e in
/// some 50 km, to 5e-14 of itself with it; the last coefficients have several times that, and steps below it shrink without end (2e-14: more than 23 s for 300 s).
const ROUNDING: f64 = 1e-12;

/// Change of the rate that is missed in one step at most, relative to the rate of the run's time scale: a thousandth of a rounding, for the thousands
/// of steps at plates that turn on.
const MISSED: f64 = 1e-19;

/// Halvings of a step at most: then it is shorter than the rounding of a time.
const MOST_HALVINGS: usize = 48;

/// Bisections after them: a step ends within 2^-12 of its length before the point that limits it.
const BISECTIONS: usize = 12;

/// Passes at most; each makes the change smaller by the square of the angle that the torque turns the body by in a step.
const MOST_PASSES: usize = 20;

/// A step that the series allow to this share is kept: their truncation is then 1.5 times as large, at the orders here.
const SAME: f64 = 0.99;

/// Coefficients of Chebyshev polynomials, for each component of the torque, B, N m.
type Coefficients = [[f64; 3]; NODES];

/// The fit of one run.
pub(super) struct FittedTorque {
    effects: ChangingEffects<f64>,
    /// Errors of the torque below this do not count, N m.
    noise: f64,
    /// Smallest moment of inertia, kg m^2.
    inertia: f64,
    /// cos(pi (k + 1/2)/NODES), by k, and the Chebyshev polynomials there, by order.
    nodes: [f64; NODES],
    values: [[f64; NODES]; NODES],
    /// Coefficients of the shifted Chebyshev polynomials on [0, 1], by order; integers below 2^53.
    monomials: [[f64; NODES]; NODES],
    fitted: Coefficients,
    step: f64,
    passes: usize,
}

/// The motion along a step, as series in `f64` in a unit of time of `unit` seconds from `time` s on.
pub(super) struct Track {
    rate: Vec<[f64; 3]>,
    attitude: Vec<[f64; 4]>,
    place: Option<Vec<[f64; 3]>>,
    time: f64,
    unit: f64,
}

impl Track {
    /// That of `jet` and of the orbit `orbit`.
    pub fn new<const N: usize>(
        jet: &[[DoubleDouble; N]],
        orbit: Option<&OrbitSeries<DoubleDouble>>,
        time: f64,
        unit: f64,
    ) -> Self {
        let high = |values: &[DoubleDouble; N], first: usize| values[first].high;
        Track {
            rate: jet.iter().map(|c| core::array::from_fn(|i| high(c, OMEGA + i))).collect(),
            attitude: jet.iter().map(|c| core::array::from_fn(|i| high(c, ATTITUDE + i))).collect(),
            place: orbit.map(|orbit| orbit.position().iter().map(|c| c.map(|x| x.high)).collect()),
            time,
            unit,
        }
    }

    /// The motion `within` units of time after the start of the step.
    fn at(&self, within: f64) -> Motion<f64> {
        let place = match &self.place {
            None => OrbitState::unknown(0.0),
            Some(series) => {
                let (position, velocity) = (value(series, within), slope(series, within));
                OrbitState { position, velocity: velocity.map(|x| x / self.unit), distance: norm(position) }
            }
        };
        Motion {
            time: within.mul_add(self.unit, self.time),
            attitude: value(&self.attitude, within),
            rate: value(&self.rate, within).map(|x| x / self.unit),
            place,
        }
    }
}

/// A series at `x`.
fn value<const K: usize>(series: &[[f64; K]], x: f64) -> [f64; K] {
    series.iter().rev().fold([0.0; K], |sum, c| core::array::from_fn(|i| sum[i].mul_add(x, c[i])))
}

/// Its derivative there.
fn slope<const K: usize>(series: &[[f64; K]], x: f64) -> [f64; K] {
    let terms = series.iter().enumerate().skip(1).rev();
    terms.fold([0.0; K], |sum, (n, c)| core::array::from_fn(|i| sum[i].mul_add(x, n as f64 * c[i])))
}

impl FittedTorque {
    /// That of `run`, of `scene`; `None` where all effects have series.
    pub fn new(run: &Gyrostat<DoubleDouble>, scene: &Scene) -> Option<Self> {
        let c_sb = run.c_sb.map(|c| c.map(|row| row.map(|entry| entry.high)));
        let effects = ChangingEffects::of(0.0, scene, c_sb).evaluated();
        if effects.is_empty() {
            return None;
        }
        let angle = |k: usize| core::f64::consts::PI * (k as f64 + 0.5) / NODES as f64;
        let mut monomials = [[0.0; NODES]; NODES];
        monomials[0][0] = 1.0;
        (monomials[1][0], monomials[1][1]) = (-1.0, 2.0);
        for j in 2..NODES {
            for n in 0..NODES {
                let raised = if n == 0 { 0.0 } else { 4.0 * monomials[j - 1][n - 1] };
                monomials[j][n] = raised - 2.0 * monomials[j - 1][n] - monomials[j - 2][n];
            }
        }
        Some(FittedTorque {
            effects,
            noise: ROUNDING * largest_changing_torque(scene),
            inertia: run.moments.map(|moment| moment.high).into_iter().fold(f64::INFINITY, f64::min),
            nodes: core::array::from_fn(|k| libm::cos(angle(k))),
            values: core::array::from_fn(|j| core::array::from_fn(|k| libm::cos(j as f64 * angle(k)))),
            monomials,
            fitted: [[0.0; 3]; NODES],
            step: 0.0,
            passes: 0,
        })
    }

    /// The torque at the start of a step, with which the first pass starts, B, N m in the unit of time.
    pub fn start(&mut self, motion: &Track) -> [[DoubleDouble; 3]; 1] {
        self.passes = 0;
        let per_unit = motion.unit * motion.unit;
        [self.effects.torque(&motion.at(0.0)).map(|torque| two_product(torque, per_unit))]
    }

    /// The next fit, its coefficients in the unit of time, where the motion along a step of at most `longest` units of time is `track`; `None` once the
    /// motion is that under the last fit, over [`FittedTorque::step`].
    pub fn next(&mut self, track: &Track, longest: f64) -> Option<[[DoubleDouble; 3]; NODES]> {
        self.passes += 1;
        let before = self.step;
        // what the series allow changes a little from pass to pass
        if self.passes == 1 || longest < SAME * self.step {
            self.step = longest;
        }
        let mut found = self.sampled(track, self.step);
        if !self.is_resolved(&found, self.step, track.unit) {
            self.step = self.resolvable(track, self.step);
            found = self.sampled(track, self.step);
        }
        let mut change = 0.0_f64;
        for (new, old) in found.iter().zip(&self.fitted) {
            change += (0..3).map(|i| (new[i] - old[i]).abs()).fold(0.0, f64::max);
        }
        let is_settled = self.passes > 1 && self.step == before && self.is_negligible(change, self.step, track.unit);
        if is_settled || self.passes > MOST_PASSES {
            return None;
        }
        self.fitted = found;
        Some(self.polynomial(track.unit))
    }

    /// Length of the step over which the last fit holds, units of time.
    pub fn step(&self) -> f64 {
        self.step
    }

    /// The interpolation over `step` units of time.
    fn sampled(&self, track: &Track, step: f64) -> Coefficients {
        let torques = self.nodes.map(|x| self.effects.torque(&track.at(0.5 * step * (1.0 + x))));
        core::array::from_fn(|j| {
            let weight = if j == 0 { 1.0 } else { 2.0 } / NODES as f64;
            core::array::from_fn(|i| {
                weight * torques.iter().zip(&self.values[j]).map(|(torque, value)| torque[i] * value).sum::<f64>()
            })
        })
    }

    /// Whether an error of the torque of `torque` N m over `step` units of time does not count.
    fn is_negligible(&self, torque: f64, step: f64, unit: f64) -> bool {
        torque <= self.noise || torque * unit * unit * step <= MISSED * self.inertia
    }

    /// Whether the last coefficients do not count.
    fn is_resolved(&self, coefficients: &Coefficients, step: f64, unit: f64) -> bool {
        let size = |c: &[f64; 3]| c.iter().fold(0.0_f64, |size, x| size.max(x.abs()));
        self.is_negligible(coefficients[NODES - TAIL..].iter().map(size).sum(), step, unit)
    }

    /// About the longest step, below `longest`, over which the interpolation holds.
    fn resolvable(&self, track: &Track, longest: f64) -> f64 {
        let holds = |step: f64| self.is_resolved(&self.sampled(track, step), step, track.unit);
        let (mut short, mut long) = (0.5 * longest, longest);
        for _ in 0..MOST_HALVINGS {
            if holds(short) {
                break;
            }
            (short, long) = (0.5 * short, short);
        }
        for _ in 0..BISECTIONS {
            let middle = 0.5 * (short + long);
            if holds(middle) {
                short = middle;
            } else {
                long = middle;
            }
        }
        short
    }

    /// The coefficients of the powers of time, in the unit of time.
    fn polynomial(&self, unit: f64) -> [[DoubleDouble; 3]; NODES] {
        let mut powers = [[DoubleDouble::exact(0.0); 3]; NODES];
        let per_step = DoubleDouble::exact(1.0) / DoubleDouble::exact(self.step);
        let mut scale = DoubleDouble::exact(unit * unit);
        for (n, power) in powers.iter_mut().enumerate() {
            for (coefficients, monomial) in self.fitted.iter().zip(&self.monomials) {
                for i in 0..3 {
                    power[i] += two_product(coefficients[i], monomial[n]);
                }
            }
            *power = power.map(|x| x * scale);
            scale = scale * per_step;
        }
        powers
    }
}
