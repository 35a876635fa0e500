//! `spindrift report`: makes the page of a result again from its rows, and its figures as files.

use std::num::NonZeroUsize;
use std::path::{Path, PathBuf};

use crate::cli::analysis::{Analysed, analyse};
use crate::cli::arguments::ReportOptions;
use crate::cli::command_outcome::{CommandOutcome, Failure};
use crate::cli::input::{isa, plan_of_result};
use crate::cli::screen;
use crate::dataset::atomic;
use crate::dataset::claim::open;
use crate::dataset::manifest::PartRecord;
use crate::dataset::names::REPORT;
use crate::dataset::rows_reader::RowsReader;
use crate::dataset::storage::Disk;
use crate::ensemble::Ensemble;
use crate::report::number::bytes;
use crate::report::page::{Contents, Page, drawing};

/// Runs the command.
///
/// # Errors
/// Where the folder has no finished result, or files cannot be read or written.
pub fn run(options: &ReportOptions) -> Result<CommandOutcome, Failure> {
    let root = &options.folder;
    let (found, _locks) = open(&Disk, root).map_err(Failure::files)?;
    if !found.is_finished {
        let root = root.display();
        return Err(Failure::Input(format!(
            "the result in `{root}` is not finished; the campaign's command continues it"
        )));
    }
    let plan = plan_of_result(root, &found)?;
    let ensemble = Ensemble::new(&plan, isa()?);
    let rows = RowsReader::new(found.row_files(root));
    let parts: Vec<PartRecord> = found.parts().into_values().collect();
    let bands: Vec<PathBuf> =
        parts.iter().flat_map(|part| part.files.iter().skip(1)).map(|file| root.join(&file.name)).collect();
    let analysed = analyse(&plan, &rows, &bands, root, options.threads)?;
    write(&ensemble, (&rows, &parts, &analysed), root, options.threads, options.figures.as_deref())?;
    Ok(CommandOutcome::Done)
}

/// Writes the page of the result in `folder`, with its rows, the records of its parts and what was computed of them, and its figures into `figures`.
///
/// # Errors
/// Where files cannot be read or written.
pub fn write(
    ensemble: &Ensemble<'_>,
    (rows, parts, analysed): (&RowsReader, &[PartRecord], &Analysed),
    folder: &Path,
    threads: Option<NonZeroUsize>,
    figures: Option<&Path>,
) -> Result<(), Failure> {
    let files = parts.iter().flat_map(|part| &part.files).map(|file| (file.name.clone(), file.sha256.clone()));
    let contents = Contents::read(ensemble, rows, threads).map_err(Failure::files)?;
    let contents =
        contents.with_analysis(&analysed.statistics, &analysed.verdicts, analysed.bands.as_ref(), files.collect());
    let page = Page::new(ensemble, &contents);
    let path = folder.join(REPORT);
    let shown = |error: std::io::Error| Failure::Files(format!("{}: {error}", path.display()));
    atomic::write_bytes(&path, page.html.as_bytes()).map_err(shown)?;
    screen::note(&format!("{}: {}", path.display(), bytes(page.html.len() as u64)));
    if let Some(figures) = figures {
        let count = drawing::save(&page.figures, figures).map_err(Failure::files)?;
        screen::note(&format!("{}: {count} figures", figures.display()));
    }
    Ok(())
}
