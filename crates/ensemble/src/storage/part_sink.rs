//! [`write_parts`]: adds finished parts to a dataset.
//!
//! Threads encode their own parts; another one writes files, so that no run waits for the disk.

use super::store::Result;
use crate::ensemble::threads::unpoisoned;
use crate::ensemble::{Ensemble, Part, Rows};
use crate::storage::bands_file::BandsFile;
use crate::storage::dataset::{Dataset, FileRecord, PartFile};
use crate::storage::identity::seal;
use crate::storage::names::{bands_of, rows_of};
use crate::storage::rows_file::RowsFile;
use crate::storage::store::Failure;
use parquet::errors::ParquetError;
use std::sync::mpsc::{SyncSender, sync_channel};
use std::sync::{Mutex, OnceLock};

/// Encoded parts, some 10 MB each, that may wait for the disk.
const WAITING: usize = 1;

pub trait CountRows: std::fmt::Debug + Sync {
    /// Counts the rows of a part in memory, on any thread.
    fn add(&self, rows: &Rows);
}

type Encoded = (Part, Vec<PartFile>);

/// Memory of written files, reused for later parts.
#[derive(Debug, Default)]
struct Buffers(Mutex<Vec<Vec<Vec<u8>>>>);

impl Buffers {
    /// Empty memory of the files of a part, if any was returned.
    fn take(&self) -> std::vec::IntoIter<Vec<u8>> {
        unpoisoned(self.0.lock()).pop().unwrap_or_default().into_iter()
    }

    fn give(&self, files: Vec<PartFile>) {
        let emptied = |file: PartFile| {
            let mut bytes = file.bytes;
            bytes.clear();
            bytes
        };
        unpoisoned(self.0.lock()).push(files.into_iter().map(emptied).collect());
    }
}

#[derive(Debug)]
pub struct PartFiles {
    rows: RowsFile,
    /// Known from the first part with bands.
    bands: OnceLock<BandsFile>,
}

impl PartFiles {
    /// # Errors
    /// Two columns of one name.
    pub fn new(ensemble: &Ensemble<'_>) -> Result<Self, ParquetError> {
        Ok(PartFiles { rows: RowsFile::new(ensemble)?, bands: OnceLock::new() })
    }

    /// The files of the part of `rows`, a function of the part alone, written to `buffers`.
    pub fn encoded(
        &self,
        rows: &Rows,
        mut buffers: impl Iterator<Item = Vec<u8>>,
    ) -> Result<Vec<PartFile>, ParquetError> {
        let part = rows.part();
        let [mut bytes, of_bands] = [(); 2].map(|()| buffers.next().unwrap_or_default());
        let mut files = Vec::new();
        if let Some(bands) = rows.bands() {
            let file = match self.bands.get() {
                Some(file) => file,
                None => {
                    let file = BandsFile::new(bands.layout())?;
                    self.bands.get_or_init(|| file)
                }
            };
            let mut bytes = of_bands;
            file.write(part, bands, &mut bytes)?;
            files.push(PartFile { record: FileRecord::of(&bands_of(part.id), &bytes), bytes });
        }
        let of_bands = files.first().map(|file| file.record.sha256.as_str());
        self.rows.write(rows, of_bands, &mut bytes)?;
        let sha256 = seal(&mut bytes);
        let record = FileRecord { name: rows_of(part.id), bytes: bytes.len() as u64, sha256 };
        files.insert(0, PartFile { record, bytes });
        Ok(files)
    }
}

/// Encodes parts for the writing thread.
#[derive(Debug)]
pub struct PartSink<'c> {
    files: PartFiles,
    counts: Option<&'c dyn CountRows>,
    buffers: &'c Buffers,
    encoded: SyncSender<Encoded>,
    seconds: Mutex<[f64; 2]>,
}

impl PartSink<'_> {
    /// # Errors
    /// A failed encoding, or a stopped writer.
    pub fn take(&self, rows: &Rows) -> Result<(), Failure> {
        let files = self.files.encoded(rows, self.buffers.take());
        let files = files.map_err(|error| format!("a part could not be encoded: {error}"))?;
        self.counts.into_iter().for_each(|counts| counts.add(rows));
        // the writer stops after its own error
        self.encoded.send((rows.part(), files)).map_err(|_| "parts are no longer written")?;
        let mut sums = unpoisoned(self.seconds.lock());
        sums.iter_mut().zip(rows.seconds()).for_each(|(sum, seconds)| *sum += seconds);
        Ok(())
    }

    /// CPU time of runs and audits so far, s, if there are audits.
    pub fn seconds(&self) -> [f64; 2] {
        *unpoisoned(self.seconds.lock())
    }
}

/// Runs `body` with a sink for the rows of `ensemble`, also counted in `counts`; on return every part of the sink is in
/// `dataset`, or an error tells why not. Errors of writing come first.
///
/// # Errors
/// Parts that could not be encoded or written.
pub fn write_parts<R>(
    dataset: &Dataset,
    ensemble: &Ensemble<'_>,
    counts: Option<&dyn CountRows>,
    body: impl FnOnce(&PartSink<'_>) -> R,
) -> Result<R, Failure> {
    let (encoded, waiting) = sync_channel::<Encoded>(WAITING);
    let buffers = Buffers::default();
    let files = PartFiles::new(ensemble).map_err(|error| format!("a part could not be encoded: {error}"))?;
    let sink = PartSink { files, counts, buffers: &buffers, encoded, seconds: Mutex::new([0.0; 2]) };
    std::thread::scope(|scope| {
        let (buffers, waiting) = (&buffers, waiting);
        let write = move || -> Result<()> {
            waiting.iter().try_for_each(|(part, files)| {
                dataset.commit(part, &files)?;
                buffers.give(files);
                Ok(())
            })
        };
        let writer = std::thread::Builder::new().spawn_scoped(scope, write);
        let writer = writer.map_err(|error| format!("cannot start a thread: {error}"))?;
        let result = body(&sink);
        drop(sink);
        writer.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic))?;
        Ok(result)
    })
}
