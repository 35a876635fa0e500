//! [`Document`]: a TOML document that is read key by key, collects everything that is wrong, and remembers the line of
//! each key. Its tables are read by [`super::section`].
//!
//! A number that is missing or wrong is read as NaN and reported once; so the lower layers can still check the rest,
//! and what they report about a key that was reported already is dropped ([`Document::add_from_below`]).

use super::excerpt::Excerpt;
use super::known_columns::KnownColumns;
use super::meaning::{Meant, meant};
use super::problem::{CampaignError, Problem, SHOWN};
use super::size;
use super::sources::{SourceText, Sources, lay_over, moved_table, put, value_at};
use crate::control::ControlLaw;
use crate::control::laws::LawKind;
use crate::sampling::keys::Written;
use crate::scene::SceneInput;
use std::collections::BTreeMap;
use std::ops::Range;
use std::path::{Path, PathBuf};
use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// Problems that are noted; further ones are counted only. More than are shown, since those are the first ones by line.
const NOTED: usize = 10 * SHOWN;

/// What is said of a text that is not TOML, and has no table of a campaign.
const NO_CAMPAIGN_FILE: &str = "there is no [campaign] table: is this a campaign file?";

/// What syntax errors say of a word without quotes; of one that begins with t, f, n or i, that it is not `true`,
/// `false`, `nan` or `inf`.
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

