//! [`finish`]: what is made of the rows of a campaign once all of them are there; `spindrift finish`.
//!
//! It is a function of the plan and the rows: whichever processes made them, and however often they were stopped, the files are the same.

use std::num::NonZeroUsize;
use std::path::{Path, PathBuf};
use std::time::Duration;

use serde_json::Value;

use crate::analysis::fold::Gathered;
use crate::analysis::trajectories;
use crate::campaign::{FilesRead, Plan, data};
use crate::cli::analysis::{Analysed, analyse, write_junit};
use crate::cli::arguments::FinishOptions;
use crate::cli::command_outcome::{CommandOutcome, Failure};
use crate::cli::input::{isa, plan_in};
use crate::cli::outputs::{refuse_inputs, refuse_within};
use crate::cli::shell_word::quoted_path;
use crate::cli::{report, screen};
use crate::ensemble::run_cost::parts;
use crate::ensemble::runner::threads;
use crate::ensemble::{Ensemble, Part, PartId};
use crate::report::audit_summary::cost;
use crate::report::drivers_text;
use crate::report::number::bytes;
use crate::report::summary::Summary;
use crate::sampling::SampleId;
use crate::storage::claim::{Claim, ClaimOptions, Ready, claim, open};
use crate::storage::disk::{Disk, Storage};
use crate::storage::folder::Folder;
use crate::storage::identity;
use crate::storage::manifest::PartRecord;
use crate::storage::names::{PLAN, REPORT, SUMMARY, TRAJECTORIES};
use crate::storage::parts_read::PartsRead;
use crate::storage::replacement::replace;
use crate::storage::rows_file::{headings, identity};
use crate::storage::rows_reader::RowsReader;
use crate::storage::table_log;

/// A dataset whose parts are all there.
#[derive(Clone, Copy, Debug)]
pub struct Finishing<'a> {
    /// The campaign.
    pub ensemble: &'a Ensemble<'a>,
    /// The dataset.
    pub ready: &'a Ready,
    /// Where it is for its user.
    pub root: &'a Path,
    /// How many threads read.
    pub threads: Option<NonZeroUsize>,
    /// The campaign file as `simulate` takes it.
    pub replayed: &'a str,
    /// Where the verdicts go as JUnit XML.
    pub junit: Option<&'a Path>,
    /// Whether the page is written, and the folder of its figures.
    pub page: (bool, Option<&'a Path>),
    /// Samples that this process ran, and how long that took.
    pub made: Option<(u64, Duration)>,
    /// CPU time of runs and audits of this process, s.
    pub seconds: [f64; 2],
}

/// Makes everything that follows from the rows, marks the dataset as finished, and says what was found. Where the rows were counted while
/// they were made, they are not read again for that.
///
/// # Errors
/// Where rows cannot be read or a file operation fails.
pub fn finish(job: &Finishing<'_>, gathered: Option<Gathered>) -> Result<CommandOutcome, Failure> {
    let (outcome, text) = complete(job, gathered)?;
    screen::print(&text)?;
    Ok(outcome)
}

/// Makes everything that follows from the rows, and marks the dataset as finished; how the command ends, and what it says.
///
/// # Errors
/// Where parts are missing, rows cannot be read or a file operation fails.
pub fn complete(job: &Finishing<'_>, gathered: Option<Gathered>) -> Result<(CommandOutcome, String), Failure> {
    let (plan, folder) = (job.ensemble.plan(), &job.ready.folder);
    let parts = parts(plan, job.ensemble.isa());
    refuse_missing(&folder.missing(parts.iter()), job.root)?;
    let records = folder.parts();
    let (reader, bands) = rows_of(job.ready);
    let gathered = match gathered {
        Some(gathered) => gathered,
        None => Gathered::of_files(job.ensemble, (&reader, &bands), job.threads).map_err(Failure::files)?,
    };
    let (tally, retained) = (gathered.tally.clone(), gathered.retained.clone());
    let analysed = analyse(plan, &reader, folder, gathered, job.threads)?;
    retain(job, &retained)?;
    make_page(job, &analysed, &records)?;
    write_junit(plan, &analysed, tally.failed(), job.junit)?;
    let (failed, undecided) = (analysed.verdicts.failed(), analysed.verdicts.undecided());
    let is_imprecise = analysed.stopping.as_ref().is_some_and(|found| !found.is_reached());
    let outcome = CommandOutcome::of_campaign(tally.failed(), failed, undecided + usize::from(is_imprecise));
    let summary =
        Summary::new(plan, &tally, &analysed.statistics, analysed.verdicts).with_stopping(plan, analysed.stopping);
    folder.write(SUMMARY, summary.json().as_bytes()).map_err(Failure::files)?;
    // the last part is larger in a campaign without an end, where it can get further rows
    let endless = |id: PartId| parts.with_samples(u64::MAX).part(id);
    let is_growing = |part: &Part| endless(part.id).is_some_and(|whole| whole.count > part.count);
    let growing = records.last().map(PartRecord::samples).filter(is_growing).map(|part| part.id);
    table_log::update(folder, &headings(job.ensemble), growing).map_err(Failure::files)?;
    folder.finish().map_err(Failure::files)?;
    if let Some(old) = &job.ready.replaces {
        replace(folder.storage(), folder.root(), old).map_err(Failure::files)?;
    }
    let audits = match (tally.audits(), job.seconds) {
        (Some(_), seconds) if seconds[1] > 0.0 => format!("\n  audits: {}\n", cost(seconds)),
        _ => String::new(),
    };
    let text = format!(
        "{}\n{summary}{audits}{}\n{}\n  {}: {} file{} of rows, {}\n",
        headline(plan, &summary, job.made),
        drivers_text::text(plan, &analysed.sensitivities),
        summary.replay(job.replayed),
        job.root.display(),
        records.len(),
        if records.len() == 1 { "" } else { "s" },
        bytes(folder.size()),
    );
    Ok((outcome, text))
}

