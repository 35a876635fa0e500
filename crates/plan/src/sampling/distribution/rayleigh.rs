//! `rayleigh`: the length of a vector with two independent normal components of mean zero and standard deviation
//! `scale` (Lord Rayleigh, *Phil. Mag.* 10 (1880) 73): an off-axis angle, a lateral offset.

use super::prelude::*;

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rayleigh {
    /// Above 0.
    pub scale: f64,
}

impl Scalar for Rayleigh {
    const NAME: &'static str = "rayleigh";
    const KEYS: &'static [Row] = &[Row::amounts("scale", "Standard deviation of each of the two components")
        .required("0.01")
        .within("> 0", "the standard deviation of each of two components, in the parameter's unit", above(0.0))];
    type Quantile = Self;

    fn of(target: &Target<'_>) -> Result<Vec<Self>> {
        target.of_numbers(["scale"], |[scale]| Rayleigh { scale })
    }
}

impl Quantile for Rayleigh {
    /// sigma sqrt(-2 ln(1 - u)).
    fn quantile(&self, u: f64) -> f64 {
        self.scale * (-2.0 * libm::log1p(-u)).sqrt()
    }

    fn text(&self, words: NumberWords<'_>) -> String {
        format!("Rayleigh, scale {}", (words.amount)(self.scale))
    }
}
