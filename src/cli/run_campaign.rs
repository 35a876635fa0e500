//! `spindrift campaign`: runs the samples of a campaign that are not there yet, and finishes the result.

use std::num::NonZeroUsize;
use std::path::{Path, PathBuf};
use std::time::Duration;

use crate::campaign::{Overrides, Plan};
use crate::cli::arguments::CampaignOptions;
use crate::cli::command_outcome::{CommandOutcome, Failure};
use crate::cli::finish_campaign::{Finishing, finish, outcome_of};
use crate::cli::input::{isa, plan};
use crate::cli::progress::Bar;
use crate::cli::screen;
use crate::cli::signals::{self, Signals};
use crate::dataset::claim::{Claim, ClaimOptions, Ready, Shard, claim};
use crate::dataset::identity::identity;
use crate::dataset::part_sink::{PartSink, write_parts};
use crate::dataset::storage::Disk;
use crate::ensemble::run_cost::parts;
use crate::ensemble::runner::threads;
use crate::ensemble::{Ensemble, Part, RunError, Supervision, run as run_parts};

/// Default folder of results, in the current folder.
const RESULTS: &str = "results";

/// Runs the command.
///
/// # Errors
/// Where the campaign cannot run or its result cannot be written.
pub fn run(options: &CampaignOptions) -> Result<CommandOutcome, Failure> {
    let signals = signals::watch();
    let overrides = Overrides { samples: options.samples, seed: options.seed, audit_fraction: options.audit };
    let plan = plan(&options.file, overrides)?;
    let ensemble = Ensemble::new(&plan, isa()?);
    let root = options.out.clone().unwrap_or_else(|| PathBuf::from(RESULTS).join(&plan.name));
    let readers = threads(options.threads, usize::MAX);
    let claimed = ClaimOptions { overwrite: options.overwrite, shard: options.shard, threads: readers };
    match claim(&Disk, &root, (&plan, &identity(&ensemble)), claimed).map_err(Failure::files)? {
        Claim::Finished(summary) => already_complete(&root, &plan, &summary),
        Claim::Ready(ready) => run_missing(options, &ensemble, *ready, &root, signals),
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
        plan.samples,
    ))?;
    Ok(outcome)
}

/// What was found in the folder, for people.
fn say_what_was_found(plan: &Plan, ready: &Ready, root: &Path, missing: &[Part]) {
    for what in &ready.damaged {
        screen::note(&format!("{}: damaged, made again: {what}", root.display()));
    }
    if ready.rows > 0 {
        let left: usize = missing.iter().map(|part| part.count).sum();
        let name = &plan.name;
        screen::note(&format!("{name}: {} samples are there already, {left} to run", plan.samples - left as u64));
    }
}

fn run_missing(
    options: &CampaignOptions,
    ensemble: &Ensemble<'_>,
    ready: Ready,
    root: &Path,
    signals: &Signals,
) -> Result<CommandOutcome, Failure> {
    let plan = ensemble.plan();
    let parts = parts(plan, ensemble.isa());
    // the last part of fewer samples is made again with its further rows
    let outgrown = ready
        .folder
        .parts()
        .into_iter()
        .filter(|record| parts.part(record.samples().id).is_none_or(|part| part != record.samples()));
    let outgrown: Vec<u64> = outgrown.map(|record| record.part).collect();
    ready.folder.drop_parts(outgrown).map_err(Failure::files)?;
    let mut missing = ready.folder.missing(parts.iter());
    if let Some(Shard { number, of }) = options.shard {
        missing.retain(|part| part.id.0 % of == number - 1);
    }
    say_what_was_found(plan, &ready, root, &missing);
    plan.notes().iter().for_each(|note| screen::note(note));
    if let Some(asked) = options.threads
        && threads(Some(asked), missing.len()) < asked.get()
        && !missing.is_empty()
    {
        screen::note(&format!(
            "{} parts are to be made: {} of {asked} threads have work",
            missing.len(),
            missing.len()
        ));
    }
    let (elapsed, seconds) = run_them(options.threads, ensemble, &ready, &missing, signals)?;
    let left = ready.folder.missing(parts.iter());
    let mine = |part: &&Part| options.shard.is_none_or(|shard| part.id.0 % shard.of == shard.number - 1);
    if let Some(signal) = signals.first()
        && left.iter().any(|part| mine(&part))
    {
        return Ok(stopped(signal, plan, left.iter().map(|part| part.count as u64).sum()));
    }
    let made = missing.iter().map(|part| part.count as u64).sum();
    match options.shard {
        Some(shard) => shard_is_done(shard, plan, root, (made, elapsed)),
        None => finish(&Finishing {
            ensemble,
            ready: &ready,
            root,
            threads: options.threads,
            replayed: &replayed(options, root),
            junit: options.junit.as_deref(),
            page: (!options.no_report, options.figures.as_deref()),
            made: Some((made, elapsed)),
            seconds,
        }),
    }
}

/// Runs `missing`; the elapsed time, and the CPU time of runs and audits, s.
fn run_them(
    threads: Option<NonZeroUsize>,
    ensemble: &Ensemble<'_>,
    ready: &Ready,
    missing: &[Part],
    signals: &Signals,
) -> Result<(Duration, [f64; 2]), Failure> {
    let bar = Bar::new(missing.iter().map(|part| part.count as u64).sum());
    let progress = |samples| bar.advance(samples);
    let supervision = Supervision { progress: &progress, stop: &signals.stop, abandon: &signals.abandon };
    let ended = write_parts(&ready.folder, ensemble, |sink: &PartSink| {
        run_parts(ensemble, missing.iter().copied(), threads, sink, supervision).map(|()| sink.seconds())
    });
    let elapsed = bar.finish();
    match ended.map_err(Failure::files)? {
        Ok(seconds) => Ok((elapsed, seconds)),
        Err(error @ RunError::Threads(_)) => Err(Failure::Input(error.to_string())),
        Err(RunError::Sink(error)) => Err(Failure::files(error)),
    }
}

fn stopped(signal: i32, plan: &Plan, left: u64) -> CommandOutcome {
    screen::note(&format!(
        "{}: stopped by {}; {} of {} samples are done and safe. The same command continues.",
        plan.name,
        signals::name(signal),
        plan.samples - left,
        plan.samples
    ));
    CommandOutcome::Stopped(signal)
}

fn shard_is_done(
    shard: Shard,
    plan: &Plan,
    root: &Path,
    (made, elapsed): (u64, Duration),
) -> Result<CommandOutcome, Failure> {
    screen::print(&format!(
        "{}: shard {}/{} is complete ({made} samples in {:.2} s). When all are: spindrift finish {}\n",
        plan.name,
        shard.number,
        shard.of,
        elapsed.as_secs_f64(),
        root.display()
    ))?;
    Ok(CommandOutcome::Done)
}

/// The campaign file as `simulate` takes it: the file of this command, or the plan in the result where options replaced its
/// numbers.
fn replayed(options: &CampaignOptions, root: &Path) -> String {
    let is_changed = options.samples.is_some() || options.seed.is_some();
    if is_changed { root.join("plan.toml").display().to_string() } else { options.file.display().to_string() }
}
