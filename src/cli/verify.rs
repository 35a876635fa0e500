//! `spindrift verify`: whether a result is what was written, and whether its rows are what the plan says.

use std::cell::OnceCell;
use std::path::Path;
use std::sync::Mutex;

use crate::cli::arguments::VerifyOptions;
use crate::cli::command_outcome::{CommandOutcome, Failure};
use crate::cli::finish_campaign::{Finishing, complete, keep_data, stop_is_continued};
use crate::cli::input::{isa, plan_in, plan_of_result, refuse_other_rows};
use crate::cli::screen;
use crate::cli::signals::{self, Signals};
use crate::ensemble::run_cost::parts;
use crate::ensemble::runner::threads;
use crate::ensemble::{Ensemble, Part, Rows, Sink, Supervision, run as run_parts};
use crate::storage::claim::{Claim, ClaimOptions, claim, lock, open};
use crate::storage::disk::{Disk, Storage};
use crate::storage::folder::PartFile;
use crate::storage::found::{Found, plan_text};
use crate::storage::manifest::{FileRecord, PartRecord};
use crate::storage::names::{MANIFEST, PLAN, rows_of};
use crate::storage::part_sink::{PartFiles, write_parts};
use crate::storage::recovery::{begin_again, is_lost};
use crate::storage::rows_file::identity;
use crate::storage::verify::{damaged, derived_damage};

/// Runs the command.
///
/// # Errors
/// Where the result is damaged and not repaired, or a file operation fails.
pub fn run(options: &VerifyOptions) -> Result<CommandOutcome, Failure> {
    let watched = OnceCell::new();
    let watch = || {
        let signals: &'static Signals = watched.get_or_init(signals::watch);
        Supervision { progress: &|_| {}, stop: &signals.stop, abandon: &signals.abandon }
    };
    match verified(&Disk, options, &watch, &screen::note)? {
        Some(text) => screen::print(&text).map(|()| CommandOutcome::Done).map_err(Failure::from),
        None => Ok(CommandOutcome::Stopped(watched.get().and_then(|signals| signals.first()).unwrap_or_default())),
    }
}

/// Does what the command says, with `note` for each problem; what it prints, or nothing where a signal stopped it. A repair calls `watch` when
/// it starts.
///
/// # Errors
/// As [`run`].
pub fn verified(
    storage: &'static dyn Storage,
    options: &VerifyOptions,
    watch: &dyn Fn() -> Supervision<'static>,
    note: &dyn Fn(&str),
) -> Result<Option<String>, Failure> {
    let root = &options.folder;
    let lost = if options.repair { new_manifest(storage, root)? } else { None };
    let (found, locks) = open(storage, root, !options.repair).map_err(Failure::files)?;
    let plan = plan_of_result(root, &found)?;
    let ensemble = Ensemble::new(&plan, isa()?);
    let expected = identity(&ensemble);
    refuse_other_rows(root, &found, &expected)?;
    let readers = threads(options.threads, usize::MAX);
    let records: Vec<PartRecord> = found.parts().into_values().collect();
    let mut problems: Vec<String> = lost.iter().cloned().collect();
    problems.extend(found.damage());
    problems.extend(found.foreign.iter().map(|entry| format!("{entry}: not what the result has under this name")));
    found.notes().iter().for_each(|entry| note(entry));
    let broken = damaged(storage, root, &expected, &records, readers).map_err(Failure::files)?;
    problems.extend(broken.iter().map(|(_, what)| what.clone()));
    problems.extend(derived_damage(storage, root, found.derived()).map_err(Failure::files)?);
    let missing = missing_parts(&found, &ensemble);
    problems.extend(
        (!missing.is_empty())
            .then(|| format!("{} parts are missing, the first is part {}", missing.len(), missing[0].id.0)),
    );
    let sound: Vec<Part> =
        records.iter().filter(|part| !broken.iter().any(|(id, _)| *id == part.part)).map(PartRecord::samples).collect();
    let chosen = choice(&sound, options.fraction);
    let differing = differing(&ensemble, &records, &chosen, options)?;
    problems.extend(differing.iter().map(|part| format!("{}: its rows are not those of the plan", rows_of(part.id))));
    let rows: usize = chosen.iter().map(|part| part.count).sum();
    let checked = format!(
        "{}: {} parts, {} rows: checksums compared; {} parts with {rows} rows computed again and compared bit for bit",
        root.display(),
        records.len(),
        found.rows(),
        chosen.len()
    );
    // a repair that was interrupted has left what is sound and not finished
    if problems.is_empty() && (found.is_finished || !options.repair) {
        let end =
            if found.is_finished { "sound" } else { "sound so far; not finished: the campaign's command continues it" };
        return Ok(Some(format!("{checked}: {end}\n")));
    }
    problems.iter().for_each(|problem| note(problem));
    if !options.repair {
        return Err(Failure::Files(format!(
            "{checked}: {} problems; --repair makes what is damaged again",
            problems.len()
        )));
    }
    drop(locks);
    let text = match repair(storage, options, &ensemble, (&found, &differing), watch)? {
        Repair::Done(text) => text,
        Repair::Stopped(left) => {
            note(&format!(
                "{}: stopped; {left} samples are not made again yet. The same command continues.",
                root.display()
            ));
            return Ok(None);
        }
    };
    let end = if problems.is_empty() {
        "sound, and finished now".to_owned()
    } else {
        format!("{} problems, repaired", problems.len())
    };
    Ok(Some(format!("{text}{checked}: {end}\n")))
}

