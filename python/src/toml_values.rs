//! [`value`]: a value of Python as TOML.

use pyo3::prelude::*;
use pyo3::types::{PyBool, PyDict, PyFloat, PyInt, PyList, PyString, PyTuple};
use toml::{Table, Value};

use crate::SpindriftError;

/// `object` as TOML: numbers, texts, truth values, lists and dicts of them, and what NumPy makes of these. `key` names it in messages.
///
/// # Errors
/// Where it is something else.
pub fn value(key: &str, object: &Bound<'_, PyAny>) -> PyResult<Value> {
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
        return table(key, found).map(Value::Table);
    }
    if object.is_instance_of::<PyList>() || object.is_instance_of::<PyTuple>() {
        let items = object.try_iter()?.enumerate();
        let items = items.map(|(index, item)| value(&format!("{key}[{index}]"), &item?));
        return items.collect::<PyResult<Vec<Value>>>().map(Value::Array);
    }
    match object.getattr("tolist") {
        Ok(list) => value(key, &list.call0()?),
        Err(_) => Err(refused(key, object, "a number, a text, True, False, or a list or dict of them")),
    }
}

/// The dict `object` as a table.
///
/// # Errors
/// Where a key is no text, or a value is none of TOML.
pub fn table(key: &str, object: &Bound<'_, PyDict>) -> PyResult<Table> {
    let entry = |(name, item): (Bound<'_, PyAny>, Bound<'_, PyAny>)| {
        let Ok(name) = name.extract::<String>() else { return Err(refused(key, &name, "texts as keys")) };
        let path = if key.is_empty() { name.clone() } else { format!("{key}.{name}") };
        Ok((name, value(&path, &item)?))
    };
    object.iter().map(entry).collect()
}

fn refused(key: &str, object: &Bound<'_, PyAny>, allowed: &str) -> PyErr {
    let shown = object.repr().map_or_else(|_| "?".to_owned(), |text| text.to_string());
    let of = if key.is_empty() { "the dict" } else { key };
    SpindriftError::new_err(format!("{of} = {shown}: must be {allowed}"))
}
