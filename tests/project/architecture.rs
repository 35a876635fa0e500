//! The layers of the architecture, checked on the source line by line; the compiler, clippy and `cargo deny` hold
//! others.

use crate::prelude::*;

const LAYERS: [(&str, u32); 22] = [
    ("testing", 0),
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
    ("loops", 4),
    ("campaign", 5),
    ("control", 6),
    ("ensemble", 6),
    ("storage", 7),
    ("analysis", 8),
    ("findings", 9),
    ("report", 10),
    ("workflow", 11),
    ("cli", 12),
    ("main", 13),
];

const CRATES: [(&str, &[&str]); 4] = [
    ("clap", &["cli"]),
    ("fearless_simd", &["math", "dynamics", "ode", "propagation", "observables", "statistics"]),
    ("parquet", &["storage", "campaign/data_columns.rs"]),
    ("rayon", &["ensemble"]),
];

/// Its path, and its code up to the unit tests, without lines of comments.
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

fn sources() -> Vec<Source> {
    CRATES_OF_THE_PROJECT[1..].iter().flat_map(|folder| sources_in(folder)).collect()
}

/// The Python package is outside the layers.
const CRATES_OF_THE_PROJECT: [&str; 7] = [
    "crates/python/src",
    "crates/kernels/src",
    "crates/plan/src",
    "crates/control/src",
    "crates/ensemble/src",
    "crates/report/src",
    "src",
];

fn sources_in(folder: &str) -> Vec<Source> {
    let root = root().join(folder);
    let mut list = Vec::new();
    read(&root, &root, &mut list);
    list
}

fn forbidden_imports(source: &Source) -> Vec<String> {
    let layer = |module: &str| LAYERS.iter().find(|(name, _)| *name == module).map(|(_, layer)| *layer);
    let Some(own) = layer(source.module()) else { return vec![format!("{} has no layer", source.path)] };
    let crates = ["crate", "spindrift", "spindrift_kernels", "spindrift_plan", "spindrift_control"];
    let starts = crates.into_iter().chain(["spindrift_ensemble", "spindrift_report"]).map(|name| format!("{name}::"));
    let starts: Vec<String> = starts.collect();
    let imported = starts.iter().flat_map(|start| source.after(start)).map(|path| path[0]);
    imported
        .filter(|name| *name != source.module() && layer(name).is_some_and(|layer| layer >= own))
        .map(|name| format!("{} imports {name}", source.path))
        .collect()
}

fn forbidden_crates(source: &Source) -> Vec<String> {
    let is_in = |places: &[&str]| {
        places.iter().any(|place| source.path == *place || source.path.starts_with(&format!("{place}/")))
    };
    let uses = |name: &str| !source.after(&format!("{name}::")).is_empty();
    let wrong = CRATES.iter().filter(|(name, places)| uses(name) && !is_in(places));
    wrong.map(|(name, _)| format!("{} uses {name}", source.path)).collect()
}

/// Of `a::{b, c::d}` `a::b` and `a::c::d`, as names.
fn paths(text: &str) -> Vec<Vec<String>> {
    let is_name = |letter: char| letter.is_alphanumeric() || letter == '_';
    if let Some(group) = text.strip_prefix('{') {
        let (mut depth, mut begin, mut found) = (1, 0, Vec::new());
        for (at, letter) in group.char_indices() {
            depth += match letter {
                '{' => 1,
                '}' => -1,
                _ => 0,
            };
            if depth == 0 || depth == 1 && letter == ',' {
                found.extend(paths(group[begin..at].trim_start()));
                begin = at + 1;
            }
            if depth == 0 {
                break;
            }
        }
        return found;
    }
    let (name, rest) = text.split_at(text.find(|letter| !is_name(letter)).unwrap_or(text.len()));
    match rest.strip_prefix("::").filter(|_| !name.is_empty()) {
        Some(rest) => paths(rest).into_iter().map(|path| [vec![name.to_owned()], path].concat()).collect(),
        None => vec![vec![name.to_owned()]],
    }
}

