//! The names that the files of distributions share.

pub(super) use super::target::{LOGARITHM, MAX, MIN, Target};
pub(super) use super::traits::{Map, Nested, NumberWords, Quantile, Scalar, Together};
pub(super) use crate::sampling::error::{Result, error};
pub(super) use crate::sampling::keys::{
    ALL_BUT_ONE, FILE_OF_PARAMETERS, Kind, Presence, Range, Row, Rule, Value, Values, Written, above, between,
};
