//! [`WorkflowError`]: why something could not be done.

use thiserror::Error;

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

impl From<std::io::Error> for WorkflowError {
    fn from(error: std::io::Error) -> Self {
        WorkflowError::Files(error.to_string())
    }
}
