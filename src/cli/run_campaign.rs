//! `spindrift campaign`: runs the samples of a campaign that are not there yet, and finishes the result.

use std::num::NonZeroUsize;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};
use std::time::Duration;

use crate::analysis::fold::RunningFold;
use crate::analysis::stopping::look;
use crate::campaign::{Overrides, Plan};
use crate::cli::arguments::CampaignOptions;
use crate::cli::command_outcome::{CommandOutcome, Failure};
use crate::cli::failed_samples::{FailFast, FailedRun, first_failed, plan_of_failed};
use crate::cli::finish_campaign::{Finishing, finish, keep_data, outcome_of, rows_of, say_notes};
use crate::cli::input::{isa, plan_and_files};
use crate::cli::outputs::{refuse_inputs, refuse_within};
use crate::cli::progress::Bar;
use crate::cli::screen;
use crate::cli::shell_word::quoted_path;
use crate::cli::signals::{self, Signals};
use crate::cli::workload::Workload;
use crate::ensemble::run_cost::parts;
use crate::ensemble::runner::threads;
use crate::ensemble::{Ensemble, Part, Parts, Supervision, run as run_parts};
use crate::report::stopping_text::text as stopping_text;
use crate::report::summary::rows_in;
use crate::storage::claim::{Claim, ClaimOptions, Ready, Shard, claim};
use crate::storage::disk::Disk;
use crate::storage::manifest::PartRecord;
use crate::storage::names::PLAN;
use crate::storage::part_sink::{CountRows, PartSink, write_parts};
use crate::storage::rows_file::identity;

/// Default folder of results, in the current folder.
pub const RESULTS: &str = "results";

/// Runs the command.
///
/// # Errors
/// Where the campaign cannot run or its result cannot be written.
pub fn run(options: &CampaignOptions) -> Result<CommandOutcome, Failure> {
    let signals = signals::watch();
    let overrides = Overrides { samples: options.samples, seed: options.seed, audit_fraction: options.audit };
    let (plan, files) = match &options.only_failed_of {
        None => plan_and_files(&options.file, overrides)?,
        Some(of) => match plan_of_failed(&options.file, of, overrides, options.threads)? {
            Some(found) => found,
            None => {
                screen::print(&format!("{}: no run failed; nothing to do\n", of.display()))?;
                return Ok(CommandOutcome::Done);
            }
        },
    };
    if let Some(shard) = options.shard {
        refuse_shards_with_stop(&plan, &format!("--shard {}/{}", shard.number, shard.of))?;
    }
    let ensemble = Ensemble::new(&plan, isa()?);
    let root = options.out.clone().unwrap_or_else(|| PathBuf::from(RESULTS).join(&plan.name));
    let outputs = [("--junit", options.junit.as_deref()), ("--figures", options.figures.as_deref())];
    refuse_inputs(&files.paths(), &[outputs[0], ("--out", Some(&root))])?;
    refuse_within(&root, &outputs)?;
    let there = Some(root.as_path()).filter(|_| !options.overwrite);
    let work = |samples| {
        Workload::of_campaign((&ensemble, samples), there, options.shard, options.threads).measured(&ensemble)
    };
    let looks = plan.looks();
    if let [first, .., last] = looks[..] {
        work(first).check(&root, options.yes, options.shard.is_some())?;
        work(last).check_limit(&root, options.yes)?;
    } else {
        work(plan.rows()).check(&root, options.yes, options.shard.is_some())?;
    }
    let readers = threads(options.threads, usize::MAX);
    let claimed = ClaimOptions { overwrite: options.overwrite, shard: options.shard, threads: readers };
    match claim(&Disk, &root, (&plan, &identity(&ensemble)), claimed).map_err(Failure::files)? {
        Claim::Finished(finished) => {
            say_notes(&root, &finished.notes);
            let outcome = already_complete(&root, &plan, &finished.summary)?;
            // the verdicts are those of the campaign, not of a shard
            Ok(if options.shard.is_some() { CommandOutcome::Done } else { outcome })
        }
        Claim::Ready(ready) => {
            keep_data(&ready.folder, &files)?;
            run_missing(options, &ensemble, *ready, &root, signals)
        }
    }
}

/// Refuses `what`, which divides the campaign into shards, where the plan has `[stop]`.
///
/// # Errors
/// Where it has.
pub fn refuse_shards_with_stop(plan: &Plan, what: &str) -> Result<(), Failure> {
    match plan.analysis.stop {
        None => Ok(()),
        Some(_) => Err(Failure::Input(format!(
            "{what}: must be left out with [stop], which looks at all samples before it runs more; delete [stop], or run without shards"
        ))),
    }
}

