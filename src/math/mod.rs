//! Floor 0: numbers. What every other floor computes with and nothing of physics.
//!
//! - [`real`]: [`Real`], the one trait a kernel is generic over (`f64`, eight lanes of `f64`).
//! - [`lanes`]: [`Lanes`], eight `f64` in one vector, on whichever instruction set was chosen.
//! - [`isa`]: the run-time choice of instruction set, and the only place that reads `SPINDRIFT_ISA`.
//! - [`symmetric`]: positive definiteness and principal axes of 3x3 matrices.
//! - [`vector`]: three-vectors, 3x3 matrices and quaternions as plain arrays of `Real`.

pub mod isa;
pub mod lanes;
pub mod real;
pub mod symmetric;
pub mod vector;

pub use isa::Isa;
pub use lanes::Lanes;
pub use real::Real;
