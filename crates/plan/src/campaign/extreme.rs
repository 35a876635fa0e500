//! [`Extreme`]: an `[[extreme]]` table: the largest or smallest value of a quantity over time, also between observation
//! points.

use super::event::Event;
use super::meaning::meant;
use super::section::Section;
use super::watched_quantity::{QUANTITY, variables};
use crate::observables::band_series::{BandSeries, event_series};
use crate::observables::{ColumnKind, LawColumn, Request};
use crate::run::Quantity;
use crate::sampling::keys::{ANY_TEXT, COLUMN_NAME, Kind, Presence, Row};

#[derive(Clone, Debug, PartialEq)]
pub struct Extreme {
    pub name: String,
    /// A quantity over time, or an expression of several.
    pub quantity: String,
    /// Empty for a pure number, and for an expression.
    pub unit: String,
    pub is_highest: bool,
    /// The event after which it is taken; `None`: from the start.
    pub after: Option<String>,
    /// Delay after that, s.
    pub delay_s: f64,
}

const MOST_EXTREMES: usize = 16;
const WHICH: [&str; 2] = ["max", "min"];

#[rustfmt::skip]
pub const ROWS: [Row; 5] = [
    Row::new("name", Kind::Text(COLUMN_NAME), "The name of its column").required_as(COLUMN_NAME.allowed,
        "\"angular_rate_after_max_rad_s\""),
    QUANTITY,
    Row::new("which", Kind::Word(&WHICH), "Whether to take the largest value or the smallest"),
    Row::new("after", Kind::Text(ANY_TEXT), "The name of the `[[event]]` after which it is taken; default: from the \
        start of the run"),
    Row::new("delay_s", Kind::Number, "Delay from that time").not_negative().or(Presence::Or(0.0)),
];

impl Extreme {
    /// Reads the tables and omits invalid ones. `observed`: the columns without extremes.
    pub(super) fn read_all(root: &mut Section<'_, '_>, observed: &Request, events: &[Event]) -> Vec<Extreme> {
        let series = event_series(observed);
        let mut names: Vec<String> =
            observed.columns().iter().map(|column| column.quantity.name().to_owned()).collect();
        let found = root.sections("extreme", MOST_EXTREMES, |table| {
            let extreme = Extreme::read(table, (&series, observed), events)?;
            if names.contains(&extreme.name) {
                return table.refused("name", "a name that no other column has", "choose another name");
            }
            names.push(extreme.name.clone());
            Some(extreme)
        });
        found.into_iter().flatten().collect()
    }

    fn read(table: &mut Section<'_, '_>, known: (&[BandSeries], &Request), events: &[Event]) -> Option<Self> {
        let written = table.whole(&ROWS, &[])?;
        let quantity = written.text("quantity")?.to_owned();
        let unit = match &variables(table, &quantity, known)?[..] {
            [only] if only.quantity.name() == quantity => only.quantity.unit().to_owned(),
            _ => String::new(),
        };
        let after = written.text("after").map(str::to_owned);
        if let Some(name) = &after
            && !events.iter().any(|event| event.name == *name)
        {
            let names = || events.iter().map(|event| event.name.as_str());
            let remedy = match (meant(name, names()), events.is_empty()) {
                (_, true) => "add an [[event]] of this name".to_owned(),
                (Some(meant), _) => meant.remedy(),
                (None, _) => format!("name one of {}", names().collect::<Vec<_>>().join(", ")),
            };
            return table.refused("after", "the name of an [[event]] of this file", remedy);
        }
        let is_highest = written.text("which") == Some(WHICH[0]);
        let written = written.completed(&ROWS, &[]);
        let (name, delay_s) = (written.text("name")?.to_owned(), written.number("delay_s")?);
        table.document.keep("[[extreme]]", written);
        Some(Extreme { name, quantity, unit, is_highest, after, delay_s })
    }

    fn since(&self) -> String {
        match (&self.after, self.delay_s > 0.0) {
            (None, false) => String::new(),
            (None, true) => format!(" from {:?} s on", self.delay_s),
            (Some(event), false) => format!(" after {event}"),
            (Some(event), true) => format!(" from {:?} s after {event} on", self.delay_s),
        }
    }

    pub fn says(&self) -> String {
        format!(
            "{} of {}{}",
            if self.is_highest { "largest value" } else { "smallest value" },
            self.quantity,
            self.since()
        )
    }

    pub(super) fn column(&self) -> LawColumn {
        let word = if self.is_highest { "Largest" } else { "Smallest" };
        let meaning = format!(
            "{word} value of {}{}, between observation points too; null if the run ends before.",
            self.quantity,
            self.since()
        );
        LawColumn {
            quantity: Quantity::named(self.name.clone(), self.unit.clone(), meaning),
            kind: ColumnKind::Float,
            codes: &[],
        }
    }
}
