//! Limits in figures over time, of requirements and of actuators.

use crate::analysis::outcomes::unique;
use crate::campaign::{Plan, Requirement, ShownUnit};
use crate::findings::number::typeset;
use crate::findings::requirement::limit_text;
use crate::report::figure::Mark;
use crate::report::page::readable::with_unit;

/// Limits beyond this multiple of the values are named at the edge of the axis.
const FAR: f64 = 3.0;
/// Limits this many times below the largest value need a logarithmic axis.
const SMALL: f64 = 30.0;
/// Values that vary by less than this fraction of the largest get an axis that excludes zero.
const VARIES: f64 = 0.5;

/// The limits of the requirements on `names`; `unit` is that of the plan.
pub fn required(plan: &Plan, names: impl Iterator<Item = String>, unit: &str) -> Vec<Mark> {
    let names: Vec<String> = names.collect();
    let of = |one: &&Requirement| names.iter().any(|name| name == one.name());
    let mark = |requirement: &Requirement| {
        let (name, at) = (requirement.name(), requirement.limit.value());
        let limit = limit_text(requirement.limit, &plan.analysis.display.of(name, unit));
        let when = match name {
            name if name.contains("_launch_") => " at launch".to_owned(),
            name if name.contains("_final_") => " at the end".to_owned(),
            _ => requirement.times(),
        };
        Mark::Limit { label: typeset(&(limit + &when)), at, vertical: false }
    };
    unique(plan.analysis.requirements.iter().filter(of).map(mark))
}

/// A line per distinct actuator limit in the unit `shown`, named unless common to all. `signed`: also below zero.
pub fn of_actuators(limits: &[(String, f64)], shown: &ShownUnit, signed: bool) -> Vec<Mark> {
    let finite: Vec<&(String, f64)> = limits.iter().filter(|(_, at)| at.is_finite() && *at > 0.0).collect();
    let mut values: Vec<f64> = finite.iter().map(|(_, at)| *at).collect();
    values.sort_by(f64::total_cmp);
    values.dedup();
    let mark = |at: f64| {
        let names: Vec<&str> = finite.iter().filter(|(_, of)| *of == at).map(|(name, _)| name.as_str()).collect();
        let of = if names.len() == limits.len() { String::new() } else { format!(" of {}", names.join(", ")) };
        let below = signed.then(|| Mark::Limit { label: String::new(), at: -at, vertical: false });
        let sign = if signed { "\u{b1}" } else { "" };
        let label = format!("limit{of} {sign}{}", with_unit(shown.written(at), &shown.unit));
        [Mark::Limit { label, at, vertical: false }].into_iter().chain(below)
    };
    values.into_iter().flat_map(mark).collect()
}

/// The range of a logarithmic axis, if a limit is far below the largest of positive values.
pub fn decades(marks: &[Mark]) -> Option<[f64; 2]> {
    let largest = marks.iter().map(Mark::largest).fold(0.0, f64::max);
    let limits = marks.iter().filter_map(|mark| match mark {
        Mark::Limit { at, vertical: false, .. } => Some(*at),
        _ => None,
    });
    let least = limits.filter(|at| *at > 0.0).reduce(f64::min)?;
    let is_negative = |values: &Vec<f64>| values.iter().any(|value| *value < 0.0);
    let is_signed = marks.iter().any(|mark| match mark {
        Mark::Line { y, .. } => is_negative(y),
        Mark::Band { low, .. } => is_negative(low),
        _ => false,
    });
    (SMALL * least < largest && largest.is_finite() && !is_signed).then(|| [least / SMALL, 1.5 * largest])
}

/// The vertical range with near limits, from zero if no value is negative and they vary or a loop controls them; `None`
/// if the values suffice.
pub fn range(marks: &[Mark], is_controlled: bool) -> Option<[f64; 2]> {
    let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
    let mut take = |values: &[f64]| {
        for value in values.iter().filter(|value| value.is_finite()) {
            (low, high) = (low.min(*value), high.max(*value));
        }
    };
    for mark in marks {
        match mark {
            Mark::Line { y, .. } => take(y),
            Mark::Band { low, high, .. } => {
                take(low);
                take(high);
            }
            _ => {}
        }
    }
    let largest = high.abs().max(low.abs());
    let limits = marks.iter().filter_map(|mark| match mark {
        Mark::Limit { at, vertical: false, .. } => Some(*at),
        _ => None,
    });
    let near: Vec<f64> = limits.filter(|at| at.abs() <= FAR * largest).collect();
    if low > high || largest == 0.0 {
        return None;
    }
    let is_positive = low >= 0.0;
    if is_positive && !is_controlled && near.is_empty() && high - low < VARIES * high {
        return None;
    }
    let top = near.iter().fold(high, |top, at| top.max(*at));
    let bottom = near.iter().fold(low, |bottom, at| bottom.min(*at));
    let bottom = if is_positive { bottom.min(0.0) } else { bottom };
    // a limit at the end is drawn on the edge
    let free = 0.04 * (top - bottom);
    Some([
        if is_positive || near.contains(&bottom) { bottom } else { bottom - free },
        if near.contains(&top) { top } else { top + free },
    ])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::figure::{Dash, Hue};

    fn curve(y: &[f64]) -> Mark {
        Mark::line("", Hue::Body, Dash::Solid, vec![0.0; y.len()], y.to_vec())
    }

    fn limit(at: f64) -> Mark {
        Mark::Limit { label: String::new(), at, vertical: false }
    }

    /// Law: an axis of positive quantities begins at zero and contains all values and near limits; nearly constant
    /// values of free motion get their own range.
    #[test]
    fn axes_have_what_matters() {
        let of = |y: &[f64], limits: &[f64], is_controlled| {
            let marks: Vec<Mark> = [curve(y)].into_iter().chain(limits.iter().map(|at| limit(*at))).collect();
            range(&marks, is_controlled)
        };
        assert_eq!(of(&[4.0, 5.0], &[], false), None);
        assert_eq!(of(&[4.0, 5.0], &[], true), Some([0.0, 5.2]));
        assert_eq!(of(&[1.0, 5.0], &[], false), Some([0.0, 5.2]));
        assert_eq!(of(&[4.0, 5.0], &[10.0], false), Some([0.0, 10.0]));
        assert_eq!(of(&[4.0, 5.0], &[15.5], true), Some([0.0, 5.2]), "a limit that is far is named at the edge");
        assert_eq!(of(&[-3.0, 2.0], &[4.0, -4.0], true), Some([-4.0, 4.0]));
        assert_eq!(of(&[-4.0, 2.0], &[4.0, -4.0], true), Some([-4.0, 4.0]), "values at a limit end the axis there");
        assert_eq!(of(&[0.0, 0.0], &[4.0], true), None);
        let [low, high] = of(&[-3.0, 2.0], &[], true).expect("a range");
        assert!((low + 3.2).abs() < 1e-12 && (high - 2.2).abs() < 1e-12);
    }
}
