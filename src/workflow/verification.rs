//! [`verify`]: whether a result is what was written, and whether its rows are what the plan says.

use std::path::Path;
use std::sync::Mutex;

use crate::control::laws::asked;
use crate::ensemble::run_cost::parts;
use crate::ensemble::{Ensemble, Part, Rows, Sink, Supervision, run as run_parts};
use crate::findings::number::counted;
use crate::findings::verified::Checked;
use crate::sampling::SampleId;
use crate::storage::claim::{Claim, ClaimOptions, claim, lock, open};
use crate::storage::folder::{PartFile, unmark};
use crate::storage::found::{Found, plan_text};
use crate::storage::manifest::{FileRecord, PartRecord};
use crate::storage::names::{MANIFEST, rows_of};
use crate::storage::part_sink::{PartFiles, write_parts};
use crate::storage::recovery::{begin_again, is_lost};
use crate::storage::rows_file::identity;
use crate::storage::verify::{damaged, derived_damage};
use crate::workflow::derived_check::derived_problems;
use crate::workflow::error::WorkflowError;
use crate::workflow::finishing::{Completed, Finishing, Outputs, complete, keep_data, stop_is_continued};
use crate::workflow::session::Session;
use crate::workflow::source::{plan_in, refuse_other_rows};
use crate::workflow::stored::{Stored, address};

/// How a result was verified.
#[derive(Clone, Debug)]
pub struct Verified {
    pub checked: Checked,
    /// The result, where a repair has finished it.
    pub completed: Option<Box<Completed>>,
}

/// What is verified of a result.
#[derive(Clone, Copy, Debug)]
pub struct Verification {
    /// The fraction of the parts whose rows are computed again.
    pub fraction: f64,
    /// Whether damaged and missing parts, and what follows from them, are made again.
    pub repair: bool,
}

