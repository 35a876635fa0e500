//! [`Spectrum`]: dominant frequency of an evenly sampled series.
//!
//! Periodogram of the series minus its least-squares line, with Hann's window (Harris 1978), zero-padded to a power of
//! two. The largest ordinate from one cycle per horizon on is refined by a parabola through the logarithms of it and
//! its neighbours (Gasior & Gonzalez 2004). The radix-2 transform has constant geometry (Pease, J. ACM 15, 1968): every
//! stage reads two halves and writes them interleaved, so that all vectorise. FFT crates choose their algorithm by the
//! machine, and their bits differ.
//!
//! Tones between one cycle per duration and half a cycle per interval are found within 0.05/duration; slower ones
//! appear as about one cycle per duration.

use fearless_simd::Simd;

use crate::math::lanes::WIDTH;
use crate::math::{Lanes, Real};
use crate::run::Grid;

const FEWEST: usize = 8;

/// Largest deviation of a time from the even grid, in steps: rounding only.
const UNEVENNESS: f64 = 1e-6;

#[derive(Clone, Debug)]
pub struct Spectrum {
    points: usize,
    step: f64,
    /// Hann's window, zero in the padding.
    window: Vec<f64>,
    /// Times minus their mean, s, with padding.
    centered_times: Vec<f64>,
    /// Number of complex values: half the padded length.
    size: usize,
    /// Position of coefficient k after the last stage.
    order: Vec<u32>,
    /// exp(-2 pi i e / size) for j < size / 2 by stage; e is j with its last bits cleared, one per earlier stage.
    stages: [Vec<f64>; 2],
    /// exp(-2 pi i k / (2 size)), k < size.
    turns: [Vec<f64>; 2],
    /// Real and imaginary parts; each stage reads one pair and writes the other.
    parts: [[Vec<f64>; 2]; 2],
    power: Vec<f64>,
}

impl Spectrum {
    /// Transform for series on `grid`; `None` if it is too short or uneven.
    pub fn of(grid: &Grid) -> Option<Self> {
        let times = grid.times();
        let points = times.len();
        if points < FEWEST {
            return None;
        }
        let step = grid.duration() / (points - 1) as f64;
        let even = times.iter().enumerate().all(|(k, t)| (t - k as f64 * step).abs() <= UNEVENNESS * step);
        if !even || step <= 0.0 {
            return None;
        }
        let size = points.next_power_of_two() / 2;
        let turn = |part: usize, whole: usize| 2.0 * std::f64::consts::PI * part as f64 / whole as f64;
        // period n + 1, so that no point has weight zero
        let padded = points.next_multiple_of(2 * WIDTH);
        let mut window: Vec<f64> = (0..points).map(|k| 0.5 - 0.5 * libm::cos(turn(k + 1, points + 1))).collect();
        window.resize(padded, 0.0);
        let mean_time = times.iter().sum::<f64>() / points as f64;
        let mut centered_times: Vec<f64> = times.iter().map(|t| t - mean_time).collect();
        centered_times.resize(padded, 0.0);
        let bits = size.trailing_zeros();
        let order = (0..size as u32).map(|k| k.reverse_bits() >> (u32::BITS - bits)).collect();
        let exponents = (0..bits).flat_map(|stage| (0..size / 2).map(move |j| (j >> stage) << stage));
        let stages = [
            exponents.clone().map(|e| libm::cos(turn(e, size))).collect(),
            exponents.map(|e| -libm::sin(turn(e, size))).collect(),
        ];
        let turns = [
            (0..size).map(|k| libm::cos(turn(k, 2 * size))).collect(),
            (0..size).map(|k| -libm::sin(turn(k, 2 * size))).collect(),
        ];
        let zeros = || vec![0.0; size.max(padded / 2)];
        let parts = [[zeros(), zeros()], [zeros(), zeros()]];
        Some(Spectrum {
            points,
            step,
            window,
            centered_times,
            size,
            order,
            stages,
            turns,
            parts,
            power: vec![0.0; size + 1],
        })
    }