/// Writes the manifest of a result that has lost it, with its plan and without parts; what was done, where that was necessary.
fn new_manifest(storage: &'static dyn Storage, root: &Path) -> Result<Option<String>, Failure> {
    if !is_lost(storage, root).map_err(Failure::files)? {
        return Ok(None);
    }
    let _locks = lock(storage, root).map_err(Failure::files)?;
    let found = Found { plan: plan_text(storage, root).map_err(Failure::files)?, ..Found::default() };
    let (plan, _) = plan_in(root, &found)?;
    let origin = (found.plan.as_str(), &identity(&Ensemble::new(&plan, isa()?)));
    let is_begun = begin_again(storage, root, origin).map_err(Failure::files)?;
    Ok(is_begun.then(|| format!("{MANIFEST}: missing; nothing says what its parts had, so they are computed again")))
}

/// The parts of the plan that no manifest lists.
fn missing_parts(found: &Found, ensemble: &Ensemble<'_>) -> Vec<Part> {
    let there = found.parts();
    let parts = parts(ensemble.plan(), ensemble.isa());
    parts.iter().filter(|part| there.get(&part.id.0).is_none_or(|record| record.samples() != *part)).collect()
}

/// A fraction of `parts`, evenly spread, and at least one where the fraction is above zero.
fn choice(parts: &[Part], fraction: f64) -> Vec<Part> {
    let count = (parts.len() as f64 * fraction).ceil() as usize;
    (0..count).map(|index| parts[index * parts.len() / count]).collect()
}

/// How a repair ended.
enum Repair {
    /// The result is finished; what that prints.
    Done(String),
    /// A signal stopped it, with so many samples left.
    Stopped(u64),
}

/// Encodes rows and remembers the parts whose bytes are not those of the manifest.
struct Comparison<'a> {
    files: PartFiles,
    records: &'a [PartRecord],
    differing: Mutex<Vec<Part>>,
}

impl Sink for Comparison<'_> {
    type Error = String;

    fn take(&self, rows: &Rows) -> Result<(), String> {
        let part = rows.part();
        let files = self.files.encoded(rows, std::iter::empty()).map_err(|error| error.to_string())?;
        let files: Vec<FileRecord> = files.iter().map(PartFile::record).collect();
        if self.records.iter().find(|record| record.part == part.id.0).is_none_or(|record| record.files != files) {
            self.differing.lock().unwrap_or_else(std::sync::PoisonError::into_inner).push(rows.part());
        }
        Ok(())
    }
}

fn differing(
    ensemble: &Ensemble<'_>,
    records: &[PartRecord],
    chosen: &[Part],
    options: &VerifyOptions,
) -> Result<Vec<Part>, Failure> {
    let comparison = Comparison {
        files: PartFiles::new(ensemble).map_err(Failure::files)?,
        records,
        differing: Mutex::new(Vec::new()),
    };
    let supervision = Supervision::progress(&|_| {});
    run_parts(ensemble, chosen.iter().copied(), options.threads, &comparison, supervision).map_err(Failure::files)?;
    let mut found = comparison.differing.into_inner().unwrap_or_else(std::sync::PoisonError::into_inner);
    found.sort_by_key(|part| part.id);
    Ok(found)
}

/// Makes damaged, missing and differing parts again, and finishes the result.
fn repair(
    storage: &'static dyn Storage,
    options: &VerifyOptions,
    ensemble: &Ensemble<'_>,
    (found, differing): (&Found, &[Part]),
    watch: &dyn Fn() -> Supervision<'static>,
) -> Result<Repair, Failure> {
    let (plan, root) = (ensemble.plan(), &options.folder);
    if plan.analysis.stop.is_some() && !found.is_finished {
        return Err(Failure::Files(stop_is_continued(root)));
    }
    let supervision = watch();
    let claimed = ClaimOptions { overwrite: false, shard: None, threads: threads(options.threads, usize::MAX) };
    let ready = match claim(storage, root, (plan, &identity(ensemble)), claimed).map_err(Failure::files)? {
        Claim::Ready(ready) => *ready,
        Claim::Finished(_) => {
            return Err(Failure::Files(format!(
                "{}: every checksum is right, so rows were made by a program whose arithmetic differs; run the campaign with --overwrite",
                root.display()
            )));
        }
    };
    keep_data(&ready.folder, &plan_in(root, found)?.1)?;
    ready.folder.drop_parts(differing.iter().map(|part| part.id.0)).map_err(Failure::files)?;
    let missing = ready.folder.missing(parts(plan, ensemble.isa()).iter());
    write_parts(&ready.folder, ensemble, None, |sink| run_parts(ensemble, missing, options.threads, sink, supervision))
        .map_err(Failure::files)?
        .map_err(Failure::files)?;
    let left = ready.folder.missing(parts(plan, ensemble.isa()).iter());
    if !left.is_empty() {
        return Ok(Repair::Stopped(left.iter().map(|part| part.count as u64).sum()));
    }
    let replayed = root.join(PLAN).display().to_string();
    let job = Finishing {
        ensemble,
        ready: &ready,
        root,
        threads: options.threads,
        replayed: &replayed,
        junit: None,
        page: (found.has_page, None),
        made: None,
        seconds: [0.0; 2],
    };
    complete(&job, None).map(|(_, text)| Repair::Done(text))
}