fn already_complete(root: &Path, plan: &Plan, summary: &str) -> Result<CommandOutcome, Failure> {
    let outcome = outcome_of(summary);
    let failed = match outcome {
        CommandOutcome::SomeFailed(failed) => format!(", {failed} of them failed"),
        _ => String::new(),
    };
    screen::print(&format!(
        "{}: already complete in {} ({} samples{failed}), every checksum verified; nothing to do. --overwrite runs it again.\n",
        plan.name,
        root.display(),
        rows_in(summary).unwrap_or(plan.rows()),
    ))?;
    Ok(outcome)
}

/// What was found in the folder, for people; `samples` are those that this process has to make.
fn say_what_was_found(plan: &Plan, ready: &Ready, root: &Path, samples: u64, missing: &[Part]) {
    say_notes(root, &ready.notes);
    for what in &ready.damaged {
        screen::note(&format!("{}: damaged, made again: {what}", root.display()));
    }
    if ready.rows > 0 {
        let left = missing.iter().map(|part| part.count as u64).sum::<u64>();
        let there = samples - left.min(samples);
        screen::note(&format!("{}: {there} samples are there already, {left} to run", plan.name));
    }
}

/// Says that some of the threads that were asked for have no work.
fn say_idle_threads(asked: Option<NonZeroUsize>, parts: usize) {
    if let Some(asked) = asked
        && parts > 0
        && threads(Some(asked), parts) < asked.get()
    {
        screen::note(&format!("{parts} parts are to be made: {parts} of {asked} threads have work"));
    }
}

/// Runs what is missing, look by look where the plan has `[stop]`, and finishes the result.
fn run_missing(
    options: &CampaignOptions,
    ensemble: &Ensemble<'_>,
    ready: Ready,
    root: &Path,
    signals: &Signals,
) -> Result<CommandOutcome, Failure> {
    let plan = ensemble.plan();
    let parts = parts(plan, ensemble.isa());
    let mut made = Made::default();
    // what is there already was counted by no one
    let is_whole = ready.folder.parts().is_empty() && options.shard.is_none() && plan.analysis.stop.is_none();
    let counts = if is_whole { RunningFold::of(ensemble) } else { None };
    plan.notes().iter().for_each(|note| screen::note(note));
    let targets = plan.looks();
    let mut samples = targets.last().copied().unwrap_or(plan.samples);
    // looks at fewer samples than there are rows have been taken
    for target in targets.into_iter().filter(|target| *target >= ready.rows) {
        samples = target;
        if let Some(outcome) =
            run_to(options, ensemble, (&ready, root), parts.with_samples(target), counts.as_ref(), signals, &mut made)?
        {
            return Ok(outcome);
        }
        let (rows, bands) = rows_of(&ready);
        match look(plan, (&rows, &bands), target, options.threads).map_err(Failure::files)? {
            Some(found) if !found.ends() => screen::note(&format!("{}: {}", plan.name, stopping_text(plan, &found))),
            _ => break,
        }
    }
    let plan = plan.clone().at_look(samples);
    let stopped = Ensemble::new(&plan, ensemble.isa());
    let job = Finishing {
        ensemble: &stopped,
        ready: &ready,
        root,
        threads: options.threads,
        replayed: &replayed(options, root),
        junit: options.junit.as_deref(),
        page: (!options.no_report, options.figures.as_deref()),
        made: Some((made.samples, made.elapsed)),
        seconds: made.seconds,
    };
    finish(&job, counts.and_then(|counts| counts.whole(parts.with_samples(samples))))
}

/// What this process has run.
#[derive(Clone, Copy, Debug, Default)]
struct Made {
    samples: u64,
    elapsed: Duration,
    /// CPU time of runs and audits, s.
    seconds: [f64; 2],
}

