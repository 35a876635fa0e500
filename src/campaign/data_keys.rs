//! The keys that name a file of numbers: `file`, `sha256`, `column`, `parameters`.

use super::data::{COPIES, DataFile, copy_name};
use super::parameter::{named, unknown_parameter};
use super::problem::nearest;
use super::section::Section;
use crate::sampling::DataColumn;
use std::path::{Path, PathBuf};

/// The column `column` of the file `file`.
pub(super) fn column(table: &mut Section<'_, '_>) -> Option<DataColumn> {
    table.require("column", "the name of a column of the file", "\"mass_kg\"");
    let column = table.text("column").map(str::to_owned);
    let (file, data) = file(table)?;
    let column = column?;
    let values = match data.column(&column) {
        Some(Ok(values)) => values.into(),
        Some(Err((value, allowed, remedy))) => {
            table.refuse_value("column", value, allowed, remedy);
            return None;
        }
        None => {
            let (allowed, remedy) = absent_column(&column, &data);
            table.refuse("column", allowed, remedy);
            return None;
        }
    };
    Some(DataColumn { file, sha256: data.sha256, column, values })
}

/// The message about a column that a file does not have.
fn absent_column(column: &str, data: &DataFile) -> (String, String) {
    let shown: Vec<&str> = data.names.iter().map(String::as_str).take(12).collect();
    let remedy = match nearest(column, data.names.iter().map(String::as_str)) {
        Some(meant) => format!("did you mean {meant:?}?"),
        None => "name one of these, or add the column to the file".to_owned(),
    };
    (format!("a column of the file ({})", shown.join(", ")), remedy)
}

/// The file that `file` names, with what is in it; if `sha256` is written, it must be the file's.
fn file(table: &mut Section<'_, '_>) -> Option<(String, DataFile)> {
    table.require("file", "the path of a .csv or .parquet file, from this file's folder", "\"data.csv\"");
    let name = table.text("file").map(str::to_owned);
    let sha256 = table.text("sha256").map(str::to_owned);
    let name = name?;
    let path = found(table.document.folder(), &name, sha256.as_deref());
    let data = match DataFile::read(&path) {
        Ok(data) => data,
        Err((value, allowed, remedy)) => {
            table.refuse_value("file", value, allowed, remedy);
            return None;
        }
    };
    table.document.files.push((path, data.sha256.clone()));
    if sha256.is_some_and(|sha256| sha256 != data.sha256) {
        let allowed = format!("the SHA-256 of the file, {}", data.sha256);
        table.refuse("sha256", allowed, "bring back the file that was meant, or delete this line");
        return None;
    }
    Some((name, data))
}

/// The file `name`, whose path counts from `folder`; where it is not there, the copy of the file of this checksum that a result has.
fn found(folder: &Path, name: &str, sha256: Option<&str>) -> PathBuf {
    let path = folder.join(name);
    let is_checksum = |sha256: &&str| sha256.len() == 64 && sha256.bytes().all(|byte| byte.is_ascii_hexdigit());
    let copy = sha256.filter(is_checksum).map(|sha256| folder.join(COPIES).join(copy_name(&path, sha256)));
    copy.filter(|copy| !path.exists() && copy.is_file()).unwrap_or(path)
}

/// The columns of a file that are parameters: those that are listed, else all but `sample_id`.
pub(super) fn columns(table: &mut Section<'_, '_>) -> Option<Vec<DataColumn>> {
    let listed = table.texts("parameters", "[\"wheels.w1.radius_m\"]");
    if table.has("parameters") && listed.as_ref().is_none_or(Vec::is_empty) {
        if listed.is_some() {
            table.refuse("parameters", "at least one name", "leave the key out for all columns of the file");
        }
        return None;
    }
    let (name, data) = file(table)?;
    let names = listed.unwrap_or_else(|| data.names.iter().filter(|name| *name != "sample_id").cloned().collect());
    if names.is_empty() {
        table.refuse(
            "file",
            "a file with columns that are named like parameters",
            "name its columns wheels.w1.radius_m, ...",
        );
        return None;
    }
    let mut columns = Vec::with_capacity(names.len());
    for parameter in names {
        columns.push(parameter_column(table, &name, &data, &parameter)?);
    }
    Some(columns)
}

/// The column of a parameter: by its dotted name, or by the name of its column in rows.
fn parameter_column(table: &mut Section<'_, '_>, file: &str, data: &DataFile, parameter: &str) -> Option<DataColumn> {
    let key = if table.has("parameters") { "parameters" } else { "file" };
    let Some(component) = named(&table.document.scene, parameter) else {
        let (allowed, remedy) = unknown_parameter(&table.document.scene, parameter);
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
