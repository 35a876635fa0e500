//! Layer 0: arithmetic and elementary mathematics, no physics.
//!
//! - [`real`]: [`Real`], the trait that kernels are generic over (`f64`, eight lanes of `f64`), and its [`Mask`].
//! - [`double_double`]: 106 bits, for reference solutions.
//! - [`lanes`]: [`Lanes`], eight `f64` in one vector of the chosen instruction set.
//! - [`chebyshev`]: smooth functions as pieces of Chebyshev series.
//! - [`incomplete_beta`], [`incomplete_gamma`], [`normal`]: distribution functions and their inverses, with what they
//!   share in [`probability`] (a probability and its complement, the search for a quantile) and [`saddle_point`]
//!   (Loader's functions).
//! - [`isa`]: the run-time choice of instruction set; the only file that reads `SPINDRIFT_ISA`.
//! - [`list`]: a short list without allocation.
//! - [`pair`]: [`Pair`], two numbers of one kind as one, to keep wide vector units busy.
//! - [`power`]: powers, logarithms and exponentials for step control, the same bits in a scalar and in lanes.
//! - [`sine`]: sine and cosine of angles in turns, eight at a time.
//! - [`sums`]: sums with their rounding errors.
//! - [`symmetric`]: positive definiteness and principal axes of 3x3 matrices.
//! - [`vector`]: three-vectors, 3x3 matrices and quaternions as plain arrays of `Real`.

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
