//! [`Document`]: a TOML document that is read key by key, collects everything that is wrong, and remembers the line of each
//! key. Its tables are read by [`super::section`].
//!
//! A number that is missing or wrong is read as NaN and reported once; so the lower layers can still check the rest, and
//! what they report about a key that was reported already is dropped ([`Document::add_from_below`]).

use super::problem::{CampaignError, Problem};
use crate::scene::SceneInput;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// What is known about a file while it is read.
#[derive(Debug)]
pub struct Document<'a> {
    file: &'a str,
    text: &'a str,
    problems: Vec<Problem>,
    pub(super) lines: BTreeMap<String, usize>,
    /// The folder from which paths in the document count.
    folder: PathBuf,
    /// The scene of the document, once it is read: names of parameters are those of its tables.
    pub(super) scene: SceneInput,
}

impl<'a> Document<'a> {
    /// A document before anything has been read.
    pub fn new(file: &'a str, text: &'a str) -> Self {
        Document {
            file,
            text,
            problems: Vec::new(),
            lines: BTreeMap::new(),
            folder: PathBuf::new(),
            scene: SceneInput::blank(),
        }
    }

    /// The same document in `folder`, from which its paths count; without, they count from the working directory.
    pub fn in_folder(mut self, folder: &Path) -> Self {
        self.folder = folder.to_owned();
        self
    }

    /// The folder from which paths in the document count.
    pub fn folder(&self) -> &Path {
        &self.folder
    }

    /// Parses the text; what is not TOML is reported, and the rest is read.
    pub fn parse(&mut self) -> DeTable<'a> {
        let (table, errors) = DeTable::parse_recoverable(self.text);
        let mut last = 0;
        for error in errors {
            let line = self.line_at(error.span().map_or(0, |span| span.start));
            // what follows on the same line follows from the first
            if line == last {
                continue;
            }
            last = line;
            let written = self.text.lines().nth(line - 1).unwrap_or("").trim();
            self.problems.push(Problem {
                file: self.file.to_owned(),
                line: Some(line),
                key: "line".to_owned(),
                value: Some(shortened(written)),
                allowed: format!("valid TOML ({})", error.message()),
                remedy: "fix this line".to_owned(),
            });
        }
        table.into_inner()
    }

    /// Whether `key`, or a table that contains it, or a key in it, has a problem already.
    pub fn is_reported(&self, key: &str) -> bool {
        let contains = |outer: &str, inner: &str| {
            inner == outer || inner.strip_prefix(outer).is_some_and(|rest| rest.starts_with(['.', '[']))
        };
        self.problems.iter().any(|problem| contains(&problem.key, key) || contains(key, &problem.key))
    }

    /// Notes a problem of `key`, on the line of that key or of the nearest table around it.
    pub fn add(&mut self, key: &str, value: Option<String>, allowed: impl Into<String>, remedy: impl Into<String>) {
        self.problems.push(Problem {
            file: self.file.to_owned(),
            line: self.line_of(key),
            key: key.to_owned(),
            value: value.map(|value| shortened(&value)),
            allowed: allowed.into(),
            remedy: remedy.into(),
        });
    }

    /// Notes what a lower layer reports about several keys, except for those that have a problem already.
    pub fn add_from_below(&mut self, found: Vec<(String, String, String, String)>) {
        let fresh: Vec<_> = found.into_iter().filter(|(key, ..)| !self.is_reported(key)).collect();
        for (key, value, allowed, remedy) in fresh {
            self.add(&key, Some(value), allowed, remedy);
        }
    }

    /// Nothing, or everything that is wrong, by line.
    ///
    /// # Errors
    /// Where anything is wrong.
    pub fn verdict(self) -> Result<(), CampaignError> {
        let mut problems = self.problems;
        problems.sort_by_key(|problem| problem.line.unwrap_or(usize::MAX));
        if problems.is_empty() { Ok(()) } else { Err(CampaignError { problems }) }
    }

    /// The line of `key`, or of the nearest table around it.
    fn line_of(&self, key: &str) -> Option<usize> {
        let mut key = key;
        loop {
            if let Some(line) = self.lines.get(key) {
                return Some(*line);
            }
            key = &key[..key.rfind(['.', '['])?];
        }
    }

    pub(super) fn line_at(&self, offset: usize) -> usize {
        1 + self.text.as_bytes()[..offset.min(self.text.len())].iter().filter(|byte| **byte == b'\n').count()
    }

    /// A value as written.
    pub(super) fn text_of(&self, value: &Spanned<DeValue<'a>>) -> &'a str {
        self.text.get(value.span()).unwrap_or("")
    }

    pub(super) fn written(&self, value: &Spanned<DeValue<'a>>) -> String {
        shortened(self.text.get(value.span()).unwrap_or(""))
    }
}

/// At most 60 characters of one line.
fn shortened(text: &str) -> String {
    let line = text.split_whitespace().collect::<Vec<_>>().join(" ");
    match line.char_indices().nth(60) {
        Some((end, _)) => format!("{}...", &line[..end]),
        None => line,
    }
}
