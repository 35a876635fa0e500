//! The launch of a net at debris; the rest of `control` knows debris only as a second body that sensors see.
//!
//! - [`geometry`]: the launch state, and the transfer to it. [`parameters`]: its numbers in campaign files.
//! - [`launch`]: what is true at the launch, and plumes that hit the debris.

pub mod geometry;
pub mod launch;
pub mod parameters;
