//! [`Results`]: a finished result: rows, analysis, replays.

use std::path::{Path, PathBuf};

use crate::analysis::fold::Gathered;
use crate::analysis::statistics::Statistics;
use crate::analysis::verdicts::Verdicts;
use crate::campaign::Plan;
use crate::ensemble::{Ensemble, SingleRun};
use crate::findings::end::SummaryEnd;
use crate::sampling::SampleId;
use crate::storage::claim::open;
use crate::storage::dataset::{PartRecord, rows};
use crate::storage::lock::Lock;
use crate::storage::names::SUMMARY;
use crate::storage::rows_reader::RowsReader;
use crate::workflow::analysed::{Analysed, computed, write_junit};
use crate::workflow::ending::end_of;
use crate::workflow::error::{Result, WorkflowError};
use crate::workflow::session::Session;
use crate::workflow::simulated::not_physical;
use crate::workflow::source::sound;

/// A finished result with verified checksums, locked while held.
pub struct Results<'a> {
    session: Session<'a>,
    root: PathBuf,
    plan: Plan,
    parts: Vec<PartRecord>,
    reader: RowsReader,
    _lock: Lock,
}

impl<'a> Results<'a> {
    /// Opens the result in the folder or at the address `root`, with its control law, if any, in `session`.
    ///
    /// # Errors
    /// A missing, unfinished or damaged result.
    pub fn open(root: impl Into<PathBuf>, session: Session<'a>) -> Result<Self> {
        let root = root.into();
        let store = session.store(&root)?;
        let (found, lock) = open(&*store, true)?;
        if !found.is_finished && found.damage.is_empty() {
            return Err(WorkflowError::Input(format!("the result in `{}` is not finished", root.display())));
        }
        let (plan, parts) = sound(&session, (&*store, &found), None)?;
        let reader = rows(&store, &parts);
        Ok(Results { session, root, plan, parts, reader, _lock: lock })
    }

    pub fn root(&self) -> &Path {
        &self.root
    }

    pub fn plan(&self) -> &Plan {
        &self.plan
    }

    pub fn parts(&self) -> &[PartRecord] {
        &self.parts
    }

    /// The rows by parts.
    pub fn rows(&self) -> &RowsReader {
        &self.reader
    }

    /// The numbers of a dispersed value or observable by row; NaN for none.
    ///
    /// # Errors
    /// A missing column, or an unreadable file.
    pub fn column(&self, name: &str) -> Result<Vec<f64>> {
        let mut numbers = Vec::new();
        let gather = |part: Vec<f64>| {
            numbers.extend(part);
            Ok(())
        };
        self.reader.visit(self.session.threads, |part| part.numbers(name), gather)?;
        Ok(numbers)
    }

    /// Everything that follows from the rows.
    ///
    /// # Errors
    /// An unreadable file.
    pub fn analysed(&self) -> Result<Analysed> {
        let (ensemble, threads) = (Ensemble::new(&self.plan, self.session.isa), self.session.threads);
        let gathered = Gathered::of_files(&ensemble, &self.reader, threads)?;
        computed(&self.plan, &self.reader, gathered, threads).map_err(WorkflowError::files)
    }

    /// Statistics of every observable.
    ///
    /// # Errors
    /// An unreadable file.
    pub fn statistics(&self) -> Result<Statistics> {
        self.analysed().map(|found| found.statistics)
    }

    /// The verdicts on the requirements.
    ///
    /// # Errors
    /// An unreadable file.
    pub fn verdicts(&self) -> Result<Verdicts> {
        self.analysed().map(|found| found.verdicts)
    }

    /// The content of the file `name`, such as `summary.json`, if present.
    pub fn file(&self, name: &str) -> Result<Option<Vec<u8>>> {
        Ok(self.reader.store().read(name)?.ok())
    }

    /// Repeats the run of a sample with its states over time, bit for bit as in its row.
    ///
    /// # Errors
    /// An unphysical scene, which had no run.
    pub fn replay(&self, sample: SampleId) -> Result<SingleRun> {
        SingleRun::new(&self.plan, sample, self.plan.grid.clone(), self.session.isa)
            .map_err(|errors| not_physical(sample.0, &errors))
    }

    pub(super) fn threads(&self) -> Option<std::num::NonZeroUsize> {
        self.session.threads
    }

    /// Writes the verdicts as JUnit XML.
    ///
    /// # Errors
    /// An unreadable or unwritable file.
    pub fn write_junit(&self, file: &Path) -> Result<()> {
        write_junit(&self.plan, &self.analysed()?, Some(file))
    }

    /// The ending of the campaign by its rows.
    ///
    /// # Errors
    /// Unreadable rows or summary, or a contradiction.
    pub fn end(&self) -> Result<SummaryEnd> {
        end_of(&self.file(SUMMARY)?.unwrap_or_default(), &self.plan, &self.reader, &self.session)
    }
}
