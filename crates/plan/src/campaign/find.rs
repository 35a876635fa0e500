//! Campaign files by their names on the command line.

use super::input_file::is_unreadable;
use super::meaning::meant;
use std::path::{Path, PathBuf};

/// The folder of shipped campaigns.
pub const FOLDER: &str = "campaigns";

/// The file `name`, with or without `.toml`; for a bare name also in [`FOLDER`].
///
/// # Errors
/// The paths tried.
pub fn find(name: &Path) -> Result<PathBuf, Vec<PathBuf>> {
    find_in(Path::new(""), name)
}

fn find_in(start: &Path, name: &Path) -> Result<PathBuf, Vec<PathBuf>> {
    let is_bare = name.components().count() == 1;
    let mut with_extension = name.as_os_str().to_owned();
    with_extension.push(".toml");
    let mut tried = Vec::new();
    let has_extension = name.extension().is_some_and(|extension| extension == "toml");
    let longer = (!has_extension).then(|| PathBuf::from(with_extension));
    for file in [Some(name.to_owned()), longer].into_iter().flatten() {
        tried.push(start.join(&file));
        if is_bare {
            tried.push(start.join(FOLDER).join(&file));
        }
    }
    // devices and unreadable files are refused when they are read
    let is_other = |path: &PathBuf| path.metadata().map_or_else(|error| is_unreadable(&error), |found| !found.is_dir());
    match tried.iter().position(|path| path.is_file()).or_else(|| tried.iter().position(is_other)) {
        Some(index) => Ok(tried.swap_remove(index)),
        None => Err(tried),
    }
}

/// The campaign file with the nearest name in its folder; for a bare name also in [`FOLDER`].
pub fn nearest_file(name: &Path) -> Option<PathBuf> {
    nearest_in(Path::new(""), name)
}

fn nearest_in(start: &Path, name: &Path) -> Option<PathBuf> {
    let is_bare = name.components().count() == 1;
    let own = name.parent().unwrap_or(Path::new("")).to_owned();
    let folders = [Some(own), is_bare.then(|| PathBuf::from(FOLDER))];
    let stem = |path: &Path| Some(path.file_stem()?.to_str()?.to_owned());
    let mut files: Vec<(String, PathBuf)> = Vec::new();
    for folder in folders.into_iter().flatten() {
        let there = if folder.as_os_str().is_empty() { Path::new(".") } else { &folder };
        let entries = std::fs::read_dir(start.join(there)).into_iter().flatten().filter_map(Result::ok);
        let campaigns = entries.map(|entry| folder.join(entry.file_name()));
        let mut campaigns: Vec<PathBuf> =
            campaigns.filter(|path| path.extension().is_some_and(|extension| extension == "toml")).collect();
        campaigns.sort();
        files.extend(campaigns.into_iter().filter_map(|path| Some((stem(&path)?, path))));
    }
    let meant = meant(&stem(name)?, files.iter().map(|(stem, _)| stem.as_str()))?.name.to_owned();
    files.into_iter().find(|(stem, _)| *stem == meant).map(|(_, path)| path)
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
        // the nearest file, also a shipped one; none for a name like no other
        std::fs::write(root.join("mine.toml"), "").expect("a file");
        let meant = |name: &str| nearest_in(&root, Path::new(name));
        assert_eq!(meant("brun.toml"), Some(PathBuf::from("campaigns/burn.toml")));
        assert_eq!(
            [meant("campaigns/bunr"), meant("mime")],
            [Some("campaigns/burn.toml".into()), Some("mine.toml".into())]
        );
        assert_eq!([meant("something_else"), meant("absent/burn")], [None, None]);
        std::fs::remove_dir_all(root).expect("removed");
    }
}
