//! The layers of the architecture, checked on the source line by line: imports, circles of files, the few crates that belong to one place.
//!
//! What the compiler, clippy (`clippy.toml`: elementary functions; `unwrap`, printing) and `cargo deny` hold is held there.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// Layers: a module imports only from layers below its own (and from itself).
const LAYERS: [(&str, u32); 20] = [
    ("math", 0),
    ("scene", 1),
    ("run", 1),
    ("ode", 1),
    ("dynamics", 2),
    ("sampling", 2),
    ("statistics", 2),
    ("table", 2),
    ("propagation", 3),
    ("observables", 3),
    ("control", 4),
    ("campaign", 5),
    ("ensemble", 6),
    ("storage", 7),
    ("analysis", 8),
    ("findings", 9),
    ("report", 10),
    ("workflow", 11),
    ("cli", 12),
    ("main", 13),
];

/// Crates that only these modules or files may use.
const CRATES: [(&str, &[&str]); 5] = [
    ("clap", &["cli"]),
    ("fearless_simd", &["math", "dynamics", "ode", "propagation", "observables", "statistics"]),
    ("parquet", &["storage", "campaign/data_columns.rs"]),
    ("resvg", &["report"]),
    ("rayon", &["ensemble"]),
];

/// A source file: its path from `src` or `kernels/src`, and its code up to the unit tests, without lines of comments.
struct Source {
    path: String,
    code: String,
}

impl Source {
    fn new(path: &str, text: &str) -> Self {
        let lines = text.lines().take_while(|line| *line != "#[cfg(test)]");
        let code = lines.filter(|line| !line.trim_start().starts_with("//")).map(|line| format!("{line}\n")).collect();
        Source { path: path.to_owned(), code }
    }

    /// The module below the root: `math`.
    fn module(&self) -> &str {
        self.path.split('/').next().unwrap_or_default().trim_end_matches(".rs")
    }

    /// What follows each `start` in the code: the names of a path, of a group `{a, b}` each.
    fn after<'s>(&'s self, start: &str) -> Vec<Vec<&'s str>> {
        let is_name = |letter: char| letter.is_alphanumeric() || letter == '_';
        let path = |text: &'s str| -> Vec<&'s str> {
            let end = text.find(|letter| !is_name(letter) && letter != ':').unwrap_or(text.len());
            text[..end].split("::").collect()
        };
        let found = self.code.match_indices(start).filter(|(at, _)| !self.code[..*at].ends_with(is_name));
        let rest = found.map(|(at, _)| &self.code[at + start.len()..]);
        rest.flat_map(|rest| match rest.strip_prefix('{') {
            Some(group) => group[..group.find(';').unwrap_or(0)].split(',').map(|one| path(one.trim())).collect(),
            None => vec![path(rest)],
        })
        .collect()
    }
}

fn read(folder: &Path, root: &Path, list: &mut Vec<Source>) {
    let mut entries: Vec<PathBuf> = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    entries.sort();
    for path in entries {
        if path.is_dir() {
            read(&path, root, list);
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            let name = path.strip_prefix(root).unwrap().to_string_lossy().replace('\\', "/");
            list.push(Source::new(&name, &std::fs::read_to_string(&path).unwrap()));
        }
    }
}

/// All files of the library and of the program.
fn sources() -> Vec<Source> {
    let mut list = Vec::new();
    for folder in ["src", "kernels/src"] {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join(folder);
        read(&root, &root, &mut list);
    }
    list
}

/// The imports of a file that its layer does not allow.
fn forbidden_imports(source: &Source) -> Vec<String> {
    let layer = |module: &str| LAYERS.iter().find(|(name, _)| *name == module).map(|(_, layer)| *layer);
    let Some(own) = layer(source.module()) else { return vec![format!("{} has no layer", source.path)] };
    let starts = ["crate::", "spindrift::", "spindrift_kernels::"];
    let imported = starts.iter().flat_map(|start| source.after(start)).map(|path| path[0]);
    imported
        .filter(|name| *name != source.module() && layer(name).is_some_and(|layer| layer >= own))
        .map(|name| format!("{} imports {name}", source.path))
        .collect()
}

