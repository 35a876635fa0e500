//! The keys of laws of directions and attitudes in a `[[disperse]]` table.
//!
//! What is written there is checked against the scene in [`crate::sampling::geometric_law`].

use super::disperse::{is_one_of, law};
use super::section::{FINITE, Section};
use crate::sampling::geometric::DirectionSpread;
use crate::sampling::{AttitudeSpread, GeometricLaw, Law};

/// `uniform_direction`.
pub(super) fn uniform_direction(table: &mut Section<'_, '_>) -> Option<Law> {
    direction(table, Some(DirectionSpread::Sphere))
}

/// `cone`.
pub(super) fn cone(table: &mut Section<'_, '_>) -> Option<Law> {
    table.require("half_angle_rad", "given, above 0 and at most pi", "0.1");
    let half_angle = table.number("half_angle_rad", FINITE);
    direction(table, half_angle.map(|half_angle_rad| DirectionSpread::Cone { half_angle_rad }))
}

/// `von_mises_fisher`.
pub(super) fn von_mises_fisher(table: &mut Section<'_, '_>) -> Option<Law> {
    table.require("concentration", "given, above 0", "100.0");
    let concentration = table.number("concentration", FINITE);
    direction(table, concentration.map(|concentration| DirectionSpread::Fisher { concentration }))
}

/// What all laws of a direction have: an axis and a law of the magnitude, if they are written.
fn direction(table: &mut Section<'_, '_>, spread: Option<DirectionSpread>) -> Option<Law> {
    let (axis, magnitude) = (axis(table), within(table, "magnitude"));
    let ((spread, axis), magnitude) = spread.zip(axis).zip(magnitude)?;
    Some(Law::Geometric(GeometricLaw::Direction { spread, axis, magnitude: magnitude.map(Box::new) }))
}

/// `attitude_error`.
pub(super) fn attitude_error(table: &mut Section<'_, '_>) -> Option<Law> {
    let one = is_one_of(table, &["std_rad", "covariance_rad2"], "0.01");
    let (std, covariance) = (table.values("std_rad"), table.matrix("covariance_rad2"));
    // a matrix that is wrong was noted, and is not a number
    let covariance = covariance.filter(|matrix| matrix.as_flattened().iter().all(|x| x.is_finite()));
    let spread = std.map(AttitudeSpread::Std).or(covariance.map(AttitudeSpread::Covariance));
    if one { spread.map(|spread| Law::Geometric(GeometricLaw::AttitudeError(spread))) } else { None }
}

/// `about_axis`.
pub(super) fn about_axis(table: &mut Section<'_, '_>) -> Option<Law> {
    table.require("axis", "given, an array of 3 finite numbers", "[0, 0, 1]");
    table.require("angle_rad", "given, a law of one number", "{ distribution = \"normal\", std = 0.1 }");
    let (axis, angle) = (axis(table), within(table, "angle_rad"));
    let (axis, angle) = (axis??, angle??);
    Some(Law::Geometric(GeometricLaw::AboutAxis { axis, angle: Box::new(angle) }))
}

/// The key `axis`, if it was written; `None` where it is wrong.
fn axis(table: &mut Section<'_, '_>) -> Option<Option<[f64; 3]>> {
    let axis = table.vector("axis");
    if axis.is_some_and(|axis| axis.iter().any(|x| x.is_nan())) { None } else { Some(axis) }
}

/// The law that stands in the table `key` within this one, if it was written; `None` where it is wrong.
fn within(table: &mut Section<'_, '_>, key: &'static str) -> Option<Option<Law>> {
    let is_written = table.has(key);
    let mut section = table.section(key);
    if !section.is_present() {
        return if is_written { None } else { Some(None) };
    }
    law(&mut section).map(Some)
}
