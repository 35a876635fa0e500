//! [`Display`]: units on the screen, in reports and figures, from `[display]` and from limits and dispersions as
//! written. Files of numbers stay in the units of their columns.

use super::section::Section;
use super::units;
use crate::sampling::keys::{Kind, Row, Value};
use crate::scene::Parameter;
use std::collections::BTreeMap;

#[derive(Clone, Debug, Default, PartialEq)]
pub struct Display {
    /// Display units, at most one for each SI unit.
    units: Vec<&'static str>,
    /// Units of individual columns and parameters, by name.
    columns: BTreeMap<String, &'static str>,
}

/// A display unit and its size in the column's unit.
#[derive(Clone, Debug, PartialEq)]
pub struct ShownUnit {
    /// Empty for a pure number.
    pub unit: String,
    /// The size as a fraction.
    size: [f64; 2],
}

impl ShownUnit {
    pub fn own(unit: &str) -> Self {
        ShownUnit { unit: unit.to_owned(), size: [1.0; 2] }
    }

    /// Hours or days instead of seconds for a time up to `longest`, s, if `limit` is a short number in them.
    #[must_use]
    pub fn of_time(self, longest: f64, limit: Option<f64>) -> Self {
        /// Most digits of a short limit.
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

    pub fn is_own(&self) -> bool {
        self.size[0] == self.size[1]
    }

    pub fn value(&self, value: f64) -> f64 {
        if self.is_own() { value } else { value * self.size[1] / self.size[0] }
    }

    /// [`ShownUnit::value`] without the rounding of two conversions, so that 5 deg reads as 5; numbers written in
    /// another unit have five digits.
    pub fn written(&self, value: f64) -> f64 {
        /// Most digits of a written number.
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

/// Default units of angles and rates.
const SAID: [&str; 2] = ["deg", "deg/s"];
/// Default unit of wheel speeds.
const OF_WHEELS: &str = "rpm";

const EXAMPLE: &str = "[\"deg\", \"deg/s\"]";

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
    /// Reads `[display]`; `written` has the units of limits and dispersions by name.
    pub(super) fn read(root: &mut Section<'_, '_>, written: Vec<(String, &'static str)>) -> Self {
        let mut display = Display { units: Vec::new(), columns: written.into_iter().collect() };
        root.kept("[display]", &ROWS, |found| {
            let units = found.texts("units").iter().filter_map(|name| units::named(name));
            display.units = units.map(|unit| unit.name).collect();
            if let Some(Value::Units(own)) = found.get("columns") {
                display.columns.extend(own.clone());
            }
            found.set("columns", Value::Units(display.columns.clone()));
        });
        display
    }

    /// The display unit of the column or parameter `name` with `unit`.
    pub fn of(&self, name: &str, unit: &str) -> ShownUnit {
        let own = units::named(unit);
        let wanted = self.columns.get(name).or_else(|| {
            // `deg/s` in the file does not apply to wheel speeds
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

/// True if a quantity in rad/s is a wheel speed: `rate_<wheel>_...`, `speed_<wheel>_...` or a key of the wheel. The
/// rates of estimates belong to the body.
fn is_wheel_speed(name: &str) -> bool {
    let is_rate = name.starts_with("rate_") && !name.starts_with("rate_estimate") && !name.starts_with("rate_expected");
    name.starts_with("wheels.") || is_rate || (name.contains("speed_") && name.ends_with("_rad_s"))
}

fn allowed() -> String {
    format!("one of {}", units::names().collect::<Vec<_>>().join(", "))
}

/// The valid units that `key` lists.
pub(super) fn of_quantities(section: &mut Section<'_, '_>, key: &str) -> Vec<String> {
    let mut units: Vec<String> = Vec::new();
    for text in section.texts(key, EXAMPLE).unwrap_or_default() {
        match units::named(&text) {
            None => section.refuse_value(key, format!("{text:?}"), allowed(), "choose one of these"),
            Some(unit) if units.iter().any(|other| units::named(other).is_some_and(|other| other.of == unit.of)) => {
                section.refuse_value(key, format!("{text:?}"), "of different quantities", "delete one of both");
            }
            Some(unit) => units.push(unit.name.to_owned()),
        }
    }
    units
}

/// The valid units in the table `key`, by column and parameter.
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

    /// Law: a column's unit takes precedence over its kind's, other kinds stay, and a number reads as it was written.
    #[test]
    fn columns_come_before_kinds() {
        let columns = BTreeMap::from([("rate_w1".to_owned(), "rpm"), ("tilt".to_owned(), "arcsec")]);
        let display = Display { units: vec!["deg", "deg/s"], columns };
        for (name, unit, shown) in [
            ("any", "rad", "deg"),
            ("any", "rad/s", "deg/s"),
            ("rate_w1", "rad/s", "rpm"),
            ("tilt", "rad", "arcsec"),
            ("tilt", "kg", "kg"),
            ("pointing", "deg", "deg"),
            ("any", "J", "J"),
            ("any", "", ""),
        ] {
            assert_eq!(display.of(name, unit).unit, shown, "{name} {unit}");
        }
        let degrees = display.of("any", "rad");
        assert!((degrees.value(core::f64::consts::PI) - 180.0).abs() < 1e-12);
        assert_eq!(degrees.written(5.0 * core::f64::consts::PI / 180.0), 5.0);
        let display = Display { columns: BTreeMap::from([("pointing".to_owned(), "arcsec")]), ..Display::default() };
        assert!((display.of("pointing", "deg").value(1.0) - 3600.0).abs() < 1e-9);
        // without `[display]`, angles are in degrees
        let written = |units: Vec<&'static str>| {
            let shown = Display { units, ..Display::default() }.of("x", "rad");
            (shown.unit.clone(), shown.written(0.03))
        };
        assert_eq!(written(vec![]), ("deg".to_owned(), 1.7189));
        assert_eq!(written(vec!["rad"]), ("rad".to_owned(), 0.03));
        assert_eq!(Display::default().of("x", "rad/s").unit, "deg/s");
    }
}
