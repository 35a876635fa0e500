//! `spindrift verify`: whether a result is what was written, and whether its rows are what the plan says.

use crate::cli::arguments::VerifyOptions;
use crate::cli::command_outcome::{CommandOutcome, Failure};
use crate::cli::terminal::Terminal;
use crate::cli::{completed_text, screen};
use crate::findings::number::counted;
use crate::storage::names::PLAN;
use crate::table::wrapped::wrapped;
use crate::workflow::{Session, Verification, Verified, verify};

/// Runs the command.
///
/// # Errors
/// Where the result is damaged and not repaired, or a file operation fails.
pub fn run(options: &VerifyOptions) -> Result<CommandOutcome, Failure> {
    let watch = Terminal::default();
    let session = Session::new(&watch)?.on_threads(options.threads);
    let wanted = Verification { fraction: options.fraction, repair: options.repair };
    let Some(verified) = verify(&session, &options.folder, wanted)? else {
        return Ok(CommandOutcome::Stopped(watch.signal().unwrap_or_default()));
    };
    let Verified { checked, problems, is_finished, missing, unchecked, completed } = &verified;
    let replayed = options.folder.join(PLAN).display().to_string();
    let completed = completed.as_ref().map(|completed| completed_text::text(completed, &replayed, false));
    let end = match (&completed, is_finished, problems) {
        (Some(_), _, 0) => "sound, and finished now".to_owned(),
        (Some(_), ..) => format!("{}, repaired", counted(*problems, "problem")),
        (None, true, _) => "sound".to_owned(),
        (None, false, _) if *missing > 0 => {
            let parts = counted(*missing, "part");
            format!(
                "what was compared is sound, and the result is not finished: {parts} not made yet; the \
                     campaign's command makes the rest"
            )
        }
        (None, false, _) if unchecked.is_empty() => {
            "what was compared is sound, and the result is not finished: _SUCCESS is missing, or not empty; the \
            campaign's command finishes it"
                .to_owned()
        }
        (None, false, _) => format!(
            "what was compared is sound, and the result is not finished; not compared, since nothing says what should \
            be in them: {}; the campaign's command finishes it and makes them again",
            unchecked.join(", ")
        ),
    };
    let said = wrapped(&format!("{checked}: {end}\n"), screen::width());
    screen::print(&(completed.unwrap_or_default() + &said))?;
    Ok(if *is_finished { CommandOutcome::Done } else { CommandOutcome::Unfinished })
}
