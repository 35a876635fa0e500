//! [`WorkflowError`]: why something could not be done.

use thiserror::Error;

use crate::campaign::CampaignError;
use crate::report::figure_files::FigureError;
use crate::storage::folder_error::FolderError;
use crate::storage::rows_reader::RowsError;
use crate::storage::store::{Failure, StoreError};

/// Why a campaign could not run, or a result could not be used. The text says where, what is wrong, and what to do.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
pub enum WorkflowError {
    /// What was asked for, or the campaign file, is wrong.
    #[error("{0}")]
    Input(String),
    /// A file operation failed, a result is damaged, or one that is there may not be replaced.
    #[error("{0}")]
    Files(String),
}

impl WorkflowError {
    /// An error of input or output.
    pub fn files(error: impl std::fmt::Display) -> Self {
        WorkflowError::Files(error.to_string())
    }
}

impl From<CampaignError> for WorkflowError {
    /// What is wrong with a campaign file, with the lines of the file; an error of input and output where it only
    /// cannot be read now.
    fn from(error: CampaignError) -> Self {
        let text = error.with_excerpts();
        if error.is_unreadable { WorkflowError::Files(text) } else { WorkflowError::Input(text) }
    }
}

impl From<FolderError> for WorkflowError {
    /// A folder without a result is a wrong argument, whichever command it is given to; everything else is about its
    /// files.
    fn from(error: FolderError) -> Self {
        let text = error.to_string();
        if matches!(error, FolderError::Nothing { .. }) {
            WorkflowError::Input(text)
        } else {
            WorkflowError::Files(text)
        }
    }
}

/// Errors of input and output, each as its text.
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
