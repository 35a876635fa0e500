//! Reading the program's own source: files, code without comments and strings, the paths in it, and the files they lead to.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

/// The folder of the package.
pub fn root() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR"))
}

/// Appends the Rust files below `folder`, sorted within each folder.
pub fn files_below(folder: &Path, list: &mut Vec<PathBuf>) {
    let mut entries: Vec<PathBuf> =
        std::fs::read_dir(folder).expect("a readable folder").map(|entry| entry.expect("an entry").path()).collect();
    entries.sort();
    for path in entries {
        if path.is_dir() {
            files_below(&path, list);
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            list.push(path);
        }
    }
}

/// A path as its segments: `crate::math::Real` is ["crate", "math", "Real"].
pub type Segments = Vec<String>;

/// The folders with the source of the library, each of a package of its own: the program exports the modules of the kernels as its own.
pub const FOLDERS: [&str; 2] = ["src", "kernels/src"];

/// A source file of the library or of the program.
#[derive(Clone, Debug)]
pub struct Source {
    /// Path from the folder of [`FOLDERS`] that it is in.
    pub path: String,
    /// Module path: `["math", "vector"]`; empty for `lib.rs`.
    pub module: Segments,
    /// Code up to the unit tests, without comments and without the contents of strings.
    pub code: String,
}

impl Source {
    /// A file at `path` below a folder of [`FOLDERS`] with this text.
    pub fn new(path: &str, text: &str) -> Self {
        let stem = path.trim_end_matches(".rs");
        let stem = stem.strip_suffix("/mod").unwrap_or(stem);
        let module = if stem == "lib" { Vec::new() } else { stem.split('/').map(str::to_owned).collect() };
        Source { path: path.to_owned(), module, code: code(text) }
    }

    /// The module below the crate's root that the file belongs to: `math`, or `lib`.
    pub fn layer(&self) -> &str {
        self.module.first().map_or("lib", String::as_str)
    }
}

/// The files of the library and of the program, without modules declared under `#[cfg(test)]`.
pub fn sources() -> Vec<Source> {
    FOLDERS.iter().flat_map(|folder| sources_of(folder)).collect()
}

/// Those of one of [`FOLDERS`].
pub fn sources_of(folder: &str) -> Vec<Source> {
    let folder = root().join(folder);
    let mut list = Vec::new();
    files_below(&folder, &mut list);
    let source = |file: PathBuf| {
        let path = file.strip_prefix(&folder).expect("below the folder").to_string_lossy().replace('\\', "/");
        Source::new(&path, &std::fs::read_to_string(&file).expect("a source file"))
    };
    list.into_iter().map(source).filter(|source| !is_for_tests_only(&source.path)).collect()
}

/// Whether the module of the file is declared under `#[cfg(test)]`.
pub fn is_for_tests_only(path: &str) -> bool {
    let path = Path::new(path);
    let (Some(folder), Some(name)) = (path.parent(), path.file_stem()) else { return false };
    let parents = FOLDERS.map(|source| root().join(source).join(folder).join("mod.rs"));
    let Some(text) = parents.iter().find_map(|parent| std::fs::read_to_string(parent).ok()) else { return false };
    let declaration = format!("mod {};", name.to_string_lossy());
    let mut lines = text.lines().zip(text.lines().skip(1));
    lines.any(|(before, line)| before.trim() == "#[cfg(test)]" && line.trim().ends_with(&declaration))
}

/// `text` up to its unit tests, without comments; strings and characters are empty.
pub fn code(text: &str) -> String {
    let shipped = text.split("#[cfg(test)]\nmod tests {").next().unwrap_or_default();
    let letters: Vec<char> = shipped.chars().collect();
    let at = |index: usize| letters.get(index).copied().unwrap_or('\0');
    let (mut code, mut k) = (String::new(), 0);
    while k < letters.len() {
        match (letters[k], at(k + 1)) {
            ('/', '/') => k += letters[k..].iter().take_while(|letter| **letter != '\n').count(),
            ('/', '*') => {
                let end = (k + 2..letters.len()).find(|end| at(*end) == '*' && at(*end + 1) == '/');
                k = end.map_or(letters.len(), |end| end + 2);
            }
            ('r', '"' | '#') if !code.ends_with(|letter: char| letter.is_alphanumeric() || letter == '_') => {
                let hashes = letters[k + 1..].iter().take_while(|letter| **letter == '#').count();
                if at(k + 1 + hashes) == '"' {
                    let closes = |end: &usize| at(*end) == '"' && (1..=hashes).all(|hash| at(*end + hash) == '#');
                    let end = (k + 2 + hashes..letters.len()).find(closes).unwrap_or(letters.len());
                    code.push_str("\"\"");
                    k = end + 1 + hashes;
                } else {
                    code.push('r'); // a raw identifier
                    k += 1;
                }
            }
            ('"', _) => {
                k += 1;
                while k < letters.len() && letters[k] != '"' {
                    k += if letters[k] == '\\' { 2 } else { 1 };
                }
                code.push_str("\"\"");
                k += 1;
            }
            ('\'', '\\') => {
                let end = (k + 3..letters.len()).find(|end| at(*end) == '\'').unwrap_or(letters.len());
                code.push_str("' '");
                k = end + 1;
            }
            ('\'', _) if at(k + 2) == '\'' => {
                code.push_str("' '");
                k += 3;
            }
            (letter, _) => {
                code.push(letter);
                k += 1;
            }
        }
    }
    code
}

