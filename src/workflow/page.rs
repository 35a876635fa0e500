//! The page of a result, made from its rows, and its figures as files.

use std::path::{Path, PathBuf};

use crate::analysis::fold::Gathered;
use crate::analysis::noise_share::noise_shares;
use crate::analysis::outcomes::outcomes;
use crate::campaign::Plan;
use crate::ensemble::Ensemble;
use crate::findings::end::SummaryEnd;
use crate::findings::number::counted;
use crate::findings::requirement::required;
use crate::findings::shell_word::quoted_path;
use crate::findings::{Finding, Findings, Kind, findings};
use crate::report::figure_files::FigureSheet;
use crate::report::page::runs::{KnownRow, listed};
use crate::report::page::{Contents, Page};
use crate::sampling::SampleId;
use crate::storage::claim::open;
use crate::storage::dataset::{PartRecord, replace_file, rows};
use crate::storage::names::REPORT;
use crate::storage::rows_reader::{RowsError, RowsReader};
use crate::workflow::analysed::{Analysed, computed, end_of_analysed};
use crate::workflow::error::{Result, WorkflowError};
use crate::workflow::session::Session;
use crate::workflow::source::{refuse_missing_law, sound};

#[derive(Clone, Debug)]
pub struct Remade {
    pub path: PathBuf,
    /// Bytes.
    pub size: u64,
    /// The question of the campaign.
    pub question: Option<String>,
    pub end: SummaryEnd,
    /// The share of noise in the outcomes, if requested.
    pub noise: Vec<Finding>,
}

/// Makes the page of the finished result in `root` again, and its figures in the folder `figures`. `noise`: number of
/// scenes flown twice to separate loop noise from draws.
///
/// # Errors
/// No finished result, requested noise without a loop, or a failed file operation.
pub fn remade(session: &Session<'_>, root: &Path, figures: Option<&Path>, noise: Option<u64>) -> Result<Remade> {
    let (store, threads) = (session.store(root)?, session.threads);
    let (there, _lock) = open(&*store, false)?;
    let unfinished = || {
        WorkflowError::Input(format!(
            "the result in `{}` is not finished; the campaign's command continues it, or: spindrift finish {}",
            root.display(),
            quoted_path(root)
        ))
    };
    // a damaged manifest is damage
    if !there.is_finished && there.damage.is_empty() {
        return Err(unfinished());
    }
    let (plan, records) = sound(session, (&*store, &there), Some(REPORT))?;
    let manifest = there.manifest.as_ref().ok_or_else(unfinished)?;
    refuse_missing_law(&plan)?;
    if noise.is_some() && plan.law.is_none() {
        return Err(WorkflowError::Input(format!(
            "campaign {} has no control loop, and without one a run has no noise: leave out --noise",
            plan.name
        )));
    }
    let ensemble = Ensemble::new(&plan, session.isa);
    let reader = rows(&store, &records);
    let gathered = Gathered::of_files(&ensemble, &reader, threads)?;
    let analysed = computed(&plan, &reader, gathered, threads)?;
    let (page, found) = made_page(session, &ensemble, &analysed, (&reader, &records), noise)?;
    let path = root.join(REPORT);
    replace_file(&*store, manifest, (REPORT, page.html.as_bytes()))?;
    save_figures(session, &plan, &page, figures)?;
    let end = end_of_analysed(&analysed, &found);
    let noise = found.of(Kind::Driver).filter(|one| one.id.starts_with("noise_")).cloned().collect();
    Ok(Remade { path, size: page.html.len() as u64, question: plan.description.clone(), end, noise })
}

/// Start of the mark in a page for its number of noise scenes, so that it can be made again.
const NOISE_MARK: &str = "<meta name=\"noise-scenes\" content=\"";
const BEFORE_MARK: &str = "<meta charset=\"utf-8\">\n";

