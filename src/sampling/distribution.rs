//! [`Distribution`]: the law of one number, as one quantile function of u in (0, 1).
//!
//! One u gives one value, monotonically. So every design (random, Latin hypercube, Sobol, ...) gives a law the same meaning,
//! and correlation can be laid between the u. Rejection and polar methods, which eat an unknown count of u, are not here.

use super::beta::BetaLaw;
use super::discrete::{Choice, Empirical};
use crate::math::normal::{probability, quantile, quantiles};

/// The law of one number.
#[derive(Clone, Debug, PartialEq)]
pub enum Distribution {
    /// Normal.
    Normal {
        /// Mean.
        mean: f64,
        /// Standard deviation, >= 0.
        std: f64,
    },
    /// Normal under the condition that it lies between two bounds: truncated, not clamped, so the bounds carry no mass.
    TruncatedNormal(TruncatedNormal),
    /// Uniform between two bounds.
    Uniform {
        /// Lower bound.
        min: f64,
        /// Upper bound, >= min.
        max: f64,
    },
    /// Normal in the logarithm.
    LogNormal {
        /// Median, > 0.
        median: f64,
        /// Standard deviation of the natural logarithm, >= 0.
        log_std: f64,
    },
    /// Uniform in the logarithm.
    LogUniform {
        /// Lower bound, > 0.
        min: f64,
        /// Upper bound.
        max: f64,
        /// ln(max/min).
        log_ratio: f64,
    },
    /// Triangular.
    Triangular {
        /// Lower bound.
        min: f64,
        /// Most likely value.
        mode: f64,
        /// Upper bound.
        max: f64,
    },
    /// Beta (and PERT) between two bounds.
    Beta(BetaLaw),
    /// One of several values (and Bernoulli: one of two).
    Choice(Choice),
    /// As a list of values.
    Empirical(Empirical),
    /// Always the same; takes no u.
    Fixed(f64),
}

/// See [`Distribution::TruncatedNormal`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TruncatedNormal {
    mean: f64,
    /// Negative where the law is reflected, so that the interval lies at or below the mean or about it.
    std: f64,
    lower: f64,
    upper: f64,
    /// Probability below, above and between the bounds, after reflection.
    below: f64,
    above: f64,
    between: f64,
}

impl TruncatedNormal {
    /// The normal law of `mean` and `std` > 0 between `lower` < `upper` (either may be infinite); `None` where less than
    /// [`TruncatedNormal::LEAST`] of the law lies between the bounds.
    pub fn new(mean: f64, std: f64, lower: f64, upper: f64) -> Option<Self> {
        let (a, b) = ((lower - mean) / std, (upper - mean) / std);
        // In an upper tail probabilities are 1 minus something and lose their digits: reflect it to a lower tail.
        let (std, a, b) = if a > 0.0 { (-std, -b, -a) } else { (std, a, b) };
        let (below, above) = (probability(a), probability(-b));
        // each form where it does not cancel
        let between = if b <= 0.0 { probability(b) - below } else { 1.0 - below - above };
        (between >= Self::LEAST).then_some(TruncatedNormal { mean, std, lower, upper, below, above, between })
    }

    /// The least probability between the bounds: further out than about 8.2 standard deviations the scene that is asked for
    /// has nothing to do with its nominal.
    pub const LEAST: f64 = 1e-16;

    #[inline]
    fn quantile(&self, u: f64) -> f64 {
        let p = self.below + u * self.between;
        let z = if p <= 0.5 { quantile(p) } else { -quantile(self.above + (1.0 - u) * self.between) };
        // The conditional law has no mass outside; this catches a last bit only.
        (self.mean + self.std * z).clamp(self.lower, self.upper)
    }

    fn quantiles(&self, u: &[f64; 8], values: &mut [f64; 8]) {
        let (mut tail, mut z) = ([0.0; 8], [0.0; 8]);
        for (tail, u) in tail.iter_mut().zip(u) {
            let u = if self.std < 0.0 { 1.0 - u } else { *u };
            let p = self.below + u * self.between;
            *tail = if p <= 0.5 { p } else { self.above + (1.0 - u) * self.between };
        }
        quantiles(&tail, &mut z);
        for ((value, u), z) in values.iter_mut().zip(u).zip(z) {
            let u = if self.std < 0.0 { 1.0 - u } else { *u };
            let z = if self.below + u * self.between <= 0.5 { z } else { -z };
            *value = (self.mean + self.std * z).max(self.lower).min(self.upper);
        }
    }
}

impl Distribution {
    /// The log-uniform law from `min` > 0 to `max` > `min`.
    pub fn log_uniform(min: f64, max: f64) -> Self {
        Distribution::LogUniform { min, max, log_ratio: libm::log(max / min) }
    }

