//! [`Stop`]: the `[stop]` table, when a campaign is precise enough.

use super::columns::{KnownColumns, unit_of};
use super::limits::{CONFIDENCE, MAX_SAMPLES, PROBABILITY};
use super::lines::Lines;
use super::numbers::POSITIVE;
use super::requirement::{DEFAULT_CONFIDENCE, observable};
use super::section::Section;
use crate::statistics::looks::Goal;

/// When a campaign is precise enough.
#[derive(Clone, Debug, PartialEq)]
pub struct Stop {
    /// The observable.
    pub observable: String,
    /// Which quantile, and how narrow its interval must be, in the unit of the observable.
    pub goal: Goal,
    /// Most samples, sample 0 included.
    pub max_samples: u64,
}

impl Stop {
    /// Reads the table; `None` where it was not written, or where something is wrong, which is then noted.
    pub(super) fn read(table: &mut Section<'_, '_>, known: &KnownColumns) -> Option<Self> {
        if !table.is_present() {
            return None;
        }
        for (key, allowed, example) in [
            ("observable", "the name of an observable", "\"energy_error_max\""),
            ("quantile", PROBABILITY.allowed, "0.95"),
            ("half_width", POSITIVE.allowed, "1e-12"),
            ("max_samples", "a whole number above campaign.samples", "100000"),
        ] {
            table.require(key, allowed, example);
        }
        let name = observable(table, "observable", known);
        let quantile = table.number("quantile", PROBABILITY);
        let confidence = table.number("confidence", CONFIDENCE);
        let max_samples = table.count("max_samples", 2..=MAX_SAMPLES);
        let unit = name.as_deref().and_then(|name| known.observable(name)).map(unit_of);
        if let Some(unit) = unit {
            table.measures(unit);
        }
        // without its unit a width cannot be read
        let half_width = unit.and_then(|_| table.number("half_width", POSITIVE));
        table.know("half_width");
        let confidence_passed = !table.has("confidence") || confidence.is_some();
        table.finish();
        let confidence = confidence.unwrap_or(DEFAULT_CONFIDENCE);
        let goal = Goal { quantile: quantile?, half_width: half_width?, confidence };
        let (observable, max_samples) = (name?, max_samples?);
        confidence_passed.then_some(Stop { observable, goal, max_samples })
    }

    /// Writes the table.
    pub(super) fn write(&self, lines: &mut Lines) {
        lines.table("[stop]");
        lines.key("observable", &self.observable);
        lines.key("quantile", self.goal.quantile);
        lines.key("half_width", self.goal.half_width);
        lines.key("confidence", self.goal.confidence);
        lines.key("max_samples", self.max_samples);
    }
}