fn is_word(letter: char) -> bool {
    letter.is_alphanumeric() || letter == '_'
}

/// Letters before a path that tell whether it begins there and whether it is in a `use`.
const LOOK_BACK: usize = 24;

/// Whether `letters` continue a path.
fn is_path(letters: &[char]) -> bool {
    let mut rest = letters.iter().skip_while(|letter| letter.is_whitespace());
    rest.next() == Some(&':') && rest.next() == Some(&':')
}

/// The paths of at least two segments in `code`, trees of braces expanded, each with the name it is imported as (its last
/// segment unless `as` says otherwise) where it is in a `use`. A path in the restriction of `pub(in ...)` is not one.
pub fn paths(code: &str) -> Vec<(Segments, Option<String>)> {
    let letters: Vec<char> = code.chars().collect();
    let mut found = Vec::new();
    let mut k = 0;
    while k < letters.len() {
        if !is_word(letters[k]) {
            k += 1;
            continue;
        }
        let length = letters[k..].iter().take_while(|letter| is_word(**letter)).count();
        let before: String = letters[k.saturating_sub(LOOK_BACK)..k].iter().collect();
        let before = before.trim_end();
        let is_start = !before.ends_with("::") && !before.ends_with('.') && !before.ends_with("(in");
        let is_use = ["use", "pub use", "pub(crate) use", "pub(super) use"].iter().any(|word| before.ends_with(word));
        if is_start && is_path(&letters[k + length..]) {
            let mut tree = Tree { letters: &letters, at: k, found: Vec::new() };
            tree.read(&Vec::new());
            k = tree.at;
            found.extend(tree.found.into_iter().map(|(path, name)| (path, name.filter(|_| is_use))));
        } else {
            k += length;
        }
    }
    found.retain(|(path, _)| path.len() > 1);
    found
}

/// Reader of one path or tree of paths.
struct Tree<'a> {
    letters: &'a [char],
    at: usize,
    found: Vec<(Segments, Option<String>)>,
}

impl Tree<'_> {
    fn blank(&mut self) {
        while self.letters.get(self.at).is_some_and(|letter| letter.is_whitespace()) {
            self.at += 1;
        }
    }

    fn accept(&mut self, text: &str) -> bool {
        self.blank();
        let is_here = text.chars().enumerate().all(|(k, letter)| self.letters.get(self.at + k) == Some(&letter));
        if is_here {
            self.at += text.len();
        }
        is_here
    }

    fn word(&mut self) -> Option<String> {
        self.blank();
        let word: String = self.letters[self.at..].iter().take_while(|letter| is_word(**letter)).collect();
        self.at += word.chars().count();
        (!word.is_empty()).then_some(word)
    }

    fn read(&mut self, prefix: &Segments) {
        let mut path = prefix.clone();
        loop {
            if self.accept("{") {
                while !self.accept("}") && self.at < self.letters.len() {
                    self.read(&path);
                    if !self.accept(",") && self.letters.get(self.at) != Some(&'}') {
                        return;
                    }
                }
                return;
            }
            if self.accept("*") {
                path.push("*".to_owned());
                self.found.push((path, None));
                return;
            }
            let Some(word) = self.word() else {
                self.found.push((path, None));
                return;
            };
            if word == "self" && !path.is_empty() {
                break; // `a::{self}` is the path `a`
            }
            path.push(word);
            if !self.accept("::") {
                break;
            }
        }
        let here = self.at;
        let name = if self.word().as_deref() == Some("as") { self.word() } else { None };
        if name.is_none() {
            self.at = here;
        }
        let name = name.or_else(|| path.last().cloned());
        self.found.push((path, name));
    }
}

/// The files of a crate, by the module path of each, with what every `pub use` names.
pub struct Crate<'a> {
    files: BTreeMap<Segments, &'a Source>,
    reexports: BTreeMap<(Segments, String), Segments>,
}

