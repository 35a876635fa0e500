//! What every command starts from: the [`plan`] of a campaign file and the instruction set ([`isa`]).

use std::num::NonZeroUsize;
use std::path::Path;

use crate::campaign::{FilesRead, Overrides, Plan, find};
use crate::cli::command_outcome::Failure;
use crate::cli::shell_word::quoted_path;
use crate::ensemble::Ensemble;
use crate::ensemble::runner::threads as ensemble_threads;
use crate::math::Isa;
use crate::math::isa::VARIABLE;
use crate::storage::disk::{Disk, Storage};
use crate::storage::found::Found;
use crate::storage::manifest::{Identity, PartRecord};
use crate::storage::names::{DATA, PLAN};
use crate::storage::rows_file::identity;
use crate::storage::verify::{damaged, derived_damage};

/// The plan of the campaign file `file`, which may be given without folder and extension.
///
/// # Errors
/// Where there is no such file, or it is wrong.
pub fn plan(file: &Path, overrides: Overrides) -> Result<Plan, Failure> {
    plan_and_files(file, overrides).map(|(plan, _)| plan)
}

/// The same, and the files that were read.
///
/// # Errors
/// Where there is no such file, or it is wrong.
pub fn plan_and_files(file: &Path, overrides: Overrides) -> Result<(Plan, FilesRead), Failure> {
    let path = find(file).map_err(|tried| {
        if file.is_dir() {
            let plan = file.join(PLAN);
            let remedy = if plan.is_file() { format!(": {}", plan.display()) } else { String::new() };
            return Failure::Input(format!("`{}` is a folder; name the campaign file in it{remedy}", file.display()));
        }
        let tried: Vec<String> = tried.iter().map(|path| format!("`{}`", path.display())).collect();
        Failure::Input(format!("there is no campaign file `{}`; looked for {}", file.display(), tried.join(", ")))
    })?;
    Plan::load_with_files(&path, overrides).map_err(|error| Failure::Input(error.with_excerpts()))
}

/// The instruction set of this process.
///
/// # Errors
/// Where the environment names one that does not exist or is not available.
pub fn isa() -> Result<Isa, Failure> {
    Isa::chosen().map_err(|value| {
        let names: Vec<&str> = Isa::available().iter().map(|isa| isa.name()).collect();
        Failure::Input(format!("{VARIABLE}={value}: must be one of {}, or unset", names.join(", ")))
    })
}

/// The plan of a result that is in a folder, and the files that it was made from.
///
/// # Errors
/// Where the plan is missing or wrong.
pub fn plan_in(root: &Path, found: &Found) -> Result<(Plan, FilesRead), Failure> {
    let path = root.join(PLAN);
    let remedy = "the campaign's command with its file writes it again";
    if found.plan.is_empty() {
        return Err(Failure::Files(format!("{}: is missing, or no text file; {remedy}", path.display())));
    }
    Plan::from_text_of(&path, &found.plan, Overrides::default()).map_err(|error| {
        let copies = found.derived().iter().filter(|file| file.name.starts_with(DATA));
        if let Some(what) = derived_damage(&Disk, root, copies).ok().and_then(|damage| damage.into_iter().next()) {
            return Failure::Files(format!("{}: {what}; {remedy}", root.display()));
        }
        Failure::Files(format!("{}: cannot be used; {remedy}\n{}", path.display(), error.with_excerpts()))
    })
}

/// The plan of the result in `root`, after every checksum was compared: for commands that read it. The file `remade` is not looked at.
///
/// # Errors
/// Where it is damaged, or its plan is not that of its rows; or where a file operation fails.
pub fn plan_of_sound(
    storage: &'static dyn Storage,
    (root, found): (&Path, &Found),
    threads: Option<NonZeroUsize>,
    remade: Option<&str>,
) -> Result<Plan, Failure> {
    let plan = plan_of_result(root, found)?;
    let expected = identity(&Ensemble::new(&plan, isa()?));
    refuse_other_rows(root, found, &expected)?;
    let records: Vec<PartRecord> = found.parts().into_values().collect();
    let readers = ensemble_threads(threads, usize::MAX);
    let broken = damaged(storage, root, &expected, &records, readers).map_err(Failure::files)?;
    let derived = found.derived().iter().filter(|file| Some(file.name.as_str()) != remade);
    let derived = derived_damage(storage, root, derived).map_err(Failure::files)?;
    let problems = found.damage().into_iter().chain(broken.into_iter().map(|(_, what)| what));
    let problems: Vec<String> = problems.chain(derived).collect();
    match problems.first() {
        None => Ok(plan),
        Some(first) => Err(Failure::Files(format!(
            "{}: {first}{}; this makes it again: spindrift verify {} --repair",
            root.display(),
            if problems.len() > 1 { format!(" (and {} more problems)", problems.len() - 1) } else { String::new() },
            quoted_path(root),
        ))),
    }
}

/// Refuses a result whose rows have not the identity `expected` of its plan.
///
/// # Errors
/// Where they have another.
pub fn refuse_other_rows(root: &Path, found: &Found, expected: &Identity) -> Result<(), Failure> {
    let there = found.identity.as_ref().filter(|there| *there != expected);
    let Some(there) = there else { return Ok(()) };
    let why = if (there.format, there.arithmetic) == (expected.format, expected.arithmetic) {
        format!(
            "plan.toml is not the plan of these rows (row hash {}, not {}); bring back the plan that belongs to them",
            there.row_hash, expected.row_hash
        )
    } else {
        format!(
            "its rows are of another version of the program (format and arithmetic {}.{}, not {}.{}); run the campaign with --overwrite",
            there.format, there.arithmetic, expected.format, expected.arithmetic
        )
    };
    Err(Failure::Files(format!("{}: {why}", root.display())))
}

/// The plan of a result that is in a folder, with the number of samples that it has, or that `[stop]` looks at next.
///
/// # Errors
/// Where the plan is missing or wrong.
pub fn plan_of_result(root: &Path, found: &Found) -> Result<Plan, Failure> {
    plan_in(root, found).map(|(plan, _)| plan.at_look(found.rows()))
}
