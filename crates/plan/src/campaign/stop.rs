//! [`Stop`]: the `[stop]` table, which ends a campaign with enough samples.

use super::numbers::{CONFIDENCE, MAX_SAMPLES, POSITIVE, PROBABILITY};
use super::requirement::DEFAULT_CONFIDENCE;
use super::section::Section;
use super::units;
use crate::sampling::keys::{Condition, Kind, Presence, Row, Rule};
use crate::statistics::looks::Goal;

#[derive(Clone, Debug, PartialEq)]
pub enum When {
    /// A quantile of an observable is known well enough.
    Precise {
        observable: String,
        /// The quantile and the half-width of its interval, in the observable's unit.
        goal: Goal,
    },
    /// No requirement is undecided.
    Decided,
}

#[derive(Clone, Debug, PartialEq)]
pub struct Stop {
    pub when: When,
    /// Including sample 0.
    pub max_samples: u64,
}

/// The keys between the first and the last belong to a goal.
#[rustfmt::skip]
pub const ROWS: [Row; 6] = [
    Row::new("when", Kind::Word(&["precise", "decided"]),
        "What ends the campaign: a quantile is known precisely enough, or no requirement is undecided"),
    Row::new("observable", Kind::Observable, "The observable").required_as("the name of an observable",
        "\"energy_error_max\""),
    Row::new("quantile", Kind::Number, "Which of its quantiles")
        .limited(PROBABILITY)
        .required_as(PROBABILITY.allowed, "0.95"),
    Row::new("half_width", Kind::Amount, "The half-width that the interval of the quantile must reach, in the unit of \
        the observable")
        .limited(POSITIVE).required_as(POSITIVE.allowed, "1e-12"),
    Row::new("confidence", Kind::Number, "Confidence of the interval")
        .limited(CONFIDENCE)
        .or(Presence::Or(DEFAULT_CONFIDENCE)),
    Row::new("max_samples", Kind::Count([2, MAX_SAMPLES]), "Largest number of samples, including sample 0")
        .required_as("a whole number above campaign.samples", "100000"),
];

pub const RULES: [Rule; 1] = [Rule::Only {
    keys: &["observable", "quantile", "half_width", "confidence"],
    with: &[Condition::IsNot("when", "decided")],
    allowed: "left out with when = \"decided\": the [[require]] tables say what is decided",
    remedy: "delete it, or write when = \"precise\"",
}];

impl Stop {
    /// Reads the table; `None` without one, and after a problem.
    pub(super) fn read(table: &mut Section<'_, '_>) -> Option<Self> {
        if !table.is_present() {
            return None;
        }
        table.describes(None, units::UNKNOWN);
        let rows = match table.plain_text("when") {
            Some("decided") => vec![ROWS[0], ROWS[5]],
            _ => ROWS.to_vec(),
        };
        let written = table.whole(&rows, &RULES)?.completed(&ROWS, &RULES);
        let goal = |observable: &str| {
            let [quantile, half_width, confidence] =
                ["quantile", "half_width", "confidence"].map(|key| written.number(key));
            let (quantile, half_width, confidence) = (quantile?, half_width?, confidence?);
            Some(When::Precise { observable: observable.to_owned(), goal: Goal { quantile, half_width, confidence } })
        };
        let when = written.text("observable").and_then(goal).unwrap_or(When::Decided);
        let max_samples = written.count("max_samples")?;
        table.document.keep("[stop]", written);
        Some(Stop { when, max_samples })
    }
}