/// Writes the report page and its figures, where they are asked for; else there is none.
fn make_page(job: &Finishing<'_>, analysed: &Analysed, records: &[PartRecord]) -> Result<(), Failure> {
    let folder = &job.ready.folder;
    if job.page.0 {
        let page = report::page(job.ensemble, analysed, records);
        folder.write(REPORT, page.html.as_bytes()).map_err(Failure::files)?;
        return report::save_figures(&page, job.page.1);
    }
    folder.remove(REPORT).map_err(Failure::files)
}

/// Writes the time series of the `samples` that the plan retains.
fn retain(job: &Finishing<'_>, samples: &[SampleId]) -> Result<(), Failure> {
    let (plan, folder) = (job.ensemble.plan(), &job.ready.folder);
    let path = folder.clear(TRAJECTORIES).map_err(Failure::files)?;
    if samples.is_empty() {
        return Ok(());
    }
    folder.storage().create_folder(&path).map_err(|error| Failure::files(format!("{}: {error}", path.display())))?;
    trajectories::save(plan, samples, folder, job.ensemble.isa(), job.threads).map_err(Failure::files)
}

/// The rows of a dataset that are there, and the files of their bands.
pub fn rows_of(ready: &Ready) -> (RowsReader, Vec<PathBuf>) {
    let parts = PartsRead::of(&ready.folder.parts(), |name| ready.folder.path(name));
    (RowsReader::new(ready.folder.storage(), parts.rows), parts.bands)
}

fn headline(plan: &Plan, summary: &Summary, made: Option<(u64, Duration)>) -> String {
    let (name, samples, seed) = (&plan.name, plan.rows(), plan.seed);
    let run = match made {
        Some((made, elapsed)) if made > 0 => {
            let seconds = elapsed.as_secs_f64();
            let which = if made == samples { String::new() } else { format!("{made} of them now, ") };
            format!(", {which}in {seconds:.2} s ({:.0}/s)", made as f64 / seconds.max(1e-9))
        }
        _ => String::new(),
    };
    format!("{name}: {samples} samples ({}){run}, seed {seed}", summary.samples())
}

/// How a command ends that finds the summary of a finished result: as the one that finished it.
pub fn outcome_of(summary: &str) -> CommandOutcome {
    let value: Value = serde_json::from_str(summary).unwrap_or_default();
    let statuses = value.get("statuses").and_then(Value::as_object);
    let failed =
        statuses.into_iter().flatten().filter(|(name, _)| *name != "ok").filter_map(|(_, count)| count.as_u64());
    let list = value.pointer("/requirements/list").and_then(Value::as_array);
    let verdicts: Vec<&str> = list.into_iter().flatten().filter_map(|one| one.get("verdict")?.as_str()).collect();
    let count = |word: &str| verdicts.iter().filter(|verdict| **verdict == word).count();
    let is_imprecise = value.pointer("/stop/reached").and_then(Value::as_bool) == Some(false);
    CommandOutcome::of_campaign(failed.sum(), count("FAIL"), count("UNDECIDED") + usize::from(is_imprecise))
}

