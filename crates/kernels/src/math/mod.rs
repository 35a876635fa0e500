//! Layer 0: arithmetic and elementary mathematics.

pub mod chebyshev;
pub mod double_double;
pub(crate) mod enumeration;
pub mod incomplete_beta;
pub mod incomplete_gamma;
pub mod isa;
pub mod lanes;
pub mod list;
pub mod normal;
pub(crate) mod one;
pub(crate) mod pair;
pub(crate) mod power;
pub(crate) mod prelude;
pub(crate) mod probability;
pub(crate) mod real;
pub(crate) mod saddle_point;
pub(crate) mod sine;
pub(crate) mod sums;
pub mod symmetric;
pub mod vector;

pub use isa::Isa;
pub use lanes::Lanes;
pub use pair::Pair;
pub use real::{Mask, Real};
