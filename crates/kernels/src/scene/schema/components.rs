//! Names of components.

pub(super) const SCALAR: &[&str] = &[""];
/// Along the axes of a frame.
pub(super) const XYZ: &[&str] = &["x", "y", "z"];
/// Along two axes across a direction.
pub(super) const ACROSS: &[&str] = &["1", "2"];
pub(super) const WXYZ: &[&str] = &["w", "x", "y", "z"];
/// Three of a kind.
pub(super) const AXES: &[&str] = &["1", "2", "3"];
pub(super) const SYMMETRIC: &[&str] = &["xx", "xy", "xz", "yy", "yz", "zz"];
