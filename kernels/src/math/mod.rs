//! Layer 0: arithmetic and elementary mathematics.
//!
//! - [`real`]: [`Real`], the arithmetic of kernels, and its [`Mask`]. [`lanes`]: [`Lanes`], eight `f64` in a vector.
//!   [`pair`]: [`Pair`], two numbers as one, for wide vector units. [`double_double`]: 106 bits. [`isa`]: run-time
//!   choice of instruction set; the only file that reads `SPINDRIFT_ISA`.
//! - [`incomplete_beta`], [`incomplete_gamma`], [`normal`]: distribution functions and inverses, on [`probability`] and
//!   [`saddle_point`].
//! - [`power`]: powers, logarithms and exponentials for step control. [`sine`]: sine and cosine of turns. [`sums`]:
//!   sums with rounding errors. [`chebyshev`]: piecewise Chebyshev series.
//! - [`vector`]: three-vectors, 3x3 matrices and quaternions. [`symmetric`]: symmetric matrices. [`list`]: short lists.

pub mod chebyshev;
pub mod double_double;
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
