//! The extension of the Python package `spindrift`, on which its modules in `spindrift/` stand. Arguments arrive
//! checked and typed: those modules decide on messages to a user.

mod campaign_source;
mod job;
mod law;
mod plan;
mod results;
mod stores;
mod table;
mod toml_values;

use std::ffi::OsString;
use std::num::NonZeroUsize;
use std::sync::{Mutex, MutexGuard, PoisonError};

use pyo3::create_exception;
use pyo3::exceptions::PyException;
use pyo3::prelude::*;
use spindrift::cli::program;
use spindrift::workflow::WorkflowError;
use spindrift::workflow::columns::{of_all_campaigns, table_of};
use spindrift::workflow::threads::usable;

use crate::table::ArrowTable;

create_exception!(
    spindrift,
    SpindriftError,
    PyException,
    "What is wrong with a campaign file, a result, or what was asked for: all of it, as the command line prints it."
);

/// Locks `mutex`, also after a panic, which leaves none of these values half changed.
fn locked<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

/// An error of the library as Python's.
fn raised(error: impl Into<WorkflowError>) -> PyErr {
    SpindriftError::new_err(error.into().to_string())
}

/// A number of threads that this machine can use; 0: one per core.
fn threads(number: usize) -> PyResult<Option<NonZeroUsize>> {
    let asked = (number > 0).then(|| usable(number)).transpose();
    asked.map_err(|allowed| SpindriftError::new_err(format!("threads={number}: {allowed}")))
}

/// The command line: does what the words say, the name of the program first; the exit code.
#[pyfunction]
fn main(py: Python<'_>, words: Vec<OsString>) -> u8 {
    py.detach(|| program::run(words.into_iter()))
}

/// Every column that a row can have.
#[pyfunction]
fn columns() -> PyResult<ArrowTable> {
    ArrowTable::of(table_of(&of_all_campaigns())).map_err(raised)
}

#[pymodule]
fn _native(module: &Bound<'_, PyModule>) -> PyResult<()> {
    spindrift::workflow::session::connect_by(stores::connect);
    spindrift_figures::register();
    module.add("SpindriftError", module.py().get_type::<SpindriftError>())?;
    module.add("__version__", env!("CARGO_PKG_VERSION"))?;
    module.add_class::<plan::Plan>()?;
    module.add_class::<job::Job>()?;
    module.add_class::<results::Results>()?;
    module.add_class::<ArrowTable>()?;
    module.add_function(wrap_pyfunction!(main, module)?)?;
    module.add_function(wrap_pyfunction!(columns, module)?)?;
    module.add_function(wrap_pyfunction!(results::compare, module)?)
}
