//! [`Document`]: a TOML document read key by key, which collects all problems and knows the line of each key.
//!
//! A missing or wrong number is reported once and reads as NaN, so that lower layers can check the rest; their errors
//! about it are dropped ([`Document::add_from_below`]).

use super::excerpt::Excerpt;
use super::known_columns::KnownColumns;
use super::meaning::{Meant, meant};
use super::problem::{CampaignError, Problem, SHOWN};
use super::size;
use super::sources::{SourceText, Sources, lay_over, moved_table, put, value_at};
use crate::loops::{ControlLaw, OwnLaw};
use crate::sampling::keys::Written;
use crate::scene::SceneInput;
use std::collections::BTreeMap;
use std::ops::Range;
use std::path::{Path, PathBuf};
use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// Values of the command line that replace the file's, and the calling program's law.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Overrides<L = ()> {
    pub samples: Option<u64>,
    pub seed: Option<u64>,
    pub audit_fraction: Option<f64>,
    /// `--set`: dotted keys and values.
    pub settings: Vec<(String, String)>,
    pub law: Option<OwnLaw>,
    pub loops: L,
}

/// Noted problems; further ones are counted. More than are shown, which are the first by line.
const NOTED: usize = 10 * SHOWN;

const NO_CAMPAIGN_FILE: &str = "there is no [campaign] table: is this a campaign file?";

/// Parts of TOML's errors about a word without quotes.
const WORDS: [&str; 4] = ["must be quoted", "invalid boolean", "expected `nan`", "expected `inf`"];

fn syntax_remedy(message: &str) -> &'static str {
    if message.contains("array") {
        "fix this line, or close with ] the array that begins here or above"
    } else if WORDS.iter().any(|word| message.contains(word)) {
        "fix this line: text is written in quotes"
    } else {
        "fix this line"
    }
}

