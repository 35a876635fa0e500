//! [`Moments`]: count, extremes, mean and central moments up to order four of numbers, mergeable.
//!
//! A block is reduced in two passes, with a correction for the rounding of its mean (T. F. Chan, G. H. Golub & R. J.
//! LeVeque, *Am. Stat.* 37 (1983) 242), and merged by P. Pébay, SAND2008-6212 (2008); in order, for the same bits with
//! any number of threads.

use fearless_simd::Simd;

use crate::math::Isa;
use crate::math::isa::Work;

/// Moments of the added numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Moments {
    count: u64,
    mean: f64,
    /// Sum of squared deviations.
    m2: f64,
    /// Sum of cubed deviations.
    m3: f64,
    /// Sum of fourth powers of deviations.
    m4: f64,
    min: f64,
    max: f64,
}

impl Default for Moments {
    fn default() -> Self {
        Moments { count: 0, mean: 0.0, m2: 0.0, m3: 0.0, m4: 0.0, min: f64::INFINITY, max: f64::NEG_INFINITY }
    }
}

impl Moments {
    /// Moments of `values`.
    pub fn of(values: impl IntoIterator<Item = f64>) -> Self {
        let mut moments = Moments::default();
        values.into_iter().for_each(|value| moments.add(value));
        moments
    }

    /// Moments of a block: [`Moments::of`] to rounding, but faster and more accurate.
    pub fn of_block(values: &[f64]) -> Self {
        Isa::best().run(Block(values))
    }

    /// Adds one number. NaN makes every moment NaN.
    pub fn add(&mut self, value: f64) {
        self.merge(&Moments { count: 1, mean: value, m2: 0.0, m3: 0.0, m4: 0.0, min: value, max: value });
    }

    /// Adds the numbers of `other`.
    pub fn merge(&mut self, other: &Moments) {
        if other.count == 0 {
            return;
        }
        if self.count == 0 {
            *self = *other;
            return;
        }
        let (mine, theirs) = (self.count as f64, other.count as f64);
        let total = mine + theirs;
        let delta = other.mean - self.mean;
        let share = theirs / total;
        let square = delta * delta;
        self.m4 += other.m4
            + square * square * mine * share * ((mine * mine - mine * theirs + theirs * theirs) / (total * total))
            + 6.0 * square * (mine / total * (mine / total) * other.m2 + share * share * self.m2)
            + 4.0 * delta * (mine / total * other.m3 - share * self.m3);
        self.m3 += other.m3
            + delta * delta * delta * mine * share * ((mine - theirs) / total)
            + 3.0 * delta * (mine / total * other.m2 - share * self.m2);
        self.m2 += other.m2 + delta * delta * mine * share;
        self.mean += delta * share;
        self.count += other.count;
        self.min = self.min.min(other.min);
        self.max = self.max.max(other.max);
    }

    /// Number of numbers.
    pub fn count(&self) -> u64 {
        self.count
    }

    /// Mean, if any.
    pub fn mean(&self) -> Option<f64> {
        (self.count > 0).then_some(self.mean)
    }

    /// Minimum, if any.
    pub fn min(&self) -> Option<f64> {
        (self.count > 0).then_some(self.min)
    }

    /// Maximum, if any.
    pub fn max(&self) -> Option<f64> {
        (self.count > 0).then_some(self.max)
    }

    /// Sample standard deviation, with n - 1; `None` for fewer than two numbers.
    pub fn standard_deviation(&self) -> Option<f64> {
        (self.count > 1).then(|| libm::sqrt(self.m2 / (self.count - 1) as f64))
    }

    /// Skewness g_1 = m_3/m_2^(3/2) (divisor n, as SciPy's `skew`); `None` if all numbers are equal.
    pub fn skewness(&self) -> Option<f64> {
        let n = self.count as f64;
        let skewness = libm::sqrt(n) * self.m3 / (self.m2 * libm::sqrt(self.m2));
        (self.count > 1 && self.m2 > 0.0).then_some(skewness)
    }

    /// Kurtosis m_4/m_2^2 (divisor n; 3 for normal numbers); `None` if all numbers are equal.
    pub fn kurtosis(&self) -> Option<f64> {
        (self.count > 1 && self.m2 > 0.0).then(|| self.count as f64 * self.m4 / (self.m2 * self.m2))
    }

