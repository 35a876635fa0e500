//! `bernoulli`: a different `value` with some `probability`, else the nominal value.

use super::choice::Choice;
use super::prelude::*;

#[derive(Clone, Copy, Debug)]
pub struct Bernoulli;

impl Scalar for Bernoulli {
    const NAME: &'static str = "bernoulli";
    const KEYS: &'static [Row] = &[
        Row::amounts("value", "The value that the parameter takes with `probability`, instead of the nominal one")
            .required("0.0"),
        Row::values("probability", "Probability of `value`").required("0.05").within(
            "from 0 to 1",
            "0.05 is one in twenty",
            between(0.0, 1.0),
        ),
    ];
    type Quantile = Choice;

    fn of(target: &Target<'_>) -> Result<Vec<Choice>> {
        let (p, value) = (target.each("probability")?, target.each("value")?);
        target.all(|k| Ok(Choice::new(&[target.nominals[k], value[k]], &[1.0 - p[k], p[k]])))
    }
}
