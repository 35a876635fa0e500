//! Floor 2: random draws. Streams, distributions, dispersions; a draw is a pure function of (seed, sample, parameter).
//!
//! A draw goes through four rooms, one after the other, so that each can grow without the others:
//! 1. [`stream`], the random *design*: a number u in (0, 1) for each (seed, sample, component name). Other designs (Latin
//!    hypercube, Sobol, table) would give their u here;
//! 2. a dependence between the u of several components (a copula) would stand here; today they are independent;
//! 3. [`distribution`]: u -> value, through one quantile function each;
//! 4. [`dispersion`]: the value into the scene, and what was applied out of it.

pub mod dispersion;
pub mod distribution;
pub mod normal;
pub mod stream;

pub use dispersion::{Cut, Dispersion, DispersionError, Dispersions, Law, Range, Sampler, Spread, Values};
pub use distribution::Distribution;
pub use stream::{SampleId, Stream};