    /// Share of the number farthest from the mean in the sum of squared (`power` 2) or fourth-power (4) deviations; 0
    /// if all numbers are equal.
    pub fn largest_share(&self, power: u8) -> f64 {
        let farthest = (self.max - self.mean).max(self.mean - self.min);
        let square = farthest * farthest;
        let (part, sum) = if power == 2 { (square, self.m2) } else { (square * square, self.m4) };
        if sum > 0.0 { (part / sum).min(1.0) } else { 0.0 }
    }

    /// Standard error of the mean of independent numbers, s/sqrt(n); `None` for fewer than two.
    pub fn mean_error(&self) -> Option<f64> {
        Some(self.standard_deviation()? / libm::sqrt(self.count as f64))
    }

    /// Asymptotic standard error of the standard deviation of independent numbers, sqrt((m_4 - m_2^2)/n)/(2 s) (H.
    /// Cramér, *Mathematical Methods of Statistics*, 1946, section 28.4); `None` if all numbers are equal.
    pub fn standard_deviation_error(&self) -> Option<f64> {
        let n = self.count as f64;
        let deviation = self.standard_deviation().filter(|deviation| *deviation > 0.0)?;
        let (second, fourth) = (self.m2 / n, self.m4 / n);
        Some(libm::sqrt((fourth - second * second).max(0.0) / n) / (2.0 * deviation))
    }
}

/// Moments of a block, the same bits on all instruction sets.
struct Block<'v>(&'v [f64]);

impl Work for Block<'_> {
    type Output = Moments;

    #[inline(always)]
    fn run<S: Simd>(self, _: S) -> Moments {
        let values = self.0;
        let n = values.len() as f64;
        let [sum, min, max] = in_lanes(
            values,
            [0.0, f64::INFINITY, f64::NEG_INFINITY],
            |[sum, min, max], x| [sum + x, if x < min { x } else { min }, if x > max { x } else { max }],
            |a, b| [a[0] + b[0], a[1].min(b[1]), a[2].max(b[2])],
        );
        if values.is_empty() {
            return Moments::default();
        }
        if min == max && !sum.is_nan() {
            // exact, unlike their rounded sum over n
            return Moments { count: values.len() as u64, mean: min, m2: 0.0, m3: 0.0, m4: 0.0, min, max };
        }
        let near = sum / n;
        let [s1, s2, s3, s4] = in_lanes(
            values,
            [0.0; 4],
            |[s1, s2, s3, s4], x| {
                let d = x - near;
                let square = d * d;
                [s1 + d, s2 + square, s3 + square * d, s4 + square * square]
            },
            |a, b| [a[0] + b[0], a[1] + b[1], a[2] + b[2], a[3] + b[3]],
        );
        // rounding of the mean
        let e = s1 / n;
        Moments {
            count: values.len() as u64,
            mean: near + e,
            m2: (s2 - e * s1).max(0.0),
            m3: s3 - 3.0 * e * s2 + 2.0 * n * e * e * e,
            m4: (s4 - 4.0 * e * s3 + 6.0 * e * e * s2 - 3.0 * n * e * e * e * e).max(0.0),
            min,
            max,
        }
    }
}

/// Number of independent accumulators, which hide the latency of a sum.
const LANES: usize = 8;

