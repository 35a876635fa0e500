//! Statistics, findings and page of a campaign once all rows are there; [`finish`] makes those of a result in a folder.
//!
//! It is a function of the plan and the rows: whichever processes made them, and however often they were stopped, the
//! files are the same.

use std::path::{Path, PathBuf};
use std::time::Duration;

use crate::analysis::fold::Gathered;
use crate::campaign::{FilesRead, Plan};
use crate::ensemble::{Ensemble, Part};
use crate::findings::Findings;
use crate::findings::end::SummaryEnd;
use crate::findings::number::counted;
use crate::findings::shell_word::quoted_path;
use crate::storage::claim::{self, Claim, Ready, Shard, open};
use crate::storage::names::{PLAN, TRAJECTORIES, rows_of};
use crate::storage::replacement::replace;
use crate::workflow::analysed::{end_of_analysed, write_junit};
use crate::workflow::derived::{Derivation, Derived, derive};
use crate::workflow::ending::end_of_finished;
use crate::workflow::error::WorkflowError;
use crate::workflow::page;
use crate::workflow::results::Results;
use crate::workflow::session::Session;
use crate::workflow::source::{at_rows_of, claimed, data_copies, plan_in};

/// What is made of the rows beside the tables and the summary.
#[derive(Clone, Debug, Default)]
pub struct Outputs {
    /// Whether the page is left out.
    pub without_page: bool,
    /// The folder of the figures of the page as files.
    pub figures: Option<PathBuf>,
    /// The file of the verdicts as JUnit XML.
    pub junit: Option<PathBuf>,
}

/// What a process has run.
#[derive(Clone, Copy, Debug, Default)]
pub struct Made {
    pub samples: u64,
    pub elapsed: Duration,
    /// CPU time of runs and of audits, s; measured where there are audits.
    pub seconds: [f64; 2],
}

/// A result that has just been finished.
#[derive(Clone, Debug)]
pub struct Completed {
    pub plan: Plan,
    pub root: PathBuf,
    pub findings: Findings,
    pub end: SummaryEnd,
    /// What this process has run of it.
    pub made: Option<Made>,
    pub is_audited: bool,
    /// Number of files of rows.
    pub files: usize,
    /// Size of the result, bytes.
    pub bytes: u64,
}

/// A campaign whose place is claimed.
#[derive(Clone, Copy)]
pub(super) struct Job<'a> {
    pub session: Session<'a>,
    pub ensemble: &'a Ensemble<'a>,
    pub ready: &'a Ready,
    /// Where the result is for its user.
    pub root: &'a Path,
    /// What is made beside the tables.
    pub outputs: &'a Outputs,
    pub shard: Option<Shard>,
    pub fail_fast: bool,
}

/// Makes everything that follows from the rows, and marks the dataset as finished. Where the rows were counted while
/// they were made, they are not read again for that.
///
/// # Errors
/// Where parts are missing, rows cannot be read or a file operation fails.
pub(super) fn complete(
    job: &Job<'_>,
    made: Option<Made>,
    gathered: Option<Gathered>,
) -> Result<Completed, WorkflowError> {
    let (plan, dataset, threads) = (job.ensemble.plan(), &job.ready.dataset, job.session.threads);
    refuse_missing(&dataset.missing(dataset.head().parts(plan.rows())), job.root)?;
    let (records, reader) = (dataset.parts(), dataset.rows());
    let gathered = match gathered {
        Some(gathered) => gathered,
        None => Gathered::of_files(job.ensemble, &reader, threads)?,
    };
    let retained = gathered.retained.clone();
    // an earlier end of the campaign may have left others
    dataset.clear(TRAJECTORIES)?;
    let (session, page) = (job.session, (!job.outputs.without_page).then_some(None));
    let derivation =
        Derivation { session, ensemble: job.ensemble, reader: &reader, records: &records, page, retained: &retained };
    let Derived { analysed, page, findings } = derive(&derivation, gathered, &|name, bytes| match bytes {
        Some(bytes) => dataset.put(name, bytes),
        None => dataset.remove(name),
    })?;
    if let Some(page) = page {
        page::save_figures(&session, plan, &page, job.outputs.figures.as_deref())?;
    }
    write_junit(plan, &analysed, job.outputs.junit.as_deref())?;
    let end = end_of_analysed(&analysed, &findings);
    dataset.finish()?;
    if let Some(old) = &job.ready.replaces {
        replace(session.folders, dataset.store(), old)?;
    }
    Ok(Completed {
        plan: plan.clone(),
        root: job.root.to_owned(),
        findings,
        end,
        made,
        is_audited: analysed.tally.audits.is_some(),
        files: records.len(),
        bytes: dataset.size(),
    })
}

