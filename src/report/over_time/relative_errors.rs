//! The axis of relative errors over time, with the tolerance of the run and the rounding of a double.

use crate::report::figure::{Axis, Mark};

/// The axis is not shorter: the rounding of some operations does not look like a drift.
const ROUNDING: f64 = 10.0 * f64::EPSILON;
/// A limit that is larger than the errors by this factor is outside of the axis, and named at its edge.
const FAR: f64 = 3.0;

/// Adds the limits of the errors `marks` of a run to them; the axis of both. `is_signed`: whether errors may be
/// negative.
pub fn limited(marks: &mut Vec<Mark>, tolerance: Option<f64>, is_signed: bool) -> Axis {
    let largest = marks.iter().map(Mark::largest).fold(0.0, f64::max);
    let own = largest.max(ROUNDING);
    let shown = tolerance.filter(|tolerance| *tolerance <= FAR * own).map_or(own, |tolerance| tolerance.max(own));
    let tolerance = tolerance.map(|tolerance| (format!("tolerance {tolerance:e}"), tolerance));
    // among larger errors nobody sees it
    let rounding = (shown <= FAR * f64::EPSILON).then(|| ("rounding of a double".to_owned(), f64::EPSILON / 2.0));
    for (label, at) in tolerance.into_iter().chain(rounding) {
        marks.push(Mark::Limit { label, at, vertical: false });
        if is_signed {
            marks.push(Mark::Limit { label: String::new(), at: -at, vertical: false });
        }
    }
    let axis = Axis::linear("relative error", "");
    if largest > 0.0 { axis.within(if is_signed { -1.1 * shown } else { 0.0 }, 1.1 * shown) } else { axis }
}
