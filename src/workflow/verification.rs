//! [`verify`]: whether a result is as written, and its rows follow from the plan.

use std::path::Path;
use std::sync::{Arc, Mutex, PoisonError};

use crate::ensemble::{Ensemble, Part, Rows, Supervision, run as run_parts};
use crate::findings::number::counted;
use crate::findings::verified::Checked;
use crate::sampling::SampleId;
use crate::storage::claim::{Claim, open};
use crate::storage::columnar::EncodingError;
use crate::storage::dataset::{Head, PartRecord, unfinish};
use crate::storage::found::Found;
use crate::storage::names::rows_of;
use crate::storage::part_sink::PartFiles;
use crate::storage::store::Store;
use crate::workflow::derived_check::derived_problems;
use crate::workflow::error::{Result, WorkflowError};
use crate::workflow::finishing::{Completed, Job, Made, Outputs, complete, keep, stop_is_continued};
use crate::workflow::session::Session;
use crate::workflow::source::{IN_A_STORE, at_rows_of, claimed, plan_in, refuse_missing_law, refuse_other_rows};

#[derive(Clone, Debug)]
pub struct Verified {
    pub checked: Checked,
    /// The result finished by a repair.
    pub completed: Option<Box<Completed>>,
}

/// Options of a verification.
#[derive(Clone, Copy, Debug)]
pub struct Verification {
    /// Fraction of the parts to compute again.
    pub fraction: f64,
    /// True to repair damaged and missing parts and derived files.
    pub repair: bool,
}

/// Compares all checksums of the result in `root`, a folder or address, and computes some rows again; reports each
/// problem. `None` if a repair was stopped.
///
/// # Errors
/// A damaged, unrepaired result, or a failed file operation.
pub fn verify(session: &Session<'_>, root: &Path, wanted: Verification) -> Result<Option<Verified>> {
    let shared = session.store(root)?;
    let store = &*shared;
    if wanted.repair && !store.replaces() {
        return Err(WorkflowError::Input(format!(
            "--repair: must be left out for {}: what is in a store is not replaced; remove the objects that `verify` \
            names, and run the campaign's command again",
            root.display()
        )));
    }
    let note = |text: &str| session.watch.note(text);
    let (found, lock) = open(store, !wanted.repair)?;
    let (plan, read) = plan_in(session, store, &found)?;
    let plan = at_rows_of(plan, &found);
    // required even without recomputed rows, since the page has runs over time
    refuse_missing_law(&plan)?;
    let ensemble = Ensemble::new(&plan, session.isa);
    let head = Head::of(&ensemble, found.largest_part);
    refuse_other_rows(store, &found, &head.identity)?;
    found.notes().iter().for_each(|entry| note(entry));
    let examined = found.examine(store, (&plan, &head), &|_| true, session.readers())?;
    let mut problems = found.problems(store, &examined)?;
    problems.extend(found.foreign.iter().map(|entry| format!("{entry}: not what the result has under this name")));
    let records = examined.parts;
    // a shorter last part is made again with its further rows
    let planned = head.parts(plan.rows());
    let sound: Vec<Part> =
        records.iter().map(|record| record.part).filter(|part| planned.part(part.id) == Some(*part)).collect();
    let missing = planned.count() as usize - sound.len();
    let chosen = choice(&sound, wanted.fraction);
    let differing = differing(session, &ensemble, &records, &chosen)?;
    problems.extend(differing.iter().map(|part| format!("{}: its rows are not those of the plan", rows_of(part.id))));
    let rows: usize = chosen.iter().map(|part| part.count).sum();
    let mut checked = format!(
        "{}: {}, {}: checksums compared; {} with {} computed again and compared bit for bit",
        root.display(),
        counted(records.len(), "part"),
        counted(records.iter().map(|record| record.part.count).sum::<usize>(), "row"),
        counted(chosen.len(), "part"),
        counted(rows, "row"),
    );
    // files derived from damaged or missing rows are made again with them
    if let Some(manifest) = found.manifest.as_ref().filter(|_| problems.is_empty()) {
        let chosen = |samples: &[SampleId]| choice(samples, wanted.fraction);
        let check = derived_problems(session, (&shared, manifest), (&ensemble, &read), &records, &chosen)?;
        checked += &format!("; {} made of plan and rows again and compared", counted(check.files, "file"));
        if check.left_out > 0 {
            checked += &format!(" ({} time series are not among them; --fraction 1 makes all)", check.left_out);
        }
        problems.extend(check.problems);
    }
    // an interrupted repair leaves a sound, unfinished result
    if problems.is_empty() && (found.is_finished || !wanted.repair) {
        let (is_finished, unchecked) = (found.is_finished, found.unchecked());
        let checked = Checked { what: checked, problems: 0, is_finished, missing, unchecked };
        return Ok(Some(Verified { checked, completed: None }));
    }
    problems.iter().for_each(|problem| note(problem));
    if !wanted.repair {
        let remedy = if store.replaces() { "--repair makes what is damaged again" } else { IN_A_STORE };
        let problems = counted(problems.len(), "problem");
        return Err(WorkflowError::Files(format!("{checked}: {problems}; {remedy}")));
    }
    if found.is_finished {
        // without the mark, all derived files are made again
        unfinish(store)?;
    }
    drop(lock);
    match repair(session, (&shared, root), &ensemble, (&found, &head, &differing))? {
        Ok(completed) => {
            let (problems, unchecked) = (problems.len(), Vec::new());
            let checked = Checked { what: checked, problems, is_finished: true, missing: 0, unchecked };
            Ok(Some(Verified { checked, completed: Some(Box::new(completed)) }))
        }
        Err(left) => {
            note(&format!(
                "{}: stopped; {left} samples are not made again yet. The same command continues.",
                root.display()
            ));
            Ok(None)
        }
    }
}

