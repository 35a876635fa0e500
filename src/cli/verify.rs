//! `spindrift verify`: checks files of a result against their checksums, and rows against the plan.

use crate::cli::arguments::VerifyOptions;
use crate::cli::command_outcome::{CommandOutcome, Failure};
use crate::cli::terminal::Terminal;
use crate::cli::{completed_text, screen};
use crate::report::screen::paragraphs;
use crate::storage::names::PLAN;
use crate::workflow::{Session, Verification, Verified, verify};

pub fn run(options: &VerifyOptions) -> Result<CommandOutcome, Failure> {
    let watch = Terminal::default();
    let session = Session::new(&watch)?.on_threads(options.threads.number);
    let wanted = Verification { fraction: options.fraction, repair: options.repair };
    let Some(verified) = verify(&session, &options.folder, wanted)? else {
        return Ok(CommandOutcome::Stopped(watch.signal().unwrap_or_default()));
    };
    let Verified { checked, completed } = &verified;
    let replayed = options.folder.join(PLAN).display().to_string();
    let completed = completed.as_ref().map(|completed| completed_text::text(completed, &replayed, false));
    let said = paragraphs(&[checked.finding(completed.is_some())], screen::width());
    screen::print(&(completed.unwrap_or_default() + &said))?;
    Ok(if checked.is_finished { CommandOutcome::Done } else { CommandOutcome::Unfinished })
}
