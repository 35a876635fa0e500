//! [`Pieces`]: a smooth function on an interval as piecewise Chebyshev series.
//!
//! A piece is halved until its last coefficients are below the tolerance (simplified from J. L. Aurentz & L. N.
//! Trefethen, ACM Trans. Math. Softw. 43 (2017)); sums by Clenshaw's recurrence.

use core::f64::consts::PI;

/// Coefficients of a piece.
const ORDER: usize = 16;
/// Limit of halvings, down to the narrowest feature of the functions here.
const MOST_HALVINGS: u32 = 14;

/// A function on an interval.
#[derive(Clone, Debug, PartialEq)]
pub struct Pieces {
    /// Upper ends of the pieces, ascending.
    ends: Vec<f64>,
    pieces: Vec<Piece>,
}

#[derive(Clone, Debug, PartialEq)]
struct Piece {
    middle: f64,
    /// 1/half width.
    scale: f64,
    coefficients: [f64; ORDER],
}

impl Pieces {
    /// `f` on [`low`, `high`], to the absolute error `tolerance(value)`.
    pub fn new(f: &dyn Fn(f64) -> f64, low: f64, high: f64, tolerance: &dyn Fn(f64) -> f64) -> Self {
        let mut pieces = Pieces { ends: Vec::new(), pieces: Vec::new() };
        pieces.add(f, [low, high], tolerance, MOST_HALVINGS);
        pieces
    }

    fn add(&mut self, f: &dyn Fn(f64) -> f64, [low, high]: [f64; 2], tolerance: &dyn Fn(f64) -> f64, halvings: u32) {
        let middle = 0.5 * (low + high);
        let piece = Piece::new(f, middle, 0.5 * (high - low));
        let tail: f64 = piece.coefficients[ORDER - 3..].iter().map(|c| c.abs()).sum();
        if tail <= tolerance(piece.coefficients[0].abs()) || halvings == 0 {
            self.ends.push(high);
            self.pieces.push(piece);
        } else {
            self.add(f, [low, middle], tolerance, halvings - 1);
            self.add(f, [middle, high], tolerance, halvings - 1);
        }
    }

    /// The value at `x`, clamped to the interval.
    #[inline]
    pub fn value(&self, x: f64) -> f64 {
        let index = self.ends.partition_point(|end| *end < x).min(self.pieces.len() - 1);
        self.pieces[index].value(x)
    }

    /// Number of pieces.
    pub fn count(&self) -> usize {
        self.pieces.len()
    }
}

impl Piece {
    fn new(f: &dyn Fn(f64) -> f64, middle: f64, half: f64) -> Self {
        let angle = |k: usize| PI * (k as f64 + 0.5) / ORDER as f64;
        let values: [f64; ORDER] = core::array::from_fn(|k| f(middle + half * libm::cos(angle(k))));
        let coefficients = core::array::from_fn(|j| {
            let sum: f64 = (0..ORDER).map(|k| values[k] * libm::cos(j as f64 * angle(k))).sum();
            sum * if j == 0 { 1.0 } else { 2.0 } / ORDER as f64
        });
        Piece { middle, scale: 1.0 / half, coefficients }
    }

    #[inline]
    fn value(&self, x: f64) -> f64 {
        let t = ((x - self.middle) * self.scale).clamp(-1.0, 1.0);
        let (mut last, mut before) = (0.0, 0.0);
        for c in self.coefficients[1..].iter().rev() {
            (last, before) = (2.0 * t * last - before + c, last);
        }
        t * last - before + self.coefficients[0]
    }
}