    /// The value below which the fraction `u` of the law lies, 0 < u < 1.
    #[inline]
    pub fn quantile(&self, u: f64) -> f64 {
        match self {
            Distribution::Normal { mean, std } => mean + std * quantile(u),
            Distribution::TruncatedNormal(law) => law.quantile(if law.std < 0.0 { 1.0 - u } else { u }),
            Distribution::Uniform { min, max } => min + u * (max - min),
            Distribution::LogNormal { median, log_std } => median * libm::exp(log_std * quantile(u)),
            Distribution::LogUniform { min, max, log_ratio } => (min * libm::exp(u * log_ratio)).clamp(*min, *max),
            Distribution::Triangular { min, mode, max } => {
                let (rise, fall, width) = (mode - min, max - mode, max - min);
                if u * width < rise { min + (u * width * rise).sqrt() } else { max - ((1.0 - u) * width * fall).sqrt() }
            }
            Distribution::Beta(law) => law.quantile(u),
            Distribution::Choice(law) => law.quantile(u),
            Distribution::Empirical(law) => law.quantile(u),
            Distribution::Fixed(value) => *value,
        }
    }

    /// The values of eight normal scores z, that is the quantiles of Phi(z), for laws that are functions of z itself; false, and
    /// nothing done, for others. A score says more than its u in the upper tail.
    pub fn of_scores(&self, z: &[f64; 8], values: &mut [f64; 8]) -> bool {
        match self {
            Distribution::Normal { mean, std } => {
                for (value, z) in values.iter_mut().zip(z) {
                    *value = mean + std * z;
                }
                true
            }
            Distribution::LogNormal { median, log_std } => {
                for (value, z) in values.iter_mut().zip(z) {
                    *value = median * libm::exp(log_std * z);
                }
                true
            }
            _ => false,
        }
    }

