//! Distributions: how each is written, checked against its target, and drawn.
//!
//! A distribution of one number ([`Scalar`]) becomes one quantile function of u in (0, 1) for each component
//! ([`Quantile`]). One of several numbers together ([`Together`]) becomes one map from a fixed number of u to all
//! components ([`Map`]). The same number of u gives a draw in every sample, so every design (random, Latin hypercube,
//! Sobol, ...) gives a distribution the same meaning, and one number can be correlated with another through their u.
//! Rejection and polar methods, which take an unknown number of u, are not here.
//!
//! To add a distribution, write its file and add it to the list below. [`target`] has the checks that distributions
//! share.

pub mod about_axis;
pub mod attitude_error;
pub mod bernoulli;
pub mod beta;
pub mod bootstrap;
pub mod choice;
pub mod direction;
pub mod empirical;
mod enumerations;
pub mod exponential;
pub mod gamma;
pub mod log_normal;
pub mod log_uniform;
pub mod normal;
pub mod of_score;
pub mod offset;
pub mod pert;
pub mod rayleigh;
pub mod student_t;
pub mod target;
pub mod traits;
pub mod triangular;
pub mod truncated_normal;
pub mod uniform;
pub mod uniform_attitude;
pub mod weibull;

pub use traits::{Map, Nested, NumberWords, Quantile, Scalar, Together};

use self::about_axis::AboutAxis;
use self::attitude_error::AttitudeError;
use self::bernoulli::Bernoulli;
use self::beta::Beta;
use self::bootstrap::Bootstrap;
use self::choice::Choice;
use self::direction::{Cone, UniformDirection, VonMisesFisher};
use self::empirical::Empirical;
use self::exponential::Exponential;
use self::gamma::Gamma;
use self::log_normal::LogNormal;
use self::log_uniform::LogUniform;
use self::normal::Normal;
use self::offset::Offset;
use self::pert::Pert;
use self::rayleigh::Rayleigh;
use self::student_t::StudentT;
use self::target::{JointTarget, Target};
use self::triangular::Triangular;
use self::truncated_normal::TruncatedNormal;
use self::uniform::Uniform;
use self::uniform_attitude::UniformAttitude;
use self::weibull::Weibull;
use crate::sampling::error::{DispersionError, error};
use crate::sampling::keys::{Kind, Row, Rule, Written};

enumerations::distributions! {
    one number:
        Normal, TruncatedNormal, Uniform, LogNormal, LogUniform, Triangular, Beta, Pert, Choice, Bernoulli,
        Empirical, Offset,
        Rayleigh, Exponential, Gamma, Weibull, StudentT;
    several together:
        UniformAttitude = UniformAttitude,
        UniformDirection = UniformDirection<DistributionKind>,
        Cone = Cone<DistributionKind>,
        VonMisesFisher = VonMisesFisher<DistributionKind>,
        AttitudeError = AttitudeError,
        AboutAxis = AboutAxis<DistributionKind>,
        Bootstrap = Bootstrap,
}

impl DistributionKind {
    /// The name in campaign files.
    pub const fn name(self) -> &'static str {
        Self::NAMES[self as usize]
    }

    /// The kind called `name`.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.iter().copied().find(|kind| kind.name() == name)
    }

    /// Whether a file of its own names the parameters, in place of the key `parameter`.
    pub fn names_parameters(self) -> bool {
        self.keys().iter().any(|row| matches!(row.kind, Kind::Columns))
    }
}

#[derive(Clone, Debug, PartialEq)]
pub struct WrittenDistribution {
    pub kind: DistributionKind,
    pub written: Written,
}

impl Nested for DistributionKind {
    type Quantile = Distribution;

    fn quantile(
        index: usize,
        key: &'static str,
        nominal: f64,
        (name, written): (&str, &Written),
    ) -> Result<Distribution, DispersionError> {
        let of = |kind: Self| kind.distributions(&Target { index, nominals: &[nominal], rows: kind.keys(), written });
        let found = Self::from_name(name).map_or(Ok(None), of).map_err(|inner| {
            let value = inner.value.map_or("{ ... }".to_owned(), |value| format!("{{ {} = {value} }}", inner.key));
            error(index, key, value, inner.allowed, inner.remedy)
        })?;
        found.and_then(|found| found.into_iter().next()).ok_or_else(|| {
            let remedy = "choose \"normal\" or \"uniform\"";
            error(index, key, format!("{name:?}"), "a distribution of one number", remedy)
        })
    }
}

