//! `spindrift report`: rebuilds the page of a finished result, and its figures as files.

use crate::cli::arguments::ReportOptions;
use crate::cli::command_outcome::{CommandOutcome, Failure};
use crate::cli::screen;
use crate::cli::terminal::Terminal;
use crate::findings::number::bytes;
use crate::table::wrapped::wrapped;
use crate::workflow::Session;
use crate::workflow::outputs::refuse_within;
use crate::workflow::page::{Remade, remade};

pub fn run(options: &ReportOptions) -> Result<CommandOutcome, Failure> {
    let watch = Terminal::default();
    refuse_within(&options.folder, &[("--figures", options.figures.as_deref())])?;
    let session = Session::new(&watch)?.on_threads(options.threads.number);
    let figures = options.figures.as_deref();
    let Remade { path, size, question, end, noise } = remade(&session, &options.folder, figures, options.noise)?;
    let question = crate::report::screen::question(question.as_deref(), screen::width());
    let verdict = end.verdict_line(&path);
    let noise: String = noise.iter().map(|one| format!("  {}: {}\n", one.title, one.sentence)).collect();
    let noise = wrapped(&noise, screen::width());
    screen::print(&format!("{question}{noise}{verdict} ({})\n", bytes(size)))?;
    Ok(CommandOutcome::Done)
}
