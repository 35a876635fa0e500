//! The vocabulary of numeric code: numbers, lanes and vectors.

pub use super::lanes::{WIDEST, WIDTH};
pub use super::vector::*;
pub use super::{Lanes, Mask, Real};
