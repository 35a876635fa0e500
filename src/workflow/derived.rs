//! [`derive`]: makes the files that follow from plan and rows, for the end of a campaign ([`super::finishing`]) and for
//! `verify` ([`super::derived_check`]).

use std::fmt::Display;

use crate::analysis::fold::Gathered;
use crate::analysis::{derived_table, sensitivity_table, statistics_table, trajectories};
use crate::ensemble::Ensemble;
use crate::findings::{Findings, findings};
use crate::report::page::Page;
use crate::report::summary;
use crate::sampling::SampleId;
use crate::storage::bands_table;
use crate::storage::columnar::{self, Packing};
use crate::storage::dataset::PartRecord;
use crate::storage::identity::provenance;
use crate::storage::names::{BANDS, OBSERVABLES, REPORT, SENSITIVITY, STATISTICS, SUMMARY};
use crate::storage::rows_reader::RowsReader;
use crate::storage::store::StoreError;
use crate::table::Table;
use crate::workflow::analysed::{Analysed, computed};
use crate::workflow::error::{Result, WorkflowError};
use crate::workflow::page::made_page;
use crate::workflow::session::Session;

/// Takes a file by name, from any thread; without content if the dataset lacks it.
pub(super) type TakeFile<'a> = dyn Fn(&str, Option<&[u8]>) -> Result<(), StoreError> + Sync + 'a;

/// A dataset with all its rows.
#[derive(Clone, Copy)]
pub(super) struct Derivation<'a> {
    pub session: Session<'a>,
    pub ensemble: &'a Ensemble<'a>,
    pub reader: &'a RowsReader,
    pub records: &'a [PartRecord],
    /// The page, if any, with its number of scenes flown twice to measure noise.
    pub page: Option<Option<u64>>,
    /// Samples with time series.
    pub retained: &'a [SampleId],
}

pub(super) struct Derived {
    pub analysed: Analysed,
    pub page: Option<Page>,
    pub findings: Findings,
}

/// Makes the files from `gathered` and passes each to `files`.
///
/// # Errors
/// A file that cannot be read, encoded or taken.
pub(super) fn derive(job: &Derivation<'_>, gathered: Gathered, files: &TakeFile<'_>) -> Result<Derived> {
    let (plan, threads) = (job.ensemble.plan(), job.session.threads);
    let analysed = computed(plan, job.reader, gathered, threads)?;
    let encoded = |table: Table<'_>| Some(columnar::encoded(&table, provenance(plan), Packing::Zstd));
    take(files, STATISTICS, encoded(statistics_table::table(&analysed.statistics)))?;
    take(files, SENSITIVITY, encoded(sensitivity_table::table(&analysed.sensitivities)))?;
    take(files, OBSERVABLES, derived_table::encoded(plan, job.reader).transpose())?;
    take(files, BANDS, analysed.bands.as_ref().map(|bands| bands_table::file(plan, bands)))?;
    trajectories::save(plan, job.retained, (job.ensemble.isa(), threads), &|name, bytes| files(name, Some(bytes)))?;
    let made = |noise| made_page(&job.session, job.ensemble, &analysed, (job.reader, job.records), noise);
    let page = job.page.map(made).transpose()?.map(|(page, _)| page);
    take(files, REPORT, page.as_ref().map(|page| Ok::<_, WorkflowError>(page.html.clone().into_bytes())))?;
    let findings = findings(plan, &analysed, &[]);
    let text = summary::json(plan, &analysed, &findings);
    take(files, SUMMARY, Some(Ok::<_, WorkflowError>(text.into_bytes())))?;
    Ok(Derived { analysed, page, findings })
}

/// Passes the file `name`, or the failure of its encoding, to `files`.
fn take<E: Display>(files: &TakeFile<'_>, name: &str, encoded: Option<Result<Vec<u8>, E>>) -> Result<()> {
    let bytes = encoded.transpose().map_err(|error| WorkflowError::files(format!("{name}: {error}")))?;
    files(name, bytes.as_deref()).map_err(WorkflowError::files)
}
