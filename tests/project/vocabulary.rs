//! The old vocabulary does not return: words, phrases and type names that were replaced are not used anywhere.
//!
//! `vocabulary.txt` lists them with their replacements. A pattern is a sequence of whole words; what separates words (spaces, `_`, line
//! ends, comment marks) does not matter. A pattern with a capital letter is matched as it is written, others in any case.

use std::path::{Path, PathBuf};

/// The list: `pattern = what to write instead`, and below `[exceptions]` lines of `path: pattern: why`.
const LIST: &str = include_str!("vocabulary.txt");

/// Where the words are looked for.
const SEARCHED: [&str; 12] = [
    "src",
    "kernels",
    "tests",
    "benches",
    "examples",
    "campaigns",
    "docs",
    "README.md",
    "ARCHITECTURE.md",
    "CONTRIBUTING.md",
    "CHANGELOG.md",
    "SECURITY.md",
];

/// Files with other kinds of text are not searched.
const EXTENSIONS: [&str; 6] = ["rs", "md", "toml", "py", "sh", "txt"];

/// A pattern and what to write instead.
struct Pattern {
    text: &'static str,
    words: Vec<&'static str>,
    instead: &'static str,
    is_exact: bool,
}

/// Where a pattern may be used.
struct Exception {
    /// A file, or a folder whose files are all excepted.
    path: &'static str,
    pattern: &'static str,
}

fn list() -> (Vec<Pattern>, Vec<Exception>) {
    let (patterns, exceptions) = LIST.split_once("[exceptions]").expect("the list has exceptions");
    let lines = |text: &'static str| text.lines().filter(|line| !line.is_empty() && !line.starts_with('#'));
    let pattern = |line: &'static str| {
        let (text, instead) = line.split_once(" = ").unwrap_or_else(|| panic!("no replacement: {line}"));
        let is_exact = text.chars().any(char::is_uppercase);
        Pattern { text, words: text.split(' ').collect(), instead, is_exact }
    };
    let exception = |line: &'static str| {
        let parts: Vec<&str> = line.splitn(3, ": ").collect();
        assert_eq!(parts.len(), 3, "path: pattern: why, not {line}");
        Exception { path: parts[0], pattern: parts[1] }
    };
    (lines(patterns).map(pattern).collect(), lines(exceptions).map(exception).collect())
}

/// The words of a text with the lines where they begin.
fn words(text: &str) -> Vec<(&str, usize)> {
    let of_line = |(number, line)| {
        let words = str::split(line, |letter: char| !letter.is_ascii_alphanumeric());
        words.filter(|word| !word.is_empty()).map(move |word| (word, number + 1))
    };
    text.lines().enumerate().flat_map(of_line).collect()
}

/// The lines of `words` where `pattern` begins.
fn found(words: &[(&str, usize)], pattern: &Pattern) -> Vec<usize> {
    let is_same = |found: &str, wanted: &str| {
        if pattern.is_exact { found == wanted } else { found.eq_ignore_ascii_case(wanted) }
    };
    let begins = words
        .windows(pattern.words.len())
        .filter(|window| window.iter().zip(&pattern.words).all(|((found, _), wanted)| is_same(found, wanted)));
    begins.map(|window| window[0].1).collect()
}

fn files_below(path: &Path, list: &mut Vec<PathBuf>) {
    if path.is_dir() {
        for entry in std::fs::read_dir(path).expect("a readable folder") {
            files_below(&entry.expect("an entry").path(), list);
        }
    } else if path.extension().is_some_and(|extension| EXTENSIONS.iter().any(|known| extension == *known)) {
        list.push(path.to_owned());
    }
}

/// The searched files: path from the root, and text.
fn searched() -> Vec<(String, String)> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut files = Vec::new();
    SEARCHED.iter().for_each(|name| files_below(&root.join(name), &mut files));
    files.sort();
    let named = files.into_iter().map(|file| {
        let text = std::fs::read_to_string(&file).unwrap_or_else(|error| panic!("{}: {error}", file.display()));
        (file.strip_prefix(root).expect("below the root").to_string_lossy().replace('\\', "/"), text)
    });
    named.filter(|(path, _)| path != "tests/project/vocabulary.txt").collect()
}

/// Checked: no pattern is found outside its exceptions.
#[test]
fn the_old_vocabulary_is_not_used() {
    let (patterns, exceptions) = list();
    let files = searched();
    assert!(files.len() > 200, "{} files", files.len());
    let mut uses = Vec::new();
    for (path, text) in &files {
        let words = words(text);
        for pattern in &patterns {
            let is_excepted =
                |exception: &Exception| exception.pattern == pattern.text && path.starts_with(exception.path);
            if exceptions.iter().any(is_excepted) {
                continue;
            }
            let lines = found(&words, pattern);
            uses.extend(lines.iter().map(|line| format!("{path}:{line}: `{}`: {}", pattern.text, pattern.instead)));
        }
    }
    assert!(uses.is_empty(), "{} uses of the old vocabulary:\n{}", uses.len(), uses.join("\n"));
}

/// Checked: every exception is needed.
#[test]
fn every_exception_is_needed() {
    let (patterns, exceptions) = list();
    let files = searched();
    for exception in exceptions {
        let pattern = patterns.iter().find(|pattern| pattern.text == exception.pattern);
        let pattern = pattern.unwrap_or_else(|| panic!("`{}` is not in the list", exception.pattern));
        let mut texts = files.iter().filter(|(path, _)| path.starts_with(exception.path));
        let is_used = texts.any(|(_, text)| !found(&words(text), pattern).is_empty());
        assert!(is_used, "{}: `{}` needs no exception", exception.path, exception.pattern);
    }
}

/// Counter-test: words and phrases are found in names, across lines of a comment, and in any case; parts of words are not.
#[test]
fn the_search_can_fail() {
    let pattern = |text: &'static str| Pattern {
        text,
        words: text.split(' ').collect(),
        instead: "",
        is_exact: text.chars().any(char::is_uppercase),
    };
    let text = "/// An Example that turns\n/// on with `turns_on`.\nstruct Example;\nlet examples = ex_ample;";
    let words = words(text);
    assert_eq!(found(&words, &pattern("turns on")), [1, 2]);
    assert_eq!(found(&words, &pattern("example")), [1, 3]);
    assert_eq!(found(&words, &pattern("Example")), [1, 3]);
    assert_eq!(found(&words, &pattern("EXAMPLE")), [0_usize; 0]);
    assert!(list().0.len() > 60);
}
