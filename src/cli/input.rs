//! What every command starts from: the [`plan`] of a campaign file and the instruction set ([`isa`]).

use std::path::Path;

use crate::campaign::{FilesRead, Overrides, Plan, find};
use crate::cli::command_outcome::Failure;
use crate::dataset::found::Found;
use crate::dataset::names::PLAN;
use crate::math::Isa;
use crate::math::isa::VARIABLE;

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
        Failure::Files(format!("{}: cannot be used; {remedy}\n{}", path.display(), error.with_excerpts()))
    })
}

/// The plan of a result that is in a folder, with the number of samples that it has, or that `[stop]` looks at next.
///
/// # Errors
/// Where the plan is missing or wrong.
pub fn plan_of_result(root: &Path, found: &Found) -> Result<Plan, Failure> {
    plan_in(root, found).map(|(plan, _)| plan.at_look(found.rows()))
}