    /// Dominant frequency, Hz, of `column` (padded to a multiple of sixteen) minus the line `mean + slope * (time -
    /// mean time)`.
    #[inline(always)]
    pub fn peak<S: Simd>(&mut self, simd: S, column: &[f64], mean: f64, slope: f64) -> f64 {
        self.fill(simd, column, mean, slope);
        self.transform(simd);
        self.fill_power();
        self.highest()
    }

    /// Even points as real, odd points as imaginary parts.
    #[inline(always)]
    fn fill<S: Simd>(&mut self, simd: S, column: &[f64], mean: f64, slope: f64) {
        let (mean, slope) = (Lanes::broadcast(simd, mean), Lanes::broadcast(simd, slope));
        let [re, im] = &mut self.parts[0];
        let (window, times) = (&self.window[..], &self.centered_times[..]);
        for first in (0..window.len()).step_by(2 * WIDTH) {
            let second = first + WIDTH;
            let early = Lanes::from_slice(simd, &column[first..]) - mean;
            let late = Lanes::from_slice(simd, &column[second..]) - mean;
            let early = early - slope * Lanes::from_slice(simd, &times[first..]);
            let late = late - slope * Lanes::from_slice(simd, &times[second..]);
            let early = early * Lanes::from_slice(simd, &window[first..]);
            let late = late * Lanes::from_slice(simd, &window[second..]);
            let (even, odd) = early.deinterleave(late);
            even.store(&mut re[first / 2..]);
            odd.store(&mut im[first / 2..]);
        }
        let filled = window.len() / 2;
        re[filled..].fill(0.0);
        im[filled..].fill(0.0);
    }

    /// Complex transform, with coefficient k at `order[k]` of the first parts.
    #[inline(always)]
    fn transform<S: Simd>(&mut self, simd: S) {
        let half = self.size / 2;
        let [from, to] = &mut self.parts;
        let stages = self.stages[0].chunks_exact(half).zip(self.stages[1].chunks_exact(half));
        for (cos, sin) in stages {
            let ([re, im], [re_out, im_out]) = (&mut *from, &mut *to);
            let (re_a, re_b) = re.split_at(half);
            let (im_a, im_b) = im.split_at(half);
            if half >= WIDTH {
                for at in (0..half).step_by(WIDTH) {
                    let a = (Lanes::from_slice(simd, &re_a[at..]), Lanes::from_slice(simd, &im_a[at..]));
                    let b = (Lanes::from_slice(simd, &re_b[at..]), Lanes::from_slice(simd, &im_b[at..]));
                    let w = (Lanes::from_slice(simd, &cos[at..]), Lanes::from_slice(simd, &sin[at..]));
                    let (sum, turned) = butterfly(a, b, w);
                    let (low, high) = sum.0.interleave(turned.0);
                    low.store(&mut re_out[2 * at..]);
                    high.store(&mut re_out[2 * at + WIDTH..]);
                    let (low, high) = sum.1.interleave(turned.1);
                    low.store(&mut im_out[2 * at..]);
                    high.store(&mut im_out[2 * at + WIDTH..]);
                }
            } else {
                for j in 0..half {
                    let (sum, turned) = butterfly((re_a[j], im_a[j]), (re_b[j], im_b[j]), (cos[j], sin[j]));
                    (re_out[2 * j], im_out[2 * j]) = sum;
                    (re_out[2 * j + 1], im_out[2 * j + 1]) = turned;
                }
            }
            core::mem::swap(from, to);
        }
    }