/// That an unfinished result with `[stop]` is completed by the command that looks at it.
pub(super) fn stop_is_continued(root: &Path) -> String {
    format!(
        "{}: is not finished, and [stop] decides after each look whether it is; this continues it: spindrift campaign \
        {} --out {}",
        root.display(),
        quoted_path(&root.join(PLAN)),
        quoted_path(root)
    )
}

/// Refuses to finish the result in `root` where these parts of it are missing.
fn refuse_missing(missing: &[Part], root: &Path) -> Result<(), WorkflowError> {
    let Some(first) = missing.first() else { return Ok(()) };
    Err(WorkflowError::Files(format!(
        "{}: {} missing, the first of them {}; this makes what is missing and finishes: spindrift campaign {} --out {}",
        root.display(),
        counted(missing.len(), "part"),
        rows_of(first.id),
        quoted_path(&root.join(PLAN)),
        quoted_path(root),
    )))
}

/// Copies the files of numbers and the module of the plan into the dataset, and then the plan: the dataset is complete
/// in itself.
///
/// # Errors
/// Where one has changed since the plan was made, or a file operation fails.
pub(super) fn keep(ready: &Ready, files: &FilesRead) -> Result<(), WorkflowError> {
    let copies = data_copies(files).collect::<Result<Vec<_>, _>>()?;
    ready.dataset.keep(&copies).map_err(WorkflowError::files)
}

/// Says what is in the folder and not part of the result.
pub(super) fn say_notes(session: &Session<'_>, root: &Path, notes: &[String]) {
    notes.iter().for_each(|note| session.watch.note(&format!("{}: {note}", root.display())));
}

/// How the campaign of a result that is there ended; its verdicts are written to the file `junit`, if one was named.
pub(super) fn already(
    session: &Session<'_>,
    root: &Path,
    plan: &Plan,
    finished: claim::Finished,
    junit: Option<&Path>,
) -> Result<SummaryEnd, WorkflowError> {
    say_notes(session, root, &finished.notes);
    let end = end_of_finished(session, plan, &finished)?;
    drop(finished);
    if let Some(file) = junit {
        Results::open(root, *session)?.write_junit(file)?;
    }
    Ok(end)
}

/// What [`finish`] found.
#[derive(Clone, Debug)]
pub enum Finished {
    /// It has made what was missing.
    Now(Box<Completed>),
    Already(SummaryEnd),
}

/// Finishes the result in `root`, a folder or an address, whose parts are all there: what follows from the rows is made
/// where it is missing. `check` is shown the files that the plan was made from before anything is written.
///
/// # Errors
/// Where parts are missing or damaged, `check` refuses, or a file operation fails.
pub fn finish(
    session: &Session<'_>,
    root: &Path,
    outputs: &Outputs,
    check: &dyn Fn(&FilesRead) -> Result<(), WorkflowError>,
) -> Result<Finished, WorkflowError> {
    let store = session.store(root)?;
    // a folder that is none is not created
    let (found, lock) = open(&*store, false)?;
    let (plan, files) = plan_in(session, &*store, &found)?;
    if plan.analysis.stop.is_some() && !found.is_finished {
        return Err(WorkflowError::Files(stop_is_continued(root)));
    }
    let plan = at_rows_of(plan, &found);
    drop(lock);
    check(&files)?;
    let ensemble = Ensemble::new(&plan, session.isa);
    let ready = match claimed(session, &store, &ensemble, (false, None))? {
        Claim::Finished(finished) => {
            return already(session, root, &plan, finished, outputs.junit.as_deref()).map(Finished::Already);
        }
        Claim::Ready(ready) => *ready,
    };
    say_notes(session, root, &ready.notes);
    ready.damaged.iter().for_each(|what| session.watch.note(&format!("{}: damaged: {what}", root.display())));
    refuse_missing(&ready.dataset.missing(ready.dataset.head().parts(plan.rows())), root)?;
    keep(&ready, &files)?;
    let (session, ensemble, ready) = (*session, &ensemble, &ready);
    let job = Job { session, ensemble, ready, root, outputs, shard: None, fail_fast: false };
    complete(&job, None, None).map(|completed| Finished::Now(Box::new(completed)))
}
