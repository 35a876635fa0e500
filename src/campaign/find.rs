//! Which file a name on the command line means.

use super::input_file::is_unreadable;
use std::path::{Path, PathBuf};

/// The folder of shipped campaigns, in which a bare name is looked up.
pub const FOLDER: &str = "campaigns";

/// The file that `name` means: the path itself, or for a bare name, with or without `.toml`, the file in `campaigns/`.
///
/// # Errors
/// The paths that were tried, where none is a file.
pub fn find(name: &Path) -> Result<PathBuf, Vec<PathBuf>> {
    find_in(Path::new(""), name)
}

/// The same, relative paths counted from `start`.
fn find_in(start: &Path, name: &Path) -> Result<PathBuf, Vec<PathBuf>> {
    let is_bare = name.components().count() == 1;
    let mut with_extension = name.as_os_str().to_owned();
    with_extension.push(".toml");
    let mut tried = Vec::new();
    for file in [name.to_owned(), PathBuf::from(with_extension)] {
        tried.push(start.join(&file));
        if is_bare {
            tried.push(start.join(FOLDER).join(&file));
        }
    }
    // what is neither file nor folder is refused where it is read, by what it is; and so is what cannot be looked at
    let is_other = |path: &PathBuf| path.metadata().map_or_else(|error| is_unreadable(&error), |found| !found.is_dir());
    match tried.iter().position(|path| path.is_file()).or_else(|| tried.iter().position(is_other)) {
        Some(index) => Ok(tried.swap_remove(index)),
        None => Err(tried),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_bare_name_is_also_looked_up_among_the_shipped_campaigns() {
        let root = std::env::temp_dir().join(format!("spindrift-find-{}", std::process::id()));
        std::fs::create_dir_all(root.join("campaigns")).expect("a folder");
        std::fs::write(root.join("campaigns/burn.toml"), "").expect("a file");
        for name in ["burn", "burn.toml", "campaigns/burn", "campaigns/burn.toml"] {
            assert_eq!(find_in(&root, Path::new(name)), Ok(root.join("campaigns/burn.toml")), "{name}");
        }
        assert_eq!(find_in(&root, Path::new("elsewhere/burn")).map_err(|tried| tried.len()), Err(2));
        assert_eq!(find_in(&root, Path::new("no_such_campaign")).map_err(|tried| tried.len()), Err(4));
        std::fs::remove_dir_all(root).expect("removed");
    }
}
