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
pub mod pair;
pub mod power;
pub mod probability;
pub mod real;
pub mod saddle_point;
pub mod sine;
pub mod sums;
pub mod symmetric;
pub mod vector;

pub use isa::Isa;
pub use lanes::Lanes;
pub use pair::Pair;
pub use real::{Mask, Real};
