//! [`Plan`]: a campaign file and what is changed of it. It is read whenever it is used, as the command line reads it.

use std::path::{Path, PathBuf};

use pyo3::prelude::*;
use pyo3::types::PyDict;
use spindrift::campaign;
use spindrift::cli::screen;
use spindrift::ensemble::Ensemble;
use spindrift::findings::checked::findings;
use spindrift::math::Isa;
use spindrift::report::screen::{question, sections};
use spindrift::run::Status;
use spindrift::workflow::WorkflowError;
use spindrift::workflow::check::probed;
use spindrift::workflow::simulated::simulated;
use spindrift::workflow::workload::Workload;

use crate::campaign_source::{CampaignSource, prepared};
use crate::job::{Job, Run};
use crate::law::Law;
use crate::table::ArrowTable;
use crate::toml_values::{table, value};

#[pyclass(module = "spindrift._native", frozen)]
#[derive(Clone)]
pub struct Plan(CampaignSource);

impl Plan {
    /// Applies `work` to the plan without holding Python's lock.
    fn with<T: Send>(
        &self,
        py: Python<'_>,
        samples: Option<u64>,
        control: Option<&Bound<'_, PyAny>>,
        work: impl FnOnce(&campaign::Plan, Isa) -> Result<T, WorkflowError> + Send,
    ) -> PyResult<T> {
        Law::flown(py, control, |session| work(prepared(self.0.campaign(session, samples))?.plan(), session.isa))
    }

    /// This plan, if it is valid.
    fn checked(self, py: Python<'_>) -> PyResult<Self> {
        self.with(py, None, None, |_, _| Ok(()))?;
        Ok(self)
    }
}

#[pymethods]
impl Plan {
    #[staticmethod]
    fn from_file(py: Python<'_>, path: PathBuf) -> PyResult<Self> {
        Plan(CampaignSource::of_file(path)).checked(py)
    }

    #[staticmethod]
    fn from_dict(py: Python<'_>, tables: &Bound<'_, PyDict>) -> PyResult<Self> {
        let text = table("", tables)?.to_string();
        Plan(CampaignSource::of_text(text)).checked(py)
    }

    fn set(&self, py: Python<'_>, values: &Bound<'_, PyDict>) -> PyResult<Self> {
        let mut plan = self.clone();
        for (key, item) in values.iter() {
            let key: String = key.extract()?;
            let text = value(&key, &item)?.to_string();
            plan.0.settings.push((key, text));
        }
        plan.checked(py)
    }

    /// The name of the campaign, its number of samples, and the end of its runs, s.
    fn facts(&self, py: Python<'_>) -> PyResult<(String, u64, f64)> {
        self.with(py, None, None, |plan, _| Ok((plan.name.clone(), plan.samples, plan.grid.duration())))
    }

    fn text(&self, py: Python<'_>) -> PyResult<String> {
        self.with(py, None, None, |plan, _| Ok(plan.text()))
    }

    fn check(&self, py: Python<'_>, samples: Option<u64>, control: Option<&Bound<'_, PyAny>>) -> PyResult<String> {
        self.with(py, samples, control, |plan, isa| {
            let ensemble = Ensemble::new(plan, isa);
            let said = sections(&findings(&probed(&ensemble)?, false), screen::width());
            Ok(question(plan.description.as_deref(), screen::width()) + &said)
        })
    }

    fn sample(&self, py: Python<'_>, samples: Option<u64>) -> PyResult<ArrowTable> {
        let mut signal = None;
        let drawn = self.with(py, samples, None, |plan, _| {
            // what takes long is stopped by Ctrl-C; what does not fit is refused
            Workload::of_drawn_table(plan).check(Path::new(""), true, false)?;
            ArrowTable::of_draws(plan, || {
                signal = Python::attach(|py| py.check_signals()).err();
                signal.is_none()
            })
        });
        signal.map_or(drawn, Err)
    }

    /// A sample over time, and what to know of it.
    fn simulate(
        &self,
        py: Python<'_>,
        sample: u64,
        times: Option<Vec<f64>>,
        control: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<(ArrowTable, Vec<String>)> {
        self.with(py, None, control, |plan, isa| {
            let found = simulated(plan, sample, times.as_deref(), isa)?;
            let status = found.run.outcome.status;
            let early = (status != Status::Done)
                .then(|| format!("sample {sample}: the run ended with {}: {}", status.name(), found.run.reason));
            Ok((ArrowTable::of(found.series)?, found.late.into_iter().chain(early).collect()))
        })
    }

    /// Starts to run what is not there yet; the result goes to the folder `out`. `control`: the function that is the
    /// law of attitude.
    #[pyo3(signature = (samples, out, threads, overwrite, page, yes, control=None))]
    #[expect(clippy::too_many_arguments, reason = "the keywords of Python's function")]
    fn run(
        &self,
        py: Python<'_>,
        samples: Option<u64>,
        out: PathBuf,
        threads: usize,
        overwrite: bool,
        page: bool,
        yes: bool,
        control: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Job> {
        let threads = crate::threads(threads)?;
        let law = control.map(|control| Law::new(py, control)).transpose()?;
        Job::start(Run { source: self.0.clone(), samples, out, threads, overwrite, page, yes, law })
    }
}
