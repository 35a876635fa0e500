//! `spindrift report`: makes the page of a finished result again from its rows, and its figures as files.

use std::path::Path;

use crate::analysis::fold::Gathered;
use crate::cli::analysis::{Analysed, computed};
use crate::cli::arguments::ReportOptions;
use crate::cli::command_outcome::{CommandOutcome, Failure};
use crate::cli::input::{isa, plan_of_sound};
use crate::cli::outputs::refuse_within;
use crate::cli::screen;
use crate::cli::shell_word::quoted_path;
use crate::ensemble::Ensemble;
use crate::report::number::bytes;
use crate::report::page::gather::Analysis;
use crate::report::page::{Contents, Page, drawing};
use crate::storage::claim::open;
use crate::storage::disk::{Disk, Storage};
use crate::storage::folder::relist;
use crate::storage::manifest::{FileRecord, PartRecord};
use crate::storage::names::{MANIFEST, REPORT};
use crate::storage::parts_read::PartsRead;
use crate::storage::rows_reader::RowsReader;
use crate::storage::whole_file::place;

/// Runs the command.
///
/// # Errors
/// Where the folder has no finished result, or files cannot be read or written.
pub fn run(options: &ReportOptions) -> Result<CommandOutcome, Failure> {
    screen::print(&remade(&Disk, options)?)?;
    Ok(CommandOutcome::Done)
}

/// Does what the command says; what it prints.
///
/// # Errors
/// As [`run`].
pub fn remade(storage: &'static dyn Storage, options: &ReportOptions) -> Result<String, Failure> {
    let root = &options.folder;
    refuse_within(root, &[("--figures", options.figures.as_deref())])?;
    let (found, _locks) = open(storage, root, false).map_err(Failure::files)?;
    let Some(manifest) = found.manifests.get(MANIFEST).filter(|_| found.is_finished) else {
        return Err(Failure::Input(format!(
            "the result in `{}` is not finished; the campaign's command continues it, or: spindrift finish {}",
            root.display(),
            quoted_path(root)
        )));
    };
    let plan = plan_of_sound(storage, (root, &found), options.threads, Some(REPORT))?;
    let ensemble = Ensemble::new(&plan, isa()?);
    let records: Vec<PartRecord> = found.parts().into_values().collect();
    let parts = PartsRead::of(&records, |name| root.join(name));
    let reader = RowsReader::new(storage, parts.rows);
    let gathered = Gathered::of_files(&ensemble, (&reader, &parts.bands), options.threads).map_err(Failure::files)?;
    let analysed = computed(&plan, &reader, gathered, options.threads)?;
    let page = page(&ensemble, &analysed, &records);
    let path = root.join(REPORT);
    place(storage, &path, page.html.as_bytes()).map_err(Failure::files)?;
    relist(storage, root, (manifest, &found.plan), FileRecord::of(REPORT, page.html.as_bytes()))
        .map_err(Failure::files)?;
    save_figures(&page, options.figures.as_deref())?;
    Ok(format!("{}: {}\n", path.display(), bytes(page.html.len() as u64)))
}

/// The page of a result whose parts are `records`.
pub fn page(ensemble: &Ensemble<'_>, analysed: &Analysed, records: &[PartRecord]) -> Page {
    let analysis = Analysis {
        statistics: &analysed.statistics,
        verdicts: &analysed.verdicts,
        sensitivities: &analysed.sensitivities,
        bands: analysed.bands.as_ref(),
        stopping: analysed.stopping.as_ref(),
    };
    let files = records.iter().flat_map(|part| &part.files).map(|file| (file.name.clone(), file.sha256.clone()));
    let contents = Contents::new(ensemble.plan(), analysed.survey.clone(), analysis, files.collect());
    Page::new(ensemble, &contents)
}

/// Writes the figures of `page` as files into `folder`, if one was named.
///
/// # Errors
/// Where a file cannot be written.
pub fn save_figures(page: &Page, folder: Option<&Path>) -> Result<(), Failure> {
    let Some(folder) = folder else { return Ok(()) };
    let count = drawing::save(&page.figures, folder).map_err(Failure::files)?;
    screen::note(&format!("{}: {count} files of figures", folder.display()));
    Ok(())
}
