//! [`refuse_inputs`]: outputs must not be inputs. [`refuse_within`]: nor in the folder of a result, which has only
//! files of a dataset.

use std::path::{Path, PathBuf};

use crate::report::figure_files::check_format;
use crate::storage::table_file::TableFormat;
use crate::workflow::error::{Result, WorkflowError};

/// Refuses a table or plot with an unknown extension before any work.
///
/// # Errors
/// The first such file.
pub fn check_formats(table: Option<&Path>, plot: Option<&Path>) -> Result<()> {
    if let Some(path) = table {
        TableFormat::of(path).map_err(WorkflowError::Input)?;
    }
    plot.map_or(Ok(()), |path| check_format(path).map_err(|error| WorkflowError::Input(error.to_string())))
}

/// Refuses `outputs`, each with its option, that are among the files `inputs` by path, link, or another name.
///
/// # Errors
/// The first such output.
pub fn refuse_inputs(inputs: &[PathBuf], outputs: &[(&str, Option<&Path>)]) -> Result<()> {
    for (option, output) in outputs {
        let Some(output) = output else { continue };
        if let Some(input) = inputs.iter().find(|input| is_same(input, output)) {
            return Err(WorkflowError::Input(format!(
                "{option} {}: must be a file that this command does not read, and `{}` is the same file; choose \
                another name",
                output.display(),
                input.display()
            )));
        }
    }
    Ok(())
}

fn is_same(one: &Path, other: &Path) -> bool {
    let (Ok(a), Ok(b)) = (one.metadata(), other.metadata()) else { return false };
    #[cfg(unix)]
    {
        use std::os::unix::fs::MetadataExt;
        (a.dev(), a.ino()) == (b.dev(), b.ino())
    }
    #[cfg(not(unix))]
    {
        a.is_file() && b.is_file() && matches!((one.canonicalize(), other.canonicalize()), (Ok(a), Ok(b)) if a == b)
    }
}

/// Refuses `outputs`, each with its option, in the folder `root` of a result.
///
/// # Errors
/// The first such output.
pub fn refuse_within(root: &Path, outputs: &[(&str, Option<&Path>)]) -> Result<()> {
    let folder = resolved(root);
    for (option, output) in outputs {
        if let Some(output) = output.filter(|output| resolved(output).starts_with(&folder)) {
            return Err(WorkflowError::Input(format!(
                "{option} {}: must be outside of the result in `{}`, which has its own files only; choose another path",
                output.display(),
                root.display()
            )));
        }
    }
    Ok(())
}

/// The absolute path without links, as far as it exists.
fn resolved(path: &Path) -> PathBuf {
    let absolute = std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
    let (mut existing, mut rest) = (absolute.as_path(), Vec::new());
    loop {
        if let Ok(found) = existing.canonicalize() {
            return rest.iter().rev().fold(found, |path: PathBuf, name| path.join(name));
        }
        match (existing.parent(), existing.file_name()) {
            (Some(parent), Some(name)) => {
                rest.push(name.to_owned());
                existing = parent;
            }
            _ => return absolute,
        }
    }
}
