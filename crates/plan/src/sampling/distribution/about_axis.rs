//! `about_axis`: the nominal attitude turned about a body `axis` by a random angle (`[disperse.angle_rad]`).

use super::prelude::*;
use crate::math::vector::{hamilton, norm, scaled};

/// q = q_0 (x) exp(angle axis/2).
#[derive(Clone, Debug, PartialEq)]
pub struct AboutAxis<Q> {
    nominal: [f64; 4],
    axis: [f64; 3],
    angle: Q,
}

impl<Q: Nested> Together for AboutAxis<Q> {
    const NAME: &'static str = "about_axis";
    const KEYS: &'static [Row] = &[
        Row::new("axis", Kind::Vector, "The axis, of any length, in the frame of the body")
            .required_as("given, an array of 3 finite numbers", "[0, 0, 1]"),
        Row::new("angle_rad", Kind::Distribution, "The distribution of the angle about it")
            .required_as("given, a distribution of one number", "{ distribution = \"normal\", std = 0.1 }"),
    ];

    fn map(target: &Target<'_>) -> Result<Self> {
        let nominal = target.attitude(Self::NAME)?;
        let axis = target.axis(target.written.vector("axis").unwrap_or_default())?;
        let angle = Q::nested(target, "angle_rad", 0.0)?;
        Ok(AboutAxis { nominal, axis: scaled(1.0 / norm(axis), axis), angle })
    }
}

impl<Q: Nested> Map for AboutAxis<Q> {
    fn dimensions(&self) -> usize {
        self.angle.dimensions()
    }

    fn values(&self, u: &[f64], values: &mut [f64]) {
        let (sine, cosine) = libm::sincos(0.5 * self.angle.quantile(u.first().copied().unwrap_or(0.5)));
        let [x, y, z] = scaled(sine, self.axis);
        values[..4].copy_from_slice(&hamilton(self.nominal, [cosine, x, y, z]));
    }

    fn text(&self, words: NumberWords<'_>) -> String {
        let [x, y, z] = self.axis.map(words.number);
        let angle = self.angle.text(NumberWords { amount: words.angle, ..words });
        format!("nominal attitude turned about [{x}, {y}, {z}], angle {angle}")
    }
}
