//! Floor 2: random draws. Streams, distributions, dispersions; a draw is a pure function of (seed, sample, parameter).
//!
//! A draw goes through rooms, one after the other, so that each can grow without the others:
//! 1. [`design`]: for each sample and each random dimension a number u in (0, 1); the random design takes them from
//!    [`stream`];
//! 2. [`copula`]: dependence between the u of several dimensions;
//! 3. laws map u to values: [`distribution`] ([`beta`], [`discrete`], [`normal`]), one quantile function each, for one number;
//!    [`joint`] for several together, [`geometric`] for directions and attitudes ([`law`], [`geometric_law`]: as written;
//!    [`scalar`]: from there to a distribution);
//! 4. [`expression`]: values that follow from others ([`dependence`]: correlation and derivation as written);
//! 5. [`dispersions`]: which law writes what, checked against the nominal scene; [`sampler`]: values into the scene, and what
//!    was applied out of it.

pub mod beta;
pub mod copula;
pub mod dependence;
pub mod design;
pub mod discrete;
pub mod dispersions;
pub mod distribution;
pub mod expression;
pub mod geometric;
pub mod geometric_law;
pub mod joint;
pub mod law;
pub mod sampler;
pub mod scalar;
pub mod stream;

pub use dependence::{Correlation, Dependence, Derivation};
pub use design::levels::Levels;
pub use design::{DESIGNS, Design};
pub use dispersions::{Column, Dispersions, Draws, Transform};
pub use distribution::Distribution;
pub use geometric_law::{AttitudeSpread, GeometricLaw};
pub use joint::Joint;
pub use law::{
    Bound, DataColumn, Dispersion, DispersionError, Interpolation, Law, LogRange, Offset, Range, Spread, Table,
    Truncation, Values,
};
pub use sampler::Sampler;
pub use stream::{SampleId, Stream};
