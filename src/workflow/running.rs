//! [`run_missing`]: runs the missing samples of a campaign, look by look under `[stop]`, and finishes the result.

use std::sync::{Mutex, PoisonError};
use std::time::Instant;

use crate::analysis::fold::RunningFold;
use crate::analysis::stopping::look;
use crate::campaign::Plan;
use crate::ensemble::runner::threads;
use crate::ensemble::{Ensemble, Part, Parts, Rows, run as run_parts};
use crate::findings::loss::stop_text;
use crate::findings::number::counted;
use crate::storage::part_sink::{CountRows, PartSink, write_parts};
use crate::storage::store::Failure;
use crate::workflow::error::{Result, WorkflowError};
use crate::workflow::failed_samples::{FailedRun, fail_fast, first_failed};
use crate::workflow::finishing::{Job, Made, complete, say_notes};
use crate::workflow::outcome::CampaignOutcome;

pub(super) fn run_missing(job: &Job<'_>) -> Result<CampaignOutcome> {
    let (plan, ready) = (job.ensemble.plan(), job.ready);
    let parts = ready.dataset.head().parts(plan.rows());
    let mut made = Made::default();
    // existing rows are uncounted
    let is_whole = ready.dataset.parts().is_empty() && job.shard.is_none() && plan.analysis.stop.is_none();
    let counts = if is_whole { RunningFold::of(job.ensemble) } else { None };
    plan.notes().iter().for_each(|note| job.session.watch.note(note));
    let targets = plan.looks();
    let mut samples = targets.last().copied().unwrap_or(plan.samples);
    // looks at fewer samples have been taken
    for target in targets.into_iter().filter(|target| *target >= ready.rows) {
        samples = target;
        if let Some(outcome) = job.run_to(parts.with_samples(target), counts.as_ref(), &mut made)? {
            return Ok(outcome);
        }
        match look(plan, &ready.dataset.rows(), target, job.session.threads)? {
            Some(found) if !found.ends() => {
                job.session.watch.note(&format!("{}: {}", plan.name, stop_text(plan, &found)));
            }
            _ => break,
        }
    }
    let plan = plan.clone().at_look(samples);
    let stopped = Ensemble::new(&plan, job.ensemble.isa());
    let gathered = counts.and_then(|counts| counts.whole(parts.with_samples(samples)));
    let completed = complete(&Job { ensemble: &stopped, ..*job }, Some(made), gathered)?;
    Ok(CampaignOutcome::Finished(Box::new(completed)))
}

impl Job<'_> {
    fn is_mine(&self, part: &Part) -> bool {
        self.shard.is_none_or(|shard| shard.has(part.id))
    }

    /// Runs the missing ones of `parts`; returns an outcome if that ends the campaign: a stop, or a shard.
    fn run_to(&self, parts: Parts, counts: Option<&RunningFold>, made: &mut Made) -> Result<Option<CampaignOutcome>> {
        let dataset = &self.ready.dataset;
        // a shorter last part is made again with its further rows
        let there = dataset.parts().into_iter().map(|record| record.part);
        let outgrown = there.filter(|part| self.is_mine(part) && parts.part(part.id) != Some(*part));
        dataset.drop_parts(outgrown.map(|part| part.id))?;
        let mut missing = dataset.missing(parts);
        missing.retain(|part| self.is_mine(part));
        if made.samples == 0 {
            let samples = parts.iter().filter(|part| self.is_mine(part)).map(|part| part.count as u64).sum();
            self.say_what_was_found(samples, &missing);
            self.say_idle_threads(missing.len());
        }
        if self.fail_fast
            && let Some(failed) = first_failed(&dataset.rows())?
        {
            return Ok(Some(CampaignOutcome::FailedFast(failed)));
        }
        if let Some(failed) = self.run_them(&missing, counts, made)? {
            return Ok(Some(CampaignOutcome::FailedFast(failed)));
        }
        let left = dataset.missing(parts);
        // other shards make theirs
        if left.iter().any(|part| self.is_mine(part)) {
            let left = left.iter().map(|part| part.count as u64).sum();
            return Ok(Some(CampaignOutcome::Stopped { samples: parts.samples(), left }));
        }
        Ok(self.shard.map(|shard| CampaignOutcome::ShardDone { shard, made: *made }))
    }

    /// Runs `missing`; returns the first failed run if it ends the campaign.
    pub(super) fn run_them(
        &self,
        missing: &[Part],
        counts: Option<&RunningFold>,
        made: &mut Made,
    ) -> Result<Option<FailedRun>> {
        let (watch, first) = (self.session.watch, Mutex::new(None));
        let samples = missing.iter().map(|part| part.count as u64).sum();
        let begun = Instant::now();
        watch.begin(samples);
        let progress = |samples| watch.advance(samples);
        let supervision = self.session.supervision(&progress);
        let counts = counts.map(|counts| counts as &dyn CountRows);
        let ended = write_parts(&self.ready.dataset, self.ensemble, counts, |sink: &PartSink<'_>| {
            let take = |rows: &Rows| {
                sink.take(rows)?;
                if self.fail_fast {
                    fail_fast(rows, &first, watch.stop());
                }
                Ok::<(), Failure>(())
            };
            let missing = missing.iter().copied();
            run_parts(self.ensemble, missing, self.session.threads, &take, supervision).map(|()| sink.seconds())
        });
        watch.end();
        let seconds = ended?.map_err(WorkflowError::files)?;
        made.samples += samples;
        made.elapsed += begun.elapsed();
        made.seconds.iter_mut().zip(seconds).for_each(|(sum, seconds)| *sum += seconds);
        Ok(first.into_inner().unwrap_or_else(PoisonError::into_inner))
    }

    /// Reports the found state of the folder; `samples` are those for this process.
    fn say_what_was_found(&self, samples: u64, missing: &[Part]) {
        let (watch, ready, plan): (_, _, &Plan) = (self.session.watch, self.ready, self.ensemble.plan());
        say_notes(&self.session, self.root, &ready.notes);
        for what in &ready.damaged {
            watch.note(&format!("{}: damaged, made again: {what}", self.root.display()));
        }
        if ready.rows > 0 {
            let left = missing.iter().map(|part| part.count as u64).sum::<u64>();
            let there = samples - left.min(samples);
            watch.note(&format!("{}: {} already there, {left} to run", plan.name, counted(there, "sample")));
        }
    }

    /// Reports requested threads without work.
    fn say_idle_threads(&self, parts: usize) {
        if let Some(asked) = self.session.threads
            && parts > 0
            && threads(Some(asked), parts) < asked.get()
        {
            self.session.watch.note(&format!("{} to make: {parts} of {asked} threads busy", counted(parts, "part")));
        }
    }
}
