//! [`Weights`]: constants of a grid for passes over a series; joins of lanes.

use fearless_simd::Simd;

use crate::math::lanes::WIDTH;
use crate::math::{Lanes, Real};
use crate::run::Grid;

/// Constants of a grid, zero in the padding.
#[derive(Clone, Debug)]
pub struct Weights {
    pub points: usize,
    /// One at every point.
    pub one: Vec<[f64; WIDTH]>,
    /// Weights of the values whose sum is the least-squares slope, 1/s.
    pub slope: Vec<[f64; WIDTH]>,
    /// 1/step to the next point, 1/s.
    pub inverse_step: Vec<[f64; WIDTH]>,
}

impl Weights {
    pub fn of(grid: &Grid) -> Self {
        Self::at(grid.times())
    }

    pub fn at(times: &[f64]) -> Self {
        let points = times.len();
        let mean = times.iter().sum::<f64>() / points as f64;
        let centered: Vec<f64> = times.iter().map(|t| t - mean).collect();
        let square: f64 = centered.iter().map(|t| t * t).sum();
        let slope = centered.iter().map(|t| if square > 0.0 { t / square } else { 0.0 });
        let inverse = times.windows(2).map(|t| if t[1] > t[0] { 1.0 / (t[1] - t[0]) } else { 0.0 });
        let padded = |values: Vec<f64>| {
            let mut values = values;
            values.resize(points.next_multiple_of(WIDTH), 0.0);
            values.as_chunks().0.to_vec()
        };
        Weights {
            points,
            one: padded(vec![1.0; points]),
            slope: padded(slope.collect()),
            inverse_step: padded(inverse.collect()),
        }
    }
}

/// The first `count` vectors of a column.
#[inline(always)]
pub fn vectors(column: &[f64], count: usize) -> &[[f64; WIDTH]] {
    &column.as_chunks().0[..count]
}

#[inline(always)]
fn joined(lanes: [f64; WIDTH], join: impl Fn(f64, f64) -> f64) -> f64 {
    let [a, b, c, d, e, f, g, h] = lanes;
    join(join(join(a, e), join(c, g)), join(join(b, f), join(d, h)))
}

#[inline(always)]
pub fn total<S: Simd>(lanes: Lanes<S>) -> f64 {
    joined(lanes.to_array(), |a, b| a + b)
}

#[inline(always)]
pub fn largest<S: Simd>(lanes: Lanes<S>) -> f64 {
    joined(lanes.to_array(), |a, b| a.larger(b))
}

#[inline(always)]
pub fn smallest<S: Simd>(lanes: Lanes<S>) -> f64 {
    joined(lanes.to_array(), |a, b| a.smaller(b))
}
