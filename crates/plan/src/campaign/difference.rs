//! [`differences`], [`text_differences`]: the keys in which two plans differ; [`said`]: their values for people.

use super::display::ShownUnit;
use super::plan::Plan;
use super::units;
use crate::sampling::DistributionKind;
use crate::sampling::keys::Kind;
use crate::scene::Parameter;
use toml::de::{DeTable, DeValue};

#[derive(Clone, Debug, PartialEq, Eq)]
pub struct KeyDifference {
    /// The dotted key: `integrator.method`, `guidance.coast.timeout_s`.
    pub key: String,
    /// Its value in the first plan; `None` for a missing key.
    pub first: Option<String>,
    pub second: Option<String>,
}

/// The keys in which two plans differ, in canonical order.
pub fn differences(first: &Plan, second: &Plan) -> Vec<KeyDifference> {
    text_differences(&first.text(), &second.text())
}

/// [`differences`] of canonical texts.
pub fn text_differences(first: &str, second: &str) -> Vec<KeyDifference> {
    let (first, second) = (keys(first), keys(second));
    let value = |list: &[(String, String)], key: &str| {
        list.iter().find(|(known, _)| known == key).map(|(_, value)| value.clone())
    };
    let gone = first.iter().filter_map(|(key, one)| {
        let other = value(&second, key);
        (other.as_ref() != Some(one)).then(|| KeyDifference {
            key: key.clone(),
            first: Some(one.clone()),
            second: other,
        })
    });
    let new = second.iter().filter(|(key, _)| value(&first, key).is_none());
    let new = new.map(|(key, one)| KeyDifference { key: key.clone(), first: None, second: Some(one.clone()) });
    gone.chain(new).collect()
}

/// Every key of a canonical text with its value, in its order.
fn keys(text: &str) -> Vec<(String, String)> {
    let mut found = Vec::new();
    collect(text, "", DeTable::parse_recoverable(text).0.get_ref(), &mut found);
    found.sort_by_key(|(start, ..)| *start);
    found.into_iter().map(|(_, key, value)| (key, value)).collect()
}

/// Adds the keys of `table`, with their places in `text`. A table of a list is addressed by its name, as in `--set`,
/// its parameter, or its number.
fn collect(text: &str, path: &str, table: &DeTable<'_>, found: &mut Vec<(usize, String, String)>) {
    for (key, value) in table {
        let (start, key, written) = (key.span().start, key.get_ref(), text.get(value.span()).unwrap_or_default());
        let inner = if path.is_empty() { key.to_string() } else { format!("{path}.{key}") };
        match value.get_ref() {
            DeValue::Table(table) if !written.starts_with('{') => collect(text, &inner, table, found),
            DeValue::Array(list) if list.iter().any(|item| item.get_ref().is_table()) => {
                for (place, table) in list.iter().filter_map(|item| item.get_ref().as_table()).enumerate() {
                    let word = |key: &str| table.get(key).and_then(|value| value.get_ref().as_str());
                    let address = match (word("name").or_else(|| word("phase")), word("parameter")) {
                        (Some(name), _) => format!("{inner}.{name}"),
                        (None, Some(parameter)) => format!("{inner}[{parameter}]"),
                        (None, None) => format!("{inner}[{place}]"),
                    };
                    collect(text, &address, table, found);
                }
            }
            _ => found.push((start, format!("{path}.{key}"), written.to_owned())),
        }
    }
}

/// The values of a key in two `plans` (SI in canonical text) in their display unit if this is shorter (5 deg for
/// 0.08726646259971647), with the unit unless the key names its own. Without plans, numbers are only shortened.
pub fn said(plans: Option<[&Plan; 2]>, key: &str, values: [Option<&str>; 2]) -> [Option<String>; 2] {
    let units = [0, 1].map(|side| values[side].and(unit_of(plans?[side], key)));
    let [first, second] = units.each_ref().map(|unit| unit.as_ref().map(|(unit, ..)| *unit));
    if values.iter().all(Option::is_some) && first != second {
        // requirements about different quantities
        let [first, _] = said(plans, key, [values[0], None]);
        let [_, second] = said(plans, key, [None, values[1]]);
        return [first, second];
    }
    let texts = |of: &dyn Fn(f64) -> f64| values.map(|value| value.map(|value| with_numbers(value, of)));
    let own = texts(&|x| x);
    let unit = units.into_iter().flatten().next();
    let Some((unit, shown, is_named)) = unit else { return own.map(|text| text.map(|(text, _)| text)) };
    let other = texts(&|x| shown.written(x));
    let length =
        |texts: &[Option<(String, bool)>; 2]| texts.iter().flatten().map(|(text, _)| text.len()).sum::<usize>();
    let is_shown = !shown.is_own() && length(&other) < length(&own) && other[0] != other[1];
    let (texts, unit) = match is_shown {
        true => (other, shown.unit.as_str()),
        false => (own, if is_named { "" } else { unit }),
    };
    let with_unit = |(text, is_number)| if is_number { format!("{text} {unit}").trim_end().to_owned() } else { text };
    texts.map(|text| text.map(with_unit))
}

