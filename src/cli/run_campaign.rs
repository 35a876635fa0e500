//! `spindrift campaign`: runs the missing samples of a campaign and finishes the result.

use std::path::Path;

use crate::cli::arguments::CampaignOptions;
use crate::cli::command_outcome::{CommandOutcome, Failure};
use crate::cli::completed_text;
use crate::cli::screen;
use crate::cli::signals;
use crate::cli::terminal::Terminal;
use crate::control::tables::Overrides;
use crate::findings::number::counted;
use crate::findings::shell_word::quoted_path;
use crate::report::screen::question;
use crate::storage::claim::Shard;
use crate::storage::names::PLAN;
use crate::table::wrapped::wrapped;
use crate::workflow::failed_samples::FailedRun;
use crate::workflow::outputs::{refuse_inputs, refuse_within};
use crate::workflow::{Campaign, CampaignOutcome, Made, PreparedCampaign, Session};

pub fn run(options: &CampaignOptions) -> Result<CommandOutcome, Failure> {
    signals::watch();
    let watch = Terminal::default();
    let session = Session::new(&watch)?.on_threads(options.threads.number);
    let Some(campaign) = campaign(options, session).prepare()? else {
        if let Some(of) = &options.only_failed_of {
            screen::print(&format!("{}: no run failed; nothing to do\n", of.display()))?;
        }
        return Ok(CommandOutcome::Done);
    };
    check(options, &campaign)?;
    let (plan, root) = (campaign.plan(), campaign.root());
    match campaign.run()? {
        CampaignOutcome::Finished(completed) => {
            screen::print(&completed_text::text(&completed, &replayed(options, root), options.verbose))?;
            Ok(CommandOutcome::of_end(&completed.end))
        }
        CampaignOutcome::AlreadyFinished(end) => {
            let outcome = CommandOutcome::of_end(&end);
            let failed = match outcome {
                CommandOutcome::SomeFailed(_) if end.failed > 0 => format!(", {} of them failed", end.failed),
                _ => String::new(),
            };
            let there = format!(
                "{}: already complete in {} ({}{failed}), every checksum verified; nothing to do. --overwrite runs it \
                again.\n",
                plan.name,
                root.display(),
                counted(end.rows, "sample"),
            );
            let question = question(plan.description.as_deref(), screen::width());
            let verdicts = completed_text::of_end(&end, root);
            screen::print(&format!("{question}{}{verdicts}", wrapped(&there, screen::width())))?;
            // verdicts belong to the campaign, not to a shard
            Ok(if options.shard.is_some() { CommandOutcome::Done } else { outcome })
        }
        CampaignOutcome::ShardDone { shard, made } => {
            screen::print(&shard_is_done(&plan.name, shard, root, made))?;
            Ok(CommandOutcome::Done)
        }
        CampaignOutcome::Stopped { samples, left } => {
            let signal = watch.signal().unwrap_or_default();
            screen::note(&format!(
                "{}: stopped by {}; {} of {samples} samples are done and safe. The same command continues.",
                plan.name,
                signals::name(signal),
                samples - left,
            ));
            Ok(CommandOutcome::Stopped(signal))
        }
        CampaignOutcome::FailedFast(failed) => {
            screen::note(&ended_by(&plan.name, &failed, root));
            Ok(CommandOutcome::SomeFailed(1))
        }
    }
}

fn campaign<'a>(options: &CampaignOptions, session: Session<'a>) -> Campaign<'a> {
    let overrides = Overrides { audit_fraction: options.audit, ..options.drawn.overrides(&options.changed) };
    let outputs = options.written.outputs();
    let mut campaign = Campaign::from_file(&options.file, session).with(overrides).outputs(outputs);
    if let Some(root) = &options.out {
        campaign = campaign.store(root);
    }
    if let Some(shard) = options.shard {
        campaign = campaign.shard(shard);
    }
    if let Some(of) = &options.only_failed_of {
        campaign = campaign.only_failed_of(of);
    }
    if options.overwrite {
        campaign = campaign.overwrite();
    }
    if options.fail_fast { campaign.fail_fast() } else { campaign }
}

/// Refuses to overwrite inputs, and excessive work.
fn check(options: &CampaignOptions, campaign: &PreparedCampaign<'_>) -> Result<(), Failure> {
    let root = campaign.root();
    let outputs = options.written.named();
    refuse_inputs(&campaign.files().paths(), &[outputs[0], ("--out", Some(root))])?;
    refuse_within(root, &outputs)?;
    campaign.refuse_work(options.drawn.yes)
}

fn ended_by(name: &str, failed: &FailedRun, root: &Path) -> String {
    format!(
        "{name}: sample {} failed ({}), and --fail-fast ends the campaign; what is done is safe. The same command \
        without it continues.\n  that run again: spindrift simulate {} --sample {}",
        failed.sample,
        failed.what,
        quoted_path(&root.join(PLAN)),
        failed.sample
    )
}

fn shard_is_done(name: &str, shard: Shard, root: &Path, made: Made) -> String {
    format!(
        "{name}: shard {}/{} is complete ({} in {:.2} s). When all are: spindrift finish {}\n",
        shard.number,
        shard.of,
        counted(made.samples, "sample"),
        made.elapsed.as_secs_f64(),
        quoted_path(root)
    )
}

/// The campaign file for replay commands, quoted: this command's file, or the result's plan if options changed numbers.
fn replayed(options: &CampaignOptions, root: &Path) -> String {
    let is_changed = options.drawn.overrides(&options.changed) != Overrides::default();
    if is_changed || options.only_failed_of.is_some() {
        quoted_path(&root.join(PLAN))
    } else {
        quoted_path(&options.file)
    }
}
