//! [`Display`]: in which units numbers are shown: `[display]`, and the units in which limits and dispersions are
//! written.
//!
//! Rows, and every file of numbers, stay in the units of their columns; the screen, verdicts, cards, JUnit and figures
//! show these.

use std::collections::BTreeMap;

use super::section::Section;
use super::units;
use crate::sampling::keys::{Kind, Row, Value};
use crate::scene::Parameter;

/// In which units numbers are shown.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Display {
    /// Units, each in place of the SI unit that it measures in.
    units: Vec<&'static str>,
    /// The units of single columns and parameters, by name.
    columns: BTreeMap<String, &'static str>,
}

/// The unit in which a quantity is shown, and its size in the unit of the column.
#[derive(Clone, Debug, PartialEq)]
pub struct ShownUnit {
    /// The unit; empty of a pure number.
    pub unit: String,
    /// Its size in the unit of the column, as a fraction.
    size: [f64; 2],
}

impl ShownUnit {
    /// The unit of a column itself.
    pub fn own(unit: &str) -> Self {
        ShownUnit { unit: unit.to_owned(), size: [1.0; 2] }
    }

    /// The same, or hours or days in place of seconds: the unit in which a person says a time as long as `longest`, if
    /// `limit` is a short number in it.
    #[must_use]
    pub fn of_time(self, longest: f64, limit: Option<f64>) -> Self {
        /// A limit with more digits in a unit is not said in it.
        const DIGITS: usize = 4;
        let is_short = |value: f64| format!("{value:.0$e}", DIGITS - 1).parse() == Ok(value);
        let units = [("days", 86_400.0, 172_800.0), ("h", 3600.0, 7200.0)].into_iter();
        let mut fitting =
            units.filter(|(_, size, from)| longest >= *from && limit.is_none_or(|one| is_short(one / size)));
        match fitting.next().filter(|_| self.unit == "s") {
            Some((unit, size, _)) => ShownUnit { unit: unit.to_owned(), size: [size, 1.0] },
            None => self,
        }
    }

    /// Whether numbers are shown as they are.
    pub fn is_own(&self) -> bool {
        self.size[0] == self.size[1]
    }

    /// A number of the column, in this unit.
    pub fn value(&self, value: f64) -> f64 {
        if self.is_own() { value } else { value * self.size[1] / self.size[0] }
    }

    /// The same with the rounding of the way there and back taken away: what was written as 5 deg is 5. What was
    /// written in another unit has five digits.
    pub fn written(&self, value: f64) -> f64 {
        /// Nobody writes a number with more digits.
        const WRITTEN: usize = 9;
        if self.is_own() {
            return value;
        }
        let value = self.value(value);
        let [whole, written, short] =
            [13, WRITTEN - 1, 4].map(|digits| format!("{value:.digits$e}").parse().unwrap_or(value));
        if whole == written { written } else { short }
    }
}

/// The units in which people say angles and rates, where the file says nothing of them.
const SAID: [&str; 2] = ["deg", "deg/s"];
/// The unit in which people say the speed of a wheel, where the file says nothing of it.
const OF_WHEELS: &str = "rpm";

/// A list of units that texts know.
const EXAMPLE: &str = "[\"deg\", \"deg/s\"]";

/// The keys of the table.
pub const ROWS: [Row; 2] = [
    Row::new(
        "units",
        Kind::Units,
        "Units in which numbers are shown, one for each kind of quantity; default: deg and deg/s, and rpm for wheel \
        speeds",
    ),
    Row::new("columns", Kind::UnitsByName, "Units of individual columns and parameters, by name"),
];