/// An evenly spread fraction of `list`, at least one if the fraction is positive.
fn choice<T: Copy>(list: &[T], fraction: f64) -> Vec<T> {
    let count = (list.len() as f64 * fraction).ceil() as usize;
    (0..count).map(|index| list[index * list.len() / count]).collect()
}

/// The `chosen` parts whose recomputed rows differ from their `records`.
fn differing(
    session: &Session<'_>,
    ensemble: &Ensemble<'_>,
    records: &[PartRecord],
    chosen: &[Part],
) -> Result<Vec<Part>> {
    let files = PartFiles::new(ensemble).map_err(WorkflowError::files)?;
    let differing = Mutex::new(Vec::new());
    let compare = |rows: &Rows| {
        let part = rows.part();
        let again = files.encoded(rows, std::iter::empty())?.into_iter().map(|file| file.record).collect();
        if !records.contains(&PartRecord { part, files: again }) {
            differing.lock().unwrap_or_else(PoisonError::into_inner).push(part);
        }
        Ok::<(), EncodingError>(())
    };
    let supervision = Supervision::progress(&|_| {});
    run_parts(ensemble, chosen.iter().copied(), session.threads, &compare, supervision)
        .map_err(WorkflowError::files)?;
    let mut found = differing.into_inner().unwrap_or_else(PoisonError::into_inner);
    found.sort_by_key(|part| part.id);
    Ok(found)
}

/// Makes damaged, missing and differing parts again, and finishes the result; returns the number of samples left by a
/// stop.
fn repair(
    session: &Session<'_>,
    (store, root): (&Arc<dyn Store>, &Path),
    ensemble: &Ensemble<'_>,
    (found, head, differing): (&Found, &Head, &[Part]),
) -> Result<Result<Completed, u64>> {
    let plan = ensemble.plan();
    if plan.analysis.stop.is_some() && !found.is_finished {
        return Err(WorkflowError::Files(stop_is_continued(root)));
    }
    let Claim::Ready(ready) = claimed(session, store, ensemble, (false, None))? else {
        return Err(WorkflowError::at(root, "another process has finished it"));
    };
    keep(&ready, &plan_in(session, &**store, found)?.1)?;
    let dataset = &ready.dataset;
    dataset.drop_parts(differing.iter().map(|part| part.id))?;
    let outputs = &Outputs { without_page: !found.has_page(), ..Outputs::default() };
    let job = Job { session: *session, ensemble, ready: &ready, root, outputs, shard: None, fail_fast: false };
    job.run_them(&dataset.missing(head.parts(plan.rows())), None, &mut Made::default())?;
    let left = dataset.missing(head.parts(plan.rows()));
    if !left.is_empty() {
        return Ok(Err(left.iter().map(|part| part.count as u64).sum()));
    }
    complete(&job, None, None).map(Ok)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Law: a choice has its share of a list, rounded up, one in each of as many equal stretches.
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
