//! [`WorkflowError`]: failures of campaigns and results.

use std::path::Path;

use thiserror::Error;

use crate::campaign::CampaignError;
use crate::report::figure_files::FigureError;
use crate::storage::folder_error::FolderError;
use crate::storage::rows_reader::RowsError;
use crate::storage::store::{Failure, StoreError};

/// The result of a workflow.
pub type Result<T, E = WorkflowError> = std::result::Result<T, E>;

/// A campaign that could not run, or a result that could not be used, with place, reason and remedy.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
pub enum WorkflowError {
    /// A wrong request or campaign file.
    #[error("{0}")]
    Input(String),
    /// A failed file operation, or a result that is damaged or may not be replaced.
    #[error("{0}")]
    Files(String),
}

impl WorkflowError {
    pub fn files(error: impl std::fmt::Display) -> Self {
        WorkflowError::Files(error.to_string())
    }

    /// A failure of the file or folder `path`.
    pub fn at(path: &Path, why: impl std::fmt::Display) -> Self {
        WorkflowError::Files(format!("{}: {why}", path.display()))
    }
}

impl From<CampaignError> for WorkflowError {
    /// A wrong campaign file, with its lines; an error of input and output if it only cannot be read now.
    fn from(error: CampaignError) -> Self {
        let text = error.with_excerpts();
        if error.is_unreadable { WorkflowError::Files(text) } else { WorkflowError::Input(text) }
    }
}

impl From<FolderError> for WorkflowError {
    /// A folder without a result is a wrong argument; everything else concerns its files.
    fn from(error: FolderError) -> Self {
        let text = error.to_string();
        if matches!(error, FolderError::Nothing { .. }) {
            WorkflowError::Input(text)
        } else {
            WorkflowError::Files(text)
        }
    }
}

macro_rules! from_files {
    ($($Error:ty),*) => {
        $(impl From<$Error> for WorkflowError {
            fn from(error: $Error) -> Self {
                WorkflowError::files(error)
            }
        })*
    };
}

from_files!(std::io::Error, StoreError, RowsError, Failure, FigureError);