    /// [`Distribution::quantile`] of eight numbers, with the same bits.
    pub fn quantiles(&self, u: &[f64; 8], values: &mut [f64; 8]) {
        match self {
            Distribution::Normal { mean, std } => {
                quantiles(u, values);
                for value in values {
                    *value = mean + std * *value;
                }
            }
            Distribution::TruncatedNormal(law) => law.quantiles(u, values),
            Distribution::Uniform { min, max } => {
                for (value, u) in values.iter_mut().zip(u) {
                    *value = min + u * (max - min);
                }
            }
            Distribution::LogNormal { median, log_std } => {
                quantiles(u, values);
                for value in values {
                    *value = median * libm::exp(log_std * *value);
                }
            }
            _ => {
                for (value, u) in values.iter_mut().zip(u) {
                    *value = self.quantile(*u);
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::stream::{SampleId, Stream};
    use super::*;
    use rand::SeedableRng;
    use rand_distr::Distribution as _;

    /// Number of values, level and critical value of each test of Kolmogorov and Smirnov: alpha = 1e-3 gives
    /// c = sqrt(-ln(alpha/2)/2) = 1.949, D = c/sqrt(n) = 0.0044. H0: the values follow the law. Power: a shift of the mean by
    /// 0.02 standard deviations moves the distribution function at the mean by 0.0080; the empirical function deviates there by
    /// 0.5/sqrt(n) = 0.0011 (1 sigma), so the shift is missed at > 3.2 sigma only, power > 0.999. The seed is fixed, so the
    /// outcome is too.
    const N: usize = 200_000;
    const CRITICAL: f64 = 1.949;

    fn values(law: Distribution) -> Vec<f64> {
        let mut stream = Stream::new(1, "test");
        let mut values: Vec<f64> = (0..N).map(|k| law.quantile(stream.uniform(SampleId(k as u64)))).collect();
        values.sort_by(f64::total_cmp);
        values
    }

    /// sqrt(n) times the largest distance between empirical and given distribution function; `values` sorted.
    fn distance(values: &[f64], law: impl Fn(f64) -> f64) -> f64 {
        let n = values.len() as f64;
        let far = values.iter().enumerate().fold(0.0f64, |far, (k, x)| {
            let p = law(*x);
            far.max((p - k as f64 / n).abs()).max(((k + 1) as f64 / n - p).abs())
        });
        far * n.sqrt()
    }

    fn truncated(mean: f64, std: f64, lower: f64, upper: f64) -> Distribution {
        Distribution::TruncatedNormal(TruncatedNormal::new(mean, std, lower, upper).expect("mass between the bounds"))
    }

    #[test]
    fn values_follow_their_law() {
        let normal = values(Distribution::Normal { mean: 3.0, std: 2.0 });
        assert!(distance(&normal, |x| probability((x - 3.0) / 2.0)) < CRITICAL);
        assert!(distance(&normal, |x| probability((x - 3.04) / 2.0)) > CRITICAL, "a shift of 0.02 std is found");

        let uniform = values(Distribution::Uniform { min: -1.0, max: 4.0 });
        assert!(distance(&uniform, |x| (x + 1.0) / 5.0) < CRITICAL);

        for (lower, upper) in [(-1.0, 1.0), (-0.5, 3.0), (0.5, 2.0), (2.0, f64::INFINITY), (-4.0, -3.0)] {
            let law = values(truncated(0.0, 1.0, lower, upper));
            let (a, b) = (probability(lower), probability(upper));
            assert!(distance(&law, |x| (probability(x) - a) / (b - a)) < CRITICAL, "[{lower}, {upper}]");
        }
    }

    /// H0: both samples, of N values each, follow one law; two-sample test at the same level.
    #[test]
    fn the_normal_law_is_that_of_another_implementation() {
        let ours = values(Distribution::Normal { mean: 0.0, std: 1.0 });
        let mut generator = rand::rngs::ChaCha8Rng::seed_from_u64(5);
        let mut theirs: Vec<f64> = (0..N).map(|_| rand_distr::StandardNormal.sample(&mut generator)).collect();
        theirs.sort_by(f64::total_cmp);
        let fraction = |x: f64| theirs.partition_point(|y| *y <= x) as f64 / N as f64;
        assert!(distance(&ours, fraction) < CRITICAL * 2.0f64.sqrt());
    }

    #[test]
    fn truncation_leaves_no_mass_at_the_bounds() {
        let at_bounds = |values: &[f64]| values.iter().filter(|x| x.abs() >= 1.0).count();
        let law = values(truncated(0.0, 1.0, -1.0, 1.0));
        assert_eq!(at_bounds(&law), 0);
        assert!(law[0] < -0.9999 && law[N - 1] > 0.9999, "the bounds are approached");
        // clamping instead: a third of the mass sits on the bounds, and the test of the law says no
        let clamped: Vec<f64> =
            values(Distribution::Normal { mean: 0.0, std: 1.0 }).into_iter().map(|x| x.clamp(-1.0, 1.0)).collect();
        assert!(at_bounds(&clamped) > N / 4);
        let (a, b) = (probability(-1.0), probability(1.0));
        assert!(distance(&clamped, |x| (probability(x) - a) / (b - a)) > 10.0 * CRITICAL);
    }

    #[test]
    fn quantiles_rise_and_keep_within_bounds_at_the_ends_of_u() {
        let ends = [f64::EPSILON / 2.0, 1e-9, 0.3, 0.5, 0.7, 1.0 - 1e-9, 1.0 - f64::EPSILON / 2.0];
        for law in [
            truncated(10.0, 0.1, 9.7, 10.3),
            truncated(10.0, 0.1, 10.5, f64::INFINITY),
            truncated(10.0, 0.1, f64::NEG_INFINITY, 9.5),
            truncated(-2.0, 3.0, -40.0, 40.0),
            Distribution::Uniform { min: 2.0, max: 3.0 },
            Distribution::Normal { mean: 1.0, std: 0.5 },
        ] {
            let values = ends.map(|u| law.quantile(u));
            assert!(values.is_sorted() && values.iter().all(|x| x.is_finite()), "{law:?}: {values:?}");
        }
        let tail = truncated(10.0, 0.1, 10.5, f64::INFINITY);
        assert!(ends.iter().all(|u| tail.quantile(*u) >= 10.5));
        assert_eq!(TruncatedNormal::new(0.0, 1.0, 9.0, 10.0), None);
    }

    #[test]
    fn eight_at_a_time_have_the_bits_of_one() {
        for law in [
            truncated(10.0, 0.1, 9.7, 10.3),
            truncated(10.0, 0.1, 10.2, f64::INFINITY),
            truncated(-1.0, 2.0, f64::NEG_INFINITY, 0.5),
            Distribution::Uniform { min: 2.0, max: 3.0 },
            Distribution::Normal { mean: 1.0, std: 0.5 },
        ] {
            let mut stream = Stream::new(2, "eight");
            for block in 0..500 {
                let (mut u, mut values) = ([0.0; 8], [0.0; 8]);
                stream.uniforms(block, &mut u);
                law.quantiles(&u, &mut values);
                assert_eq!(values.map(f64::to_bits), u.map(|u| law.quantile(u).to_bits()), "{law:?} {u:?}");
            }
        }
    }

    #[test]
    fn a_symmetric_law_has_its_median_at_the_mean() {
        assert_eq!(truncated(10.0, 0.1, 9.7, 10.3).quantile(0.5), 10.0);
        assert_eq!(Distribution::Uniform { min: 2.0, max: 3.0 }.quantile(0.5), 2.5);
    }
}