/// Runs those of `parts` that are missing; an outcome where that ends the command: a signal, or a shard.
fn run_to(
    options: &CampaignOptions,
    ensemble: &Ensemble<'_>,
    (ready, root): (&Ready, &Path),
    parts: Parts,
    counts: Option<&RunningFold>,
    signals: &Signals,
    made: &mut Made,
) -> Result<Option<CommandOutcome>, Failure> {
    let plan = ensemble.plan();
    let is_mine = |part: &Part| options.shard.is_none_or(|shard| part.id.0 % shard.of == shard.number - 1);
    // a last part of fewer samples is made again with its further rows
    let is_outgrown = |record: &PartRecord| {
        is_mine(&record.samples()) && parts.part(record.samples().id).is_none_or(|part| part != record.samples())
    };
    let outgrown: Vec<u64> =
        ready.folder.parts().iter().filter(|record| is_outgrown(record)).map(|record| record.part).collect();
    ready.folder.drop_parts(outgrown).map_err(Failure::files)?;
    let mut missing = ready.folder.missing(parts.iter());
    missing.retain(is_mine);
    if made.samples == 0 {
        let samples = parts.iter().filter(is_mine).map(|part| part.count as u64).sum();
        say_what_was_found(plan, ready, root, samples, &missing);
        say_idle_threads(options.threads, missing.len());
    }
    if options.fail_fast
        && let Some(failed) = first_failed(&rows_of(ready).0).map_err(Failure::files)?
    {
        return Ok(Some(ended_by(&failed, plan, root)));
    }
    let first = Mutex::new(None);
    let (elapsed, seconds) = run_them(options, ensemble, (ready, &missing), counts, (signals, &first))?;
    if let Some(failed) = first.into_inner().unwrap_or_else(PoisonError::into_inner) {
        return Ok(Some(ended_by(&failed, plan, root)));
    }
    made.samples += missing.iter().map(|part| part.count as u64).sum::<u64>();
    made.elapsed += elapsed;
    made.seconds.iter_mut().zip(seconds).for_each(|(sum, seconds)| *sum += seconds);
    let left = ready.folder.missing(parts.iter());
    if let Some(signal) = signals.first()
        && left.iter().any(is_mine)
    {
        let left = left.iter().map(|part| part.count as u64).sum();
        return Ok(Some(stopped(signal, plan, parts.samples(), left)));
    }
    options.shard.map(|shard| shard_is_done(shard, plan, root, *made)).transpose()
}

/// Runs `missing`; the elapsed time, and the CPU time of runs and audits, s.
fn run_them(
    options: &CampaignOptions,
    ensemble: &Ensemble<'_>,
    (ready, missing): (&Ready, &[Part]),
    counts: Option<&RunningFold>,
    (signals, first): (&Signals, &Mutex<Option<FailedRun>>),
) -> Result<(Duration, [f64; 2]), Failure> {
    let bar = Bar::new(missing.iter().map(|part| part.count as u64).sum());
    let progress = |samples| bar.advance(samples);
    let supervision = Supervision { progress: &progress, stop: &signals.stop, abandon: &signals.abandon };
    let ended =
        write_parts(&ready.folder, ensemble, counts.map(|counts| counts as &dyn CountRows), |sink: &PartSink<'_>| {
            let watched = FailFast { sink, is_on: options.fail_fast, stop: &signals.stop, first };
            run_parts(ensemble, missing.iter().copied(), options.threads, &watched, supervision)
                .map(|()| sink.seconds())
        });
    let elapsed = bar.finish();
    match ended.map_err(Failure::files)? {
        Ok(seconds) => Ok((elapsed, seconds)),
        Err(error) => Err(Failure::files(error)),
    }
}

fn ended_by(failed: &FailedRun, plan: &Plan, root: &Path) -> CommandOutcome {
    screen::note(&format!(
        "{}: sample {} failed ({}), and --fail-fast ends the campaign; what is done is safe. The same command without it continues.\n  that run again: spindrift simulate {} --sample {}",
        plan.name,
        failed.sample,
        failed.what,
        quoted_path(&root.join(PLAN)),
        failed.sample
    ));
    CommandOutcome::SomeFailed(1)
}

fn stopped(signal: i32, plan: &Plan, samples: u64, left: u64) -> CommandOutcome {
    screen::note(&format!(
        "{}: stopped by {}; {} of {samples} samples are done and safe. The same command continues.",
        plan.name,
        signals::name(signal),
        samples - left,
    ));
    CommandOutcome::Stopped(signal)
}

fn shard_is_done(shard: Shard, plan: &Plan, root: &Path, made: Made) -> Result<CommandOutcome, Failure> {
    screen::print(&format!(
        "{}: shard {}/{} is complete ({} samples in {:.2} s). When all are: spindrift finish {}\n",
        plan.name,
        shard.number,
        shard.of,
        made.samples,
        made.elapsed.as_secs_f64(),
        quoted_path(root)
    ))?;
    Ok(CommandOutcome::Done)
}

/// The campaign file as a word of the command `simulate`: the file of this command, or the plan in the result where options replaced its
/// numbers.
fn replayed(options: &CampaignOptions, root: &Path) -> String {
    let is_changed = options.samples.is_some() || options.seed.is_some() || options.only_failed_of.is_some();
    if is_changed { quoted_path(&root.join(PLAN)) } else { quoted_path(&options.file) }
}