/// Files that depend on each other in circles; a `mod x;` is no dependence.
fn circles(sources: &[Source]) -> Vec<String> {
    let module = |source: &Source| {
        let stem = source.path.trim_end_matches(".rs");
        stem.strip_suffix("/mod").unwrap_or(stem).to_owned()
    };
    let modules: BTreeMap<String, &Source> =
        sources.iter().map(|source| (module(source), source)).filter(|(name, _)| name != "lib").collect();
    let uses = |(own, source): (&String, &&Source)| -> Vec<String> {
        let names: Vec<String> = own.split('/').map(str::to_owned).collect();
        let above = names[..names.len() - 1].to_vec();
        // `pub(in crate::x)` says who may use, not what is used
        let mut parts = source.code.split("pub(in ");
        let first = parts.next().unwrap_or_default().to_owned();
        let code = parts.fold(first, |code, part| code + part.split_once(')').map_or(part, |(_, rest)| rest));
        let after = |start: &str, base: &[String]| -> Vec<Vec<String>> {
            let is_name = |letter: char| letter.is_alphanumeric() || letter == '_' || letter == ':';
            let found = code.match_indices(start).filter(|(at, _)| !code[..*at].ends_with(is_name));
            found.flat_map(|(at, _)| paths(&code[at + start.len()..])).map(|path| [base, &path[..]].concat()).collect()
        };
        let mut found = [after("crate::", &[]), after("super::", &above), after("self::", &names)].concat();
        for below in modules.keys().filter_map(|other| other.strip_prefix(&format!("{own}/"))) {
            if !below.contains('/') {
                found.extend(after(&format!("{below}::"), &[&names[..], &[below.to_owned()]].concat()));
            }
        }
        let file = |path: Vec<String>| {
            (1..=path.len()).rev().map(|n| path[..n].join("/")).find(|name| modules.contains_key(name))
        };
        found.into_iter().filter_map(file).filter(|name| name != own).collect()
    };
    let uses: BTreeMap<&String, Vec<String>> = modules.iter().map(|one| (one.0, uses(one))).collect();
    let reaches = |from: &&String| {
        let (mut open, mut seen) = (uses[*from].clone(), Vec::new());
        while let Some(next) = open.pop() {
            if !seen.contains(&next) {
                open.extend(uses[&next].clone());
                seen.push(next);
            }
        }
        seen.contains(*from)
    };
    modules.keys().filter(reaches).cloned().collect()
}

#[test]
fn modules_import_only_from_layers_below() {
    let sources = sources();
    assert!(sources.len() > 80, "the source was found: {} files", sources.len());
    let library = sources.iter().filter(|source| source.module() != "lib");
    let wrong: Vec<String> = library.flat_map(forbidden_imports).collect();
    assert!(wrong.is_empty(), "{wrong:#?}");
}

#[test]
fn files_do_not_depend_on_each_other_in_circles() {
    for folder in CRATES_OF_THE_PROJECT {
        let found = circles(&sources_in(folder));
        assert!(found.is_empty(), "{folder}: {found:#?}");
    }
}

#[test]
fn crates_stay_in_their_places() {
    let wrong: Vec<String> = sources().iter().flat_map(forbidden_crates).collect();
    assert!(wrong.is_empty(), "{wrong:#?}");
}

/// Counter-test: each check finds what it looks for, in paths and groups, and not in comments and tests.
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
    let chain = |last: &str| {
        let three = file("storage/three.rs", last);
        let one = file("storage/one.rs", "use crate::storage::two::X;");
        circles(&[one, file("storage/two.rs", "use super::three;"), three]).len()
    };
    assert_eq!([chain("fn f() {}"), chain("pub(in crate::storage::one) fn f() {}")], [0, 0]);
    assert_eq!([chain("fn f() -> crate::storage::one::X {}"), chain("use super::{four, one::{X, Y}};")], [3, 3]);
    // between folders, through what a `mod.rs` exports again, and to one below it
    let above = file("a/mod.rs", "pub mod b; pub use b::X;");
    assert_eq!(circles(&[file("a/mod.rs", "pub mod b;"), file("a/b.rs", "use super::Y;")]).len(), 0);
    assert_eq!(circles(&[above, file("a/b.rs", "use crate::a::Y;")]).len(), 2);
    assert_eq!(circles(&[file("a/c.rs", "use crate::d::e::X;"), file("d/e.rs", "use crate::a::c::Y;")]).len(), 2);
}

const WIDTH: usize = 120;

/// Law: no line is longer; rustfmt leaves comments, texts and macros alone.
#[test]
fn no_line_is_too_long() {
    let root = root();
    let mut long = Vec::new();
    let mut open: Vec<PathBuf> =
        ["benches", "crates", "examples", "fuzz", "src", "tests"].map(|name| root.join(name)).into();
    while let Some(path) = open.pop() {
        if path.is_dir() && path.file_name().is_some_and(|name| name != "target") {
            open.extend(std::fs::read_dir(&path).unwrap().map(|entry| entry.unwrap().path()));
        } else if path.extension().is_some_and(|found| found == "rs") {
            let text = std::fs::read_to_string(&path).unwrap();
            let lines = text.lines().enumerate().filter(|(_, line)| line.chars().count() > WIDTH);
            long.extend(lines.map(|(at, _)| format!("{}:{}", path.display(), at + 1)));
        }
    }
    assert!(long.is_empty(), "{long:#?}");
}
