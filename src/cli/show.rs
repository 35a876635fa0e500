//! `spindrift show`: prints a finished result again, as text or as its `summary.json`.

use crate::cli::arguments::ShowOptions;
use crate::cli::command_outcome::{CommandOutcome, Failure};
use crate::cli::terminal::Terminal;
use crate::cli::{completed_text, screen};
use crate::findings::shell_word::quoted_path;
use crate::storage::names::PLAN;
use crate::workflow::outcome::again;
use crate::workflow::{Results, Session};

pub fn run(options: &ShowOptions) -> Result<CommandOutcome, Failure> {
    let watch = Terminal::default();
    let results = Results::open(&options.folder, Session::new(&watch)?.on_threads(options.threads.number))?;
    let (completed, json) = again(&results)?;
    let text = match options.json {
        true => json,
        false => completed_text::text(&completed, &quoted_path(&options.folder.join(PLAN)), options.verbose),
    };
    screen::print(&text)?;
    Ok(CommandOutcome::of_end(&completed.end))
}
