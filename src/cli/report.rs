//! `spindrift report`: makes the page of a finished result again from its rows, and its figures as files.

use crate::cli::arguments::ReportOptions;
use crate::cli::command_outcome::{CommandOutcome, Failure};
use crate::cli::outputs::refuse_within;
use crate::cli::screen;
use crate::cli::terminal::Terminal;
use crate::report::noise_text;
use crate::report::number::bytes;
use crate::workflow::Session;
use crate::workflow::page::{Remade, remade};

/// Runs the command.
///
/// # Errors
/// Where the folder has no finished result, or files cannot be read or written.
pub fn run(options: &ReportOptions) -> Result<CommandOutcome, Failure> {
    let watch = Terminal::default();
    refuse_within(&options.folder, &[("--figures", options.figures.as_deref())])?;
    let session = Session::new(&watch)?.on_threads(options.threads);
    let figures = options.figures.as_deref().map(|folder| (folder, options.size.of()));
    let Remade { path, size, noise } = remade(&session, &options.folder, figures, options.noise)?;
    screen::print(&noise_text::lines(&noise))?;
    screen::print(&format!("{}: {}\n", path.display(), bytes(size)))?;
    Ok(CommandOutcome::Done)
}
