//! Where plans come from: a campaign file ([`plan_and_files`]), or a result that is there ([`plan_of_sound`]).

use std::path::Path;

use crate::campaign::{FilesRead, Overrides, Plan, data, find, nearest_file};
use crate::ensemble::Ensemble;
use crate::findings::number::counted;
use crate::findings::shell_word::quoted_path;
use crate::storage::found::Found;
use crate::storage::identity::sha256;
use crate::storage::manifest::{Identity, PartRecord};
use crate::storage::names::{DATA, PLAN};
use crate::storage::rows_file::identity;
use crate::storage::verify::{damaged, derived_damage};
use crate::workflow::error::WorkflowError;
use crate::workflow::session::Session;

/// The plan of the campaign file `file`, as [`plan_and_files`].
///
/// # Errors
/// Where there is no such file, or it is wrong.
pub fn plan(file: &Path, overrides: Overrides) -> Result<Plan, WorkflowError> {
    plan_and_files(file, overrides).map(|(plan, _)| plan)
}

/// The plan of the campaign file `file`, which may be given without folder and extension, and the files that were read.
///
/// # Errors
/// Where there is no such file, or it is wrong.
pub fn plan_and_files(file: &Path, overrides: Overrides) -> Result<(Plan, FilesRead), WorkflowError> {
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

/// The plan of a result that is in a folder, and the files that it was made from.
///
/// # Errors
/// Where the plan is missing or wrong.
pub fn plan_in(session: &Session<'_>, root: &Path, found: &Found) -> Result<(Plan, FilesRead), WorkflowError> {
    let overrides = session.overrides();
    let path = root.join(PLAN);
    let remedy = "the campaign's command with its file writes it again";
    if found.plan.is_empty() {
        return Err(WorkflowError::Files(format!("{}: is missing, or no text file; {remedy}", path.display())));
    }
    Plan::from_text_of(&path, &found.plan, overrides).map_err(|error| {
        let copies = found.derived().iter().filter(|file| file.name.starts_with(DATA));
        if let Some(what) =
            derived_damage(session.storage, root, copies).ok().and_then(|damage| damage.into_iter().next())
        {
            return WorkflowError::Files(format!("{}: {what}; {remedy}", root.display()));
        }
        WorkflowError::Files(format!("{}: cannot be used; {remedy}\n{}", path.display(), error.with_excerpts()))
    })
}

/// The plan of the result in `root`, after every checksum was compared: for commands that read it. The file `remade` is
/// not looked at.
///
/// # Errors
/// Where it is damaged, or its plan is not that of its rows; or where a file operation fails.
pub fn plan_of_sound(
    session: &Session<'_>,
    (root, found): (&Path, &Found),
    remade: Option<&str>,
) -> Result<Plan, WorkflowError> {
    let plan = plan_of_result(session, root, found)?;
    let expected = identity(&Ensemble::new(&plan, session.isa));
    refuse_other_rows(root, found, &expected)?;
    let records: Vec<PartRecord> = found.parts().into_values().collect();
    let broken =
        damaged(session.storage, root, &expected, &records, session.readers()).map_err(WorkflowError::files)?;
    let derived = found.derived().iter().filter(|file| Some(file.name.as_str()) != remade);
    let derived = derived_damage(session.storage, root, derived).map_err(WorkflowError::files)?;
    let problems = found.damage().into_iter().chain(broken.into_iter().map(|(_, what)| what));
    let problems: Vec<String> = problems.chain(derived).collect();
    match problems.first() {
        None => Ok(plan),
        Some(first) => Err(WorkflowError::Files(format!(
            "{}: {first}{}; this makes it again: spindrift verify {} --repair",
            root.display(),
            if problems.len() > 1 {
                format!(" (and {})", counted(problems.len() - 1, "more problem"))
            } else {
                String::new()
            },
            quoted_path(root),
        ))),
    }
}

/// Refuses a result whose rows have not the identity `expected` of its plan.
///
/// # Errors
/// Where they have another.
pub fn refuse_other_rows(root: &Path, found: &Found, expected: &Identity) -> Result<(), WorkflowError> {
    let there = found.identity.as_ref().filter(|there| *there != expected);
    let Some(there) = there else { return Ok(()) };
    let why = if (there.format, there.arithmetic) == (expected.format, expected.arithmetic) {
        format!(
            "plan.toml is not the plan of these rows (row hash {}, not {}); bring back the plan that belongs to them",
            there.row_hash, expected.row_hash
        )
    } else {
        format!(
            "its rows are of another version of the program (format and arithmetic {}.{}, not {}.{}); run the campaign \
            with --overwrite",
            there.format, there.arithmetic, expected.format, expected.arithmetic
        )
    };
    Err(WorkflowError::Files(format!("{}: {why}", root.display())))
}

/// The plan of a result that is in a folder, with the number of samples that it has, or that `[stop]` looks at next.
///
/// # Errors
/// Where the plan is missing or wrong.
pub fn plan_of_result(session: &Session<'_>, root: &Path, found: &Found) -> Result<Plan, WorkflowError> {
    plan_in(session, root, found).map(|(plan, _)| plan.at_look(found.rows()))
}

/// The files of numbers and the module of the plan, each with the name that its copy has.
///
/// # Errors
/// Where one has changed since the plan was made, or cannot be read.
pub(super) fn data_copies(files: &FilesRead) -> impl Iterator<Item = Result<(String, Vec<u8>), WorkflowError>> {
    files.data.iter().map(|(path, expected)| {
        let failed = |why: &dyn std::fmt::Display| WorkflowError::Files(format!("{}: {why}", path.display()));
        let bytes = data::bytes(path).map_err(|error| failed(&error))?;
        if sha256(&bytes) != *expected {
            return Err(failed(&"changed while it was read; run the command again"));
        }
        Ok((data::copy_name(path, expected), bytes))
    })
}
