//! [`Moments`]: count, extremes, mean, standard deviation and skewness of a stream of numbers, in one pass and mergeable.
//!
//! Central moments are updated and merged by the formulas of P. Pébay, *Formulas for Robust, One-Pass Parallel Computation of
//! Covariances and Arbitrary-Order Statistical Moments*, SAND2008-6212 (2008), equations (1.1) to (1.4). Merging parts in their order gives
//! the same bits for any number of threads.

/// Moments of the numbers that were added.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Moments {
    count: u64,
    mean: f64,
    /// Sum of squared deviations from the mean.
    m2: f64,
    /// Sum of cubed deviations from the mean.
    m3: f64,
    min: f64,
    max: f64,
}

impl Default for Moments {
    fn default() -> Self {
        Moments { count: 0, mean: 0.0, m2: 0.0, m3: 0.0, min: f64::INFINITY, max: f64::NEG_INFINITY }
    }
}

impl Moments {
    /// Moments of `values`.
    pub fn of(values: impl IntoIterator<Item = f64>) -> Self {
        let mut moments = Moments::default();
        values.into_iter().for_each(|value| moments.add(value));
        moments
    }

    /// Adds one number. NaN makes every moment NaN: leave out what has no value.
    pub fn add(&mut self, value: f64) {
        self.merge(&Moments { count: 1, mean: value, m2: 0.0, m3: 0.0, min: value, max: value });
    }

    /// Adds everything that `other` has.
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
        self.m3 += other.m3
            + delta * delta * delta * mine * share * ((mine - theirs) / total)
            + 3.0 * delta * (mine / total * other.m2 - share * self.m2);
        self.m2 += other.m2 + delta * delta * mine * share;
        self.mean += delta * share;
        self.count += other.count;
        self.min = self.min.min(other.min);
        self.max = self.max.max(other.max);
    }

    /// How many numbers were added.
    pub fn count(&self) -> u64 {
        self.count
    }

    /// The mean; `None` where there is no number.
    pub fn mean(&self) -> Option<f64> {
        (self.count > 0).then_some(self.mean)
    }

    /// The smallest number.
    pub fn min(&self) -> Option<f64> {
        (self.count > 0).then_some(self.min)
    }

    /// The largest number.
    pub fn max(&self) -> Option<f64> {
        (self.count > 0).then_some(self.max)
    }

    /// The sample standard deviation, with n - 1; `None` for fewer than two numbers.
    pub fn standard_deviation(&self) -> Option<f64> {
        (self.count > 1).then(|| libm::sqrt(self.m2 / (self.count - 1) as f64))
    }

    /// The skewness g_1 = m_3/m_2^(3/2) (with n, as SciPy's `skew`); `None` where all numbers are alike.
    pub fn skewness(&self) -> Option<f64> {
        let n = self.count as f64;
        let skewness = libm::sqrt(n) * self.m3 / (self.m2 * libm::sqrt(self.m2));
        (self.count > 1 && self.m2 > 0.0).then_some(skewness)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn close(found: Option<f64>, expected: f64) {
        let found = found.unwrap_or(f64::NAN);
        assert!((found - expected).abs() <= 6e-16 * (1.0 + expected.abs()), "{found} {expected}");
    }

    #[test]
    fn known_moments() {
        // 1, 2, 4, 8: mean 15/4, m2 = 115/4, m3 = 2 * 45 + 3/8
        let moments = Moments::of([1.0, 2.0, 4.0, 8.0]);
        close(moments.mean(), 3.75);
        close(moments.standard_deviation(), libm::sqrt(28.75 / 3.0));
        let m3: f64 = [1.0, 2.0, 4.0, 8.0].iter().map(|x| (x - 3.75) * (x - 3.75) * (x - 3.75)).sum();
        close(moments.skewness(), 2.0 * m3 / libm::pow(28.75, 1.5));
        assert_eq!((moments.count(), moments.min(), moments.max()), (4, Some(1.0), Some(8.0)));
    }

    #[test]
    fn too_few_numbers_have_no_moments() {
        let none = Moments::default();
        assert_eq!((none.mean(), none.standard_deviation(), none.skewness(), none.min()), (None, None, None, None));
        let one = Moments::of([7.0]);
        assert_eq!((one.mean(), one.standard_deviation(), one.skewness()), (Some(7.0), None, None));
        assert_eq!(Moments::of([7.0, 7.0]).skewness(), None);
    }

    /// Law: merging is adding. A large offset costs no more digits than it has.
    #[test]
    fn merged_parts_are_the_whole() {
        let values: Vec<f64> = (0..10_000).map(|k| 1e9 + libm::sin(f64::from(k) * 0.7) * f64::from(k % 17)).collect();
        let whole = Moments::of(values.iter().copied());
        let mut merged = Moments::default();
        values.chunks(777).for_each(|part| merged.merge(&Moments::of(part.iter().copied())));
        // two passes, deviations from the mean of deviations
        let shift = values[0];
        let mean = values.iter().map(|value| value - shift).sum::<f64>() / 1e4;
        let m2: f64 = values.iter().map(|value| (value - shift - mean) * (value - shift - mean)).sum();
        let exact = libm::sqrt(m2 / 9999.0);
        for moments in [whole, merged] {
            let found = moments.mean().unwrap_or(f64::NAN) - shift;
            assert!((found - mean).abs() < 1e-14 * 1e9, "{found} {mean}");
            assert!((moments.standard_deviation().unwrap_or(0.0) / exact - 1.0).abs() < 1e-9);
        }
        assert_eq!((whole.count(), whole.min(), whole.max()), (merged.count(), merged.min(), merged.max()));
    }
}
