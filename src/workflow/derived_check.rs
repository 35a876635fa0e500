//! [`derived_problems`]: whether the derived files of a result are those of this program. Checksums alone only match
//! the manifest, which an intruder can change too.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::{Arc, Mutex, PoisonError};

use crate::analysis::fold::Gathered;
use crate::analysis::trajectories::file_name;
use crate::campaign::{FilesRead, data};
use crate::ensemble::Ensemble;
use crate::sampling::SampleId;
use crate::storage::dataset::{FileRecord, Manifest, PartRecord, rows};
use crate::storage::names::{DATA, HEAD, PLAN, REPORT, SUMMARY, TRAJECTORIES};
use crate::storage::store::Store;
use crate::workflow::derived::{Derivation, derive};
use crate::workflow::error::Result;
use crate::workflow::page::noise_scenes;
use crate::workflow::session::Session;

#[derive(Debug, Default)]
pub(super) struct DerivedCheck {
    /// Files made again.
    pub files: usize,
    /// Time series not made again.
    pub left_out: usize,
    /// Problems by file.
    pub problems: Vec<String>,
}

struct Comparison<'a> {
    listed: BTreeMap<&'a str, &'a FileRecord>,
    /// Names of the files made again, and problems.
    found: Mutex<(BTreeSet<String>, Vec<String>)>,
}

impl Comparison<'_> {
    /// Compares the file `name` with its record; without bytes there must be none.
    fn compare(&self, name: &str, bytes: Option<&[u8]>) {
        let what = match (self.listed.get(name), bytes) {
            (None, None) => return,
            (Some(listed), Some(bytes)) if **listed == FileRecord::of(name, bytes) => None,
            (Some(_), Some(_)) => Some("is not what this program makes of plan and rows, though its checksum is right"),
            (Some(_), None) => Some(NO_SUCH_FILE),
            (None, Some(_)) => Some(NOT_LISTED),
        };
        let mut found = self.found.lock().unwrap_or_else(PoisonError::into_inner);
        found.0.insert(name.to_owned());
        found.1.extend(what.map(|what| format!("{name}: {what}")));
    }
}

const NO_SUCH_FILE: &str = "is listed, and plan and rows have no such file";
const NOT_LISTED: &str = "is missing, and the manifest does not list it";

/// Makes the derived files of the result in `store` again, with time series selected by `chosen`, and compares them
/// with the manifest. Checksums of the parts `records` are verified.
///
/// # Errors
/// A file that cannot be read.
pub(super) fn derived_problems(
    session: &Session<'_>,
    (store, manifest): (&Arc<dyn Store>, &Manifest),
    (ensemble, read): (&Ensemble<'_>, &FilesRead),
    records: &[PartRecord],
    chosen: &dyn Fn(&[SampleId]) -> Vec<SampleId>,
) -> Result<DerivedCheck> {
    let plan = ensemble.plan();
    let listed = manifest.derived().map(|file| (file.name.as_str(), file)).collect();
    let files = Comparison { listed, found: Mutex::default() };
    let reader = rows(store, records);
    let gathered = Gathered::of_files(ensemble, &reader, session.threads)?;
    let retained = gathered.retained.clone();
    let made_again = chosen(&retained);
    let html = files.listed.get(REPORT).map(|_| store.read(REPORT)).transpose()?;
    let page = html.map(|html| noise_scenes(&html.unwrap_or_default()));
    let job = Derivation { session: *session, ensemble, reader: &reader, records, page, retained: &made_again };
    derive(&job, gathered, &|name, bytes| {
        files.compare(name, bytes);
        Ok(())
    })?;
    files.compare(PLAN, Some(plan.text().as_bytes()));
    files.compare(HEAD, Some(&manifest.head.bytes()));
    let series: BTreeSet<String> =
        retained.iter().map(|sample| format!("{TRAJECTORIES}/{}", file_name(*sample))).collect();
    let copies: BTreeSet<String> =
        read.data.iter().map(|(path, sha256)| format!("{DATA}/{}", data::copy_name(path, sha256))).collect();
    let (made, mut problems) = files.found.into_inner().unwrap_or_else(PoisonError::into_inner);
    let missing = series.iter().chain(&copies).filter(|name| !files.listed.contains_key(name.as_str()));
    problems.extend(missing.map(|name| format!("{name}: {NOT_LISTED}")));
    let is_known = |name: &str| made.contains(name) || series.contains(name) || copies.contains(name);
    problems.extend((files.listed.keys().filter(|name| !is_known(name))).map(|name| format!("{name}: {NO_SUCH_FILE}")));
    if problems.iter().any(|what| what.starts_with(SUMMARY))
        && let Some(version) = other_version(&**store)?
    {
        problems.push(format!("{SUMMARY}: says that version {version} of the program made it, and this one is {THIS}"));
    }
    problems.sort();
    problems.dedup();
    Ok(DerivedCheck { files: made.len(), left_out: retained.len() - made_again.len(), problems })
}

const THIS: &str = env!("CARGO_PKG_VERSION");

fn other_version(store: &dyn Store) -> Result<Option<String>> {
    let bytes = store.read(SUMMARY)?.unwrap_or_default();
    let summary: serde_json::Value = serde_json::from_slice(&bytes).unwrap_or_default();
    let version = summary.get("version").and_then(serde_json::Value::as_str);
    Ok(version.filter(|version| *version != THIS).map(str::to_owned))
}