impl<'a> Crate<'a> {
    /// The crate of these files.
    pub fn new(sources: &'a [Source]) -> Self {
        let files = sources.iter().map(|source| (source.module.clone(), source)).collect();
        let mut this = Crate { files, reexports: BTreeMap::new() };
        for source in sources {
            for statement in source.code.split("pub use ").skip(1) {
                let statement = format!("use {};", statement.split(';').next().unwrap_or_default());
                for (path, name) in paths(&statement) {
                    if let (Some(path), Some(name)) = (this.absolute(source, &path), name) {
                        this.reexports.insert((source.module.clone(), name), path);
                    }
                }
            }
        }
        this
    }

    /// The path from the crate's root; `None` where it leads out of the crate or is no path of a module.
    fn absolute(&self, source: &Source, path: &Segments) -> Option<Segments> {
        let (first, rest) = path.split_first()?;
        let mut module = source.module.clone();
        match first.as_str() {
            "crate" | "spindrift" | "spindrift_kernels" => module.clear(),
            "self" => {}
            "super" => {
                module.pop();
                let above = rest.iter().take_while(|segment| *segment == "super").count();
                module.truncate(module.len().saturating_sub(above));
                module.extend_from_slice(&rest[above..]);
                return Some(module);
            }
            child => {
                module.push(child.to_owned());
                if !self.files.contains_key(&module) {
                    return None;
                }
            }
        }
        module.extend_from_slice(rest);
        Some(module)
    }

    /// The file that defines what the absolute `path` names.
    fn file(&self, path: &Segments) -> Option<&'a Source> {
        let mut path = path.clone();
        for _ in 0..8 {
            let depth = (0..=path.len()).rev().find(|depth| self.files.contains_key(&path[..*depth]))?;
            let (module, rest) = path.split_at(depth);
            let Some((item, rest)) = rest.split_first() else { return self.files.get(module).copied() };
            match self.reexports.get(&(module.to_vec(), item.clone())) {
                Some(target) => path = target.iter().chain(rest).cloned().collect(),
                None => return self.files.get(module).copied(),
            }
        }
        None
    }

    /// The files that `source` depends on, itself excluded. `pub use` of a module's own submodules is not a dependency.
    pub fn dependencies(&self, source: &Source) -> BTreeSet<&'a str> {
        let own = paths(&source.code);
        // modules that a `use` gives a local name: `use crate::a::b;` makes `b::f` the path `crate::a::b::f`
        let aliases: BTreeMap<&String, Segments> = own
            .iter()
            .filter_map(|(path, name)| Some((name.as_ref()?, self.absolute(source, path)?)))
            .filter(|(_, path)| self.files.contains_key(path))
            .collect();
        let mut found = BTreeSet::new();
        for (path, name) in &own {
            let alias = path.first().and_then(|first| aliases.get(first)).filter(|_| name.is_none());
            let absolute = match alias {
                Some(alias) => Some(alias.iter().chain(&path[1..]).cloned().collect()),
                None => self.absolute(source, path),
            };
            let Some(absolute) = absolute else { continue };
            let is_reexport = name.as_ref().is_some_and(|name| {
                let known = self.reexports.get(&(source.module.clone(), name.clone()));
                known == Some(&absolute) && absolute.starts_with(&source.module)
            });
            // a module that is only named stands for the items that are used through its name
            let is_module_import = name.is_some() && self.files.contains_key(&absolute);
            if is_reexport || is_module_import && own.iter().any(|(path, _)| path.first() == name.as_ref()) {
                continue;
            }
            found.extend(self.file(&absolute).map(|file| file.path.as_str()));
        }
        found.remove(source.path.as_str());
        found
    }

    /// Groups of files of `layer` in which each depends on every other, directly or through others.
    pub fn cycles(&self, layer: &str) -> Vec<Vec<&'a str>> {
        let files: Vec<&'a Source> = self.files.values().copied().filter(|source| source.layer() == layer).collect();
        let mut reach: BTreeMap<&'a str, BTreeSet<&'a str>> =
            files.iter().map(|source| (source.path.as_str(), self.dependencies(source))).collect();
        loop {
            let before: usize = reach.values().map(BTreeSet::len).sum();
            for source in &files {
                let through: Vec<&str> =
                    reach[source.path.as_str()].iter().filter_map(|next| reach.get(next)).flatten().copied().collect();
                reach.entry(&source.path).or_default().extend(through);
            }
            if reach.values().map(BTreeSet::len).sum::<usize>() == before {
                break;
            }
        }
        let reaches = |from: &Source, to: &Source| reach[from.path.as_str()].contains(to.path.as_str());
        let group = |source: &&'a Source| -> Vec<&'a str> {
            let together = files.iter().filter(|other| reaches(source, other) && reaches(other, source));
            let mut together: Vec<&str> = together.map(|other| other.path.as_str()).collect();
            together.sort_unstable();
            together
        };
        let groups: BTreeSet<Vec<&'a str>> = files.iter().filter(|source| reaches(source, source)).map(group).collect();
        groups.into_iter().collect()
    }
}
