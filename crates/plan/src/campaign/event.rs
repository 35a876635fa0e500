//! [`Event`]: an `[[event]]` table: a quantity over time that crosses a value.

use super::known_columns::unit_of;
use super::numbers::FINITE;
use super::section::Section;
use super::units;
use super::watched_quantity::{QUANTITY, variables};
use crate::observables::Request;
use crate::observables::band_series::{BandSeries, event_series};
use crate::run::Quantity;
use crate::sampling::keys::{Kind, Row, TextLimit, is_name, words};

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Direction {
    Either,
    Rising,
    Falling,
}

/// Which crossing gives the time.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Which {
    First,
    Last,
    /// The last, if the quantity then stays on that side; zero if it always was there.
    Stays,
}

impl Direction {
    pub const ALL: [(&'static str, Direction); 3] =
        [("either", Direction::Either), ("rising", Direction::Rising), ("falling", Direction::Falling)];
}

impl Which {
    pub const ALL: [(&'static str, Which); 3] =
        [("first", Which::First), ("last", Which::Last), ("stays", Which::Stays)];
}

#[derive(Clone, Debug, PartialEq)]
pub struct Event {
    pub name: String,
    /// A quantity over time, or an expression of several.
    pub quantity: String,
    /// In the unit of the quantity.
    pub value: f64,
    pub direction: Direction,
    pub which: Which,
    pub ends_run: bool,
}

/// The column with the code of the event that ended a run.
pub const ENDED_BY: &str = "ended_by";

pub(super) const MOST_EVENTS: usize = 16;
const NAME: TextLimit = TextLimit {
    allowed: "1 to 40 lower-case letters, digits and underscores, the first a letter",
    remedy: "write it like settled",
    test: |name| is_name(name, 40),
};
const DIRECTIONS: [&str; 3] = words(&Direction::ALL);
const WHICH: [&str; 3] = words(&Which::ALL);

#[rustfmt::skip]
pub const ROWS: [Row; 6] = [
    Row::new("name", Kind::Text(NAME), "Its name, with which the names of its columns \
        begin").required_as(NAME.allowed, "\"settled\""),
    QUANTITY,
    Row::new("value", Kind::Amount, "The value that it crosses").required_as(FINITE.allowed, "0.1"),
    Row::new("direction", Kind::Word(&DIRECTIONS), "Direction of the crossing"),
    Row::new("which", Kind::Word(&WHICH), "Which crossing gives its time; `stays`: the last one, if the quantity then \
        stays on that side to the end of the run"),
    Row::new("ends_run", Kind::Flag, "Whether the run ends at its first crossing; default: false").sparse(),
];

impl Event {
    /// Reads the tables and omits invalid ones. `observed`: the columns without events.
    pub(super) fn read_all(root: &mut Section<'_, '_>, observed: &Request) -> Vec<Event> {
        let series = event_series(observed);
        let mut names: Vec<String> = Vec::new();
        let found = root.sections("event", MOST_EVENTS, |table| {
            let event = Event::read(table, (&series, observed), &names)?;
            let taken = observed
                .columns()
                .into_iter()
                .find(|column| event.quantities().iter().any(|own| own.name() == column.quantity.name()));
            if let Some(column) = taken {
                let allowed = format!("a name with which no column is there already: {} is", column.quantity.name());
                return table.refused("name", allowed, "choose another name");
            }
            names.push(event.name.clone());
            Some(event)
        });
        found.into_iter().flatten().collect()
    }

    fn read(table: &mut Section<'_, '_>, known: (&[BandSeries], &Request), taken: &[String]) -> Option<Self> {
        let [name, quantity, rest @ ..] = &ROWS;
        let head = table.rows(&[*name, *quantity], &[]);
        let variables = head.as_ref().and_then(|head| variables(table, head.text("quantity")?, known));
        let unit =
            variables.as_ref().zip(head.as_ref()).map_or(units::UNKNOWN, |(variables, head)| match &variables[..] {
                [only] if head.text("quantity") == Some(only.quantity.name()) => unit_of(&only.quantity),
                _ => units::UNKNOWN,
            });
        table.describes(None, unit);
        let rest = table.whole(rest, &[])?;
        let (direction, which) = (rest.meaning("direction", &Direction::ALL)?, rest.meaning("which", &Which::ALL)?);
        if (direction, which) == (Direction::Either, Which::Stays) {
            let allowed = "\"first\" or \"last\" where direction is \"either\"";
            return table.refused(
                "which",
                allowed,
                "write direction = \"rising\" or \"falling\": the side on which it stays",
            );
        }
        let ends_run = rest.flag("ends_run");
        if ends_run && which != Which::First {
            return table.refused(
                "which",
                "\"first\" where ends_run = true",
                "leave it out: nothing crosses after the end of the run",
            );
        }
        let (mut head, _) = head.zip(variables)?;
        let name = head.text("name")?;
        if taken.iter().any(|other| other == name) {
            return table.refused(
                "name",
                "another name than that of the other [[event]] tables",
                "give each its own name",
            );
        }
        let (name, quantity) = (name.to_owned(), head.text("quantity")?.to_owned());
        let value = rest.number("value")?;
        head.extend(rest);
        table.document.keep("[[event]]", head.completed(&ROWS, &[]));
        Some(Event { name, quantity, value, direction, which, ends_run })
    }

    pub fn says(&self) -> String {
        let how = match self.direction {
            Direction::Either => "crosses",
            Direction::Rising => "rises beyond",
            Direction::Falling => "falls below",
        };
        format!("{} {how} {:?}", self.quantity, self.value)
    }

    /// Its columns: time and count.
    pub fn quantities(&self) -> [Quantity; 2] {
        let (name, says) = (&self.name, self.says());
        let time = match self.which {
            Which::First if self.ends_run => format!("When {says}, at which the run ends; null if it never does."),
            Which::First => format!("When {says} for the first time; null if it never does."),
            Which::Last => format!("When {says} for the last time; null if it never does."),
            Which::Stays => {
                format!(
                    "When {says} and stays there to the end of the run, 0 if it is there all the time; null if it does \
                    not."
                )
            }
        };
        let count =
            format!("How often {says}, as seen at the observation points; null if it is not a number at one of them.");
        [
            Quantity::named(format!("{name}_time_s"), "s".to_owned(), time),
            Quantity::named(format!("{name}_count"), String::new(), count),
        ]
    }

    /// The ends of runs in the order of their codes in [`ENDED_BY`], including a mission's law if it `ends` runs; empty
    /// unless an event does.
    pub fn ends(events: &[Event], ends: bool) -> Vec<&str> {
        let of_events = events.iter().filter(|event| event.ends_run).map(|event| event.name.as_str());
        let others = ["duration", "mission"];
        match of_events.clone().next() {
            None => Vec::new(),
            Some(_) => others[..1 + usize::from(ends)].iter().copied().chain(of_events).collect(),
        }
    }
}