/// Compares every checksum of the result in `root`, a folder or an address, and computes some of its rows again; each
/// problem is told. `None` where a repair was stopped.
///
/// # Errors
/// Where the result is damaged and not repaired, or a file operation fails.
pub fn verify(session: &Session<'_>, root: &Path, wanted: Verification) -> Result<Option<Verified>, WorkflowError> {
    if let Some(address) = address(root)? {
        if wanted.repair {
            return Err(WorkflowError::Input(format!(
                "--repair: must be left out for {address}: what is in a store is not replaced; remove the objects that \
                `verify` names, and run the campaign's command again"
            )));
        }
        let stored = Stored::there(session, address)?;
        stored.fetch(true)?;
        return verify(session, stored.root(), wanted);
    }
    let storage = session.storage;
    let note = |text: &str| session.watch.note(text);
    let lost = if wanted.repair && !root.is_file() { new_manifest(session, root)? } else { None };
    let (found, locks) = open(storage, root, !wanted.repair)?;
    let (plan, read) = plan_in(session, root, &found)?;
    let plan = plan.at_look(found.rows());
    // also without rows to compute again: the page has runs over time
    asked::refuse_unanswered(plan.loop_spec()).map_err(WorkflowError::Input)?;
    let ensemble = Ensemble::new(&plan, session.isa);
    let expected = identity(&ensemble);
    refuse_other_rows(root, &found, &expected)?;
    let records: Vec<PartRecord> = found.parts().into_values().collect();
    let mut problems: Vec<String> = lost.iter().cloned().collect();
    problems.extend(found.damage());
    problems.extend(found.foreign.iter().map(|entry| format!("{entry}: not what the result has under this name")));
    found.notes().iter().for_each(|entry| note(entry));
    let broken = damaged(storage, root, &expected, &records, session.readers()).map_err(WorkflowError::files)?;
    problems.extend(broken.iter().map(|(_, what)| what.clone()));
    problems.extend(derived_damage(storage, root, found.written()).map_err(WorkflowError::files)?);
    let missing = missing_parts(&found, &ensemble);
    // parts that no manifest lists are not made yet, unless it says that all are there
    let is_claimed = found.manifests.get(MANIFEST).is_some_and(|manifest| manifest.is_finished);
    problems.extend(
        (is_claimed && !missing.is_empty())
            .then(|| format!("{} missing, the first is part {}", counted(missing.len(), "part"), missing[0].id.0)),
    );
    let sound: Vec<Part> =
        records.iter().filter(|part| !broken.iter().any(|(id, _)| *id == part.part)).map(PartRecord::samples).collect();
    let chosen = choice(&sound, wanted.fraction);
    let differing = differing(session, &ensemble, &records, &chosen)?;
    problems.extend(differing.iter().map(|part| format!("{}: its rows are not those of the plan", rows_of(part.id))));
    let rows: usize = chosen.iter().map(|part| part.count).sum();
    let mut checked = format!(
        "{}: {}, {}: checksums compared; {} with {} computed again and compared bit for bit",
        root.display(),
        counted(records.len(), "part"),
        counted(found.rows(), "row"),
        counted(chosen.len(), "part"),
        counted(rows, "row"),
    );
    // what follows from rows that are damaged, or not all there, is made again with them
    let is_comparable = problems.is_empty() && !found.written().is_empty();
    if is_comparable {
        let chosen = |samples: &[SampleId]| choice(samples, wanted.fraction);
        let check = derived_problems(session, (root, &found), (&ensemble, &read), &records, &chosen)?;
        checked += &format!("; {} made of plan and rows again and compared", counted(check.files, "file"));
        if check.left_out > 0 {
            checked += &format!(" ({} time series are not among them; --fraction 1 makes all)", check.left_out);
        }
        problems.extend(check.problems);
    }
    // a repair that was interrupted has left what is sound and not finished
    if problems.is_empty() && (found.is_finished || !wanted.repair) {
        let (is_finished, unchecked) = (found.is_finished, found.unchecked);
        let checked = Checked { what: checked, problems: 0, is_finished, missing: missing.len(), unchecked };
        return Ok(Some(Verified { checked, completed: None }));
    }
    problems.iter().for_each(|problem| note(problem));
    if !wanted.repair {
        return Err(WorkflowError::Files(format!(
            "{checked}: {}; --repair makes what is damaged again",
            counted(problems.len(), "problem")
        )));
    }
    if is_comparable && found.is_finished {
        // all checksums are right: without the mark, everything that follows from the rows is made again
        unmark(storage, root).map_err(WorkflowError::files)?;
    }
    drop(locks);
    match repair(session, root, &ensemble, (&found, &differing))? {
        Repair::Done(completed) => {
            let (problems, unchecked) = (problems.len(), Vec::new());
            let checked = Checked { what: checked, problems, is_finished: true, missing: 0, unchecked };
            Ok(Some(Verified { checked, completed: Some(completed) }))
        }
        Repair::Stopped(left) => {
            note(&format!(
                "{}: stopped; {left} samples are not made again yet. The same command continues.",
                root.display()
            ));
            Ok(None)
        }
    }
}

/// Writes the manifest of a result that has lost it, with its plan and without parts; what was done, where that was
/// necessary.
fn new_manifest(session: &Session<'_>, root: &Path) -> Result<Option<String>, WorkflowError> {
    let storage = session.storage;
    if !is_lost(storage, root).map_err(WorkflowError::files)? {
        return Ok(None);
    }
    let _locks = lock(storage, root).map_err(WorkflowError::files)?;
    let found = Found { plan: plan_text(storage, root).map_err(WorkflowError::files)?, ..Found::default() };
    let (plan, _) = plan_in(session, root, &found)?;
    let origin = (found.plan.as_str(), &identity(&Ensemble::new(&plan, session.isa)));
    let is_begun = begin_again(storage, root, origin).map_err(WorkflowError::files)?;
    Ok(is_begun.then(|| format!("{MANIFEST}: missing; nothing says what its parts had, so they are computed again")))
}

/// The parts of the plan that no manifest lists.
fn missing_parts(found: &Found, ensemble: &Ensemble<'_>) -> Vec<Part> {
    let there = found.parts();
    let parts = parts(ensemble.plan(), ensemble.isa());
    parts.iter().filter(|part| there.get(&part.id.0).is_none_or(|record| record.samples() != *part)).collect()
}