impl Display {
    /// Reads `[display]`; `written` are units in which limits and dispersions are written, by the name of what they are
    /// of.
    pub(super) fn read(root: &mut Section<'_, '_>, written: Vec<(String, &'static str)>) -> Self {
        let mut display = Display { units: Vec::new(), columns: written.into_iter().collect() };
        root.kept("[display]", &ROWS, |found| {
            if let Some(Value::Words(units)) = found.get("units") {
                display.units.clone_from(units);
            }
            if let Some(Value::Units(own)) = found.get("columns") {
                display.columns.extend(own.clone());
            }
            found.set("columns", Value::Units(display.columns.clone()));
        });
        display
    }

    /// The unit in which the column or parameter `name`, of unit `unit`, is shown.
    pub fn of(&self, name: &str, unit: &str) -> ShownUnit {
        let own = units::named(unit);
        let wanted = self.columns.get(name).or_else(|| {
            // a file that wants rates as people say them wants wheel speeds so, too
            let is_wheel = is_wheel_speed(name);
            let said = self.units.iter().filter(|unit| !(is_wheel && SAID.contains(unit)));
            let all = said.chain(is_wheel.then_some(&OF_WHEELS)).chain(&SAID);
            all.into_iter().find(|name| units::named(name).is_some_and(|wanted| wanted.of == unit))
        });
        match (own, wanted.and_then(|name| units::named(name))) {
            (Some(own), Some(wanted)) if own.of == wanted.of => ShownUnit {
                unit: wanted.name.to_owned(),
                size: [wanted.size[0] * own.size[1], wanted.size[1] * own.size[0]],
            },
            _ => ShownUnit::own(unit),
        }
    }
}

/// Whether a column, quantity over time or parameter in rad/s is the speed of a wheel: `rate_<wheel>_...`,
/// `speed_<wheel>_...` or a key of the wheel. No other rate is called a speed; the rates of estimates are those of the
/// body.
fn is_wheel_speed(name: &str) -> bool {
    let is_rate = name.starts_with("rate_") && !name.starts_with("rate_estimate") && !name.starts_with("rate_expected");
    name.starts_with("wheels.") || is_rate || (name.contains("speed_") && name.ends_with("_rad_s"))
}

fn allowed() -> String {
    format!("one of {}", units::names().collect::<Vec<_>>().join(", "))
}

/// The units that `key` lists, without those that are wrong, which are noted.
pub(super) fn of_quantities(section: &mut Section<'_, '_>, key: &str) -> Vec<&'static str> {
    let mut units: Vec<&'static str> = Vec::new();
    for text in section.texts(key, EXAMPLE).unwrap_or_default() {
        match units::named(&text) {
            None => section.refuse_value(key, format!("{text:?}"), allowed(), "choose one of these"),
            Some(unit) if units.iter().any(|other| units::named(other).is_some_and(|other| other.of == unit.of)) => {
                section.refuse_value(key, format!("{text:?}"), "of different quantities", "delete one of both");
            }
            Some(unit) => units.push(unit.name),
        }
    }
    units
}

/// The units in the table `key` by the names of columns and parameters; without those that are wrong, which are noted.
pub(super) fn by_name(section: &mut Section<'_, '_>, key: &str) -> BTreeMap<String, &'static str> {
    let mut columns = BTreeMap::new();
    let names: Vec<String> = section.entries(key).into_iter().map(|(name, _)| name).collect();
    let mut table = section.section(key);
    for name in names.clone() {
        let (Some(text), Some(known)) = (table.text(&name), table.document.known.as_ref()) else { continue };
        let quantity = known.observable(&name).or_else(|| known.band(&name)).map(|quantity| quantity.unit().to_owned());
        let own = quantity.or_else(|| Some(Parameter::find(&table.document.scene, &name)?.0.unit().to_owned()));
        match (own, units::named(text)) {
            (None, _) => {
                let (_, remedy) = known.refusal(&name);
                table.refuse(&name, "a unit of a column of the rows or of bands, or of a parameter", remedy);
            }
            (_, None) => table.refuse(&name, allowed(), "choose one of these"),
            (Some(own), Some(unit)) if units::named(&own).is_none_or(|own| own.of != unit.of) => {
                let own = if own.is_empty() { "1".to_owned() } else { own };
                let remedy = "delete this entry, or choose another unit";
                table.refuse(&name, format!("a unit in place of {own}"), remedy);
            }
            (_, Some(unit)) => {
                let over_time = known.over_time(&name).filter(|other| !names.contains(other));
                columns.extend(over_time.into_iter().chain([name]).map(|name| (name, unit.name)));
            }
        }
    }
    table.finish();
    columns
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Law: a unit of a column comes before one of its kind; other kinds stay; a number comes back as it was written.
    #[test]
    fn columns_come_before_kinds() {
        let columns = BTreeMap::from([("rate_w1".to_owned(), "rpm"), ("tilt".to_owned(), "arcsec")]);
        let display = Display { units: vec!["deg", "deg/s"], columns };
        for (name, unit, shown) in [
            ("any", "rad", "deg"),
            ("any", "rad/s", "deg/s"),
            ("rate_w1", "rad/s", "rpm"),
            ("tilt", "rad", "arcsec"),
            // a unit that is not of the kind of the column
            ("tilt", "kg", "kg"),
            // a column that is in degrees already
            ("pointing", "deg", "deg"),
            ("any", "J", "J"),
            ("any", "", ""),
        ] {
            assert_eq!(display.of(name, unit).unit, shown, "{name} {unit}");
        }
        let degrees = display.of("any", "rad");
        assert!((degrees.value(core::f64::consts::PI) - 180.0).abs() < 1e-12);
        assert_eq!(degrees.written(5.0 * core::f64::consts::PI / 180.0), 5.0);
        // a derived observable in degrees, shown in arcseconds
        let display = Display { columns: BTreeMap::from([("pointing".to_owned(), "arcsec")]), ..Display::default() };
        assert!((display.of("pointing", "deg").value(1.0) - 3600.0).abs() < 1e-9);
        // without a word in the file angles are in degrees; one that asks for radians gets them
        let written = |units: Vec<&'static str>| {
            let shown = Display { units, ..Display::default() }.of("x", "rad");
            (shown.unit.clone(), shown.written(0.03))
        };
        assert_eq!(written(vec![]), ("deg".to_owned(), 1.7189));
        assert_eq!(written(vec!["rad"]), ("rad".to_owned(), 0.03));
        assert_eq!(Display::default().of("x", "rad/s").unit, "deg/s");
    }
}
