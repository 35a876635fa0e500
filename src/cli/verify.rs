//! `spindrift verify`: whether a result is what was written, and whether its rows are what the plan says.

use std::sync::Mutex;

use crate::cli::arguments::VerifyOptions;
use crate::cli::command_outcome::{CommandOutcome, Failure};
use crate::cli::finish_campaign::{Finishing, complete, stop_is_continued};
use crate::cli::input::{isa, plan_of_result};
use crate::cli::screen;
use crate::cli::signals;
use crate::dataset::claim::{Claim, ClaimOptions, claim, open};
use crate::dataset::found::Found;
use crate::dataset::identity::{identity, sha256};
use crate::dataset::manifest::PartRecord;
use crate::dataset::names::{PLAN, rows_of};
use crate::dataset::part_sink::write_parts;
use crate::dataset::rows_file::RowsFile;
use crate::dataset::storage::{Disk, Storage};
use crate::dataset::table_log;
use crate::dataset::verify::damaged;
use crate::ensemble::run_cost::parts;
use crate::ensemble::runner::threads;
use crate::ensemble::{Ensemble, Part, Rows, Sink, Supervision, run as run_parts};

/// Runs the command.
///
/// # Errors
/// Where the result is damaged and not repaired, or a file operation fails.
pub fn run(options: &VerifyOptions) -> Result<CommandOutcome, Failure> {
    let watch = || {
        let signals = signals::watch();
        Supervision { progress: &|_| {}, stop: &signals.stop, abandon: &signals.abandon }
    };
    screen::print(&verified(&Disk, options, &watch, &screen::note)?)?;
    Ok(CommandOutcome::Done)
}

/// Does what the command says, with `note` for each problem; what it prints. A repair calls `watch` when it starts.
///
/// # Errors
/// As [`run`].
pub fn verified(
    storage: &'static dyn Storage,
    options: &VerifyOptions,
    watch: &dyn Fn() -> Supervision<'static>,
    note: &dyn Fn(&str),
) -> Result<String, Failure> {
    let root = &options.folder;
    let (found, locks) = open(storage, root).map_err(Failure::files)?;
    let plan = plan_of_result(root, &found)?;
    let ensemble = Ensemble::new(&plan, isa()?);
    let expected = identity(&ensemble);
    if found.identity.as_ref().is_some_and(|there| *there != expected) {
        return Err(Failure::Files(format!(
            "{}: plan.toml is not the plan of these rows (row hash {}), or they are of another version of the program",
            root.display(),
            expected.row_hash
        )));
    }
    let readers = threads(options.threads, usize::MAX);
    let records: Vec<PartRecord> = found.parts().into_values().collect();
    let mut problems: Vec<String> = found.damaged_lines().iter().map(|line| format!("{line}: damaged line")).collect();
    problems.extend(found.foreign.iter().map(|entry| format!("{entry}: not part of the result")));
    let broken = damaged(storage, root, &records, readers).map_err(Failure::files)?;
    problems.extend(broken.iter().map(|(_, what)| what.clone()));
    if found.is_finished {
        problems.extend(table_log::damage(storage, root, &expected, &records).map_err(Failure::files)?);
    }
    let missing = missing_parts(&found, &ensemble);
    problems.extend(missing.iter().map(|part| format!("{}: missing", rows_of(part.id))));
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
        return Ok(format!("{checked}: {end}\n"));
    }
    problems.iter().for_each(|problem| note(problem));
    if !options.repair {
        return Err(Failure::Files(format!(
            "{checked}: {} problems; --repair makes damaged parts again",
            problems.len()
        )));
    }
    drop(locks);
    let text = repair(storage, options, &ensemble, (&found, &differing), watch)?;
    let end = if problems.is_empty() {
        "sound, and finished now".to_owned()
    } else {
        format!("{} problems, repaired", problems.len())
    };
    Ok(format!("{text}{checked}: {end}\n"))
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

/// Encodes rows and remembers the parts whose bytes are not those of the manifest.
struct Comparison<'a> {
    file: RowsFile,
    records: &'a [PartRecord],
    differing: Mutex<Vec<Part>>,
}

impl Sink for Comparison<'_> {
    type Error = String;

    fn take(&self, rows: &Rows) -> Result<(), String> {
        let mut bytes = Vec::new();
        self.file.write(rows, &mut bytes).map_err(|error| error.to_string())?;
        let name = rows_of(rows.part().id);
        let listed = self.records.iter().flat_map(|part| &part.files).find(|file| file.name == name);
        if listed.is_none_or(|file| file.sha256 != sha256(&bytes)) {
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
        file: RowsFile::new(ensemble).map_err(Failure::files)?,
        records,
        differing: Mutex::new(Vec::new()),
    };
    let supervision = Supervision::progress(&|_| {});
    run_parts(ensemble, chosen.iter().copied(), options.threads, &comparison, supervision).map_err(Failure::files)?;
    let mut found = comparison.differing.into_inner().unwrap_or_else(std::sync::PoisonError::into_inner);
    found.sort_by_key(|part| part.id);
    Ok(found)
}

/// Makes damaged, missing and differing parts again, and finishes the result; what that prints.
fn repair(
    storage: &'static dyn Storage,
    options: &VerifyOptions,
    ensemble: &Ensemble<'_>,
    (found, differing): (&Found, &[Part]),
    watch: &dyn Fn() -> Supervision<'static>,
) -> Result<String, Failure> {
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
    ready.folder.drop_parts(differing.iter().map(|part| part.id.0)).map_err(Failure::files)?;
    let missing = ready.folder.missing(parts(plan, ensemble.isa()).iter());
    write_parts(&ready.folder, ensemble, None, |sink| run_parts(ensemble, missing, options.threads, sink, supervision))
        .map_err(Failure::files)?
        .map_err(Failure::files)?;
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
    complete(&job, None).map(|(_, text)| text)
}