/// A fraction of `list`, evenly spread, and at least one where the fraction is above zero.
fn choice<T: Copy>(list: &[T], fraction: f64) -> Vec<T> {
    let count = (list.len() as f64 * fraction).ceil() as usize;
    (0..count).map(|index| list[index * list.len() / count]).collect()
}

enum Repair {
    Done(Box<Completed>),
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
    session: &Session<'_>,
    ensemble: &Ensemble<'_>,
    records: &[PartRecord],
    chosen: &[Part],
) -> Result<Vec<Part>, WorkflowError> {
    let comparison = Comparison {
        files: PartFiles::new(ensemble).map_err(WorkflowError::files)?,
        records,
        differing: Mutex::new(Vec::new()),
    };
    let supervision = Supervision::progress(&|_| {});
    run_parts(ensemble, chosen.iter().copied(), session.threads, &comparison, supervision)
        .map_err(WorkflowError::files)?;
    let mut found = comparison.differing.into_inner().unwrap_or_else(std::sync::PoisonError::into_inner);
    found.sort_by_key(|part| part.id);
    Ok(found)
}

/// Makes damaged, missing and differing parts again, and finishes the result.
fn repair(
    session: &Session<'_>,
    root: &Path,
    ensemble: &Ensemble<'_>,
    (found, differing): (&Found, &[Part]),
) -> Result<Repair, WorkflowError> {
    let plan = ensemble.plan();
    if plan.analysis.stop.is_some() && !found.is_finished {
        return Err(WorkflowError::Files(stop_is_continued(root)));
    }
    let claimed = ClaimOptions { overwrite: false, shard: None, threads: session.readers() };
    let claimed = claim(session.storage, root, (plan, &identity(ensemble)), claimed).map_err(WorkflowError::files)?;
    let ready = match claimed {
        Claim::Ready(ready) => *ready,
        Claim::Finished(_) => {
            return Err(WorkflowError::Files(format!(
                "{}: every checksum is right, so rows were made by a program whose arithmetic differs; run the \
                campaign with --overwrite",
                root.display()
            )));
        }
    };
    keep_data(&ready.folder, &plan_in(session, root, found)?.1)?;
    ready.folder.drop_parts(differing.iter().map(|part| part.id.0)).map_err(WorkflowError::files)?;
    let missing = ready.folder.missing(parts(plan, ensemble.isa()).iter());
    let samples = |parts: &[Part]| parts.iter().map(|part| part.count as u64).sum();
    session.watch.begin(samples(&missing));
    let progress = |samples| session.watch.advance(samples);
    let made = write_parts(&ready.folder, ensemble, (None, &|_| Ok(())), |sink| {
        run_parts(ensemble, missing, session.threads, sink, session.supervision(&progress))
    });
    session.watch.end();
    made.map_err(WorkflowError::files)?.map_err(WorkflowError::files)?;
    let left = ready.folder.missing(parts(plan, ensemble.isa()).iter());
    if !left.is_empty() {
        return Ok(Repair::Stopped(samples(&left)));
    }
    let outputs = Outputs { without_page: !found.has_page, ..Outputs::default() };
    let job = Finishing { session: *session, ensemble, ready: &ready, root, outputs: &outputs, made: None };
    complete(&job, None).map(|completed| Repair::Done(Box::new(completed)))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Law: a choice has its share of a list, rounded up, and is spread over all of it: each of as many stretches of
    /// equal length has one, and none has two.
    #[test]
    fn a_choice_is_spread_over_the_list() {
        for length in [1, 7, 10, 100, 1_001] {
            let list: Vec<usize> = (0..length).collect();
            for fraction in [0.0, 1e-6, 0.1, 0.3, 0.5, 1.0] {
                let chosen = choice(&list, fraction);
                assert_eq!(chosen.len(), (fraction * length as f64).ceil() as usize);
                for (stretch, at) in chosen.iter().enumerate() {
                    let of = |stretch: usize| stretch * length / chosen.len();
                    assert!((of(stretch)..of(stretch + 1)).contains(at), "{at} of {length} in stretch {stretch}");
                }
            }
        }
    }
}
