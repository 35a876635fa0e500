//! Distributions: keys, checks against the target, draws.
//!
//! A distribution of one number ([`Scalar`]) becomes a quantile function of u in (0, 1) for each component
//! ([`Quantile`]), a joint one ([`Together`]) a map from several u to all components ([`Map`]). Every sample takes the
//! same number of u, so that a distribution means the same in every design and u can be correlated; rejection and polar
//! methods, which take a random number of u, are excluded.
//!
//! A new distribution needs its file and a row of the list below; [`target`] has the common checks.

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

    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.iter().copied().find(|kind| kind.name() == name)
    }

    /// Whether its file names the parameters, instead of the key `parameter`.
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
    use super::empirical::{EmpiricalQuantile, Interpolation};
    use super::log_uniform::LogUniformQuantile;
    use super::normal::NormalQuantile;
    use super::triangular::TriangularQuantile;
    use super::truncated_normal::TruncatedNormalQuantile;
    use super::uniform::UniformQuantile;
    use super::*;
    use crate::sampling::stream::Stream;

    fn truncated(mean: f64, std: f64, lower: f64, upper: f64) -> Distribution {
        Distribution::TruncatedNormal(
            TruncatedNormalQuantile::new(mean, std, lower, upper).expect("mass between the bounds"),
        )
    }

    /// Law: widths and ratios beyond the largest number give the values of the same shape, scaled.
    #[test]
    fn overflowing_widths_keep_the_shape() {
        let most = 1.7e308;
        let triangle = |size: f64| TriangularQuantile { min: -size, mode: 0.5 * size, max: size };
        for (law, values) in [
            (Distribution::Uniform(UniformQuantile { min: -most, max: most }), [-0.5 * most, 0.0, 0.5 * most]),
            (
                Distribution::Empirical(EmpiricalQuantile::new(&[most, -most], Interpolation::Linear)),
                [-0.5 * most, 0.0, 0.5 * most],
            ),
            (Distribution::LogUniform(LogUniformQuantile::new(1e-300, 1e300)), [1e-150, 1.0, 1e150]),
            (Distribution::Triangular(triangle(most)), [0.25, 0.5, 0.75].map(|u| most * triangle(1.0).quantile(u))),
            (Distribution::Triangular(triangle(1e160)), [0.25, 0.5, 0.75].map(|u| 1e160 * triangle(1.0).quantile(u))),
        ] {
            for (u, expected) in [0.25, 0.5, 0.75].into_iter().zip(values) {
                // an ulp of the logarithm, 345, is worth 5.7e-14 of the value; measured: 4.5e-14
                assert!((law.quantile(u) - expected).abs() <= 2e-13 * expected.abs(), "{law:?} {u}");
            }
        }
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
}
