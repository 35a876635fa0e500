//! Statistics, findings and page of a complete campaign; [`finish`] makes those of a result in a folder.
//!
//! They are a function of plan and rows, whichever processes made them and however often they stopped.

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
use crate::storage::dataset::PartRecord;
use crate::storage::names::{PLAN, TRAJECTORIES, rows_of};
use crate::storage::replacement::replace;
use crate::workflow::analysed::{Analysed, end_of_analysed, write_junit};
use crate::workflow::derived::{Derivation, Derived, derive};
use crate::workflow::ending::end_of_finished;
use crate::workflow::error::{Result, WorkflowError};
use crate::workflow::page;
use crate::workflow::results::Results;
use crate::workflow::session::Session;
use crate::workflow::source::{at_rows_of, claimed, data_copies, plan_in};

/// Outputs besides tables and summary.
#[derive(Clone, Debug, Default)]
pub struct Outputs {
    /// True to omit the page.
    pub without_page: bool,
    /// Folder of the page's figures.
    pub figures: Option<PathBuf>,
    /// File of the verdicts as JUnit XML.
    pub junit: Option<PathBuf>,
}

/// The work of a process.
#[derive(Clone, Copy, Debug, Default)]
pub struct Made {
    pub samples: u64,
    pub elapsed: Duration,
    /// CPU time of runs and audits, s, in a campaign with audits.
    pub seconds: [f64; 2],
}

#[derive(Clone, Debug)]
pub struct Completed {
    pub plan: Plan,
    pub root: PathBuf,
    pub findings: Findings,
    pub end: SummaryEnd,
    /// The work of this process.
    pub made: Option<Made>,
    pub is_audited: bool,
    /// Number of files of rows.
    pub files: usize,
    pub bytes: u64,
}

impl Completed {
    /// The result of `plan` in `root` with the parts `parts`.
    pub(super) fn of(
        plan: &Plan,
        root: &Path,
        (analysed, findings): (&Analysed, Findings),
        parts: &[PartRecord],
        made: Option<Made>,
    ) -> Self {
        Completed {
            plan: plan.clone(),
            root: root.to_owned(),
            end: end_of_analysed(analysed, &findings),
            findings,
            made,
            is_audited: analysed.tally.audits.is_some(),
            files: parts.len(),
            bytes: parts.iter().flat_map(|part| &part.files).map(|file| file.bytes).sum(),
        }
    }
}

/// A campaign with a claimed place.
#[derive(Clone, Copy)]
pub(super) struct Job<'a> {
    pub session: Session<'a>,
    pub ensemble: &'a Ensemble<'a>,
    pub ready: &'a Ready,
    /// The place for the user.
    pub root: &'a Path,
    pub outputs: &'a Outputs,
    pub shard: Option<Shard>,
    pub fail_fast: bool,
}

/// Makes everything that follows from the rows, and marks the dataset as finished. Rows counted in memory are not read
/// again.
///
/// # Errors
/// Missing parts, unreadable rows, or a failed file operation.
pub(super) fn complete(job: &Job<'_>, made: Option<Made>, gathered: Option<Gathered>) -> Result<Completed> {
    let (plan, dataset, threads) = (job.ensemble.plan(), &job.ready.dataset, job.session.threads);
    refuse_missing(&dataset.missing(dataset.head().parts(plan.rows())), job.root)?;
    let (records, reader) = (dataset.parts(), dataset.rows());
    let gathered = match gathered {
        Some(gathered) => gathered,
        None => Gathered::of_files(job.ensemble, &reader, threads)?,
    };
    let retained = gathered.retained.clone();
    // left by an earlier end of the campaign
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
    dataset.finish()?;
    if let Some(old) = &job.ready.replaces {
        replace(session.folders, dataset.store(), old)?;
    }
    Ok(Completed::of(plan, job.root, (&analysed, findings), &records, made))
}

/// Message that an unfinished result with `[stop]` is continued by its own command.
pub(super) fn stop_is_continued(root: &Path) -> String {
    format!(
        "{}: is not finished, and [stop] decides after each look whether it is; this continues it: spindrift campaign \
        {} --out {}",
        root.display(),
        quoted_path(&root.join(PLAN)),
        quoted_path(root)
    )
}

/// Refuses to finish the result in `root` without these parts.
fn refuse_missing(missing: &[Part], root: &Path) -> Result<()> {
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

/// Copies data files, module and plan into the dataset, which is then complete in itself.
///
/// # Errors
/// A changed file, or a failed file operation.
pub(super) fn keep(ready: &Ready, files: &FilesRead) -> Result<()> {
    let copies = data_copies(files).collect::<Result<Vec<_>, _>>()?;
    ready.dataset.keep(&copies).map_err(WorkflowError::files)
}

/// Reports foreign entries of the folder.
pub(super) fn say_notes(session: &Session<'_>, root: &Path, notes: &[String]) {
    notes.iter().for_each(|note| session.watch.note(&format!("{}: {note}", root.display())));
}

/// The ending of an existing result; writes its verdicts to `junit`, if any.
pub(super) fn already(
    session: &Session<'_>,
    root: &Path,
    plan: &Plan,
    finished: claim::Finished,
    junit: Option<&Path>,
) -> Result<SummaryEnd> {
    say_notes(session, root, &finished.notes);
    let end = end_of_finished(session, plan, &finished)?;
    drop(finished);
    if let Some(file) = junit {
        Results::open(root, *session)?.write_junit(file)?;
    }
    Ok(end)
}

#[derive(Clone, Debug)]
pub enum Finished {
    /// Made now.
    Now(Box<Completed>),
    Already(SummaryEnd),
}

/// Finishes the result in `root`, a folder or address with all parts: makes missing derived files. `check` receives the
/// files of the plan before anything is written.
///
/// # Errors
/// Missing or damaged parts, a refusal by `check`, or a failed file operation.
pub fn finish(
    session: &Session<'_>,
    root: &Path,
    outputs: &Outputs,
    check: &dyn Fn(&FilesRead) -> Result<()>,
) -> Result<Finished> {
    let store = session.store(root)?;
    // an absent folder is not created
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