/// Folds number k of `values` into accumulator k mod [`LANES`], then the accumulators in order.
#[inline(always)]
fn in_lanes<const N: usize>(
    values: &[f64],
    start: [f64; N],
    add: impl Fn([f64; N], f64) -> [f64; N],
    merge: impl Fn([f64; N], [f64; N]) -> [f64; N],
) -> [f64; N] {
    let mut lanes = start.map(|start| [start; LANES]);
    let mut blocks = values.chunks_exact(LANES);
    for block in &mut blocks {
        for lane in 0..LANES {
            let sum = add(lanes.map(|lanes| lanes[lane]), block[lane]);
            lanes.iter_mut().zip(sum).for_each(|(lanes, sum)| lanes[lane] = sum);
        }
    }
    for (lane, value) in blocks.remainder().iter().enumerate() {
        let sum = add(lanes.map(|lanes| lanes[lane]), *value);
        lanes.iter_mut().zip(sum).for_each(|(lanes, sum)| lanes[lane] = sum);
    }
    (0..LANES).map(|lane| lanes.map(|lanes| lanes[lane])).reduce(merge).unwrap_or(start)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::near;

    fn close(found: Option<f64>, expected: f64) {
        let found = found.unwrap_or(f64::NAN);
        assert!((found - expected).abs() <= 6e-16 * (1.0 + expected.abs()), "{found} {expected}");
    }

    #[test]
    fn known_moments() {
        // 1, 2, 4, 8: mean 15/4, sum of squared deviations 115/4
        let moments = Moments::of([1.0, 2.0, 4.0, 8.0]);
        let sum = |power: f64| [1.0, 2.0, 4.0, 8.0].iter().map(|x| libm::pow(x - 3.75, power)).sum::<f64>();
        close(moments.mean(), 3.75);
        close(moments.standard_deviation(), libm::sqrt(28.75 / 3.0));
        close(moments.skewness(), 2.0 * sum(3.0) / libm::pow(28.75, 1.5));
        close(moments.kurtosis(), 4.0 * sum(4.0) / (28.75 * 28.75));
        close(Some(moments.largest_share(2)), 4.25 * 4.25 / 28.75);
        close(Some(moments.largest_share(4)), libm::pow(4.25, 4.0) / sum(4.0));
        assert_eq!((moments.count(), moments.min(), moments.max()), (4, Some(1.0), Some(8.0)));
        for (few, mean) in [(&[][..], None), (&[7.0], Some(7.0))] {
            let few = Moments::of(few.iter().copied());
            assert_eq!((few.mean(), few.min(), few.standard_deviation(), few.skewness()), (mean, mean, None, None));
        }
    }

    /// Law: a block of any length has the moments of its numbers; equal numbers have no spread.
    #[test]
    fn a_block_is_its_numbers() {
        for length in [0, 1, 7, 8, 9, 100, 1001] {
            let values: Vec<f64> = (0..length).map(|k| libm::sin(f64::from(k) * 0.7) * f64::from(k % 17)).collect();
            let (block, one_by_one) = (Moments::of_block(&values), Moments::of(values.iter().copied()));
            let numbers = |m: &Moments| {
                [m.mean(), m.standard_deviation(), m.skewness(), m.mean_error(), m.standard_deviation_error()]
            };
            assert_eq!((block.count, block.min(), block.max()), (one_by_one.count, one_by_one.min(), one_by_one.max()));
            for (a, b) in numbers(&block).into_iter().zip(numbers(&one_by_one)) {
                // rounding of sums of up to 1001 numbers; measured 3e-14
                let error = (a.unwrap_or(-1.0) - b.unwrap_or(-1.0)).abs();
                assert!(error <= 2e-13, "{length}: {a:?} {b:?}");
            }
        }
        let equal = Moments::of_block(&[0.1; 1000]);
        assert_eq!((equal.mean(), equal.standard_deviation(), equal.skewness()), (Some(0.1), Some(0.0), None));
        assert!(Moments::of_block(&[1.0, f64::NAN]).mean().is_some_and(f64::is_nan));
    }

    /// Known: +1 and -1, equally often, have m_4 = m_2 = 1 and no error of this order.
    #[test]
    fn known_error_of_a_standard_deviation() {
        let two = Moments::of((0..100).map(|k| if k % 2 == 0 { 1.0 } else { -1.0 }));
        // the square root of a rounding error
        assert!(two.standard_deviation_error().is_some_and(|error| error < 5e-9));
        let rare = Moments::of((0..4).map(|k| if k == 0 { 1.0 } else { 0.0 }));
        // mean 1/4: m_2 = 3/16, m_4 = (81 + 3)/1024
        let (m2, m4) = (3.0 / 16.0, 84.0 / 1024.0);
        close(rare.standard_deviation_error(), libm::sqrt((m4 - m2 * m2) / 4.0) / (2.0 * 0.5));
        close(rare.mean_error(), 0.25);
    }
    /// Law: merged parts of different size, mean and spread have the moments of the whole, up to the fourth.
    #[test]
    fn merged_parts_have_the_moments_of_the_whole() {
        let values: Vec<f64> = (0..60).map(|k| libm::exp(0.05 * f64::from(k)) + f64::from(k % 7)).collect();
        let mean = values.iter().sum::<f64>() / 60.0;
        let sum = |power: i32| values.iter().map(|value| (value - mean).powi(power)).sum::<f64>();
        let (m2, m3, m4) = (sum(2), sum(3), sum(4));
        for cuts in [[10, 13], [30, 59], [1, 50]] {
            let mut merged = Moments::default();
            for part in [&values[..cuts[0]], &values[cuts[0]..cuts[1]], &values[cuts[1]..]] {
                merged.merge(&Moments::of(part.iter().copied()));
            }
            for (found, exact) in [(merged.mean, mean), (merged.m2, m2), (merged.m3, m3), (merged.m4, m4)] {
                near(found, exact, 1e-13);
            }
        }
    }
}
