//! `uniform_direction`, `cone`, `von_mises_fisher`: direction and magnitude of a vector separately, with `axis`
//! (default: the nominal vector) and `[disperse.magnitude]` (default: the nominal length).
//!
//! Isotropic means uniform in the cosine of the angle to the axis, not in components or the angle (test
//! `usual_mistakes_are_caught`).

use super::prelude::*;
use crate::math::vector::{cross, norm, scaled};
use core::f64::consts::{PI, TAU};
use std::fmt::Debug;

const AXIS: Row = Row::new("axis", Kind::Vector, "The axis, of any length; default: the nominal vector");
const MAGNITUDE: Row =
    Row::new("magnitude", Kind::Distribution, "The distribution of the length; default: the nominal length");

/// The distribution of the angle to the axis; the azimuth is uniform.
pub trait Spread: Clone + Copy + Debug + PartialEq {
    /// The name of the distribution in campaign files.
    const NAME: &'static str;
    const KEYS: &'static [Row];
    /// The axis where the nominal vector is zero.
    const AXIS: Option<[f64; 3]> = None;

    fn new(target: &Target<'_>) -> Self;

    /// 1 - cos(theta) at `u`, exact near the axis, where 1 minus a cosine has no digits.
    fn versine(self, u: f64) -> f64;

    /// Its description, about the written `axis`.
    fn text(self, axis: &str, words: NumberWords<'_>) -> String;
}

/// Uniform over the sphere.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sphere;

impl Spread for Sphere {
    const NAME: &'static str = "uniform_direction";
    const KEYS: &'static [Row] = &[AXIS, MAGNITUDE];
    const AXIS: Option<[f64; 3]> = Some([0.0, 0.0, 1.0]);

    fn new(_target: &Target<'_>) -> Self {
        Sphere
    }

    #[inline]
    fn versine(self, u: f64) -> f64 {
        2.0 * u
    }

    fn text(self, _axis: &str, _words: NumberWords<'_>) -> String {
        "direction uniform over the sphere".to_owned()
    }
}

/// Uniform within a cone of this half-angle, rad.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cone(f64);

impl Spread for Cone {
    const NAME: &'static str = "cone";
    const KEYS: &'static [Row] = &[
        Row::new("half_angle_rad", Kind::Number, "Half-angle of the cone")
            .required_as("given, above 0 and at most pi", "0.1")
            .within("above 0 and at most pi", "write an angle in radians", between(f64::MIN_POSITIVE, PI)),
        AXIS,
        MAGNITUDE,
    ];

    fn new(target: &Target<'_>) -> Self {
        Cone(target.written.number("half_angle_rad").unwrap_or(f64::NAN))
    }

    #[inline]
    fn versine(self, u: f64) -> f64 {
        let sine = libm::sin(0.5 * self.0);
        2.0 * sine * sine * u
    }

    fn text(self, axis: &str, words: NumberWords<'_>) -> String {
        format!("direction uniform within {} of {axis}", (words.angle)(self.0))
    }
}

/// Von Mises-Fisher: density proportional to exp(kappa cos theta) (R. A. Fisher, *Dispersion on a sphere*, Proc. R.
/// Soc. A 217, 1953), with this kappa > 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct VonMisesFisher(f64);

impl Spread for VonMisesFisher {
    const NAME: &'static str = "von_mises_fisher";
    const KEYS: &'static [Row] = &[
        Row::new("concentration", Kind::Number, "kappa; about 1/sigma^2 for a narrow distribution")
            .required_as("given, above 0", "100.0")
            .within(
                "above 0",
                "1/sigma^2 of a narrow distribution: 100 spreads about 0.1 rad each way",
                between(f64::MIN_POSITIVE, f64::MAX),
            ),
        AXIS,
        MAGNITUDE,
    ];

    fn new(target: &Target<'_>) -> Self {
        VonMisesFisher(target.written.number("concentration").unwrap_or(f64::NAN))
    }

    #[inline]
    fn versine(self, u: f64) -> f64 {
        // P(1 - cos <= v) = (1 - exp(-kappa v))/(1 - exp(-2 kappa))
        (-libm::log1p(u * libm::expm1(-2.0 * self.0)) / self.0).min(2.0)
    }

    fn text(self, axis: &str, words: NumberWords<'_>) -> String {
        format!("direction von Mises-Fisher, kappa {}, about {axis}", (words.number)(self.0))
    }
}

