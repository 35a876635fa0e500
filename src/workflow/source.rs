//! Sources of plans: a campaign file ([`plan_and_files`]), or an existing result ([`sound`]).

use std::path::{Path, PathBuf};
use std::sync::Arc;

use crate::campaign::{FilesRead, Plan, data, find, nearest_file};
use crate::control::tables::Overrides;
use crate::ensemble::{Ensemble, Parts};
use crate::findings::number::counted;
use crate::findings::shell_word::quoted_path;
use crate::storage::atomic::{make_folder, write_bytes};
use crate::storage::claim::{Claim, ClaimOptions, Shard, claim};
use crate::storage::dataset::{Head, PartRecord};
use crate::storage::disk::above;
use crate::storage::found::Found;
use crate::storage::identity::{Identity, sha256};
use crate::storage::names::{DATA, PLAN};
use crate::storage::store::Store;
use crate::workflow::error::{Result, WorkflowError};
use crate::workflow::session::Session;

/// The plan of the campaign file `file`, possibly without folder and extension, and the files read.
///
/// # Errors
/// A missing or wrong file.
pub fn plan_and_files(file: &Path, overrides: Overrides) -> Result<(Plan, FilesRead)> {
    let path = find(file).map_err(|tried| {
        if file.is_dir() {
            let plan = file.join(PLAN);
            let remedy = if plan.is_file() { format!(": {}", plan.display()) } else { String::new() };
            return WorkflowError::Input(format!(
                "`{}` is a folder; name the campaign file in it{remedy}",
                file.display()
            ));
        }
        let tried: Vec<String> = tried.iter().map(|path| format!("`{}`", path.display())).collect();
        let meant = nearest_file(file);
        let meant = meant.map_or(String::new(), |path| format!("; did you mean {}?", quoted_path(&path)));
        WorkflowError::Input(format!(
            "there is no campaign file `{}`; looked for {}{meant}",
            file.display(),
            tried.join(", ")
        ))
    })?;
    Ok(Plan::load_with_files(&path, overrides)?)
}

/// The plan of the result in `store`, and its files.
///
/// # Errors
/// A missing or wrong plan.
pub fn plan_in(session: &Session<'_>, store: &dyn Store, found: &Found) -> Result<(Plan, FilesRead)> {
    let path = store.path(PLAN);
    let remedy = "the campaign's command with its file writes it again";
    if found.plan.is_empty() {
        return Err(WorkflowError::at(&path, format!("is missing, or no text file; {remedy}")));
    }
    let folder = folder_of_data(store, found)?;
    Plan::from_text_of(&folder.join(PLAN), &found.plan, session.overrides()).map_err(|error| {
        let damage = found.derived_damage(store).unwrap_or_default();
        if let Some(what) = damage.into_iter().find(|what| what.starts_with(DATA)) {
            return WorkflowError::at(store.root(), format!("{what}; {remedy}"));
        }
        WorkflowError::at(&path, format!("cannot be used; {remedy}\n{}", error.with_excerpts()))
    })
}

/// The folder of the data copies of the result in `store`: its own, or a temporary one for an object store.
fn folder_of_data(store: &dyn Store, found: &Found) -> Result<PathBuf> {
    if store.replaces() {
        return Ok(store.root().to_owned());
    }
    let folder = std::env::temp_dir().join(format!("spindrift-{}", &sha256(found.plan.as_bytes())[..16]));
    for name in found.files.iter().filter(|name| name.starts_with(DATA)) {
        let path = folder.join(name);
        if !path.exists() {
            let bytes = store.read(name)?.unwrap_or_default();
            make_folder(above(&path))?;
            write_bytes(&path, &bytes)?;
        }
    }
    Ok(folder)
}

/// The `plan` of a result with its number of samples, or that of the next look of `[stop]`.
pub fn at_rows_of(plan: Plan, found: &Found) -> Plan {
    let parts = Parts::up_to(u64::MAX, found.largest_part.unwrap_or(u64::MAX));
    plan.at_look(found.rows(parts))
}