/// The crates that a file uses and may not use.
fn forbidden_crates(source: &Source) -> Vec<String> {
    let is_in = |places: &[&str]| {
        places.iter().any(|place| source.path == *place || source.path.starts_with(&format!("{place}/")))
    };
    let uses = |name: &str| !source.after(&format!("{name}::")).is_empty();
    let wrong = CRATES.iter().filter(|(name, places)| uses(name) && !is_in(places));
    wrong.map(|(name, _)| format!("{} uses {name}", source.path)).collect()
}

/// Files of one folder that depend on each other in a circle: one of them each.
fn circles(sources: &[Source]) -> Vec<String> {
    let stem = |source: &Source| source.path.trim_end_matches(".rs").to_owned();
    let files: Vec<String> = sources.iter().map(stem).filter(|stem| !stem.ends_with("/mod")).collect();
    let mut uses: BTreeMap<String, Vec<String>> = BTreeMap::new();
    for source in sources {
        let own = stem(source);
        let folder = own.rsplit_once('/').map_or("", |(folder, _)| folder);
        let here = source.after("super::").into_iter().map(|path| format!("{folder}/{}", path[0]));
        let absolute =
            source.after("crate::").into_iter().flat_map(|path| (2..=path.len()).map(move |n| path[..n].join("/")));
        let found = here.chain(absolute).filter(|file| *file != own && files.contains(file));
        let beside = found.filter(|file| file.rsplit_once('/').map_or("", |(folder, _)| folder) == folder);
        uses.entry(own.clone()).or_default().extend(beside);
    }
    let reaches = |from: &String| {
        let (mut open, mut seen) = (uses.get(from).cloned().unwrap_or_default(), Vec::new());
        while let Some(next) = open.pop() {
            if !seen.contains(&next) {
                open.extend(uses.get(&next).cloned().unwrap_or_default());
                seen.push(next);
            }
        }
        seen.contains(from)
    };
    files.iter().filter(|file| reaches(file)).cloned().collect()
}

/// Law: a module imports from layers below its own.
#[test]
fn modules_import_only_from_layers_below() {
    let sources = sources();
    assert!(sources.len() > 80, "the source was found: {} files", sources.len());
    let library = sources.iter().filter(|source| source.module() != "lib");
    let wrong: Vec<String> = library.flat_map(forbidden_imports).collect();
    assert!(wrong.is_empty(), "{wrong:#?}");
}

/// Law: files of a module do not depend on each other in a circle.
#[test]
fn files_of_a_module_do_not_depend_on_each_other_in_circles() {
    let found = circles(&sources());
    assert!(found.is_empty(), "{found:#?}");
}

/// Law: crates that belong to one place are used there only.
#[test]
fn crates_stay_in_their_places() {
    let wrong: Vec<String> = sources().iter().flat_map(forbidden_crates).collect();
    assert!(wrong.is_empty(), "{wrong:#?}");
}

/// Counter-test: each of the checks finds what it looks for, in paths and in groups, and not in comments and tests.
#[test]
fn the_checks_can_fail() {
    let file = |path: &str, text: &str| Source::new(path, text);
    for text in ["use crate::report::x;", "use crate::{math, report::x};", "fn f() { crate::report::x() }"] {
        assert_eq!(forbidden_imports(&file("storage/a.rs", text)), ["storage/a.rs imports report"], "{text}");
    }
    for text in ["// use crate::report::x;", "use crate::math::x;", "#[cfg(test)]\nuse crate::report::x;"] {
        assert!(forbidden_imports(&file("storage/a.rs", text)).is_empty(), "{text}");
    }
    assert_eq!(forbidden_crates(&file("campaign/a.rs", "parquet::x()")), ["campaign/a.rs uses parquet"]);
    assert!(forbidden_crates(&file("storage/a.rs", "use parquet::x;")).is_empty());
    let one = file("storage/one.rs", "use crate::storage::two::X;");
    let two = file("storage/two.rs", "use super::three;");
    let three = file("storage/three.rs", "fn f() -> crate::storage::one::X {}");
    assert_eq!(circles(&[one, two]).len(), 0);
    let one = file("storage/one.rs", "use crate::storage::two::X;");
    let two = file("storage/two.rs", "use super::three;");
    assert_eq!(circles(&[one, two, three]).len(), 3);
}
