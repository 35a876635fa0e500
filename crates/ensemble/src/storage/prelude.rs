//! The names of stores, parts and tables that most files of results share.

pub(super) use super::store::{Result, Store, StoreError};
pub(super) use crate::ensemble::prelude::*;
pub(super) use crate::ensemble::{Ensemble, Part, PartId};
pub(super) use crate::table::{Column, Content, Table, Values};
pub(super) use std::fs::File;
pub(super) use std::io::{self, ErrorKind};
pub(super) use std::path::{Path, PathBuf};
pub(super) use std::sync::{Arc, Mutex};
