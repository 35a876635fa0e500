//! The keys of data files: `file`, `sha256`, `column`, `parameters`, `columns`.

use super::data::{COPIES, DataFile, MOST_FILES, MOST_NUMBERS, Unused, copy_name};
use super::meaning::meant;
use super::parameter::{named, refuse_unknown, without_effect};
use super::section::Section;
use crate::sampling::keys::{ANY_TEXT, Kind, Row};
use crate::sampling::{Component, DataColumn};
use crate::scene::{Parameter, SceneInput};
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

const SHA256: Row = Row::new("sha256", Kind::Text(ANY_TEXT), "SHA-256 of the file");

/// The keys of a file with one column, besides its path.
pub const COLUMN: [Row; 2] = [
    SHA256,
    Row::new("column", Kind::Text(ANY_TEXT), "The column of the file")
        .required_as("the name of a column of the file", "\"mass_kg\""),
];

/// The keys of a file with columns for parameters, besides its path.
pub const COLUMNS: [Row; 3] = [
    SHA256,
    Row::new("parameters", Kind::Names, "The parameters that are read; default: all columns of the file"),
    Row::new("columns", Kind::Names, "Their columns; default: the names of the parameters"),
];

pub(super) fn column(table: &mut Section<'_, '_>) -> Option<DataColumn> {
    let column = table.right_rows(&COLUMN[1..]).text("column").map(str::to_owned);
    let wanted = column.clone();
    let (file, data) = file(table, &|name| wanted.as_deref() == Some(name))?;
    let column = column?;
    let values = match data.column(&column) {
        Some(Ok(values)) => values.into(),
        Some(Err((value, allowed, remedy))) => {
            table.refuse_value("column", value, allowed, remedy);
            return None;
        }
        None => {
            let (allowed, remedy) = absent_column(&column, &data);
            return table.refused("column", allowed, remedy);
        }
    };
    Some(DataColumn { file, sha256: data.sha256, column, target: None, values })
}

const LONGEST_SHOWN: usize = 60;

fn absent_column(column: &str, data: &DataFile) -> (String, String) {
    let short = |name: &String| name.chars().take(LONGEST_SHOWN).collect::<String>();
    let shown: Vec<String> = data.names.iter().map(short).take(12).collect();
    let remedy = match meant(column, data.names.iter().map(String::as_str)) {
        Some(meant) => meant.remedy(),
        None => "name one of these, or add the column to the file".to_owned(),
    };
    (format!("a column of the file ({})", shown.join(", ")), remedy)
}

/// The file at `file` with its `used` columns; `sha256`, if written, must match.
fn file(table: &mut Section<'_, '_>, used: &dyn Fn(&str) -> bool) -> Option<(String, DataFile)> {
    table.require("file", "the path of a .csv or .parquet file, from this file's folder", "\"data.csv\"");
    let name = table.text("file").map(str::to_owned);
    let sha256 = table.text("sha256").map(str::to_owned);
    let name = name?;
    let (tables, numbers) = table.document.data;
    table.document.data.0 += 1;
    if tables >= MOST_FILES {
        let allowed = format!("in at most {MOST_FILES} tables of a campaign file");
        return table.refused(
            "file",
            allowed,
            "draw several parameters from the rows of one file (parameters = [...])",
        );
    }
    let written_at = table.value("file").map_or(0, |value| value.span().start);
    let path = found(table.document.folder_of(written_at), &name, sha256.as_deref());
    let data = match DataFile::read(&path, MOST_NUMBERS - numbers, used) {
        Ok(data) => data,
        Err(Unused { refusal: (value, allowed, remedy), is_unreadable }) => {
            table.document.unreadable += usize::from(is_unreadable);
            table.refuse_value("file", value, allowed, remedy);
            return None;
        }
    };
    table.document.data.1 += data.numbers();
    table.document.files.push((path, data.sha256.clone()));
    if sha256.is_some_and(|sha256| sha256 != data.sha256) {
        let allowed = format!("the SHA-256 of the file, {}", data.sha256);
        return table.refused("sha256", allowed, "bring back the file that was meant, or delete this line");
    }
    Some((name, data))
}

/// The file `name` in `folder`; if missing, the copy with this checksum in a result.
pub fn found(folder: &Path, name: &str, sha256: Option<&str>) -> PathBuf {
    let path = folder.join(name);
    let is_checksum = |sha256: &&str| sha256.len() == 64 && sha256.bytes().all(|byte| byte.is_ascii_hexdigit());
    let copy = sha256.filter(is_checksum).map(|sha256| folder.join(COPIES).join(copy_name(&path, sha256)));
    copy.filter(|copy| !path.exists() && copy.is_file()).unwrap_or(path)
}