/// That an unfinished result with `[stop]` is completed by the command that looks at it.
pub fn stop_is_continued(root: &Path) -> String {
    format!(
        "{}: is not finished, and [stop] decides after each look whether it is; this continues it: spindrift campaign {} --out {}",
        root.display(),
        quoted_path(&root.join(PLAN)),
        quoted_path(root)
    )
}

/// Refuses to finish the result in `root` where these parts of it are missing.
fn refuse_missing(missing: &[Part], root: &Path) -> Result<(), Failure> {
    let (Some(first), Some(last)) = (missing.first(), missing.last()) else { return Ok(()) };
    Err(Failure::Files(format!(
        "{}: {} parts are missing, from part {} to part {}; this makes them and finishes: spindrift campaign {} --out {}",
        root.display(),
        missing.len(),
        first.id.0,
        last.id.0,
        quoted_path(&root.join(PLAN)),
        quoted_path(root),
    )))
}

/// Copies the files of numbers of the plan into the dataset, which is then complete in itself: `finish`, `verify` and `report` read its plan.
///
/// # Errors
/// Where one has changed since the plan was made, or a file operation fails.
pub fn keep_data(folder: &Folder, files: &FilesRead) -> Result<(), Failure> {
    for (path, sha256) in &files.data {
        let bytes = data::bytes(path).map_err(|error| Failure::Files(format!("{}: {error}", path.display())))?;
        if identity::sha256(&bytes) != *sha256 {
            return Err(Failure::Files(format!(
                "{}: changed while it was read; run the command again",
                path.display()
            )));
        }
        folder.keep_data(&data::copy_name(path, sha256), &bytes).map_err(Failure::files)?;
    }
    Ok(())
}

/// Says what is in the folder and not part of the result.
pub fn say_notes(root: &Path, notes: &[String]) {
    notes.iter().for_each(|note| screen::note(&format!("{}: {note}", root.display())));
}

/// Runs the command `finish`.
///
/// # Errors
/// Where parts are missing or damaged, or a file operation fails.
pub fn run(options: &FinishOptions) -> Result<CommandOutcome, Failure> {
    let (outcome, text) = finished(&Disk, options)?;
    screen::print(&text)?;
    Ok(outcome)
}

/// Does what the command says; how it ends, and what it prints.
///
/// # Errors
/// As [`run`].
pub fn finished(storage: &'static dyn Storage, options: &FinishOptions) -> Result<(CommandOutcome, String), Failure> {
    let root = &options.folder;
    // a folder that is none is not created
    let (found, locks) = open(storage, root, false).map_err(Failure::files)?;
    if let Some(difference) = &found.shards_differ {
        return Err(Failure::Files(format!(
            "{}: its shards ask different questions: {difference}\nthis answers those of a file, from the rows that are there: spindrift campaign FILE --out {}",
            root.display(),
            quoted_path(root)
        )));
    }
    let (plan, files) = plan_in(root, &found)?;
    if plan.analysis.stop.is_some() && !found.is_finished {
        return Err(Failure::Files(stop_is_continued(root)));
    }
    let plan = plan.at_look(found.rows());
    drop(locks);
    let outputs = [("--junit", options.junit.as_deref()), ("--figures", options.figures.as_deref())];
    refuse_inputs(&files.paths(), &outputs[..1])?;
    refuse_within(root, &outputs)?;
    let ensemble = Ensemble::new(&plan, isa()?);
    let claimed = ClaimOptions { overwrite: false, shard: None, threads: threads(options.threads, usize::MAX) };
    let ready = match claim(storage, root, (&plan, &identity(&ensemble)), claimed).map_err(Failure::files)? {
        Claim::Finished(finished) => {
            say_notes(root, &finished.notes);
            return Ok((
                outcome_of(&finished.summary),
                format!("{}: already finished, every checksum verified\n", root.display()),
            ));
        }
        Claim::Ready(ready) => *ready,
    };
    say_notes(root, &ready.notes);
    ready.damaged.iter().for_each(|what| screen::note(&format!("{}: damaged: {what}", root.display())));
    refuse_missing(&ready.folder.missing(parts(&plan, ensemble.isa()).iter()), root)?;
    keep_data(&ready.folder, &files)?;
    let replayed = quoted_path(&root.join(PLAN));
    let job = Finishing {
        ensemble: &ensemble,
        ready: &ready,
        root,
        threads: options.threads,
        replayed: &replayed,
        junit: options.junit.as_deref(),
        page: (!options.no_report, options.figures.as_deref()),
        made: None,
        seconds: [0.0; 2],
    };
    complete(&job, None)
}
