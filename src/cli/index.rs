//! `spindrift index`: a table and a page of all results below a folder.

use crate::cli::arguments::IndexOptions;
use crate::cli::command_outcome::{CommandOutcome, Failure};
use crate::cli::screen;
use crate::cli::terminal::Terminal;
use crate::findings::number::counted;
use crate::findings::results_index::findings;
use crate::report::index_page;
use crate::report::screen::paragraphs;
use crate::storage::atomic;
use crate::workflow::Session;
use crate::workflow::results_index::{ResultsIndex, indexed};

/// The name of the page.
const PAGE: &str = "index.html";

pub fn run(options: &IndexOptions) -> Result<CommandOutcome, Failure> {
    let watch = Terminal::default();
    let root = &options.folder;
    let ResultsIndex { entries, unreadable } = indexed(&Session::new(&watch)?, root)?;
    if entries.is_empty() && unreadable.is_empty() {
        return Err(Failure::Input(format!("there is no result of spindrift in `{}` or below it", root.display())));
    }
    let mut folders = entries.iter().map(|one| &one.folder).chain(unreadable.iter().map(|one| &one.folder));
    if folders.any(|folder| folder.as_os_str().is_empty()) {
        return Err(Failure::Input(format!(
            "`{}` is itself a result, in which nothing else is written; name the folder above it",
            root.display()
        )));
    }
    let name = root.canonicalize().ok().and_then(|path| Some(path.file_name()?.to_string_lossy().into_owned()));
    let html = index_page::html(&name.unwrap_or_else(|| "results".to_owned()), &entries, &unreadable);
    let path = root.join(PAGE);
    atomic::write_bytes(&path, html.as_bytes())
        .map_err(|error| Failure::Files(format!("{}: {error}", path.display())))?;
    let table = paragraphs(&findings(&entries, &unreadable), screen::width());
    screen::print(&format!("{table}{} -> {}\n", counted(entries.len(), "result"), path.display()))?;
    Ok(CommandOutcome::Done)
}
