//! [`derive`]: makes the files that follow from plan and rows, one after another. A campaign that ends writes them
//! ([`super::finishing`]), and `verify` compares them with those that are there ([`super::derived_check`]).

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
use crate::storage::dataset::{Dataset, PartRecord};
use crate::storage::identity::provenance;
use crate::storage::names::{BANDS, OBSERVABLES, REPORT, SENSITIVITY, STATISTICS, SUMMARY};
use crate::storage::rows_reader::RowsReader;
use crate::storage::store::StoreError;
use crate::table::Table;
use crate::workflow::analysed::{Analysed, computed};
use crate::workflow::error::WorkflowError;
use crate::workflow::page::made_page;
use crate::workflow::session::Session;

/// Where the files go; called from any thread.
pub(super) trait Destination: Sync {
    /// Takes the file `name` with this content.
    fn take(&self, name: &str, bytes: &[u8]) -> Result<(), StoreError>;

    /// Is told that the dataset has no file `name`.
    fn leave_out(&self, name: &str) -> Result<(), StoreError>;
}

impl Destination for Dataset {
    fn take(&self, name: &str, bytes: &[u8]) -> Result<(), StoreError> {
        self.put(name, bytes)
    }

    fn leave_out(&self, name: &str) -> Result<(), StoreError> {
        self.remove(name)
    }
}

#[derive(Clone, Copy, Debug)]
pub(super) enum PageKind {
    Without,
    /// One of the rows alone.
    OfRows,
    /// One that says which share is noise within control loops, by so many scenes that are flown twice.
    WithNoise(u64),
}

/// A dataset with all its rows.
#[derive(Clone, Copy)]
pub(super) struct Derivation<'a> {
    pub session: Session<'a>,
    pub ensemble: &'a Ensemble<'a>,
    pub reader: &'a RowsReader,
    pub records: &'a [PartRecord],
    pub page: PageKind,
    /// The samples whose time series are made.
    pub retained: &'a [SampleId],
}

pub(super) struct Derived {
    pub analysed: Analysed,
    pub page: Option<Page>,
    pub findings: Findings,
}

/// Makes the files from what was `gathered` from the rows, each for `files`.
///
/// # Errors
/// Where a file cannot be read, encoded or taken.
pub(super) fn derive(
    job: &Derivation<'_>,
    gathered: Gathered,
    files: &dyn Destination,
) -> Result<Derived, WorkflowError> {
    let (plan, threads) = (job.ensemble.plan(), job.session.threads);
    let analysed = computed(plan, job.reader, gathered, threads).map_err(WorkflowError::files)?;
    let encoded = |table: Table<'_>| Some(columnar::encoded(&table, provenance(plan), Packing::Zstd));
    take(files, STATISTICS, encoded(statistics_table::table(&analysed.statistics)))?;
    take(files, SENSITIVITY, encoded(sensitivity_table::table(&analysed.sensitivities)))?;
    take(files, OBSERVABLES, derived_table::encoded(plan, job.reader).transpose())?;
    take(files, BANDS, analysed.bands.as_ref().map(|bands| bands_table::file(plan, bands)))?;
    trajectories::save(plan, job.retained, (job.ensemble.isa(), threads), &|name, bytes| files.take(name, bytes))
        .map_err(WorkflowError::files)?;
    let page = match job.page {
        PageKind::Without => None,
        PageKind::OfRows => Some(made_page(&job.session, job.ensemble, &analysed, (job.reader, job.records), None)?.0),
        PageKind::WithNoise(scenes) => {
            Some(made_page(&job.session, job.ensemble, &analysed, (job.reader, job.records), Some(scenes))?.0)
        }
    };
    take(files, REPORT, page.as_ref().map(|page| Ok::<_, WorkflowError>(page.html.clone().into_bytes())))?;
    let findings = findings(plan, &analysed, &[]);
    let text = summary::json(plan, &analysed, &findings);
    take(files, SUMMARY, Some(Ok::<_, WorkflowError>(text.into_bytes())))?;
    Ok(Derived { analysed, page, findings })
}

/// Gives `files` the file `name`, or says that there is none.
fn take<E: Display>(
    files: &dyn Destination,
    name: &str,
    encoded: Option<Result<Vec<u8>, E>>,
) -> Result<(), WorkflowError> {
    match encoded {
        None => files.leave_out(name),
        Some(Ok(bytes)) => files.take(name, &bytes),
        Some(Err(error)) => return Err(WorkflowError::files(format!("{name}: {error}"))),
    }
    .map_err(WorkflowError::files)
}