/// A value with `of` applied to its numbers, and whether it consists of numbers.
fn with_numbers(value: &str, of: &dyn Fn(f64) -> f64) -> (String, bool) {
    let inner = value.strip_prefix('[').and_then(|rest| rest.strip_suffix(']'));
    let numbers: Option<Vec<f64>> = inner.unwrap_or(value).split(", ").map(|number| number.parse().ok()).collect();
    let Some(numbers) = numbers else { return (value.to_owned(), false) };
    let number = |x: &f64| format!("{:?}", of(*x)).trim_end_matches(".0").to_owned();
    let list: Vec<String> = numbers.iter().map(number).collect();
    (if inner.is_some() { format!("[{}]", list.join(", ")) } else { list.concat() }, true)
}

/// The SI unit of a key's numbers, their display unit, and whether the key names the former.
fn unit_of(plan: &Plan, key: &str) -> Option<(&'static str, ShownUnit, bool)> {
    let (table, last) = key.rsplit_once('.')?;
    let (name, unit, is_named) =
        if let Some(parameter) = table.strip_prefix("disperse[").and_then(|rest| rest.strip_suffix(']')) {
            let rows = DistributionKind::ALL.iter().flat_map(|kind| kind.keys());
            let is_amount = |kind: &Kind| matches!(kind, Kind::Amount | Kind::Amounts | Kind::AmountList);
            match rows.filter(|row| row.key == last).all(|row| is_amount(&row.kind)) {
                true => (parameter, Parameter::find(&plan.nominal, parameter)?.0.unit(), false),
                false => (parameter, units::in_name(last), true),
            }
        } else if let Some(place) = table.strip_prefix("require[").and_then(|rest| rest.strip_suffix(']')) {
            let requirement = plan.analysis.requirements.get(place.parse::<usize>().ok()?)?;
            let columns = plan.request().columns();
            let column = columns.iter().find(|column| Some(column.quantity.name()) == requirement.observable())?;
            let unit = units::known(column.quantity.unit()).filter(|_| ["at_most", "at_least"].contains(&last))?;
            (requirement.name(), unit, false)
        } else {
            (key, units::in_name(last), true)
        };
    (unit != "1").then(|| (unit, plan.analysis.display.of(name, unit), is_named))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn differing_keys_are_named() {
        let first = "[a]\nx = 1\ny = 2\n\n[[l]]\nname = \"p\"\n\n[l.inner]\nz = 3\n\n[[l]]\nname = \"q\"\n# x = 9\n";
        let second = "[a]\nx = 1\ny = 3\n\n[[l]]\nname = \"p\"\n\n[l.inner]\nz = 4\n\n[b]\nw = 5\n";
        let found = text_differences(first, second);
        let found: Vec<_> = found.iter().map(|d| (d.key.as_str(), d.first.as_deref(), d.second.as_deref())).collect();
        assert_eq!(
            found,
            [
                ("a.y", Some("2"), Some("3")),
                ("l.p.inner.z", Some("3"), Some("4")),
                ("l.q.name", Some("\"q\""), None),
                ("b.w", None, Some("5")),
            ]
        );
        assert!(text_differences(first, first).is_empty());
        let names = |text: &str| keys(text).into_iter().map(|(key, _)| key).collect::<Vec<_>>();
        let text = "[[guidance]]\nuntil = \"launch\"\nphase = \"coast\"\n[[disperse]]\nparameter = \
            \"w.x\"\n[[require]]\nat_most = 1\n[[require]]\nat_most = 2\n";
        assert_eq!(
            names(text),
            [
                "guidance.coast.until",
                "guidance.coast.phase",
                "disperse[w.x].parameter",
                "require[0].at_most",
                "require[1].at_most"
            ]
        );
    }
}