/// What is known about a file while it is read.
#[derive(Debug)]
pub struct Document<'a> {
    sources: &'a Sources,
    /// The texts of all sources, one after the other.
    text: &'a str,
    problems: Vec<Problem>,
    /// Problems that are counted only.
    more: usize,
    /// Where each line begins, bytes.
    starts: Vec<usize>,
    pub(super) spans: BTreeMap<String, Spans>,
    /// The files of numbers and the module that were read, each with the SHA-256 of its bytes.
    pub(super) files: Vec<(PathBuf, String)>,
    /// Problems that are no more than that a file cannot be read now.
    pub(super) unreadable: usize,
    /// How many tables named a file of numbers, and how many numbers were read.
    pub(super) data: (usize, u64),
    /// The scene of the document, once it is read: names of parameters are those of its tables.
    pub(super) scene: SceneInput,
    /// The control law that the program brings, or the loop of the file.
    pub(super) law: Option<ControlLaw>,
    /// The law of attitude that the program brings, for phases.
    pub(super) attitude_law: Option<&'static LawKind>,
    /// Whether the file has a control loop of which too little could be read to say its columns and parameters.
    pub(super) is_loop_unknown: bool,
    /// Keys that are there without effect, a sentence each.
    pub(super) ignored: Vec<String>,
    /// What the tables that follow the scene can name, once that is known.
    pub(super) known: Option<KnownColumns>,
    /// The units in which limits and dispersions are written, by the name of the column or parameter.
    pub(super) units: Vec<(String, &'static str)>,
    /// Tables that canonical text has as they were read, in its order.
    pub(super) tables: Vec<(&'static str, Written)>,
}

/// Where a key is in the text, bytes.
#[derive(Clone, Debug)]
pub(super) struct Spans {
    /// Where it is written; of a table of a list, where the table is.
    pub key: Range<usize>,
    /// Where its value is; empty for a table.
    pub value: Range<usize>,
}

impl<'a> Document<'a> {
    pub(super) fn new(sources: &'a Sources) -> Self {
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
            law: None,
            attitude_law: None,
            is_loop_unknown: false,
            ignored: Vec::new(),
            known: None,
            units: Vec::new(),
            tables: Vec::new(),
        }
    }

    /// The same document of a program that brings the control law `law`, or a law of attitude for phases.
    pub fn under(self, law: Option<ControlLaw>, attitude_law: Option<&'static LawKind>) -> Self {
        Document { law, attitude_law, ..self }
    }

    /// The folder from which a path counts that is written at the byte `offset`.
    pub(super) fn folder_of(&self, offset: usize) -> &'a Path {
        &self.sources.at(offset).folder
    }

    /// Parses the texts, and lays what is set over the file, and the file over those that it extends.
    ///
    /// # Errors
    /// Where a text is too large or has too many keys; where it is no TOML, its first syntax error alone; where a
    /// setting leads nowhere.
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
                CampaignError::of(Problem {
                    file: source.name.clone(),
                    line: None,
                    key: key.clone(),
                    value: Some(text.to_owned()),
                    allowed: format!("set where a campaign has the key ({why})"),
                    remedy: "write the key as shown in error messages: campaign.duration_s, wheels.w1.rate_rad_s"
                        .to_owned(),
                    is_unknown: false,
                    excerpt: None,
                })
            })?;
        }
        Ok(whole)
    }

    fn parse_file(&self, source: &'a SourceText) -> Result<DeTable<'a>, CampaignError> {
        let (file, text) = (&source.name, &self.text[source.range.clone()]);
        if let Some(problem) = size::of_text(file, text) {
            return Err(CampaignError::of(problem));
        }
        let (table, errors) = DeTable::parse_recoverable(text);
        // what follows the first error mostly follows from it
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
        match size::of_table(file, &table) {
            Some(problem) => Err(CampaignError::of(problem)),
            // the places of a single file are its own
            None if self.sources.is_single() => Ok(table),
            None => Ok(moved_table(table, source.range.start)),
        }
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
        // a setting has one value, which the message names
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

    /// The written key that the key of what is set at the byte `offset` probably means: it, or what follows a table
    /// that no file has.
    pub(super) fn setting_meant(&self, offset: usize) -> Option<Meant<'_>> {
        let written = self.sources.at(offset).key.as_deref()?;
        let (_, rest) = written.split_once('.')?;
        let near = |name: &str| meant(name, self.spans.keys().map(String::as_str).filter(|key| key.contains('.')));
        near(rest).or_else(|| near(written)).filter(|meant| meant.name != written)
    }

    pub(super) fn noted(&self) -> usize {
        self.problems.len()
    }

    /// Forgets the problems after the first `noted`: they follow from one of those.
    pub(super) fn forget_since(&mut self, noted: usize) {
        self.problems.truncate(noted);
    }

    pub(super) fn keep(&mut self, header: &'static str, written: Written) {
        if written != Written::NONE {
            self.tables.push((header, written));
        }
    }

    /// Whether `name` may be a parameter of the control loop, of which too little could be read.
    pub(super) fn may_be_of_loop(&self, name: &str) -> bool {
        self.is_loop_unknown && ["control.", "sensors.", "guidance."].iter().any(|table| name.starts_with(table))
    }

    pub(super) fn is_full(&self) -> bool {
        self.problems.len() >= NOTED
    }

    /// The line of the text in which `span` begins, with what is to be marked in it.
    fn excerpt(&self, span: &Range<usize>) -> Option<Excerpt> {
        let line = self.line_at(span.start);
        let start = self.starts[line - 1];
        Excerpt::new(self.line(line), span.start.checked_sub(start)?..span.end.max(span.start) - start)
    }

    /// Notes what a lower layer reports about several keys, except for those that have a problem already.
    pub fn add_from_below(&mut self, found: Vec<(String, Option<String>, String, String)>) {
        let fresh: Vec<_> = found.into_iter().filter(|(key, ..)| !self.is_reported(key)).collect();
        for (key, value, allowed, remedy) in fresh {
            self.add(&key, value, allowed, remedy);
        }
    }

    /// Nothing, or everything that is wrong, by line.
    ///
    /// # Errors
    /// Where anything is wrong.
    pub fn verdict(self) -> Result<(), CampaignError> {
        let mut problems = self.problems;
        problems.sort_by_key(|problem| problem.line.unwrap_or(usize::MAX));
        if problems.is_empty() {
            return Ok(());
        }
        let is_unreadable = self.unreadable == problems.len() + self.more;
        Err(CampaignError { problems, more: self.more, note: None, is_unreadable })
    }

    /// Where `key` is, or the nearest table around it.
    fn offset_of(&self, key: &str) -> Option<usize> {
        let mut key = key;
        loop {
            if let Some(spans) = self.spans.get(key) {
                return Some(spans.key.start);
            }
            key = &key[..key.rfind(['.', '['])?];
        }
    }

    /// The source that has the byte `offset`, and the line in it; what is set has no lines.
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

/// Most characters of a key in a message.
const LONGEST_KEY: usize = 300;
/// Most characters of a value in a message.
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
