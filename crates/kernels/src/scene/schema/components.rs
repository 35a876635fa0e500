//! Names of components.

/// One number.
pub(super) const SCALAR: &[&str] = &[""];
/// Along the axes of a frame.
pub(super) const XYZ: &[&str] = &["x", "y", "z"];
/// Along two axes across a direction.
pub(super) const ACROSS: &[&str] = &["1", "2"];
/// A quaternion, scalar first.
pub(super) const WXYZ: &[&str] = &["w", "x", "y", "z"];
/// Three of a kind.
pub(super) const AXES: &[&str] = &["1", "2", "3"];
/// A symmetric tensor.
pub(super) const SYMMETRIC: &[&str] = &["xx", "xy", "xz", "yy", "yz", "zz"];
