//! Numbers of the page outside of findings, typeset.

use crate::findings::number::{trimmed, typeset, with_interval};

/// At most four digits; "-" for NaN.
pub fn number(value: f64) -> String {
    if value.is_nan() { "-".to_owned() } else { typeset(&trimmed(value, 4)) }
}

pub fn with_unit(value: f64, unit: &str) -> String {
    match unit {
        _ if unit.is_empty() || value.is_nan() => number(value),
        "%" => format!("{}%", number(value)),
        _ => format!("{}\u{a0}{}", number(value), unit.replace("^2", "\u{b2}").replace("^3", "\u{b3}")),
    }
}

pub fn in_brackets(value: f64, interval: [f64; 2]) -> String {
    match interval.iter().any(|end| end.is_finite()) {
        true => typeset(&with_interval(value, interval)),
        false => number(value),
    }
}
