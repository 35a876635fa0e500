//! The keys of the `[design]` table.

use super::data::DataFile;
use super::disperse::{absent_column, file};
use super::section::Section;
use super::spec::MOST_SAMPLES;
use crate::sampling::{DESIGNS, DataColumn, Design, Levels};
use crate::scene::Parameter;

/// The design of a campaign; `None` where something is wrong, which is then noted. Without the table, the random one.
pub fn read(table: &mut Section<'_, '_>) -> Option<Design> {
    if !table.is_present() {
        table.finish();
        return Some(Design::Random);
    }
    table.require("kind", &format!("one of {}", DESIGNS.join(", ")), "\"sobol\"");
    let kind = table.name("kind", &DESIGNS, |name| DESIGNS.into_iter().find(|known| *known == name))?;
    let design = match kind {
        "latin_hypercube" => Some(Design::LatinHypercube),
        "sobol" => Some(Design::Sobol),
        "halton" => Some(Design::Halton),
        "grid" => levels(table).map(Design::Grid),
        "one_at_a_time" => levels(table).map(Design::OneAtATime),
        "saltelli" => Some(Design::Saltelli),
        "table" => rows(table).map(Design::Table),
        _ => Some(Design::Random),
    };
    table.finish();
    design
}

/// `levels` or `quantiles`.
fn levels(table: &mut Section<'_, '_>) -> Option<Levels> {
    let (has_levels, has_quantiles) = (table.has("levels"), table.has("quantiles"));
    if has_levels && has_quantiles {
        table.refuse("quantiles", "the only one of levels, quantiles", "delete one of them");
    }
    if !has_levels && !has_quantiles {
        table.require("levels", "given (levels or quantiles)", "5");
    }
    let levels = table.counts("levels", 1..=MOST_SAMPLES);
    let quantiles = table.numbers("quantiles");
    if let Some(list) = &quantiles
        && (list.is_empty() || list.iter().any(|u| *u <= 0.0 || *u >= 1.0))
    {
        table.refuse("quantiles", "numbers between 0 and 1, neither included", "write them like [0.05, 0.5, 0.95]");
        return None;
    }
    match (has_levels, has_quantiles) {
        (true, false) => levels,
        (false, true) => quantiles.map(Levels::Quantiles),
        _ => None,
    }
}

/// The columns of a file that are parameters: those that are listed, else all but `sample_id`.
fn rows(table: &mut Section<'_, '_>) -> Option<Vec<DataColumn>> {
    let listed = table.texts("parameters", "[\"wheel1.radius_m\"]");
    if table.has("parameters") && listed.as_ref().is_none_or(Vec::is_empty) {
        if listed.is_some() {
            table.refuse("parameters", "at least one name", "leave the key out for all columns of the file");
        }
        return None;
    }
    let (name, data) = file(table)?;
    let wanted = listed.unwrap_or_else(|| data.names.iter().filter(|name| *name != "sample_id").cloned().collect());
    if wanted.is_empty() {
        table.refuse(
            "file",
            "a file with columns that are named like parameters",
            "name its columns wheel1.radius_m, ...",
        );
        return None;
    }
    let mut columns = Vec::with_capacity(wanted.len());
    for parameter in wanted {
        columns.push(column(table, &name, &data, &parameter)?);
    }
    Some(columns)
}

/// The column of a parameter: by its dotted name, or by the name of its column in rows.
fn column(table: &mut Section<'_, '_>, file: &str, data: &DataFile, parameter: &str) -> Option<DataColumn> {
    let key = if table.has("parameters") { "parameters" } else { "file" };
    let Some(component) = named(parameter) else {
        let (allowed, remedy) = super::disperse::unknown_parameter(parameter);
        table.refuse_value(key, format!("{parameter:?}"), format!("made of names, each {allowed}"), remedy);
        return None;
    };
    let (dotted, flat) = (component.0.component_name(component.1), component.0.column_name(component.1));
    let found = [parameter, &dotted, &flat].into_iter().find_map(|name| data.column(name));
    let values = match found {
        Some(Ok(values)) => values,
        Some(Err((value, allowed, remedy))) => {
            table.refuse_value("file", value, allowed, remedy);
            return None;
        }
        None => {
            let (allowed, remedy) = absent_column(parameter, data);
            table.refuse_value(key, format!("{parameter:?}"), allowed, remedy);
            return None;
        }
    };
    Some(DataColumn { file: file.to_owned(), sha256: data.sha256.clone(), column: dotted, values: values.into() })
}

/// The component that a name means: dotted, or as a column of rows.
fn named(name: &str) -> Option<(Parameter, usize)> {
    let flat = || {
        Parameter::all().find_map(|parameter| {
            (0..parameter.width()).map(|k| (parameter, k)).find(|(parameter, k)| parameter.column_name(*k) == name)
        })
    };
    match Parameter::find(name) {
        Some((parameter, Some(component))) => Some((parameter, component)),
        Some((parameter, None)) if parameter.width() == 1 => Some((parameter, 0)),
        _ => flat(),
    }
}
