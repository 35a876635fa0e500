//! Layer 2: random draws. Streams, designs, distributions, dispersions; a draw is a pure function of (seed, sample,
//! parameter).
//!
//! A draw takes five steps:
//! 1. [`design`]: u in (0, 1) for each sample and random dimension, for the random design from [`stream`];
//! 2. [`copula`]: dependence between the u of several dimensions;
//! 3. [`distribution`]: from u to values;
//! 4. [`expression`]: values derived from others;
//! 5. [`dispersions`]: distributions assigned to columns and checked against the nominal scene;
//!    [`sampler`]: values written into the scene, and read back as applied.

pub mod columns;
pub mod copula;
pub mod correlation;
pub mod derivation;
pub mod design;
pub mod dispersions;
pub mod distribution;
pub mod error;
pub mod expression;
pub mod keys;
pub mod rank;
pub mod sampler;
pub mod stream;

pub use columns::{Column, Component};
pub use correlation::{Correlation, Measure, Replaced};
pub use derivation::Derivation;
pub use design::Design;
pub use dispersions::{Dispersion, Dispersions, Draws, Transform};
pub use distribution::{Distribution, DistributionKind, Joint, NumberWords, WrittenDistribution};
pub use error::{DispersionError, Table};
pub use keys::{DataColumn, Values, Written};
pub use sampler::Sampler;
pub use stream::{Noise, SampleId, Stream};
