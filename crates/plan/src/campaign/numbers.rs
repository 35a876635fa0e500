//! Numbers, vectors and matrices of a [`Section`], with units in text.

use super::section::Section;
use super::units::{self, UnitProblem};
use crate::sampling::Values;
use crate::sampling::keys::{between, inside};
use crate::scene::schema::Limit;
use std::ops::Bound;
use toml::de::DeValue;

pub use crate::sampling::keys::NumberLimit;

pub const FINITE: NumberLimit = NumberLimit {
    allowed: "a finite number",
    remedy: "write a number such as 1.5",
    range: inside(f64::NEG_INFINITY, f64::INFINITY),
};
pub const POSITIVE: NumberLimit =
    NumberLimit { allowed: "a number > 0", remedy: "write a positive number", range: inside(0.0, f64::INFINITY) };

pub const NOT_NEGATIVE: NumberLimit = NumberLimit {
    allowed: "a number of at least 0",
    remedy: "write zero or a positive number",
    range: (Bound::Included(0.0), Bound::Excluded(f64::INFINITY)),
};

impl Section<'_, '_> {
    /// Sets the quantity that the table is about, and its unit.
    pub(super) fn describes(&mut self, about: impl Into<Option<String>>, unit: &'static str) {
        (self.about, self.unit) = (about.into(), unit);
    }

    /// The number of `key`, valid or not, for examples.
    pub fn written(&self, key: &str) -> Option<f64> {
        number(self.value(key)?.get_ref(), units::in_name(key))
    }

    /// Notes that `value` of `key` is not a number in `unit`: the problem of its unit, else `allowed` and `remedy`.
    pub(super) fn refuse_number(
        &mut self,
        key: &str,
        unit: &'static str,
        value: &DeValue<'_>,
        allowed: impl Into<String>,
        remedy: impl Into<String>,
    ) {
        match unit_problem(value, unit) {
            Some(problem) => self.refuse(key, problem.allowed, problem.remedy),
            None => self.refuse(key, allowed, remedy),
        }
    }

    pub fn require_numbers(&mut self, key: &str, count: usize, example: &str) {
        self.require(key, &numbers_in_words(count), example);
    }

    /// Fills `numbers` with the finite numbers of `key` in `unit`: one, a list, or three rows for nine; returns whether
    /// the key was written. A problem is noted, with an example within `limit`, and gives NaN.
    pub fn fill(&mut self, key: &str, unit: &'static str, numbers: &mut [f64], limit: Limit) -> bool {
        let Some(value) = self.take(key) else { return false };
        let found = values(value.get_ref(), &|value| number(value, unit));
        match found.filter(|found| found.are(numbers.len())).map(|found| found.flat()) {
            Some(found) if found.iter().all(|x| x.is_finite()) => numbers.copy_from_slice(&found),
            _ => {
                let remedy = match numbers.len() {
                    1 if number(value.get_ref(), unit).is_some() => FINITE.remedy.to_owned(),
                    1 => remedy_for_text(value.get_ref()).to_owned(),
                    count => format!("write it like {}", limit.example(count)),
                };
                self.refuse_number(key, unit, value.get_ref(), numbers_in_words(numbers.len()), remedy);
                numbers.fill(f64::NAN);
            }
        }
        true
    }
}

/// An integer, float or text with a unit, in the SI unit `unit`; may be NaN or infinite.
pub(super) fn number(value: &DeValue<'_>, unit: &str) -> Option<f64> {
    match value {
        DeValue::Float(float) => float.as_str().parse().ok(),
        DeValue::Integer(integer) => i128::from_str_radix(integer.as_str(), integer.radix()).ok().map(|x| x as f64),
        DeValue::String(text) => units::parsed(text, unit).ok(),
        _ => None,
    }
}

/// The problem of the first text in a value that should be a number in `unit`.
fn unit_problem(value: &DeValue<'_>, unit: &str) -> Option<UnitProblem> {
    match value {
        DeValue::String(text) => units::parsed(text, unit).err(),
        DeValue::Array(list) => list.iter().find_map(|item| unit_problem(item.get_ref(), unit)),
        _ => None,
    }
}

/// A value, a list or rows of values that `of` reads.
pub(super) fn values<T>(value: &DeValue<'_>, of: &impl Fn(&DeValue<'_>) -> Option<T>) -> Option<Values<T>> {
    let list = |value: &DeValue<'_>| value.as_array()?.iter().map(|item| of(item.get_ref())).collect();
    match value {
        DeValue::Array(rows) if rows.iter().any(|row| row.get_ref().is_array()) => {
            rows.iter().map(|row| list(row.get_ref())).collect::<Option<_>>().map(Values::Rows)
        }
        DeValue::Array(_) => list(value).map(Values::Each),
        one => of(one).map(Values::One),
    }
}

pub(super) fn numbers_in_words(count: usize) -> String {
    match count {
        1 => FINITE.allowed.to_owned(),
        9 => "three rows of three finite numbers".to_owned(),
        count => format!("an array of {count} finite numbers"),
    }
}

pub(super) fn remedy_for_text(value: &DeValue<'_>) -> &'static str {
    match value {
        DeValue::String(text) if text.trim().parse::<f64>().is_ok() => "write it without quotes",
        DeValue::Array(_) => "write one number, without brackets",
        _ => "write a number",
    }
}

pub const MAX_SAMPLES: u64 = crate::sampling::design::MAX_SAMPLES;
/// TOML integers are signed.
pub const LARGEST_SEED: u64 = i64::MAX as u64;
/// Some gigabytes in each thread.
pub const MAX_POINTS: u64 = 1_000_000;

/// From a few units in the last place to useless accuracy.
pub const TOLERANCE: NumberLimit = NumberLimit {
    allowed: "a number from 1e-16 to 1e-2",
    remedy: "1e-10 is a good start",
    range: between(1e-16, 1e-2),
};

pub const PROBABILITY: NumberLimit = NumberLimit {
    allowed: "a number between 0 and 1, neither included",
    remedy: "write it like 0.99",
    range: inside(0.0, 1.0),
};

pub const CONFIDENCE: NumberLimit = NumberLimit {
    allowed: "a number from 0.5 to below 1",
    remedy: "0.95 is usual",
    range: (Bound::Included(0.5), Bound::Excluded(1.0)),
};

pub const FRACTION: NumberLimit = NumberLimit {
    allowed: "a number from 0 to 1",
    remedy: "0.01 runs one sample in a hundred again exactly, 1 all of them",
    range: between(0.0, 1.0),
};

/// A whole number of at least 0.
pub(super) fn whole(value: &DeValue<'_>) -> Option<u64> {
    let integer = value.as_integer()?;
    u64::from_str_radix(integer.as_str(), integer.radix()).ok()
}