    /// |X_k|^2 of the real series, k = 0 ... size, from the transform of even and odd points.
    #[inline(always)]
    fn fill_power(&mut self) {
        let size = self.size;
        let [cos, sin] = &self.turns;
        let [re, im] = &self.parts[0];
        let power = &mut self.power[..=size];
        power[0] = (re[0] + im[0]) * (re[0] + im[0]);
        power[size] = (re[0] - im[0]) * (re[0] - im[0]);
        for k in 1..=size / 2 {
            let other = size - k;
            let (at, at_other) = (self.order[k] as usize, self.order[other] as usize);
            let even = (0.5 * (re[at] + re[at_other]), 0.5 * (im[at] - im[at_other]));
            let odd = (0.5 * (im[at] + im[at_other]), -0.5 * (re[at] - re[at_other]));
            let turned = (cos[k] * odd.0 - sin[k] * odd.1, cos[k] * odd.1 + sin[k] * odd.0);
            let (x, y) = (even.0 + turned.0, even.1 + turned.1);
            power[k] = x * x + y * y;
            let (x, y) = (even.0 - turned.0, even.1 - turned.1);
            power[other] = x * x + y * y;
        }
    }

    /// Frequency of the largest ordinate, Hz; NaN if it is at an end of the spectrum, and no peak.
    #[inline(always)]
    fn highest(&self) -> f64 {
        let bin = 1.0 / (2.0 * self.size as f64 * self.step);
        let lowest = (2 * self.size).div_ceil(self.points);
        let mut peak = lowest;
        for k in lowest..=self.size {
            if self.power[k] > self.power[peak] {
                peak = k;
            }
        }
        if peak == self.size || self.power[peak - 1] >= self.power[peak] {
            return f64::NAN;
        }
        if self.power[peak + 1] <= 0.0 {
            return bin * peak as f64;
        }
        let [a, b, c] = [peak - 1, peak, peak + 1].map(|k| libm::log(self.power[k]));
        let curvature = (a - b) + (c - b);
        let shift = if curvature < 0.0 && a.is_finite() { 0.5 * (a - c) / curvature } else { 0.0 };
        bin * (peak as f64 + shift)
    }
}

#[inline(always)]
fn butterfly<R: Real>(a: (R, R), b: (R, R), w: (R, R)) -> ((R, R), (R, R)) {
    let apart = (a.0 - b.0, a.1 - b.1);
    let turned = (w.0.mul_add(apart.0, -(w.1 * apart.1)), w.0.mul_add(apart.1, w.1 * apart.0));
    ((a.0 + b.0, a.1 + b.1), turned)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Isa;
    use crate::math::isa::Work;

    const BIN_ERROR: f64 = 0.05;

    struct Peak<'a>(&'a mut Spectrum, &'a [f64], f64, f64);
    impl Work for Peak<'_> {
        type Output = f64;
        #[inline(always)]
        fn run<S: Simd>(self, simd: S) -> f64 {
            self.0.peak(simd, self.1, self.2, self.3)
        }
    }

    fn padded(mut values: Vec<f64>) -> Vec<f64> {
        values.resize(values.len().next_multiple_of(2 * WIDTH), 1e3);
        values
    }

    fn peak(points: usize, duration: f64, f: impl Fn(f64) -> f64) -> f64 {
        let grid = Grid::uniform(duration, points);
        let values: Vec<f64> = grid.times().iter().map(|t| f(*t)).collect();
        let mut spectrum = Spectrum::of(&grid).unwrap();
        Isa::best().run(Peak(&mut spectrum, &padded(values), 0.0, 0.0))
    }

    #[test]
    fn a_tone_is_found_where_it_is() {
        let mut worst: f64 = 0.0;
        for points in [51, 64, 101, 128, 129, 1000, 5000] {
            for cycles in [2.2, 3.0, 4.55, 7.31, 11.5, 17.77, 20.01] {
                let duration = 3.0;
                let turn = 2.0 * std::f64::consts::PI * cycles / duration;
                let found = peak(points, duration, |t| 0.1 * libm::sin(turn * t + 0.3));
                let error = (found * duration - cycles).abs();
                worst = worst.max(error);
                assert!(error <= BIN_ERROR, "{points} points, {cycles} cycles: {}", found * duration);
            }
        }
        // measured 0.016
        assert!(worst > 2e-3, "the bound is close to the measured error");
    }
}
