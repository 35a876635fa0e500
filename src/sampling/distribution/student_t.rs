//! `student_t`: about the nominal value, with `degrees_of_freedom` and `scale`, or `relative_scale` (Student, *Biometrika* 6 (1908) 1):
//! an error whose tails are heavier than normal. From a table of its quantiles ([`super::of_score`]) of asinh(t/sqrt(nu)).

use super::of_score::OfScore;
use super::target::Target;
use super::traits::{NumberWords, Quantile, Scalar, each_score};
use crate::math::incomplete_beta::logit_quantile;
use crate::math::normal::quantile;
use crate::sampling::error::DispersionError;
use crate::sampling::keys::{KeyReader, KeyWriter, Values};

/// The scale as written.
#[derive(Clone, Debug, PartialEq)]
pub enum Scale {
    /// In the parameter's unit (`scale`).
    Absolute(Values),
    /// As a fraction of the nominal's absolute value (`relative_scale`).
    Relative(Values),
}

/// As written.
#[derive(Clone, Debug, PartialEq)]
pub struct StudentT {
    /// Degrees of freedom nu, pure; 1 is the Cauchy distribution.
    pub degrees_of_freedom: Values,
    /// Of (value - nominal)/scale = t.
    pub scale: Scale,
}

/// Ready to be drawn.
#[derive(Clone, Debug, PartialEq)]
pub struct StudentTQuantile {
    degrees_of_freedom: f64,
    middle: f64,
    /// Scale times sqrt(nu).
    factor: f64,
    scale: f64,
    /// asinh(t/sqrt(nu)).
    asinh: OfScore,
}

/// Allowed degrees of freedom: below, values overflow; above, the distribution is normal to four digits.
const DEGREES: std::ops::RangeInclusive<f64> = 0.5..=1e4;

impl StudentTQuantile {
    /// The distribution of `degrees_of_freedom` from 0.5 to 1e4 about `middle`.
    pub fn new(degrees_of_freedom: f64, middle: f64, scale: f64) -> Self {
        // t^2 = nu (1 - x)/x where the smaller tail is I_x(nu/2, 1/2)/2 (DLMF 8.17); the median, at 0, is exact
        let tail = |p: f64| {
            libm::asinh(libm::exp(-0.5 * logit_quantile(2.0 * p, 1.0 - 2.0 * p, 0.5 * degrees_of_freedom, 0.5)))
        };
        let asinh = move |p: f64, q: f64| match p.partial_cmp(&q) {
            Some(std::cmp::Ordering::Less) => -tail(p),
            Some(std::cmp::Ordering::Greater) => tail(q),
            _ => 0.0,
        };
        let factor = scale * degrees_of_freedom.sqrt();
        StudentTQuantile {
            degrees_of_freedom,
            middle,
            factor,
            scale,
            asinh: OfScore::new(&asinh, 0.5 * degrees_of_freedom),
        }
    }

    /// The value at the normal score `z`.
    fn at_score(&self, z: f64) -> f64 {
        self.middle + self.factor * libm::sinh(self.asinh.value(z))
    }
}

impl Scalar for StudentT {
    const NAME: &'static str = "student_t";
    type Quantile = StudentTQuantile;

    fn read(keys: &mut dyn KeyReader) -> Option<Self> {
        let degrees_of_freedom = keys.required("degrees_of_freedom", "5.0");
        let one = keys.is_one_of(&["scale", "relative_scale"], "0.1");
        let (absolute, relative) = (keys.values("scale"), keys.values("relative_scale"));
        let scale = absolute.map(Scale::Absolute).or(relative.map(Scale::Relative)).filter(|_| one);
        degrees_of_freedom.zip(scale).map(|(degrees_of_freedom, scale)| StudentT { degrees_of_freedom, scale })
    }

    fn write(&self, keys: &mut dyn KeyWriter) {
        keys.values("degrees_of_freedom", &self.degrees_of_freedom);
        match &self.scale {
            Scale::Absolute(values) => keys.values("scale", values),
            Scale::Relative(values) => keys.values("relative_scale", values),
        }
    }

    fn quantiles(&self, target: &Target<'_>) -> Result<Vec<StudentTQuantile>, DispersionError> {
        let (allowed, remedy) = ("a number from 0.5 to 1e4", "above 1e4 use a normal distribution");
        let degrees = target.passing(
            "degrees_of_freedom",
            &self.degrees_of_freedom,
            |x| DEGREES.contains(&x),
            allowed,
            remedy,
        )?;
        let scale = match &self.scale {
            Scale::Absolute(values) => target.widths("scale", values, None)?,
            Scale::Relative(values) => target.widths("relative_scale", values, Some("scale"))?,
        };
        target.all(|k| Ok(StudentTQuantile::new(degrees[k], target.nominals[k], scale[k])))
    }
}

impl Quantile for StudentTQuantile {
    fn quantile(&self, u: f64) -> f64 {
        self.at_score(quantile(u))
    }

    fn of_scores(&self, z: &[f64; 8], values: &mut [f64; 8]) -> bool {
        each_score(z, values, |z| self.at_score(z))
    }

    fn text(&self, words: NumberWords<'_>) -> String {
        format!(
            "Student's t, {} degrees of freedom, scale {}",
            (words.number)(self.degrees_of_freedom),
            (words.amount)(self.scale)
        )
    }
}
