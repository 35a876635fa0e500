//! `spindrift index`: all results below a folder, as table and page.

use crate::cli::arguments::IndexOptions;
use crate::cli::command_outcome::{CommandOutcome, Failure};
use crate::cli::screen;
use crate::cli::terminal::Terminal;
use crate::findings::number::counted;
use crate::findings::results_index::findings;
use crate::report::screen::paragraphs;
use crate::workflow::Session;
use crate::workflow::results_index::written;

pub fn run(options: &IndexOptions) -> Result<CommandOutcome, Failure> {
    let watch = Terminal::default();
    let (index, path) = written(&Session::new(&watch)?, &options.folder)?;
    let table = paragraphs(&findings(&index.entries, &index.unreadable), screen::width());
    screen::print(&format!("{table}{} -> {}\n", counted(index.entries.len(), "result"), path.display()))?;
    Ok(CommandOutcome::Done)
}
