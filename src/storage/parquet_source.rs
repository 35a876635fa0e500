//! [`ParquetSource`]: a file of a dataset as the Parquet reader reads it.
//!
//! The Parquet reader turns errors into texts of its own, and may panic where a read has failed: the first error of the
//! file is kept, so that a file that cannot be read is not called damaged.

use std::io::{self, BufReader, Read};
use std::path::Path;
use std::sync::{Arc, Mutex, PoisonError};

use bytes::Bytes;
use parquet::errors::ParquetError;
use parquet::file::reader::{ChunkReader, Length};

use crate::storage::disk::Storage;
use crate::storage::stored_file::{StoredFile, ended, read_some};

/// An open file, and the first error of reading it.
#[derive(Clone, Debug)]
pub struct ParquetSource {
    file: Arc<dyn StoredFile>,
    length: u64,
    failure: Arc<Mutex<Option<io::Error>>>,
}

impl ParquetSource {
    /// Opens the file `path`.
    ///
    /// # Errors
    /// Where it cannot be opened.
    pub fn open(storage: &dyn Storage, path: &Path) -> io::Result<Self> {
        let file: Arc<dyn StoredFile> = storage.open(path)?.into();
        let length = file.length()?;
        Ok(ParquetSource { file, length, failure: Arc::default() })
    }

    /// What the first read said that failed; the next call has nothing to say.
    pub fn failure(&self) -> Option<io::Error> {
        self.failure.lock().unwrap_or_else(PoisonError::into_inner).take()
    }
}

impl Length for ParquetSource {
    fn len(&self) -> u64 {
        self.length
    }
}

impl ChunkReader for ParquetSource {
    type T = BufReader<FileRest>;

    fn get_read(&self, start: u64) -> Result<Self::T, ParquetError> {
        Ok(BufReader::new(FileRest { source: self.clone(), offset: start }))
    }

    fn get_bytes(&self, start: u64, length: usize) -> Result<Bytes, ParquetError> {
        // what a damaged file claims is not allocated
        if start.checked_add(length as u64).is_none_or(|end| end > self.length) {
            return Err(ParquetError::EOF(format!(
                "{length} bytes from byte {start} on, where the file has {}",
                self.length
            )));
        }
        let mut bytes = vec![0; length];
        FileRest { source: self.clone(), offset: start }.read_exact(&mut bytes)?;
        Ok(bytes.into())
    }
}

/// The rest of a file, read from the start to the end.
#[derive(Debug)]
pub struct FileRest {
    source: ParquetSource,
    offset: u64,
}

impl Read for FileRest {
    fn read(&mut self, bytes: &mut [u8]) -> io::Result<usize> {
        let source = &self.source;
        let found = match read_some(&*source.file, self.offset, bytes) {
            Ok(0) if !bytes.is_empty() && self.offset < source.length => Err(ended(self.offset)),
            read => read,
        };
        match found {
            Ok(count) => {
                self.offset += count as u64;
                Ok(count)
            }
            Err(error) => {
                let told = io::Error::new(error.kind(), error.to_string());
                source.failure.lock().unwrap_or_else(PoisonError::into_inner).get_or_insert(error);
                Err(told)
            }
        }
    }
}
