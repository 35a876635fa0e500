//! [`value`]: a value of Python as TOML.

use pyo3::prelude::*;
use pyo3::types::{PyBool, PyDict, PyFloat, PyInt, PyList, PyString, PyTuple};
use toml::{Table, Value};

use crate::SpindriftError;

/// Most lists and dicts within each other: a campaign file has six, and the parser of TOML takes 80.
const MOST_NESTED: usize = 64;

/// `object` as TOML: numbers, texts, truth values, lists and dicts of them, and what NumPy makes of these. `key` names
/// it in messages.
///
/// # Errors
/// An object of another type.
pub fn value(key: &str, object: &Bound<'_, PyAny>) -> PyResult<Value> {
    nested(key, object, 0)
}

/// [`value`] within `depth` lists and dicts.
fn nested(key: &str, object: &Bound<'_, PyAny>, depth: usize) -> PyResult<Value> {
    if depth > MOST_NESTED {
        let top = key.split(['.', '[']).next().unwrap_or_default();
        return Err(SpindriftError::new_err(format!(
            "{top}: must be at most {MOST_NESTED} lists and dicts within each other; this one is deeper, or \
                     contains itself"
        )));
    }
    // a truth value is an int of Python too
    if let Ok(found) = object.cast::<PyBool>() {
        return Ok(Value::Boolean(found.is_true()));
    }
    if object.is_instance_of::<PyInt>() {
        let number = object.extract::<i64>();
        return number.map(Value::Integer).map_err(|_| refused(key, object, "a whole number of 64 bits"));
    }
    if object.is_instance_of::<PyFloat>() {
        return Ok(Value::Float(object.extract()?));
    }
    if object.is_instance_of::<PyString>() {
        return Ok(Value::String(object.extract()?));
    }
    if let Ok(found) = object.cast::<PyDict>() {
        return entries(key, found, depth).map(Value::Table);
    }
    if object.is_instance_of::<PyList>() || object.is_instance_of::<PyTuple>() {
        let items = object.try_iter()?.enumerate();
        let items = items.map(|(index, item)| nested(&format!("{key}[{index}]"), &item?, depth + 1));
        return items.collect::<PyResult<Vec<Value>>>().map(Value::Array);
    }
    let refused = || refused(key, object, "a number, a text, True, False, or a list or dict of them");
    let list = object.getattr("tolist").map_err(|_| refused())?.call0()?;
    if !list.get_type().is(object.get_type()) {
        return nested(key, &list, depth + 1);
    }
    // what NumPy has no number of Python for, as a long double, is its own list
    let kind = object.getattr("dtype").and_then(|dtype| dtype.getattr("kind")?.extract::<String>());
    if kind.is_ok_and(|kind| kind == "f") {
        Ok(Value::Float(object.call_method0("__float__")?.extract()?))
    } else {
        Err(refused())
    }
}

/// The dict `object` as a table.
///
/// # Errors
/// A key that is not text, or a value that TOML does not have.
pub fn table(key: &str, object: &Bound<'_, PyDict>) -> PyResult<Table> {
    entries(key, object, 0)
}

fn entries(key: &str, object: &Bound<'_, PyDict>, depth: usize) -> PyResult<Table> {
    let entry = |(name, item): (Bound<'_, PyAny>, Bound<'_, PyAny>)| {
        let Ok(name) = name.extract::<String>() else { return Err(refused(key, &name, "texts as keys")) };
        let path = if key.is_empty() { name.clone() } else { format!("{key}.{name}") };
        Ok((name, nested(&path, &item, depth + 1)?))
    };
    object.iter().map(entry).collect()
}

fn refused(key: &str, object: &Bound<'_, PyAny>, allowed: &str) -> PyErr {
    let shown = object.repr().map_or_else(|_| "?".to_owned(), |text| text.to_string());
    let of = if key.is_empty() { "the dict" } else { key };
    SpindriftError::new_err(format!("{of} = {shown}: must be {allowed}"))
}