/// Claims `store` for the rows of `ensemble`, for a shard or all, possibly replacing a result.
///
/// # Errors
/// A result that must not be replaced, or a failed file operation.
pub fn claimed(
    session: &Session<'_>,
    store: &Arc<dyn Store>,
    ensemble: &Ensemble<'_>,
    (overwrite, shard): (bool, Option<Shard>),
) -> Result<Claim> {
    let options = ClaimOptions { folders: session.folders, overwrite, shard, threads: session.readers() };
    claim(store, ensemble, options).map_err(WorkflowError::files)
}

/// Remedy for damaged objects of a store.
pub(super) const IN_A_STORE: &str = "remove what has changed, and the campaign's command with this --out puts it again";

/// The plan of the result in `store` and its parts, with verified checksums except of the file `remade`.
///
/// # Errors
/// A damaged result, a plan of other rows, or a failed file operation.
pub fn sound(
    session: &Session<'_>,
    (store, found): (&dyn Store, &Found),
    remade: Option<&str>,
) -> Result<(Plan, Vec<PartRecord>)> {
    let plan = at_rows_of(plan_in(session, store, found)?.0, found);
    let head = Head::of(&Ensemble::new(&plan, session.isa), found.largest_part);
    refuse_other_rows(store, found, &head.identity)?;
    let examined = found.examine(store, (&plan, &head), &|_| true, session.readers())?;
    let mut problems = found.problems(store, &examined)?;
    problems.retain(|what| remade.is_none_or(|remade| !what.starts_with(remade)));
    match problems.first() {
        None => Ok((plan, examined.parts)),
        Some(first) => {
            let more = match problems.len() - 1 {
                0 => String::new(),
                more => format!(" (and {})", counted(more, "more problem")),
            };
            let remedy = if store.replaces() {
                format!("this makes it again: spindrift verify {} --repair", quoted_path(store.root()))
            } else {
                IN_A_STORE.to_owned()
            };
            Err(WorkflowError::at(store.root(), format!("{first}{more}; {remedy}")))
        }
    }
}

/// Refuses to fly `plan` without a law of another program that it names.
///
/// # Errors
/// The law is not here.
pub fn refuse_missing_law(plan: &Plan) -> Result<()> {
    let missing = plan.loop_spec().and_then(|spec| spec.laws().find(|law| law.is_missing()));
    missing.map_or(Ok(()), |law| {
        Err(WorkflowError::Input(format!(
            "[[guidance]]: law = {:?} is a function of Python, which is not here: give it to the Python package, \
            plan.run(control=...)",
            law.name
        )))
    })
}

/// Refuses a result with rows of another identity than `expected`.
///
/// # Errors
/// If the rows have another identity.
pub fn refuse_other_rows(store: &dyn Store, found: &Found, expected: &Identity) -> Result<()> {
    let there = found.identity.as_ref().filter(|there| *there != expected);
    let Some(there) = there else { return Ok(()) };
    let why = if (there.format, there.arithmetic) == (expected.format, expected.arithmetic) {
        format!(
            "plan.toml is not the plan of the rows of dataset.json (row hash {}, not {}); bring back the \
            one that belongs to them",
            there.row_hash, expected.row_hash
        )
    } else {
        format!(
            "its rows are of another version of the program (format and arithmetic {}.{}, not {}.{}); run the campaign \
            with --overwrite",
            there.format, there.arithmetic, expected.format, expected.arithmetic
        )
    };
    Err(WorkflowError::at(store.root(), why))
}

/// The data files and module of the plan, with the names of their copies.
///
/// # Errors
/// A file that has changed since, or is unreadable.
pub(super) fn data_copies(files: &FilesRead) -> impl Iterator<Item = Result<(String, Vec<u8>)>> {
    files.data.iter().map(|(path, expected)| {
        let bytes = data::bytes(path).map_err(|error| WorkflowError::at(path, error))?;
        if sha256(&bytes) != *expected {
            return Err(WorkflowError::at(path, "changed while it was read; run the command again"));
        }
        Ok((data::copy_name(path, expected), bytes))
    })
}
