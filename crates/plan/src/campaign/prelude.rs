//! The names of keys, tables and scenes that most files of campaigns share.

pub(super) use super::document::Document;
pub(super) use super::known_columns::KnownColumns;
pub(super) use super::lines::Lines;
pub(super) use super::meaning::meant;
pub(super) use super::numbers::MAX_SAMPLES;
pub(super) use super::section::Section;
pub(super) use super::units;
pub(super) use crate::loops::ControlLaw;
pub(super) use crate::observables::{Group, Request, request::NutationAxis};
pub(super) use crate::propagation::Method;
pub(super) use crate::run::Quantity;
pub(super) use crate::sampling::keys::{ANY_TEXT, Kind, Presence, Row, Rule, TextLimit, Value, Written};
pub(super) use crate::sampling::{Component, Design};
pub(super) use crate::scene::{Name, Parameter, Scene, SceneInput, schema::Limit};
pub(super) use std::path::{Path, PathBuf};
pub(super) use toml::de::{DeTable, DeValue};
