//! The names of rows and their statistics that most files of the analysis share.

pub(super) use super::accumulator::{Accumulator, of_files};
pub(super) use super::observed::Observed;
pub(super) use super::part_columns::PartColumns;
pub(super) use super::population::Population;
pub(super) use crate::campaign::Statement;
pub(super) use crate::ensemble::audit::AuditValue;
pub(super) use crate::ensemble::prelude::*;
pub(super) use crate::ensemble::{Bands, Ensemble};
pub(super) use crate::statistics::binomial::Decision;
pub(super) use crate::statistics::correlation::Estimate;
pub(super) use crate::statistics::gate::GateLimit;
pub(super) use crate::statistics::moments::Moments;
pub(super) use crate::storage::rows_reader::{Result, RowsError, RowsReader};
pub(super) use std::borrow::Cow;