/// The columns of a file for parameters: the listed ones, else all but `sample_id`; `columns` gives their names in the
/// file.
pub(super) fn columns(table: &mut Section<'_, '_>) -> Option<Vec<DataColumn>> {
    let listed = table.texts("parameters", "[\"wheels.w1.radius_m\"]");
    let own = table.texts("columns", "[\"radius\"]");
    let scene = table.document.scene.clone();
    let used: BTreeSet<String> = match (&own, &listed) {
        (Some(own), _) => own.iter().cloned().collect(),
        (None, Some(listed)) => listed.iter().flat_map(|name| names_of(&scene, name)).collect(),
        (None, None) => Parameter::all(&scene).flat_map(|parameter| names_of(&scene, &parameter.name())).collect(),
    };
    // a component may also be written as [0]
    let is_component =
        |name: &str| listed.is_none() && name.split_once('[').is_some_and(|(whole, _)| used.contains(whole));
    let read = file(table, &|name| used.contains(name) || is_component(name));
    if table.has("parameters") && listed.as_ref().is_none_or(Vec::is_empty) {
        if listed.is_some() {
            table.refuse("parameters", "at least one name", "leave the key out for all columns of the file");
        }
        return None;
    }
    if table.has("columns") {
        table.require("parameters", "given together with columns", "[\"wheels.w1.radius_m\"]");
        own.as_ref().zip(listed.as_ref())?;
    }
    let (name, data) = read?;
    let names = listed.unwrap_or_else(|| data.names.iter().filter(|name| *name != "sample_id").cloned().collect());
    if names.is_empty() {
        return table.refused(
            "file",
            "a file with columns that are named like parameters",
            "name its columns wheels.w1.radius_m, ...",
        );
    }
    let mut targets = Vec::with_capacity(names.len());
    for parameter in names {
        targets.extend(components(table, &parameter)?);
    }
    if let Some(own) = own.as_ref().filter(|own| own.len() != targets.len()) {
        let (value, count) = (format!("{} names", own.len()), targets.len());
        let remedy = "write one for each number, in the order of parameters; a vector or an attitude has several";
        table.refuse_value("columns", value, format!("{count}, as there are numbers in parameters"), remedy);
        return None;
    }
    let mut columns = Vec::with_capacity(targets.len());
    for (place, (written, target)) in targets.into_iter().enumerate() {
        let (dotted, flat) = (target.0.component_name(target.1), target.0.column_name(target.1));
        let (key, known, column) = match own.as_ref().map(|own| own[place].clone()) {
            Some(own) => ("columns", vec![own.clone()], own),
            None if table.has("parameters") => ("parameters", vec![written, dotted.clone(), flat], dotted),
            None => ("file", vec![written, dotted.clone(), flat], dotted),
        };
        let values = finite_column(table, &data, key, &known)?.into();
        columns.push(DataColumn {
            file: name.clone(),
            sha256: data.sha256.clone(),
            column,
            target: Some(target),
            values,
        });
    }
    Some(columns)
}

/// The components that a name addresses, each with its name as written.
fn components(table: &mut Section<'_, '_>, name: &str) -> Option<Vec<(String, Component)>> {
    if let Some((parameter, None)) = Parameter::find(&table.document.scene, name) {
        refuse_without_effect(table, name, parameter);
        return Some((0..parameter.width()).map(|k| (parameter.component_name(k), (parameter, k))).collect());
    }
    let Some(component) = named(&table.document.scene, name) else {
        let key = if table.has("parameters") { "parameters" } else { "file" };
        refuse_unknown(table, key, name);
        return None;
    };
    refuse_without_effect(table, name, component.0);
    Some(vec![(name.to_owned(), component)])
}

/// Notes that a draw of `parameter` changes no run.
fn refuse_without_effect(table: &mut Section<'_, '_>, name: &str, parameter: Parameter) {
    if let Some((allowed, remedy)) = without_effect(table, parameter) {
        let key = if table.has("parameters") { "parameters" } else { "file" };
        table.refuse_value(key, format!("{name:?}"), format!("made of names, each {allowed}"), remedy);
    }
}

fn names_of(scene: &SceneInput, name: &str) -> Vec<String> {
    let (parameter, components) = match (Parameter::find(scene, name), named(scene, name)) {
        (Some((parameter, None)), _) => (parameter, 0..parameter.width()),
        (_, Some((parameter, component))) => (parameter, component..component + 1),
        _ => return Vec::new(),
    };
    let names = components.flat_map(|k| [parameter.component_name(k), parameter.column_name(k)]);
    names.chain([name.to_owned()]).collect()
}

/// The numbers of the first column with one of the names `known`.
fn finite_column(table: &mut Section<'_, '_>, data: &DataFile, key: &str, known: &[String]) -> Option<Vec<f64>> {
    match known.iter().find_map(|name| data.column(name)) {
        Some(Ok(values)) => Some(values),
        Some(Err((value, allowed, remedy))) => {
            table.refuse_value("file", value, allowed, remedy);
            None
        }
        None => {
            let (allowed, remedy) = absent_column(&known[0], data);
            table.refuse_value(key, format!("{:?}", known[0]), allowed, remedy);
            None
        }
    }
}
