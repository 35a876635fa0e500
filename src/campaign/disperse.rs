//! The keys of a `[[disperse]]` table.
//!
//! Here is only how a law is written; whether it can be drawn for a scene, [`crate::sampling::Dispersions`] says.

use super::data::DataFile;
use super::disperse_geometric::{about_axis, attitude_error, cone, uniform_direction, von_mises_fisher};
use super::problem::nearest;
use super::section::Section;
use crate::sampling::scalar::{LOWER_KEYS, UPPER_KEYS};
use crate::sampling::{
    Bound, DataColumn, Dispersion, Interpolation, Law, LogRange, Offset, Range, Spread, Truncation, Values,
};
use crate::scene::Parameter;

/// Reads what belongs to one law.
type Reader = fn(&mut Section<'_, '_>) -> Option<Law>;

/// The laws: name, and how its keys are read.
const LAWS: [(&str, Reader); 18] = [
    ("normal", |table| spread(table).map(Law::Normal)),
    ("truncated_normal", |table| {
        let (spread, cut) = (spread(table), cut(table));
        spread.zip(cut).map(|(spread, cut)| Law::TruncatedNormal(spread, cut))
    }),
    ("uniform", |table| range(table).map(Law::Uniform)),
    ("log_normal", |table| {
        let (log_std, median) = (required(table, "log_std", "0.1"), optional(table, "median"));
        log_std.zip(median).map(|(log_std, median)| Law::LogNormal { log_std, median })
    }),
    ("log_uniform", |table| log_range(table).map(Law::LogUniform)),
    ("triangular", |table| {
        ends(table).zip(optional(table, "mode")).map(|((min, max), mode)| Law::Triangular { min, max, mode })
    }),
    ("beta", |table| {
        let shapes = required(table, "alpha", "2.0").zip(required(table, "beta", "5.0"));
        ends(table).zip(shapes).map(|((min, max), (alpha, beta))| Law::Beta { alpha, beta, min, max })
    }),
    ("pert", |table| ends(table).zip(optional(table, "mode")).map(|((min, max), mode)| Law::Pert { min, max, mode })),
    ("choice", |table| {
        table.require("values", "an array of finite numbers", "[1.0, 2.0]");
        let (values, has_weights) = (table.numbers("values"), table.has("weights"));
        let weights = table.numbers("weights");
        if has_weights && weights.is_none() { None } else { values.map(|values| Law::Choice { values, weights }) }
    }),
    ("bernoulli", |table| {
        let (value, probability) = (required(table, "value", "0.0"), required(table, "probability", "0.05"));
        value.zip(probability).map(|(value, probability)| Law::Bernoulli { value, probability })
    }),
    ("empirical", empirical),
    ("offset", |table| {
        let one = is_one_of(table, &["offset", "relative_offset"], "0.1");
        let (absolute, relative) = (table.values("offset"), table.values("relative_offset"));
        let offset = absolute.map(Offset::Absolute).or(relative.map(Offset::Relative));
        if one { offset.map(Law::Offset) } else { None }
    }),
    ("uniform_attitude", |_| Some(Law::UniformAttitude)),
    ("uniform_direction", uniform_direction),
    ("cone", cone),
    ("von_mises_fisher", von_mises_fisher),
    ("attitude_error", attitude_error),
    ("about_axis", about_axis),
];

/// Reads one table; `None` where something is wrong, which is then noted.
pub fn read(table: &mut Section<'_, '_>) -> Option<Dispersion> {
    let target = parameter(table, "parameter");
    let law = law(table);
    let ((parameter, component), law) = target.zip(law)?;
    Some(Dispersion { parameter, component, law })
}

/// The law that a table describes, and that nothing else is written there.
pub(super) fn law(table: &mut Section<'_, '_>) -> Option<Law> {
    let names = LAWS.map(|(name, _)| name);
    table.require("distribution", &format!("one of {}", names.join(", ")), "\"normal\"");
    let reader = table
        .name("distribution", &names, |name| LAWS.iter().find(|(known, _)| *known == name).map(|(_, reader)| *reader));
    // without a law nobody can say which other keys belong here
    let law = reader?(table);
    table.finish();
    law
}

