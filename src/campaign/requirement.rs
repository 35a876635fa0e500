//! [`Requirement`]: a `[[require]]` table, what a campaign must show.

use super::columns::{KnownColumns, unit_of};
use super::limits::{CONFIDENCE, PROBABILITY};
use super::lines::Lines;
use super::numbers::FINITE;
use super::section::Section;
use crate::statistics::gate::Limit;

/// What must be within the limit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Statement {
    /// This quantile of the runs.
    Quantile(f64),
    /// Each of this fraction of the runs.
    Fraction(f64),
    /// The mean of the runs.
    Mean,
}

/// What a campaign must show.
#[derive(Clone, Debug, PartialEq)]
pub struct Requirement {
    /// The observable.
    pub observable: String,
    /// What of it must be within the limit.
    pub statement: Statement,
    /// The limit, in the unit of the observable.
    pub limit: Limit,
    /// With which confidence.
    pub confidence: f64,
}

/// Confidence where the file does not say.
pub const DEFAULT_CONFIDENCE: f64 = 0.95;
/// The keys that say what is required: a requirement has exactly one.
const STATEMENTS: [&str; 3] = ["quantile", "fraction", "mean"];
/// The keys of limits: a requirement has exactly one.
const LIMITS: [&str; 2] = ["at_most", "at_least"];

impl Requirement {
    /// Reads one table; `None` where something is wrong, which is then noted.
    pub(super) fn read(table: &mut Section<'_, '_>, known: &KnownColumns) -> Option<Self> {
        table.require("observable", "the name of an observable", "\"energy_error_max\"");
        let name = observable(table, "observable", known);
        let confidence = table.number("confidence", CONFIDENCE);
        let statement = one_of(table, STATEMENTS, "quantile = 0.99").and_then(|key| match key {
            "quantile" => table.number(key, PROBABILITY).map(Statement::Quantile),
            "fraction" => table.number(key, PROBABILITY).map(Statement::Fraction),
            _ => match table.flag(key) {
                Some(true) => Some(Statement::Mean),
                Some(false) => {
                    table.refuse(key, "true where it is written", "delete it, or write mean = true");
                    None
                }
                None => None,
            },
        });
        let unit = name.as_deref().and_then(|name| known.observable(name)).map(unit_of);
        if let Some(unit) = unit {
            table.measures(unit);
        }
        let limit = one_of(table, LIMITS, "at_most = 1e-9").and_then(|key| {
            // without its unit a limit cannot be read
            unit?;
            let number = table.number(key, FINITE)?;
            Some(if key == "at_most" { Limit::AtMost(number) } else { Limit::AtLeast(number) })
        });
        STATEMENTS.iter().chain(&LIMITS).for_each(|key| table.know(key));
        let confidence_passed = !table.has("confidence") || confidence.is_some();
        table.finish();
        let (observable, statement, limit) = (name?, statement?, limit?);
        let confidence = confidence.unwrap_or(DEFAULT_CONFIDENCE);
        confidence_passed.then_some(Requirement { observable, statement, limit, confidence })
    }

    /// Writes the table.
    pub(super) fn write(&self, lines: &mut Lines) {
        lines.table("[[require]]");
        lines.key("observable", &self.observable);
        match self.statement {
            Statement::Quantile(quantile) => lines.key("quantile", quantile),
            Statement::Fraction(fraction) => lines.key("fraction", fraction),
            Statement::Mean => lines.key("mean", true),
        }
        match self.limit {
            Limit::AtMost(limit) => lines.key("at_most", limit),
            Limit::AtLeast(limit) => lines.key("at_least", limit),
        }
        lines.key("confidence", self.confidence);
    }
}

/// The observable that `key` names; `None` where there is none, which is then noted.
pub(super) fn observable(table: &mut Section<'_, '_>, key: &str, known: &KnownColumns) -> Option<String> {
    let name = table.text(key)?;
    if known.observable(name).is_none() {
        let (allowed, remedy) = known.refusal(name);
        table.refuse(key, allowed, remedy);
        return None;
    }
    Some(name.to_owned())
}

/// The one of `keys` that was written; `None` where none was or several were, which is then noted.
fn one_of<const N: usize>(table: &mut Section<'_, '_>, keys: [&'static str; N], example: &str) -> Option<&'static str> {
    let written: Vec<&'static str> = keys.into_iter().filter(|key| table.has(key)).collect();
    match written[..] {
        [key] => Some(key),
        [] => {
            let (key, value) = example.split_once(" = ").unwrap_or((example, ""));
            table.require(key, &format!("given (one of {})", keys.join(", ")), value);
            None
        }
        [_, second, ..] => {
            table.refuse(second, format!("the only one of {}", keys.join(", ")), "write a [[require]] table for each");
            None
        }
    }
}
