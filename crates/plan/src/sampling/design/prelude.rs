//! The names that the files of designs share.

pub(super) use super::hash::keyed;
pub(super) use super::traits::{BLOCK, Dimensions, Facts, Kind, PointSource, by_point};
pub(super) use crate::sampling::error::Result;
pub(super) use crate::sampling::keys::{Row, Rule, Written};
pub(super) use crate::sampling::stream::key;
