//! [`Results`]: a finished result in a folder. Every look at it compares its checksums, and that it is still the same;
//! none of them keeps it locked.

use std::path::PathBuf;

use pyo3::prelude::*;
use spindrift::analysis::comparison_table;
use spindrift::cli::screen::width;
use spindrift::findings::comparison::findings;
use spindrift::report::screen;
use spindrift::report::summary;
use spindrift::storage::names::{BANDS, REPORT, SENSITIVITY, STATISTICS, SUMMARY};
use spindrift::storage::rows_reader::PartReader;
use spindrift::workflow::compared::compared;
use spindrift::workflow::outcome::place;
use spindrift::workflow::page::remade;
use spindrift::workflow::simulated::simulated;
use spindrift::workflow::{self, WorkflowError};

use crate::law::Law;
use crate::table::ArrowTable;

#[pyclass(module = "spindrift._native", frozen)]
pub struct Results {
    root: PathBuf,
    /// `summary.json` when it was opened.
    summary: String,
}

/// The text of the file `name` of a result; `None` where there is none.
fn text(results: &workflow::Results<'_>, name: &str) -> Result<Option<String>, WorkflowError> {
    Ok(results.file(name)?.map(|bytes| String::from_utf8_lossy(&bytes).into_owned()))
}

impl Results {
    /// Applies `work` to the result without holding Python's lock.
    fn with<T: Send>(
        &self,
        py: Python<'_>,
        control: Option<&Bound<'_, PyAny>>,
        work: impl FnOnce(&workflow::Results<'_>) -> Result<T, WorkflowError> + Send,
    ) -> PyResult<T> {
        Law::flown(py, control, |session| {
            let results = workflow::Results::open(&self.root, session)?;
            if text(&results, SUMMARY)?.as_ref() != Some(&self.summary) {
                return Err(WorkflowError::Files(format!(
                    "{}: another campaign has taken the place of this result, or made it larger; open it again",
                    self.root.display()
                )));
            }
            work(&results)
        })
    }
}

#[pymethods]
impl Results {
    #[staticmethod]
    fn open(py: Python<'_>, root: PathBuf) -> PyResult<Self> {
        Law::flown(py, None, |session| {
            let results = workflow::Results::open(&root, session)?;
            text(&results, SUMMARY).map(|summary| Results { summary: summary.unwrap_or_default(), root })
        })
    }

    fn root(&self) -> PathBuf {
        self.root.clone()
    }

    fn summary(&self) -> String {
        self.summary.clone()
    }

    fn verdicts(&self) -> String {
        let end = summary::read(self.summary.as_bytes());
        end.map_or_else(String::new, |end| screen::end(&end, &place(&self.root), width()))
    }

    fn plan(&self, py: Python<'_>) -> PyResult<String> {
        self.with(py, None, |results| Ok(results.plan().text()))
    }

    fn rows(&self, py: Python<'_>) -> PyResult<ArrowTable> {
        self.with(py, None, ArrowTable::of_rows)
    }

    fn statistics(&self, py: Python<'_>) -> PyResult<ArrowTable> {
        self.with(py, None, |results| derived(results, STATISTICS))
    }

    fn sensitivity(&self, py: Python<'_>) -> PyResult<ArrowTable> {
        self.with(py, None, |results| derived(results, SENSITIVITY))
    }

    fn bands(&self, py: Python<'_>) -> PyResult<Option<ArrowTable>> {
        self.with(py, None, |results| results.file(BANDS)?.map(|_| derived(results, BANDS)).transpose())
    }

    fn series(&self, py: Python<'_>, sample: u64, control: Option<&Bound<'_, PyAny>>) -> PyResult<ArrowTable> {
        self.with(py, control, |results| {
            let found = simulated(results.plan(), sample, None, workflow::isa()?)?;
            ArrowTable::of(found.series)
        })
    }

    fn page(&self, py: Python<'_>, control: Option<&Bound<'_, PyAny>>) -> PyResult<String> {
        if let Some(page) = self.with(py, None, |results| text(results, REPORT))? {
            return Ok(page);
        }
        Law::flown(py, control, |session| remade(&session, &self.root, None, None))?;
        self.with(py, None, |results| text(results, REPORT).map(Option::unwrap_or_default))
    }
}

/// The file `name` of a result as a table.
fn derived(results: &workflow::Results<'_>, name: &str) -> Result<ArrowTable, WorkflowError> {
    let part = PartReader::open(results.rows().store(), name)?;
    ArrowTable::of_part(&part)
}

/// Compares two results: what the command line says, and the shift of every statistic.
#[pyfunction]
pub fn compare(py: Python<'_>, first: PathBuf, second: PathBuf) -> PyResult<(String, ArrowTable)> {
    Law::flown(py, None, |session| {
        let names = [&first, &second].map(|root| root.display().to_string());
        let (first, second) = (workflow::Results::open(&first, session)?, workflow::Results::open(&second, session)?);
        let found = compared([&first, &second], names)?;
        let text = screen::list(&findings(&found), false, [screen::LINES, width()]);
        Ok((text, ArrowTable::of(comparison_table::table(&found.comparison))?))
    })
}
