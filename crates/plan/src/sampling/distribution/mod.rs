//! Distributions: keys, checks against the target, draws.
//!
//! A distribution of one number ([`Scalar`]) becomes a quantile function of u in (0, 1) for each component
//! ([`Quantile`]), a joint one ([`Together`]) a map from several u to all components ([`Map`]). Every sample takes the
//! same number of u, so that a distribution means the same in every design and u can be correlated; this excludes
//! rejection and polar methods.
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
mod prelude;
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
use self::direction::{Cone, Direction, Sphere, VonMisesFisher};
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
use self::target::Target;
use self::triangular::Triangular;
use self::truncated_normal::TruncatedNormal;
use self::uniform::Uniform;
use self::uniform_attitude::UniformAttitude;
use self::weibull::Weibull;
use crate::sampling::error::Result;
use crate::sampling::keys::{Kind, Row, Rule, Value, Written};
use std::ops::Deref;

enumerations::distributions! {
    one number:
        Normal, TruncatedNormal, Uniform, LogNormal, LogUniform, Triangular, Beta, Pert, Choice, Bernoulli,
        Empirical, Offset,
        Rayleigh, Exponential, Gamma, Weibull, StudentT;
    several together:
        UniformAttitude = UniformAttitude,
        UniformDirection = Direction<Distribution, Sphere>,
        Cone = Direction<Distribution, Cone>,
        VonMisesFisher = Direction<Distribution, VonMisesFisher>,
        AttitudeError = AttitudeError,
        AboutAxis = AboutAxis<Distribution>,
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

    pub const fn keys(self) -> &'static [Row] {
        self.table().0
    }

    /// Rules between keys.
    pub const fn rules(self) -> &'static [Rule] {
        self.table().1
    }

    /// True if its file names the parameters, instead of the key `parameter`.
    pub fn names_parameters(self) -> bool {
        self.keys().iter().any(|row| matches!(row.kind, Kind::Columns))
    }
}

#[derive(Clone, Debug, PartialEq)]
pub struct WrittenDistribution {
    pub kind: DistributionKind,
    pub written: Written,
}

impl Nested for Distribution {
    fn nested(target: &Target<'_>, key: &'static str, nominal: f64) -> Result<Self> {
        let Some(Value::Distribution(name, written)) = target.written.get(key) else {
            return target.lacks(key, "given", "write a distribution of one number");
        };
        let of = |kind: DistributionKind| {
            kind.distributions(&Target { nominals: &[nominal], rows: kind.keys(), written, ..*target })
        };
        let found = DistributionKind::from_name(name).map_or(Ok(None), of).or_else(|inner| {
            let value = inner.value.map_or("{ ... }".to_owned(), |value| format!("{{ {} = {value} }}", inner.key));
            target.refused(key, value, inner.allowed, inner.remedy)
        })?;
        match found.and_then(|found| found.into_iter().next()) {
            Some(found) => Ok(found),
            None => {
                let remedy = "choose \"normal\" or \"uniform\"";
                target.refused(key, format!("{name:?}"), "a distribution of one number", remedy)
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::empirical::Interpolation;
    use super::*;
    use crate::sampling::stream::Stream;

    fn truncated(mean: f64, std: f64, lower: f64, upper: f64) -> Distribution {
        Distribution::TruncatedNormal(TruncatedNormal::new(mean, std, lower, upper).expect("mass between the bounds"))
    }

    /// Law: widths and ratios beyond the largest number give the values of the same shape, scaled.
    #[test]
    fn overflowing_widths_keep_the_shape() {
        let most = 1.7e308;
        let triangle = |size: f64| Triangular { min: -size, mode: 0.5 * size, max: size };
        for (law, values) in [
            (Distribution::Uniform(Uniform { min: -most, max: most }), [-0.5 * most, 0.0, 0.5 * most]),
            (
                Distribution::Empirical(Empirical::new(&[most, -most], Interpolation::Linear)),
                [-0.5 * most, 0.0, 0.5 * most],
            ),
            (Distribution::LogUniform(LogUniform::new(1e-300, 1e300)), [1e-150, 1.0, 1e150]),
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
            Distribution::Uniform(Uniform { min: 2.0, max: 3.0 }),
            Distribution::Normal(Normal { mean: 1.0, std: 0.5 }),
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