/// The page of a result with the parts `records`, its findings, and the share of noise measured with `scenes`, if any.
///
/// # Errors
/// Threads that cannot start, or unreadable rows.
pub(super) fn made_page(
    session: &Session<'_>,
    ensemble: &Ensemble<'_>,
    analysed: &Analysed,
    (reader, records): (&RowsReader, &[PartRecord]),
    scenes: Option<u64>,
) -> Result<(Page, Findings)> {
    let plan = ensemble.plan();
    let machine = (session.isa, session.threads);
    let noise = scenes.map(|scenes| noise_shares(plan, &outcomes(plan), scenes, machine));
    let noise = noise.transpose().map_err(WorkflowError::files)?.unwrap_or_default();
    let found = findings(plan, analysed, &noise);
    let listed = listed(plan, &analysed.survey, &required(plan, found.of(Kind::Requirement)));
    let samples: Vec<SampleId> = listed.iter().map(|(sample, _)| *sample).collect();
    let rows = rows_of(ensemble, reader, records, &samples)?;
    let files = records.iter().flat_map(|part| &part.files).map(|file| (file.name.clone(), file.sha256.clone()));
    let contents = Contents { analysed, found: &found, listed, rows, files: files.collect() };
    let mut page = Page::new(ensemble, &contents);
    if let Some(text) = &page.left_out {
        session.watch.note(&format!("{REPORT}: {text}"));
    }
    if let Some(scenes) = scenes {
        let marked = format!("{BEFORE_MARK}{NOISE_MARK}{scenes}\">\n");
        page.html = page.html.replacen(BEFORE_MARK, &marked, 1);
    }
    Ok((page, found))
}

/// The rows of `samples`, from their parts.
fn rows_of(
    ensemble: &Ensemble<'_>,
    reader: &RowsReader,
    records: &[PartRecord],
    samples: &[SampleId],
) -> Result<Vec<KnownRow>, RowsError> {
    let plan = ensemble.plan();
    let columns = ensemble.request().columns();
    let inputs = plan.dispersions.columns().iter().map(|column| column.parameter.column_name(column.component));
    let wanted: Vec<String> = columns.iter().map(|column| column.quantity.name().to_owned()).chain(inputs).collect();
    let mut rows = Vec::new();
    for (index, record) in records.iter().enumerate() {
        let part = record.part;
        // chosen samples have their own numbers
        let may_have = |sample: &SampleId| (part.first.0..part.first.0 + part.count as u64).contains(&sample.0);
        let Some(part) = reader.part(index).filter(|_| plan.chosen.is_some() || samples.iter().any(may_have)) else {
            continue;
        };
        let part = part?;
        let all = part.samples()?;
        let places: Vec<usize> = (0..all.len()).filter(|row| samples.contains(&all[*row])).collect();
        if places.is_empty() {
            continue;
        }
        let (statuses, reasons) = (part.statuses()?, part.reasons()?);
        let first = rows.len();
        rows.extend(places.iter().map(|row| KnownRow {
            sample: all[*row],
            status: statuses[*row],
            reason: reasons[*row].clone().unwrap_or_default(),
            numbers: Vec::with_capacity(wanted.len()),
        }));
        for name in &wanted {
            let column = part.numbers(name)?;
            let known = rows[first..].iter_mut().zip(&places);
            known.for_each(|(known, row)| known.numbers.push((name.clone(), column[*row])));
        }
    }
    Ok(rows)
}

/// The number of noise scenes of the page `html`, if any.
pub(super) fn noise_scenes(html: &[u8]) -> Option<u64> {
    let text = std::str::from_utf8(html).ok()?;
    let (_, after) = text.split_once(BEFORE_MARK)?;
    after.strip_prefix(NOISE_MARK)?.split('"').next()?.parse().ok()
}

/// Writes the figures of `page` of the campaign `plan` into `folder`, if any.
pub fn save_figures(session: &Session<'_>, plan: &Plan, page: &Page, folder: Option<&Path>) -> Result<()> {
    let Some(folder) = folder else { return Ok(()) };
    let of = format!("{}: {}.", plan.name, counted(plan.rows(), "run"));
    let sheet = FigureSheet { title: of, figures: page.figures.clone() };
    let (count, note) = sheet.save_all(folder)?;
    session.watch.note(&note.unwrap_or_else(|| format!("{}: {} of figures", folder.display(), counted(count, "file"))));
    Ok(())
}
