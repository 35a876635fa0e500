//! Floor 0: numbers. What every other floor computes with and nothing of physics.
//!
//! - [`real`]: [`Real`], the one trait a kernel is generic over (`f64`, eight lanes of `f64`).
//! - [`double_double`]: 106 bits, for reference solutions.
//! - [`lanes`]: [`Lanes`], eight `f64` in one vector, on whichever instruction set was chosen.
//! - [`isa`]: the run-time choice of instruction set, and the only place that reads `SPINDRIFT_ISA`.
//! - [`pair`]: [`Pair`], two of a kind as one, to keep wide vector units busy.
//! - [`power`]: fractional powers for step control, the same bits in a scalar and in lanes.
//! - [`sine`]: sine and cosine in turns, eight at a time.
//! - [`symmetric`]: positive definiteness and principal axes of 3x3 matrices.
//! - [`vector`]: three-vectors, 3x3 matrices and quaternions as plain arrays of `Real`.

pub mod double_double;
pub mod incomplete_beta;
pub mod isa;
pub mod lanes;
pub mod normal;
pub mod pair;
pub mod power;
pub mod real;
pub mod sine;
pub mod symmetric;
pub mod vector;

pub use isa::Isa;
pub use lanes::Lanes;
pub use pair::Pair;
pub use real::Real;
