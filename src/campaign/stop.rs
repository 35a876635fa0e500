//! [`Stop`]: the `[stop]` table, when a campaign has enough samples.

use super::columns::{KnownColumns, unit_of};
use super::limits::{CONFIDENCE, MAX_SAMPLES, PROBABILITY};
use super::lines::Lines;
use super::numbers::POSITIVE;
use super::requirement::{DEFAULT_CONFIDENCE, observable};
use super::section::Section;
use crate::statistics::looks::Goal;

/// What ends a campaign.
#[derive(Clone, Debug, PartialEq)]
pub enum When {
    /// That a quantile of an observable is known well enough.
    Precise {
        /// The observable.
        observable: String,
        /// Which quantile, and how narrow its interval must be, in the unit of the observable.
        goal: Goal,
    },
    /// That no requirement is undecided.
    Decided,
}

/// When a campaign has enough samples.
#[derive(Clone, Debug, PartialEq)]
pub struct Stop {
    /// What ends it.
    pub when: When,
    /// Most samples, sample 0 included.
    pub max_samples: u64,
}

/// The names of [`When`].
const NAMES: [&str; 2] = ["precise", "decided"];
/// The keys of a goal.
const GOAL: [&str; 4] = ["observable", "quantile", "half_width", "confidence"];

impl Stop {
    /// Reads the table; `None` where it was not written, or where something is wrong, which is then noted.
    pub(super) fn read(table: &mut Section<'_, '_>, known: &KnownColumns) -> Option<Self> {
        if !table.is_present() {
            return None;
        }
        let name = |text: &str| NAMES.into_iter().find(|name| *name == text);
        let is_right = !table.has("when") || table.plain_text("when").is_some_and(|when| NAMES.contains(&when));
        let name = table.name("when", &NAMES, name);
        table.require("max_samples", "a whole number above campaign.samples", "100000");
        let max_samples = table.count("max_samples", 2..=MAX_SAMPLES);
        let when = if name == Some("decided") {
            let written: Vec<&str> = GOAL.into_iter().filter(|key| table.has(key)).collect();
            for key in &written {
                let allowed = "left out with when = \"decided\": the [[require]] tables say what is decided";
                table.refuse(key, allowed, "delete it, or write when = \"precise\"");
            }
            GOAL.into_iter().for_each(|key| table.know(key));
            written.is_empty().then_some(When::Decided)
        } else {
            precise(table, known)
        };
        table.finish();
        is_right.then_some(Stop { when: when?, max_samples: max_samples? })
    }

    /// Writes the table.
    pub(super) fn write(&self, lines: &mut Lines) {
        lines.table("[stop]");
        match &self.when {
            When::Precise { observable, goal } => {
                lines.key("when", "precise");
                lines.key("observable", observable);
                lines.key("quantile", goal.quantile);
                lines.key("half_width", goal.half_width);
                lines.key("confidence", goal.confidence);
            }
            When::Decided => lines.key("when", "decided"),
        }
        lines.key("max_samples", self.max_samples);
    }
}

/// The goal of a precision; `None` where something is wrong, which is then noted.
fn precise(table: &mut Section<'_, '_>, known: &KnownColumns) -> Option<When> {
    for (key, allowed, example) in [
        ("observable", "the name of an observable", "\"energy_error_max\""),
        ("quantile", PROBABILITY.allowed, "0.95"),
        ("half_width", POSITIVE.allowed, "1e-12"),
    ] {
        table.require(key, allowed, example);
    }
    let name = observable(table, "observable", known);
    let quantile = table.number("quantile", PROBABILITY);
    let confidence = table.number("confidence", CONFIDENCE);
    let unit = name.as_deref().and_then(|name| known.observable(name)).map(unit_of);
    if let Some(unit) = unit {
        table.measures(unit);
    }
    // without its unit a width cannot be read
    let half_width = unit.and_then(|_| table.number("half_width", POSITIVE));
    table.know("half_width");
    let confidence_passed = !table.has("confidence") || confidence.is_some();
    let confidence = confidence.unwrap_or(DEFAULT_CONFIDENCE);
    let goal = Goal { quantile: quantile?, half_width: half_width?, confidence };
    confidence_passed.then_some(When::Precise { observable: name?, goal })
}
