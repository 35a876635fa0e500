//! `student_t`: about the nominal value, with `degrees_of_freedom` and `scale` or `relative_scale` (Student,
//! *Biometrika* 6 (1908) 1): heavier tails than normal. Tabulated ([`super::of_score`]) as asinh(t/sqrt(nu)).

use super::of_score::OfScore;
use super::prelude::*;
use crate::math::incomplete_beta::logit_quantile;

#[derive(Clone, Debug, PartialEq)]
pub struct StudentT {
    degrees_of_freedom: f64,
    middle: f64,
    /// Scale times sqrt(nu).
    factor: f64,
    scale: f64,
    /// asinh(t/sqrt(nu)).
    asinh: OfScore,
}

/// Allowed degrees of freedom: below, values overflow; above, the distribution is normal to four digits.
const DEGREES: Range = between(0.5, 1e4);

impl StudentT {
    /// With `degrees_of_freedom` from 0.5 to 1e4 about `middle`.
    pub fn new(degrees_of_freedom: f64, middle: f64, scale: f64) -> Self {
        // t^2 = nu (1 - x)/x at the smaller tail I_x(nu/2, 1/2)/2 (DLMF 8.17); the median, 0, is exact
        let tail = |p: f64| {
            libm::asinh(libm::exp(-0.5 * logit_quantile(2.0 * p, 1.0 - 2.0 * p, 0.5 * degrees_of_freedom, 0.5)))
        };
        let asinh = move |p: f64, q: f64| match p.partial_cmp(&q) {
            Some(std::cmp::Ordering::Less) => -tail(p),
            Some(std::cmp::Ordering::Greater) => tail(q),
            _ => 0.0,
        };
        let factor = scale * degrees_of_freedom.sqrt();
        StudentT { degrees_of_freedom, middle, factor, scale, asinh: OfScore::new(&asinh, 0.5 * degrees_of_freedom) }
    }
}

impl Scalar for StudentT {
    const NAME: &'static str = "student_t";
    const KEYS: &'static [Row] =
        &[
            Row::values("degrees_of_freedom", "Degrees of freedom; 1 is the Cauchy distribution")
                .required("5.0")
                .within("a number from 0.5 to 1e4", "above 1e4 use a normal distribution", DEGREES),
            Row::amounts("scale", "Scale about the nominal value").not_negative(),
            Row::values("relative_scale", "Scale as a fraction of the nominal value").not_negative(),
        ];
    const RULES: &'static [Rule] = &[Rule::One(&[&["scale"], &["relative_scale"]], "0.1", ALL_BUT_ONE)];
    type Quantile = Self;

    fn of(target: &Target<'_>) -> Result<Vec<Self>> {
        let degrees = target.each("degrees_of_freedom")?;
        let scale = target.amounts("scale", "relative_scale")?;
        target.all(|k| Ok(Self::new(degrees[k], target.nominals[k], scale[k])))
    }
}

impl Quantile for StudentT {
    fn at_score(&self, z: f64) -> Option<f64> {
        Some(self.middle + self.factor * libm::sinh(self.asinh.value(z)))
    }

    fn text(&self, words: NumberWords<'_>) -> String {
        format!(
            "Student's t, {} degrees of freedom, scale {}",
            (words.number)(self.degrees_of_freedom),
            (words.amount)(self.scale)
        )
    }
}
