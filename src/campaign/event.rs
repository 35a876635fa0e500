//! [`Event`]: an `[[event]]` table, a quantity over time that crosses a value.

use super::lines::Lines;
use super::numbers::FINITE;
use super::problem::nearest;
use super::section::Section;
use super::units;
use crate::observables::band_series::{BandSeries, event_series};
use crate::observables::{Group, Groups, Request};
use crate::run::Quantity;
use crate::sampling::expression::Expression;

/// In which direction a quantity crosses the value.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Direction {
    /// In either.
    Either,
    /// From below to above.
    Rising,
    /// From above to below.
    Falling,
}

/// Which crossing of a run its time is of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Which {
    /// The first.
    First,
    /// The last.
    Last,
    /// The last, where the quantity stays on that side to the end of the run; time zero where it is there all the time.
    Stays,
}

impl Direction {
    /// All values with their names in campaign files.
    pub const ALL: [(&'static str, Direction); 3] =
        [("either", Direction::Either), ("rising", Direction::Rising), ("falling", Direction::Falling)];
}

impl Which {
    /// All values with their names in campaign files.
    pub const ALL: [(&'static str, Which); 3] =
        [("first", Which::First), ("last", Which::Last), ("stays", Which::Stays)];
}

/// A quantity over time that crosses a value.
#[derive(Clone, Debug, PartialEq)]
pub struct Event {
    /// Its name.
    pub name: String,
    /// The quantity: the name of one over time, or an expression of several.
    pub quantity: String,
    /// The value, in its unit.
    pub value: f64,
    /// In which direction it is crossed.
    pub direction: Direction,
    /// Which crossing the time is of.
    pub which: Which,
}

/// Most events of a file.
pub(super) const MOST_EVENTS: usize = 16;
/// What a name must be.
const NAME: &str = "1 to 40 small letters, digits and underscores, the first a letter";

impl Event {
    /// Reads the tables; what is wrong is noted, and left out here. `observed` is what the rows have without events.
    pub(super) fn read_all(root: &mut Section<'_, '_>, observed: &Request) -> Vec<Event> {
        if !root.has("event") {
            root.know("event");
            return Vec::new();
        }
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
                table.refuse("name", allowed, "choose another name");
                return None;
            }
            names.push(event.name.clone());
            Some(event)
        });
        found.into_iter().flatten().collect()
    }

    fn read(table: &mut Section<'_, '_>, known: (&[BandSeries], &Request), taken: &[String]) -> Option<Self> {
        table.require("name", NAME, "\"settled\"");
        table.require("quantity", "a quantity over time, or an expression of some", "\"angular_rate_rad_s\"");
        table.require("value", FINITE.allowed, "0.1");
        let name = name(table, taken);
        let quantity = table.text("quantity").map(str::to_owned);
        let variables = quantity.as_ref().and_then(|text| variables(table, text, known));
        let unit = variables.as_ref().map(|variables| match &variables[..] {
            [only] if quantity.as_deref() == Some(only.quantity.name()) => {
                units::known(only.quantity.unit()).unwrap_or("1")
            }
            _ => units::UNKNOWN,
        });
        table.measures(unit.unwrap_or(units::UNKNOWN));
        let value = table.number("value", FINITE);
        let direction = choice(table, "direction", &Direction::ALL);
        let which = choice(table, "which", &Which::ALL);
        if (direction, which) == (Some(Direction::Either), Some(Which::Stays)) {
            let allowed = "\"first\" or \"last\" where direction is \"either\"";
            table.refuse("which", allowed, "write direction = \"rising\" or \"falling\": the side on which it stays");
            table.finish();
            return None;
        }
        table.finish();
        variables?;
        Some(Event { name: name?, quantity: quantity?, value: value?, direction: direction?, which: which? })
    }

    /// The expression, and the quantities that are its variables, of runs of `request`; `None` only for what [`Event::read_all`] refuses.
    pub fn parsed(&self, series: &[BandSeries]) -> Option<(Expression, Vec<BandSeries>)> {
        let expression = Expression::parse(&self.quantity).ok()?;
        let of = |name: &String| series.iter().find(|band| band.quantity.name() == name).cloned();
        let variables = expression.variables().iter().map(of).collect::<Option<_>>()?;
        Some((expression, variables))
    }

    /// What happens, in words.
    pub fn says(&self) -> String {
        let how = match self.direction {
            Direction::Either => "crosses",
            Direction::Rising => "rises beyond",
            Direction::Falling => "falls below",
        };
        format!("{} {how} {:?}", self.quantity, self.value)
    }

    /// The columns: name, unit and meaning of the time and of the count.
    pub fn quantities(&self) -> [Quantity; 2] {
        let (name, says) = (&self.name, self.says());
        let time = match self.which {
            Which::First => format!("When {says} for the first time; null where it never does."),
            Which::Last => format!("When {says} for the last time; null where it never does."),
            Which::Stays => {
                format!(
                    "When {says} and stays there to the end of the run, 0 where it is there all the time; null where it does not."
                )
            }
        };
        let count = format!("How often {says}, as seen at the observation points.");
        [
            Quantity::named(format!("{name}_time_s"), "s".to_owned(), time),
            Quantity::named(format!("{name}_count"), String::new(), count),
        ]
    }

    /// Writes the table.
    pub(super) fn write(&self, lines: &mut Lines) {
        lines.table("[[event]]");
        lines.key("name", &self.name);
        lines.text_key("quantity", &self.quantity);
        lines.key("value", self.value);
        lines.key("direction", named(self.direction, &Direction::ALL));
        lines.key("which", named(self.which, &Which::ALL));
    }
}

/// The name of `value`.
fn named<T: PartialEq>(value: T, all: &[(&'static str, T)]) -> &'static str {
    all.iter().find(|(_, one)| *one == value).map_or("", |(name, _)| *name)
}

/// The value of `key`, the first one where it is not written; `None` where it is wrong, which is then noted.
fn choice<T: Copy>(table: &mut Section<'_, '_>, key: &str, all: &[(&'static str, T)]) -> Option<T> {
    let names: Vec<&str> = all.iter().map(|(name, _)| *name).collect();
    let found = table.name(key, &names, |text| all.iter().find(|(name, _)| *name == text).map(|(_, value)| *value));
    if table.has(key) { found } else { Some(all[0].1) }
}

/// The quantities in `text`; `None` where it is wrong, which is then noted.
fn variables(
    table: &mut Section<'_, '_>,
    text: &str,
    (series, observed): (&[BandSeries], &Request),
) -> Option<Vec<BandSeries>> {
    let parsed = match Expression::parse(text) {
        Ok(parsed) => parsed,
        Err(error) => {
            table.refuse("quantity", error, "correct the expression");
            return None;
        }
    };
    if parsed.variables().is_empty() {
        table.refuse("quantity", "made of quantities over time", "name one, such as \"angular_rate_rad_s\"");
        return None;
    }
    let mut found = Vec::new();
    for name in parsed.variables() {
        let Some(band) = series.iter().find(|band| band.quantity.name() == name) else {
            let (allowed, remedy) = refusal(name, series, observed);
            table.refuse_value("quantity", format!("{name:?}"), allowed, remedy);
            return None;
        };
        found.push(band.clone());
    }
    Some(found)
}

/// What is allowed in place of `name`, which is no quantity over time of `series`, and what to do.
fn refusal(name: &str, series: &[BandSeries], observed: &Request) -> (String, String) {
    let names = || series.iter().map(|band| band.quantity.name());
    let allowed = "made of quantities over time that are observed".to_owned();
    let mut of = *observed;
    let group = Group::ALL.into_iter().find(|group| {
        of.groups = Groups::NONE.with(*group);
        event_series(&of).iter().any(|band| band.quantity.name() == name)
    });
    let remedy = match (group, nearest(name, names())) {
        (Some(group), _) => {
            format!("it is in a group that is not observed: add {:?} to observe.groups", group.name())
        }
        (None, Some(meant)) => format!("did you mean {meant:?}?"),
        (None, None) => format!("name some of {}", names().collect::<Vec<_>>().join(", ")),
    };
    (allowed, remedy)
}

/// A name that no other event has.
fn name(table: &mut Section<'_, '_>, taken: &[String]) -> Option<String> {
    let name = table.text("name")?;
    let is_letter = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '_';
    if !name.starts_with(|c: char| c.is_ascii_lowercase()) || !name.chars().all(is_letter) || name.len() > 40 {
        table.refuse("name", NAME, "write it like settled");
        return None;
    }
    if taken.iter().any(|other| other == name) {
        table.refuse("name", "another name than that of the other [[event]] tables", "give each its own name");
        return None;
    }
    Some(name.to_owned())
}
