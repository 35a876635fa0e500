//! `spindrift campaign`: runs every sample of a campaign and writes rows and summary.

use std::path::{Path, PathBuf};
use std::time::Duration;

use crate::campaign::{Overrides, Plan};
use crate::cli::arguments::CampaignOptions;
use crate::cli::command_outcome::{CommandOutcome, Failure};
use crate::cli::input::{isa, plan};
use crate::cli::progress::Bar;
use crate::cli::screen;
use crate::dataset::folder::{Claim, Folder};
use crate::dataset::part_sink::PartSink;
use crate::ensemble::{Ensemble, Parts, RunError, run as run_parts};
use crate::report::audit_summary::cost;
use crate::report::number::bytes;
use crate::report::summary::{Summary, failed_runs};

/// Default folder of results, in the current folder.
const RESULTS: &str = "results";

/// Runs the command.
///
/// # Errors
/// Where the campaign cannot run or its result cannot be written.
pub fn run(options: &CampaignOptions) -> Result<CommandOutcome, Failure> {
    let overrides = Overrides { samples: options.samples, seed: options.seed, audit_fraction: options.audit };
    let plan = plan(&options.file, overrides)?;
    let isa = isa()?;
    let root = options.out.clone().unwrap_or_else(|| PathBuf::from(RESULTS).join(&plan.name));
    match Folder::claim(&root, &plan, options.overwrite).map_err(Failure::files)? {
        Claim::Finished(summary) => already_complete(&root, &plan, &summary),
        Claim::Ready(folder) => run_all(options, &plan, &Ensemble::new(&plan, isa), &folder, &root),
    }
}

fn already_complete(root: &Path, plan: &Plan, summary: &str) -> Result<CommandOutcome, Failure> {
    let failed = match failed_runs(summary) {
        Some(0) | None => String::new(),
        Some(failed) => format!(", {failed} of them failed"),
    };
    screen::print(&format!(
        "{}: already complete in {} ({} samples{failed}); nothing to do. --overwrite runs it again.\n",
        plan.name,
        root.display(),
        plan.samples,
    ))?;
    Ok(CommandOutcome::Done)
}

fn run_all(
    options: &CampaignOptions,
    plan: &Plan,
    ensemble: &Ensemble<'_>,
    folder: &Folder,
    root: &Path,
) -> Result<CommandOutcome, Failure> {
    if folder.restarted {
        screen::note(&format!("{}: unfinished result in {}, starting again", plan.name, root.display()));
    }
    plan.notes().iter().for_each(|note| screen::note(note));
    let sink = PartSink::new(folder, ensemble).map_err(Failure::files)?;
    let parts = Parts::of(plan.samples);
    let bar = Bar::new(plan.samples);
    let ended = run_parts(ensemble, parts, options.threads, &sink, &|samples| bar.advance(samples));
    let elapsed = bar.finish();
    ended.map_err(|error| match error {
        RunError::Threads(_) => Failure::Input(error.to_string()),
        RunError::Sink(_) => Failure::files(error),
    })?;
    let tally = sink.into_tally();
    let summary = Summary::new(plan, &tally);
    folder.finish(&summary.json()).map_err(Failure::files)?;
    let size = folder.size().map_err(Failure::files)?;
    let audits = tally.audits().map_or(String::new(), |audits| format!("\n  audits: {}\n", cost(audits)));
    screen::print(&format!(
        "{}\n{summary}{audits}\n{}\n  {}: {} file{} of rows, {}\n",
        headline(plan, &summary, elapsed),
        summary.replay(&replayed(options, root)),
        root.display(),
        parts.count(),
        if parts.count() == 1 { "" } else { "s" },
        bytes(size),
    ))?;
    Ok(match tally.failed() {
        0 => CommandOutcome::Done,
        failed => CommandOutcome::SomeFailed(failed),
    })
}

/// The campaign file as `simulate` takes it: the file of this command, or the plan in the result where options replaced its
/// numbers.
fn replayed(options: &CampaignOptions, root: &Path) -> String {
    let is_changed = options.samples.is_some() || options.seed.is_some();
    if is_changed { root.join("plan.toml").display().to_string() } else { options.file.display().to_string() }
}

fn headline(plan: &Plan, summary: &Summary, elapsed: Duration) -> String {
    let seconds = elapsed.as_secs_f64();
    let rate = plan.samples as f64 / seconds.max(1e-9);
    let (name, samples, seed) = (&plan.name, plan.samples, plan.seed);
    format!("{name}: {samples} samples ({}) in {seconds:.2} s ({rate:.0}/s), seed {seed}", summary.samples())
}