#[cfg(test)]
mod tests {
    use super::normal::NormalQuantile;
    use super::truncated_normal::TruncatedNormalQuantile;
    use super::uniform::UniformQuantile;
    use super::*;
    use crate::math::normal::probability;
    use crate::sampling::stream::{SampleId, Stream};
    use rand::SeedableRng;
    use rand_distr::Distribution as _;

    /// Number of values, level and critical value of each test of Kolmogorov and Smirnov: alpha = 1e-3 gives c =
    /// sqrt(-ln(alpha/2)/2) = 1.949, D = c/sqrt(n) = 0.0044. H0: the values follow the law. Power: a shift of the mean
    /// by 0.02 standard deviations moves the distribution function at the mean by 0.0080; the empirical function
    /// deviates there by 0.5/sqrt(n) = 0.0011 (1 sigma), so the shift is missed at > 3.2 sigma only, power > 0.999. The
    /// seed is fixed, so the outcome is too.
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
        Distribution::TruncatedNormal(
            TruncatedNormalQuantile::new(mean, std, lower, upper).expect("mass between the bounds"),
        )
    }

    #[test]
    fn values_follow_their_distribution() {
        let normal = values(Distribution::Normal(NormalQuantile { mean: 3.0, std: 2.0 }));
        assert!(distance(&normal, |x| probability((x - 3.0) / 2.0)) < CRITICAL);
        assert!(distance(&normal, |x| probability((x - 3.04) / 2.0)) > CRITICAL, "a shift of 0.02 std is found");

        let uniform = values(Distribution::Uniform(UniformQuantile { min: -1.0, max: 4.0 }));
        assert!(distance(&uniform, |x| (x + 1.0) / 5.0) < CRITICAL);

        for (lower, upper) in [(-1.0, 1.0), (-0.5, 3.0), (0.5, 2.0), (2.0, f64::INFINITY), (-4.0, -3.0)] {
            let law = values(truncated(0.0, 1.0, lower, upper));
            let (a, b) = (probability(lower), probability(upper));
            assert!(distance(&law, |x| (probability(x) - a) / (b - a)) < CRITICAL, "[{lower}, {upper}]");
        }
    }

    /// H0: both samples, of N values each, follow one law; two-sample test at the same level.
    #[test]
    fn the_normal_distribution_is_that_of_another_implementation() {
        let ours = values(Distribution::Normal(NormalQuantile { mean: 0.0, std: 1.0 }));
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
        let clamped: Vec<f64> = values(Distribution::Normal(NormalQuantile { mean: 0.0, std: 1.0 }))
            .into_iter()
            .map(|x| x.clamp(-1.0, 1.0))
            .collect();
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
            Distribution::Uniform(UniformQuantile { min: 2.0, max: 3.0 }),
            Distribution::Normal(NormalQuantile { mean: 1.0, std: 0.5 }),
        ] {
            let values = ends.map(|u| law.quantile(u));
            assert!(values.is_sorted() && values.iter().all(|x| x.is_finite()), "{law:?}: {values:?}");
        }
        let tail = truncated(10.0, 0.1, 10.5, f64::INFINITY);
        for u in ends {
            assert!(tail.quantile(u) >= 10.5, "{u:e}: {}", tail.quantile(u));
        }
        assert_eq!(TruncatedNormalQuantile::new(0.0, 1.0, 9.0, 10.0), None);
    }

    #[test]
    fn eight_at_a_time_have_the_bits_of_one() {
        for law in [
            truncated(10.0, 0.1, 9.7, 10.3),
            truncated(10.0, 0.1, 10.2, f64::INFINITY),
            truncated(-1.0, 2.0, f64::NEG_INFINITY, 0.5),
            Distribution::Uniform(UniformQuantile { min: 2.0, max: 3.0 }),
            Distribution::Normal(NormalQuantile { mean: 1.0, std: 0.5 }),
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
    fn a_symmetric_distribution_has_its_median_at_the_mean() {
        assert_eq!(truncated(10.0, 0.1, 9.7, 10.3).quantile(0.5), 10.0);
        assert_eq!(Distribution::Uniform(UniformQuantile { min: 2.0, max: 3.0 }).quantile(0.5), 2.5);
    }
}