#[derive(Clone, Debug, PartialEq)]
pub struct Direction<Q, S> {
    /// Two unit vectors normal to the axis, then the axis.
    frame: [[f64; 3]; 3],
    spread: S,
    magnitude: Magnitude<Q>,
}

#[derive(Clone, Debug, PartialEq)]
enum Magnitude<Q> {
    Fixed(f64),
    Drawn(Q),
}

impl<Q: Nested, S: Spread> Together for Direction<Q, S> {
    const NAME: &'static str = S::NAME;
    const KEYS: &'static [Row] = S::KEYS;

    fn map(target: &Target<'_>) -> Result<Self> {
        let nominal = target.vector(S::NAME)?;
        let length = length_of(nominal);
        let axis = match (target.written.vector("axis"), S::AXIS) {
            (Some(axis), _) => target.axis(axis)?,
            (None, _) if length > 0.0 => target.axis(nominal)?,
            (None, Some(axis)) => axis,
            (None, None) => {
                let allowed = "given where the nominal vector is zero and has no direction";
                return target.lacks("axis", allowed, "add axis = [0, 0, 1]");
            }
        };
        let magnitude = match target.written.has("magnitude") {
            true if target.is_direction() => {
                let allowed = format!("left out: the length of {} has no effect", target.parameter.name());
                return target.refused("magnitude", "{ ... }", allowed, "delete it");
            }
            true => Magnitude::Drawn(Q::nested(target, "magnitude", length)?),
            false if length == 0.0 => {
                let allowed = "given where the nominal vector is zero: every direction of it would be zero";
                let remedy = "add magnitude = { distribution = \"uniform\", min = 0, max = 1 }";
                return target.lacks("magnitude", allowed, remedy);
            }
            false => Magnitude::Fixed(length),
        };
        Ok(Direction { frame: frame(axis), spread: S::new(target), magnitude })
    }
}

impl<Q: Nested, S: Spread> Map for Direction<Q, S> {
    fn dimensions(&self) -> usize {
        match &self.magnitude {
            Magnitude::Fixed(_) => 2,
            Magnitude::Drawn(quantile) => 2 + quantile.dimensions(),
        }
    }

    /// A negative magnitude points backwards.
    fn values(&self, u: &[f64], values: &mut [f64]) {
        let versine = self.spread.versine(u[0]);
        let (sine, cosine) = ((versine * (2.0 - versine)).sqrt(), 1.0 - versine);
        let (s, c) = libm::sincos(TAU * u[1]);
        let magnitude = match &self.magnitude {
            Magnitude::Fixed(length) => *length,
            Magnitude::Drawn(quantile) => quantile.quantile(u.get(2).copied().unwrap_or(0.5)),
        };
        let [x, y, z] = self.frame;
        for (i, value) in values[..3].iter_mut().enumerate() {
            *value = magnitude * (sine * (c * x[i] + s * y[i]) + cosine * z[i]);
        }
    }

    fn text(&self, words: NumberWords<'_>) -> String {
        let [x, y, z] = self.frame[2].map(words.number);
        let direction = self.spread.text(&format!("[{x}, {y}, {z}]"), words);
        match &self.magnitude {
            Magnitude::Fixed(length) => format!("{direction}, magnitude {}", (words.amount)(*length)),
            Magnitude::Drawn(quantile) => format!("{direction}, magnitude {}", quantile.text(words)),
        }
    }
}

fn length_of(vector: [f64; 3]) -> f64 {
    let largest = vector.iter().fold(0.0f64, |largest, x| largest.max(x.abs()));
    if largest == 0.0 || (1e-150..1e150).contains(&largest) {
        return norm(vector);
    }
    largest * norm(vector.map(|x| x / largest))
}

/// Two unit vectors normal to `axis` and the unit vector along it, right-handed.
fn frame(axis: [f64; 3]) -> [[f64; 3]; 3] {
    let z = scaled(1.0 / norm(axis), axis);
    let least = (1..3).fold(0, |least, i| if z[i].abs() < z[least].abs() { i } else { least });
    let mut other = [0.0; 3];
    other[least] = 1.0;
    let x = cross(other, z);
    let x = scaled(1.0 / norm(x), x);
    [x, cross(z, x), z]
}