#[derive(Debug)]
pub struct Document<'a> {
    sources: &'a Sources,
    /// The texts of all sources in turn.
    text: &'a str,
    problems: Vec<Problem>,
    more: usize,
    /// Start of each line, bytes.
    starts: Vec<usize>,
    pub(super) spans: BTreeMap<String, Spans>,
    /// Data files and module, each with its SHA-256.
    pub files: Vec<(PathBuf, String)>,
    /// Number of problems that are unreadable files.
    pub unreadable: usize,
    /// Number of data tables, and of numbers read from them.
    pub(super) data: (usize, u64),
    /// The scene, whose tables give parameters their names.
    pub scene: SceneInput,
    /// The calling program's law.
    pub(super) own_law: Option<OwnLaw>,
    /// The control law of the plan, once read.
    pub law: Option<ControlLaw>,
    /// True if problems of the control loop leave its columns and parameters unknown.
    pub is_loop_unknown: bool,
    /// One sentence for each key without effect.
    pub(super) ignored: Vec<String>,
    /// The columns that later tables can name.
    pub(super) known: Option<KnownColumns>,
    /// Units of limits and dispersions as written, by column or parameter.
    pub(super) units: Vec<(String, &'static str)>,
    /// Tables for canonical text, in its order.
    pub(super) tables: Vec<(&'static str, Written)>,
}

/// The place of a key in the text, bytes.
#[derive(Clone, Debug)]
pub(super) struct Spans {
    /// The key; for a table of a list, the table.
    pub key: Range<usize>,
    /// The value; empty for a table.
    pub value: Range<usize>,
}

impl<'a> Document<'a> {
    pub(super) fn new<L>(sources: &'a Sources, overrides: &Overrides<L>) -> Self {
        let text = &sources.text;
        let ends = text.bytes().enumerate().filter(|(_, byte)| *byte == b'\n').map(|(offset, _)| offset + 1);
        Document {
            sources,
            text,
            problems: Vec::new(),
            more: 0,
            starts: std::iter::once(0).chain(ends).collect(),
            spans: BTreeMap::new(),
            files: Vec::new(),
            unreadable: 0,
            data: (0, 0),
            scene: SceneInput::blank(),
            own_law: overrides.law.clone(),
            law: None,
            is_loop_unknown: false,
            ignored: Vec::new(),
            known: None,
            units: Vec::new(),
            tables: Vec::new(),
        }
    }

    /// The base folder of a path at byte `offset`.
    pub fn folder_of(&self, offset: usize) -> &'a Path {
        &self.sources.at(offset).folder
    }

    /// Parses the texts and merges settings over the file, and the file over those that it extends.
    ///
    /// # Errors
    /// A text that is too large or not TOML (its first syntax error); a setting without a place.
    pub fn parse(&mut self) -> Result<DeTable<'a>, CampaignError> {
        let mut whole = DeTable::new();
        for source in self.sources.list.iter().filter(|source| source.key.is_none()).rev() {
            let mut table = self.parse_file(source)?;
            table.remove("extends");
            lay_over(&mut whole, table);
        }
        for source in &self.sources.list {
            let Some(key) = &source.key else { continue };
            let text = &self.text[source.range.clone()];
            put(&mut whole, key, value_at(text, source.range.start)).map_err(|why| {
                let remedy = "write the key as shown in error messages: campaign.duration_s, wheels.w1.rate_rad_s";
                let allowed = format!("set where a campaign has the key ({why})");
                CampaignError::new(&source.name, key, text.to_owned(), allowed, remedy)
            })?;
        }
        Ok(whole)
    }

    fn parse_file(&self, source: &'a SourceText) -> Result<DeTable<'a>, CampaignError> {
        let (file, text) = (&source.name, &self.text[source.range.clone()]);
        size::check_text(file, text.len() as u64)?;
        let (table, errors) = DeTable::parse_recoverable(text);
        // later errors mostly follow from the first
        let start = |error: &toml::de::Error| error.span().map_or(0, |span| span.start);
        if let Some(error) = errors.into_iter().min_by_key(start) {
            let span = error.span().unwrap_or_default();
            let span = span.start + source.range.start..span.end + source.range.start;
            let line = self.line_at(span.start);
            let problem = Problem {
                file: file.clone(),
                line: self.place(span.start).1,
                key: "line".to_owned(),
                value: Some(shortened(self.line(line))),
                allowed: format!("valid TOML ({})", size::plain(error.message())),
                remedy: syntax_remedy(error.message()).to_owned(),
                is_unknown: false,
                excerpt: self.excerpt(&span),
            };
            let is_campaign = self.text.contains("[campaign");
            let note = (!is_campaign).then_some(NO_CAMPAIGN_FILE);
            return Err(CampaignError { note, ..CampaignError::of(problem) });
        }
        let table = table.into_inner();
        size::check_table(file, &table)?;
        Ok(if self.sources.list.len() == 1 { table } else { moved_table(table, source.range.start) })
    }

    /// True if `key`, a table around it or a key in it has a problem.
    pub fn is_reported(&self, key: &str) -> bool {
        let contains = |outer: &str, inner: &str| {
            inner == outer || inner.strip_prefix(outer).is_some_and(|rest| rest.starts_with(['.', '[']))
        };
        self.problems.iter().any(|problem| contains(&problem.key, key) || contains(key, &problem.key))
    }

    /// Notes a problem of `key`, at its line or that of the nearest table around it.
    pub fn add(&mut self, key: &str, value: Option<String>, allowed: impl Into<String>, remedy: impl Into<String>) {
        self.note(key, value, allowed.into(), remedy.into(), false);
    }

    pub(super) fn add_unknown(&mut self, key: &str, value: Option<String>, place: String, remedy: String) {
        self.note(key, value, place, remedy, true);
    }

    fn note(&mut self, key: &str, value: Option<String>, allowed: String, remedy: String, is_unknown: bool) {
        if self.is_full() {
            self.more += 1;
            return;
        }
        let exact = self.spans.get(key).filter(|_| value.is_some());
        let excerpt =
            exact.and_then(|spans| self.excerpt(if spans.value.is_empty() { &spans.key } else { &spans.value }));
        let offset = self.offset_of(key);
        // the message of a setting shows its value
        let excerpt = excerpt.filter(|_| offset.is_some_and(|offset| self.sources.at(offset).key.is_none()));
        let (file, line) = offset.map_or((self.sources.list[0].name.as_str(), None), |offset| self.place(offset));
        self.problems.push(Problem {
            file: file.to_owned(),
            line,
            key: key.chars().take(LONGEST_KEY).collect(),
            value: value.map(|value| shortened(&value)),
            allowed,
            remedy,
            is_unknown,
            excerpt,
        });
    }

    /// The existing key that the setting at byte `offset` probably means, with or without its first table.
    pub(super) fn setting_meant(&self, offset: usize) -> Option<Meant<'_>> {
        let written = self.sources.at(offset).key.as_deref()?;
        let (_, rest) = written.split_once('.')?;
        let near = |name: &str| meant(name, self.spans.keys().map(String::as_str).filter(|key| key.contains('.')));
        near(rest).or_else(|| near(written)).filter(|meant| meant.name != written)
    }

    pub(super) fn noted(&self) -> usize {
        self.problems.len()
    }

    /// Drops the problems after the first `noted`, from which they follow.
    pub(super) fn forget_since(&mut self, noted: usize) {
        self.problems.truncate(noted);
    }

    pub(super) fn keep(&mut self, header: &'static str, written: Written) {
        if written != Written::NONE {
            self.tables.push((header, written));
        }
    }

    /// True if `name` may be a parameter of an unreadable control loop.
    pub(super) fn may_be_of_loop(&self, name: &str) -> bool {
        self.is_loop_unknown && ["control.", "sensors.", "guidance."].iter().any(|table| name.starts_with(table))
    }

    pub(super) fn is_full(&self) -> bool {
        self.problems.len() >= NOTED
    }

    /// The line at the start of `span`, with a mark.
    fn excerpt(&self, span: &Range<usize>) -> Option<Excerpt> {
        let line = self.line_at(span.start);
        let start = self.starts[line - 1];
        Excerpt::new(self.line(line), span.start.checked_sub(start)?..span.end.max(span.start) - start)
    }

    /// Notes problems from a lower layer, except for keys that have one.
    pub fn add_from_below(&mut self, found: Vec<(String, Option<String>, String, String)>) {
        let fresh: Vec<_> = found.into_iter().filter(|(key, ..)| !self.is_reported(key)).collect();
        for (key, value, allowed, remedy) in fresh {
            self.add(&key, value, allowed, remedy);
        }
    }

    /// # Errors
    /// All problems, by line.
    pub fn verdict(self) -> Result<(), CampaignError> {
        let mut problems = self.problems;
        problems.sort_by_key(|problem| problem.line.unwrap_or(usize::MAX));
        if problems.is_empty() {
            return Ok(());
        }
        let is_unreadable = self.unreadable == problems.len() + self.more;
        Err(CampaignError { problems, more: self.more, note: None, is_unreadable })
    }

    /// The place of `key`, or of the nearest table around it.
    fn offset_of(&self, key: &str) -> Option<usize> {
        let mut key = key;
        loop {
            if let Some(spans) = self.spans.get(key) {
                return Some(spans.key.start);
            }
            key = &key[..key.rfind(['.', '['])?];
        }
    }

    /// The source at byte `offset` and the line in it; a setting has no line.
    fn place(&self, offset: usize) -> (&'a str, Option<usize>) {
        let source = self.sources.at(offset);
        let line = self.line_at(offset) + 1 - self.line_at(source.range.start);
        (&source.name, source.key.is_none().then_some(line))
    }

    pub(super) fn line_at(&self, offset: usize) -> usize {
        self.starts.partition_point(|start| *start <= offset)
    }

    fn line(&self, number: usize) -> &'a str {
        let end = self.starts.get(number).copied().unwrap_or(self.text.len());
        self.text.get(self.starts[number - 1]..end).unwrap_or("").trim_end()
    }

    pub(super) fn text_of(&self, value: &Spanned<DeValue<'a>>) -> &'a str {
        self.text.get(value.span()).unwrap_or("")
    }

    pub(super) fn written(&self, value: &Spanned<DeValue<'a>>) -> String {
        shortened(self.text.get(value.span()).unwrap_or(""))
    }
}

const LONGEST_KEY: usize = 300;
const LONGEST_VALUE: usize = 60;

fn shortened(text: &str) -> String {
    let (mut line, mut left) = (String::new(), LONGEST_VALUE);
    for word in text.split_whitespace() {
        if !line.is_empty() {
            if left == 0 {
                return line + "...";
            }
            (line, left) = (line + " ", left - 1);
        }
        match word.char_indices().nth(left) {
            Some((end, _)) => return line + &word[..end] + "...",
            None => (line, left) = (line + word, left - word.chars().count()),
        }
    }
    line
}
