//! Floor 2: random draws. Streams, distributions, dispersions; a draw is a pure function of (seed, sample, parameter).
//!
//! A draw goes through rooms, one after the other, so that each can grow without the others:
//! 1. [`design`]: for each sample and each random dimension a number u in (0, 1); the random design takes them from
//!    [`stream`];
//! 2. laws map u to values: [`distribution`], one quantile function each, for one number; [`joint`] for several together
//!    ([`law`]: as written; [`scalar`]: from there to a distribution);
//! 3. [`dispersions`]: which law writes what, checked against the nominal scene; [`sampler`]: values into the scene, and what
//!    was applied out of it.

pub mod beta;
pub mod design;
pub mod discrete;
pub mod dispersions;
pub mod distribution;
pub mod joint;
pub mod law;
pub mod normal;
pub mod sampler;
pub mod scalar;
pub mod stream;

pub use dispersions::{Column, Dispersions, Map};
pub use distribution::Distribution;
pub use joint::Joint;
pub use law::{
    Bound, Cut, DataColumn, Dispersion, DispersionError, Interpolation, Law, LogRange, Offset, Range, Spread, Values,
};
pub use sampler::Sampler;
pub use stream::{SampleId, Stream};
