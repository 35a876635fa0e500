//! `rayleigh`: the length of a vector with two independent normal components of mean zero and standard deviation `scale` (Lord
//! Rayleigh, *Phil. Mag.* 10 (1880) 73): an off-axis angle, a lateral offset.

use super::target::Target;
use super::traits::{NumberWords, Quantile, Scalar};
use crate::sampling::error::DispersionError;
use crate::sampling::keys::{KeyReader, KeyWriter, Values};

/// As written: standard deviation of each of the two components, in the parameter's unit.
#[derive(Clone, Debug, PartialEq)]
pub struct Rayleigh(pub Values);

/// Ready to be drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RayleighQuantile {
    scale: f64,
}

impl RayleighQuantile {
    /// With `scale` > 0.
    pub fn new(scale: f64) -> Self {
        RayleighQuantile { scale }
    }
}

impl Scalar for Rayleigh {
    const NAME: &'static str = "rayleigh";
    type Quantile = RayleighQuantile;

    fn read(keys: &mut dyn KeyReader) -> Option<Self> {
        keys.required("scale", "0.01").map(Rayleigh)
    }

    fn write(&self, keys: &mut dyn KeyWriter) {
        keys.values("scale", &self.0);
    }

    fn quantiles(&self, target: &Target<'_>) -> Result<Vec<RayleighQuantile>, DispersionError> {
        let remedy = "the standard deviation of each of two components, in the parameter's unit";
        let scale = target.passing("scale", &self.0, |x| x > 0.0, "> 0", remedy)?;
        target.all(|k| Ok(RayleighQuantile::new(scale[k])))
    }
}

impl Quantile for RayleighQuantile {
    /// sigma sqrt(-2 ln(1 - u)).
    fn quantile(&self, u: f64) -> f64 {
        self.scale * (-2.0 * libm::log1p(-u)).sqrt()
    }

    fn text(&self, words: NumberWords<'_>) -> String {
        format!("Rayleigh, scale {}", (words.amount)(self.scale))
    }
}
