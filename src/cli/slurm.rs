//! `spindrift slurm`: the scripts that run a campaign on a cluster with Slurm, and their submission.

use std::path::{Path, PathBuf, absolute};
use std::process::Command;

use crate::campaign::{Overrides, find};
use crate::cli::arguments::SlurmOptions;
use crate::cli::command_outcome::{CommandOutcome, Failure};
use crate::cli::screen;
use crate::cli::slurm_script::{Jobs, MARK};
use crate::ensemble::run_cost::parts;
use crate::report::number::counted;
use crate::report::shell_word::quoted_path;
use crate::storage::atomic;
use crate::storage::remote::Address;
use crate::workflow::campaign::{RESULTS, refuse_shards_with_stop};
use crate::workflow::isa;
use crate::workflow::source::plan;

/// Runs the command.
///
/// # Errors
/// Where the campaign file is wrong, a script cannot be written, or Slurm does not take it.
pub fn run(options: &SlurmOptions) -> Result<CommandOutcome, Failure> {
    let plan =
        plan(&options.file, Overrides { samples: options.samples, seed: options.seed, ..options.changed.overrides() })?;
    refuse_shards_with_stop(&plan, "slurm")?;
    let many = parts(&plan, isa()?).count();
    let shards = options.nodes.get().min(many);
    if shards < options.nodes.get() {
        screen::note(&format!(
            "{}: {} to make: {shards} of {} tasks busy",
            plan.name,
            counted(many, "part"),
            options.nodes
        ));
    }
    let file = find(&options.file).unwrap_or_else(|_| options.file.clone());
    let out = options.out.clone().unwrap_or_else(|| PathBuf::from(RESULTS).join(&plan.name));
    // an address is the same in every folder
    let is_address = Address::of(&out).map_err(Failure::Input)?.is_some();
    let absolute = |path: &Path| if is_address && path == out { Ok(path.to_owned()) } else { absolute(path) };
    let [file, out] = [&file, &out].map(|path| word(&absolute(path).map_err(|error| in_file(path, &error))?));
    let program =
        std::env::current_exe().map_err(|error| Failure::files(format!("the path of this program: {error}")))?;
    let program = word(&program)?;
    let number = |flag: &str, value: Option<u64>| value.map(|value| [flag.to_owned(), value.to_string()]);
    let settings =
        options.changed.settings.iter().map(|(key, value)| Some(["--set".to_owned(), format!("{key}={value}")]));
    let arguments: Vec<_> =
        [number("--samples", options.samples), number("--seed", options.seed)].into_iter().chain(settings).collect();
    let jobs = Jobs {
        name: &plan.name,
        program: &program,
        file: &file?,
        out: &out?,
        arguments: &arguments.into_iter().flatten().flatten().collect::<Vec<_>>(),
        shards,
        cpus: options.cpus.get(),
        time: &options.time,
        options: &options.sbatch,
    };
    let script = |what: &str| PathBuf::from(format!("{}-{what}.sh", plan.name));
    let (array, finish) = (script("array"), script("finish"));
    write(&array, &jobs.array())?;
    write(&finish, &jobs.finish())?;
    let text = if options.submit {
        let first = submit(&array, None)?;
        let last = submit(&finish, Some(&first))?;
        format!(
            "{}: submitted: array {first} of {} ({}), then {last} ({})\n",
            plan.name,
            counted(shards, "task"),
            array.display(),
            finish.display()
        )
    } else {
        format!(
            "{}: {}. Where Slurm is:\n  job=$(sbatch --parsable {})\n  sbatch --dependency=afterany:\"$job\" {}\n",
            plan.name,
            counted(shards, "task"),
            quoted_path(&array),
            quoted_path(&finish)
        )
    };
    screen::print(&text)?;
    Ok(CommandOutcome::Done)
}

/// A path that a script can have as a word.
fn word(path: &Path) -> Result<PathBuf, Failure> {
    let is_word = path.to_str().is_some_and(|text| !text.contains(char::is_control));
    let refusal = || {
        Failure::Input(format!(
            "{path:?}: must be a path in UTF-8 without line ends and other control characters: scripts have it as a word; rename it"
        ))
    };
    is_word.then(|| path.to_owned()).ok_or_else(refusal)
}

fn in_file(path: &Path, error: &dyn std::fmt::Display) -> Failure {
    Failure::files(format!("{}: {error}", path.display()))
}

/// Writes a script; what else has its name is not replaced.
fn write(path: &Path, text: &str) -> Result<(), Failure> {
    let is_ours = |old: String| old.lines().nth(1) == Some(MARK);
    if path.symlink_metadata().is_ok() && !std::fs::read_to_string(path).is_ok_and(is_ours) {
        return Err(in_file(path, &"exists, and is no script of `spindrift slurm`; move it away"));
    }
    atomic::write_bytes(path, text.as_bytes()).map_err(|error| in_file(path, &error))
}

/// Submits a script, to start when all tasks of the job `after` have ended; the number of the job.
fn submit(script: &Path, after: Option<&str>) -> Result<String, Failure> {
    let path = absolute(script).map_err(|error| in_file(script, &error))?;
    let mut sbatch = Command::new("sbatch");
    sbatch.arg("--parsable").args(after.map(|job| format!("--dependency=afterany:{job}"))).arg(&path);
    let output = sbatch.output().map_err(|error| {
        Failure::files(format!(
            "sbatch: {error}; the scripts are written: submit them where Slurm is (without --submit: how)"
        ))
    })?;
    // with several clusters the name of the cluster follows the number
    let said = String::from_utf8_lossy(&output.stdout);
    let job = said.trim().split(';').next().unwrap_or_default();
    let is_number = !job.is_empty() && job.bytes().all(|byte| byte.is_ascii_digit());
    if !output.status.success() || !is_number {
        let why = String::from_utf8_lossy(&output.stderr);
        let earlier = after.map(|job| format!("; array {job} is submitted")).unwrap_or_default();
        return Err(Failure::files(format!("sbatch {} ({}): {}{earlier}", path.display(), output.status, why.trim())));
    }
    Ok(job.to_owned())
}
