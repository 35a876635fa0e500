//! [`Job`]: a campaign that runs on a thread of its own, so that the one that asked for it can listen to the user.

use std::num::NonZeroUsize;
use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Arc, Condvar, Mutex, PoisonError};
use std::thread::JoinHandle;
use std::time::Duration;

use pyo3::prelude::*;
use spindrift::workflow::{CampaignOutcome, Outputs, Session, Watch, WorkflowError};

use crate::campaign_source::{CampaignSource, prepared};
use crate::law::{Law, refuse_unnamed};
use crate::{SpindriftError, locked, raised};

/// A campaign to run, with its options.
pub struct Run {
    pub source: CampaignSource,
    pub samples: Option<u64>,
    pub out: PathBuf,
    pub threads: Option<NonZeroUsize>,
    pub overwrite: bool,
    pub page: bool,
    pub yes: bool,
    pub law: Option<Arc<Law>>,
}

/// State shared with the thread that runs the campaign.
#[derive(Default)]
struct Shared {
    stop: AtomicBool,
    abandon: AtomicBool,
    /// Number of started runs; `done`: of ended ones.
    samples: AtomicU64,
    done: AtomicU64,
    notes: Mutex<Vec<String>>,
    has_ended: Mutex<bool>,
    ended: Condvar,
}

impl Watch for Shared {
    fn note(&self, text: &str) {
        locked(&self.notes).push(text.to_owned());
    }

    fn begin(&self, samples: u64) {
        self.samples.fetch_add(samples, Ordering::Relaxed);
    }

    fn advance(&self, samples: u64) {
        self.done.fetch_add(samples, Ordering::Relaxed);
    }

    fn stop(&self) -> &AtomicBool {
        &self.stop
    }

    fn abandon(&self) -> &AtomicBool {
        &self.abandon
    }
}

/// Says at its end, whichever, that the thread has ended.
struct Ends(Arc<Shared>);

impl Drop for Ends {
    fn drop(&mut self) {
        *locked(&self.0.has_ended) = true;
        self.0.ended.notify_all();
    }
}

/// End of the campaign: `None` if it is complete, else its number of samples and the number of missing ones.
type Ended = Result<Option<(u64, u64)>, WorkflowError>;

#[pyclass(module = "spindrift._native", frozen)]
pub struct Job {
    shared: Arc<Shared>,
    law: Option<Arc<Law>>,
    thread: Mutex<Option<JoinHandle<Ended>>>,
}

impl Job {
    /// Starts the campaign.
    ///
    /// # Errors
    /// A thread that cannot be started.
    pub fn start(run: Run) -> PyResult<Self> {
        let shared = Arc::new(Shared::default());
        let (ends, law) = (Ends(shared.clone()), run.law.clone());
        let thread = std::thread::Builder::new().name("spindrift".to_owned()).spawn(move || ran(&run, &ends.0));
        let thread = thread.map_err(|error| SpindriftError::new_err(format!("cannot start a thread: {error}")))?;
        Ok(Job { shared, law, thread: Mutex::new(Some(thread)) })
    }
}

/// Runs what is not there yet.
fn ran(run: &Run, watch: &Shared) -> Ended {
    let own = run.law.as_ref().map(Law::own);
    let mut session = Session { law: own.as_ref(), ..Session::new(watch)?.on_threads(run.threads) };
    if let Some(law) = &run.law {
        session = Session { crew: &**law, ..session };
    }
    let outputs = Outputs { without_page: !run.page, ..Outputs::default() };
    let campaign = run.source.campaign(session, run.samples).store(&run.out).outputs(outputs);
    let campaign = prepared(if run.overwrite { campaign.overwrite() } else { campaign })?;
    if run.law.is_some() {
        refuse_unnamed(campaign.plan())?;
    }
    campaign.refuse_work(run.yes)?;
    Ok(match campaign.run()? {
        CampaignOutcome::Stopped { samples, left } => Some((samples, left)),
        _ => None,
    })
}

#[pymethods]
impl Job {
    /// Waits at most so many seconds for the end; whether it is there.
    fn wait(&self, py: Python<'_>, seconds: f64) -> bool {
        if self.law.as_ref().is_some_and(|law| law.has_raised()) {
            self.abandon();
        }
        py.detach(|| {
            let has_ended = locked(&self.shared.has_ended);
            let limit = Duration::from_secs_f64(seconds.clamp(0.0, 60.0));
            let waited = self.shared.ended.wait_timeout_while(has_ended, limit, |ended| !*ended);
            *waited.unwrap_or_else(PoisonError::into_inner).0
        })
    }

    /// Number of started runs, and of ended ones.
    fn progress(&self) -> (u64, u64) {
        (self.shared.samples.load(Ordering::Relaxed), self.shared.done.load(Ordering::Relaxed))
    }

    /// Messages since the last call.
    fn notes(&self) -> Vec<String> {
        std::mem::take(&mut *locked(&self.shared.notes))
    }

    /// Starts no further part; parts under way are finished.
    fn stop(&self) {
        self.shared.stop.store(true, Ordering::SeqCst);
    }

    /// Gives up parts under way.
    fn abandon(&self) {
        self.stop();
        self.shared.abandon.store(true, Ordering::SeqCst);
    }

    /// Waits for the end, once: `None` if the campaign is complete; its number of samples and the number of missing
    /// ones if it was stopped.
    fn ended(&self, py: Python<'_>) -> PyResult<Option<(u64, u64)>> {
        let thread = locked(&self.thread).take();
        let Some(thread) = thread else { return Ok(None) };
        let ended = py.detach(|| thread.join());
        // a law that has raised an exception is why runs ended, whatever else is told of them
        if let Some(error) = self.law.as_ref().and_then(|law| law.raised()) {
            return Err(error);
        }
        let broken = || SpindriftError::new_err("a thread of the campaign has panicked; what is committed stays");
        ended.map_err(|_| broken())?.map_err(raised)
    }
}