/// The parameter, and the component if one is meant, that `key` names.
pub(super) fn parameter(table: &mut Section<'_, '_>, key: &'static str) -> Option<(Parameter, Option<usize>)> {
    table.require(key, "a numeric key of scene or initial state", "\"fuselage.density_kg_m3\"");
    let name = table.text(key)?;
    let found = Parameter::find(name);
    if found.is_none() {
        let (allowed, remedy) = unknown_parameter(name);
        table.refuse(key, allowed, remedy);
    }
    found
}

/// What is said of a name that is no parameter: what is allowed, and what was probably meant.
pub(super) fn unknown_parameter(name: &str) -> (String, String) {
    let remedy = match nearest(name, Parameter::all().map(Parameter::name)) {
        Some(meant) => format!("did you mean {meant:?}?"),
        None => "write table and key as in this file, \"wheel1.radius_m\"".to_owned(),
    };
    ("a numeric key of scene or initial state, as a whole or with a component ([0] or .x)".to_owned(), remedy)
}

/// Notes that of `keys` not exactly one was written, where that is so.
pub(super) fn is_one_of(table: &mut Section<'_, '_>, keys: &[&'static str], example: &str) -> bool {
    let written: Vec<&'static str> = keys.iter().copied().filter(|key| table.has(key)).collect();
    match written[..] {
        [_] => true,
        [] => {
            table.require(keys[0], &format!("given ({})", keys.join(" or ")), example);
            false
        }
        [_, second, ..] => {
            table.refuse(second, format!("the only one of {}", keys.join(", ")), "delete all but one of them");
            false
        }
    }
}

/// Values that must be there.
fn required(table: &mut Section<'_, '_>, key: &'static str, example: &str) -> Option<Values> {
    table.require(key, "a finite number, or an array of one for each component", example);
    table.values(key)
}

/// Values that may be left out; `None` where they are wrong.
fn optional(table: &mut Section<'_, '_>, key: &'static str) -> Option<Option<Values>> {
    let values = table.values(key);
    if table.has(key) && values.is_none() { None } else { Some(values) }
}

fn spread(table: &mut Section<'_, '_>) -> Option<Spread> {
    let one = is_one_of(table, &["std", "relative_std"], "0.1");
    let (absolute, relative) = (table.values("std"), table.values("relative_std"));
    if one { absolute.map(Spread::Absolute).or(relative.map(Spread::Relative)) } else { None }
}

/// The bound that one of three keys gives, if any; `None` where what is written is wrong.
fn bound(table: &mut Section<'_, '_>, keys: [&'static str; 3]) -> Option<Option<Bound>> {
    let written: Vec<&'static str> = keys.into_iter().filter(|key| table.has(key)).collect();
    if let [_, second, ..] = written[..] {
        table.refuse(second, format!("the only one of {}", keys.join(", ")), "delete all but one of them");
    }
    let kinds: [fn(Values) -> Bound; 3] = [Bound::Absolute, Bound::Relative, Bound::Sigmas];
    let bounds = keys.into_iter().zip(kinds).filter_map(|(key, kind)| table.values(key).map(kind)).collect::<Vec<_>>();
    (written.len() <= 1 && bounds.len() == written.len()).then(|| bounds.into_iter().next())
}

fn cut(table: &mut Section<'_, '_>) -> Option<Truncation> {
    let first = LOWER_KEYS.into_iter().chain(UPPER_KEYS).find(|key| table.has(key)).unwrap_or(LOWER_KEYS[0]);
    let one = is_one_of(table, &["sigmas", first], "3");
    let sigmas = optional(table, "sigmas");
    let (lower, upper) = (bound(table, LOWER_KEYS), bound(table, UPPER_KEYS));
    let (sigmas, (lower, upper)) = sigmas.zip(lower.zip(upper))?;
    match (one, sigmas) {
        (false, _) => None,
        (true, Some(sigmas)) => Some(Truncation::Sigmas(sigmas)),
        (true, None) => Some(Truncation::Bounds { lower, upper }),
    }
}

/// `min` and `max`, both of them.
fn ends(table: &mut Section<'_, '_>) -> Option<(Values, Values)> {
    let min = required(table, "min", "0.0");
    let max = required(table, "max", "1.0");
    min.zip(max)
}

fn range(table: &mut Section<'_, '_>) -> Option<Range> {
    let first = if table.has("max") && !table.has("min") { "max" } else { "min" };
    let one = is_one_of(table, &["half_width", "relative_half_width", first], "0.1");
    let (half, relative) = (table.values("half_width"), table.values("relative_half_width"));
    if one && table.has(first) {
        table.require("min", "given together with max", "0.0");
        table.require("max", "given together with min", "1.0");
    }
    let ends = table.values("min").zip(table.values("max"));
    if !one {
        return None;
    }
    match (half, relative, ends) {
        (Some(half), ..) => Some(Range::Around(half)),
        (_, Some(relative), _) => Some(Range::AroundRelative(relative)),
        (.., Some((min, max))) => Some(Range::Between { min, max }),
        _ => None,
    }
}

fn log_range(table: &mut Section<'_, '_>) -> Option<LogRange> {
    let first = if table.has("max") && !table.has("min") { "max" } else { "min" };
    let one = is_one_of(table, &["factor", first], "2.0");
    let factor = table.values("factor");
    if one && table.has(first) {
        table.require("min", "given together with max", "0.1");
        table.require("max", "given together with min", "10.0");
    }
    let ends = table.values("min").zip(table.values("max"));
    match (one, factor, ends) {
        (true, Some(factor), _) => Some(LogRange::Around(factor)),
        (true, None, Some((min, max))) => Some(LogRange::Between { min, max }),
        _ => None,
    }
}

fn empirical(table: &mut Section<'_, '_>) -> Option<Law> {
    table.require("column", "the name of a column of the file", "\"mass_kg\"");
    let column = table.text("column").map(str::to_owned);
    let names = Interpolation::ALL.map(Interpolation::name);
    let has_interpolation = table.has("interpolation");
    let interpolation =
        table.name("interpolation", &names, |name| Interpolation::ALL.into_iter().find(|known| known.name() == name));
    let (file, data) = file(table)?;
    let column = column?;
    let Some(values) = data.column(&column) else {
        let (allowed, remedy) = absent_column(&column, &data);
        table.refuse("column", allowed, remedy);
        return None;
    };
    let values = match values {
        Ok(values) => values.into(),
        Err((value, allowed, remedy)) => {
            table.refuse_value("column", value, allowed, remedy);
            return None;
        }
    };
    let data = DataColumn { file, sha256: data.sha256, column, values };
    let interpolation = if has_interpolation { interpolation? } else { Interpolation::None };
    Some(Law::Empirical(data, interpolation))
}

/// What is said of a column that a file does not have.
pub(super) fn absent_column(column: &str, data: &DataFile) -> (String, String) {
    let shown: Vec<&str> = data.names.iter().map(String::as_str).take(12).collect();
    let remedy = match nearest(column, data.names.iter().map(String::as_str)) {
        Some(meant) => format!("did you mean {meant:?}?"),
        None => "name one of these, or add the column to the file".to_owned(),
    };
    (format!("a column of the file ({})", shown.join(", ")), remedy)
}

/// The file that `file` names, with what is in it; if `sha256` is written, it must be the file's.
pub(super) fn file(table: &mut Section<'_, '_>) -> Option<(String, DataFile)> {
    table.require("file", "the path of a .csv or .parquet file, from this file's folder", "\"data.csv\"");
    let name = table.text("file").map(str::to_owned);
    let sha256 = table.text("sha256").map(str::to_owned);
    let name = name?;
    let data = match DataFile::read(&table.document.folder().join(&name)) {
        Ok(data) => data,
        Err((value, allowed, remedy)) => {
            table.refuse_value("file", value, allowed, remedy);
            return None;
        }
    };
    if sha256.is_some_and(|sha256| sha256 != data.sha256) {
        let allowed = format!("the SHA-256 of the file, {}", data.sha256);
        table.refuse("sha256", allowed, "bring back the file that was meant, or delete this line");
        return None;
    }
    Some((name, data))
}
