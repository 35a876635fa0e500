//! [`Document`] and [`Section`]: a TOML document that is read key by key, gathers everything that is wrong, and remembers on
//! which line each key stands.
//!
//! A number that is missing or wrong is read as NaN and reported once; so the floors below can still look at the rest, and
//! what they say about a key that was reported already is dropped ([`Document::add_from_below`]).

use super::problem::{CampaignError, Problem, nearest};
use crate::sampling::Values;
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
    lines: BTreeMap<String, usize>,
    /// The folder from which paths in the document count.
    folder: PathBuf,
}

/// What a number may be.
#[derive(Clone, Copy, Debug)]
pub struct Limit {
    /// In words, to follow `must be`.
    pub allowed: &'static str,
    /// What to do otherwise.
    pub remedy: &'static str,
    /// Whether a number is allowed.
    pub test: fn(f64) -> bool,
}

/// Any finite number.
pub const FINITE: Limit =
    Limit { allowed: "a finite number", remedy: "write a number such as 1.5", test: |x| x.is_finite() };
/// A number above zero.
pub const POSITIVE: Limit =
    Limit { allowed: "a number > 0", remedy: "write a positive number", test: |x| x.is_finite() && x > 0.0 };

impl<'a> Document<'a> {
    /// A document of which nothing has been read.
    pub fn new(file: &'a str, text: &'a str) -> Self {
        Document { file, text, problems: Vec::new(), lines: BTreeMap::new(), folder: PathBuf::new() }
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
                remedy: "mend this line".to_owned(),
            });
        }
        table.into_inner()
    }

    /// Whether `key`, or a table that holds it, or a key in it, has a problem already.
    pub fn is_reported(&self, key: &str) -> bool {
        let holds = |outer: &str, inner: &str| {
            inner == outer || inner.strip_prefix(outer).is_some_and(|rest| rest.starts_with(['.', '[']))
        };
        self.problems.iter().any(|problem| holds(&problem.key, key) || holds(key, &problem.key))
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

    /// Notes what a floor below says about several keys, but for those that have a problem already.
    pub fn add_from_below(&mut self, found: Vec<(String, String, String, String)>) {
        let fresh: Vec<_> = found.into_iter().filter(|(key, ..)| !self.is_reported(key)).collect();
        for (key, value, allowed, remedy) in fresh {
            self.add(&key, Some(value), allowed, remedy);
        }
    }

    /// Nothing, or everything that is wrong, by line.
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

    fn line_at(&self, offset: usize) -> usize {
        1 + self.text.as_bytes()[..offset.min(self.text.len())].iter().filter(|byte| **byte == b'\n').count()
    }

    fn written(&self, value: &Spanned<DeValue<'a>>) -> String {
        shortened(self.text.get(value.span()).unwrap_or(""))
    }
}

/// At most 60 letters of one line.
fn shortened(text: &str) -> String {
    let line = text.split_whitespace().collect::<Vec<_>>().join(" ");
    match line.char_indices().nth(60) {
        Some((end, _)) => format!("{}...", &line[..end]),
        None => line,
    }
}

/// One table of a document while it is read.
#[derive(Debug)]
pub struct Section<'d, 'a> {
    /// Where problems go.
    pub document: &'d mut Document<'a>,
    path: String,
    table: Option<&'d DeTable<'a>>,
    known: Vec<&'static str>,
}

impl<'d, 'a> Section<'d, 'a> {
    /// The whole document.
    pub fn root(document: &'d mut Document<'a>, table: &'d DeTable<'a>) -> Self {
        Section { document, path: String::new(), table: Some(table), known: Vec::new() }
    }

    /// The dotted path of a key of this table.
    pub fn path(&self, key: &str) -> String {
        if self.path.is_empty() { key.to_owned() } else { format!("{}.{key}", self.path) }
    }

    /// Whether the table was written.
    pub fn is_present(&self) -> bool {
        self.table.is_some()
    }

    /// Whether `key` was written.
    pub fn has(&self, key: &str) -> bool {
        self.table.is_some_and(|table| table.contains_key(key))
    }

    /// The value of `key` if it was written; the key is known from now on, and so is its line.
    pub(super) fn take(&mut self, key: &'static str) -> Option<&'d Spanned<DeValue<'a>>> {
        self.known.push(key);
        self.note_line(key);
        self.table?.get(key)
    }

    /// Remembers the line of `key`, if it was written.
    fn note_line(&mut self, key: &str) {
        if let Some((name, _)) = self.table.and_then(|table| table.get_key_value(key)) {
            let line = self.document.line_at(name.span().start);
            self.document.lines.insert(self.path(key), line);
        }
    }

    /// Notes that `value`, which `key` led to, is wrong.
    pub fn refuse_value(&mut self, key: &str, value: String, allowed: impl Into<String>, remedy: impl Into<String>) {
        self.note_line(key);
        let path = self.path(key);
        self.document.add(&path, Some(value), allowed, remedy);
    }

    /// Notes that the value of `key` is wrong.
    pub fn refuse(&mut self, key: &str, allowed: impl Into<String>, remedy: impl Into<String>) {
        let value = self.table.and_then(|table| table.get(key)).map(|value| self.document.written(value));
        self.note_line(key);
        let path = self.path(key);
        self.document.add(&path, value, allowed, remedy);
    }

    /// The table called `key`; one that was not written reads as empty.
    pub fn section(&mut self, key: &'static str) -> Section<'_, 'a> {
        let path = self.path(key);
        let table = match self.take(key).map(Spanned::get_ref) {
            Some(DeValue::Table(table)) => Some(table),
            Some(_) => {
                self.refuse(key, "a table", format!("write [{path}] on a line of its own, and its keys below"));
                None
            }
            None => None,
        };
        Section { document: &mut *self.document, path, table, known: Vec::new() }
    }

    /// The tables `[[key]]`, in order, each read by `read`.
    pub fn sections<T>(&mut self, key: &'static str, mut read: impl FnMut(&mut Section<'_, 'a>) -> T) -> Vec<T> {
        let Some(value) = self.take(key) else { return Vec::new() };
        let tables: Option<Vec<_>> = value.get_ref().as_array().and_then(|list| {
            list.iter().map(|item| item.get_ref().as_table().map(|table| (item.span().start, table))).collect()
        });
        let Some(tables) = tables else {
            self.refuse(key, "a list of tables", format!("write [[{key}]] with two brackets"));
            return Vec::new();
        };
        let mut list = Vec::with_capacity(tables.len());
        for (index, (start, table)) in tables.into_iter().enumerate() {
            let path = format!("{}[{index}]", self.path(key));
            let line = self.document.line_at(start);
            self.document.lines.insert(path.clone(), line);
            let mut section = Section { document: &mut *self.document, path, table: Some(table), known: Vec::new() };
            list.push(read(&mut section));
        }
        list
    }

    /// Notes that `key` is missing, unless it was written (and is wrong in another way).
    pub fn require(&mut self, key: &'static str, allowed: &str, example: &str) {
        let is_reported = !self.is_present() && self.document.is_reported(&self.path);
        if !self.has(key) && !is_reported {
            let remedy = if self.path.ends_with(']') {
                format!("add {key} = {example} to this table")
            } else {
                format!("add {key} = {example} to [{}]", self.path)
            };
            let path = self.path(key);
            self.document.add(&path, None, allowed, remedy);
        }
    }

    /// A number, if it was written and is allowed.
    pub fn number(&mut self, key: &'static str, limit: Limit) -> Option<f64> {
        let value = self.take(key)?;
        match number(value.get_ref()) {
            Some(number) if (limit.test)(number) => Some(number),
            Some(_) => {
                self.refuse(key, limit.allowed, limit.remedy);
                None
            }
            None => {
                self.refuse(key, limit.allowed, remedy_for_text(value.get_ref()));
                None
            }
        }
    }

    /// A finite number that must be there; NaN where it is not.
    pub fn required_number(&mut self, key: &'static str, example: &str) -> f64 {
        self.require(key, FINITE.allowed, example);
        self.number(key, FINITE).unwrap_or(f64::NAN)
    }

    /// A finite number, if it was written; NaN where it is wrong.
    pub fn optional_number(&mut self, key: &'static str) -> Option<f64> {
        let number = self.number(key, FINITE);
        if self.has(key) { Some(number.unwrap_or(f64::NAN)) } else { None }
    }

    /// `N` finite numbers, if they were written; NaN each where they are wrong.
    pub fn vector<const N: usize>(&mut self, key: &'static str) -> Option<[f64; N]> {
        let value = self.take(key)?;
        let numbers = match value.get_ref() {
            DeValue::Array(list) => list.iter().map(|item| number(item.get_ref())).collect::<Option<Vec<f64>>>(),
            _ => None,
        };
        let vector = numbers.and_then(|numbers| <[f64; N]>::try_from(numbers).ok());
        match vector.filter(|vector| vector.iter().all(|x| x.is_finite())) {
            Some(vector) => Some(vector),
            None => {
                let example = vec!["0"; N].join(", ");
                self.refuse(key, format!("an array of {N} finite numbers"), format!("write it like [{example}]"));
                Some([f64::NAN; N])
            }
        }
    }

    /// A 3x3 matrix of finite numbers by rows, if it was written; NaN where it is wrong.
    pub fn matrix(&mut self, key: &'static str) -> Option<[[f64; 3]; 3]> {
        let value = self.take(key)?;
        let row = |value: &DeValue<'a>| -> Option<[f64; 3]> {
            let numbers: Option<Vec<f64>> = value.as_array()?.iter().map(|item| number(item.get_ref())).collect();
            <[f64; 3]>::try_from(numbers?).ok()
        };
        let rows: Option<Vec<[f64; 3]>> =
            value.get_ref().as_array().and_then(|list| list.iter().map(|item| row(item.get_ref())).collect());
        let matrix = rows.and_then(|rows| <[[f64; 3]; 3]>::try_from(rows).ok());
        match matrix.filter(|matrix| matrix.as_flattened().iter().all(|x| x.is_finite())) {
            Some(matrix) => Some(matrix),
            None => {
                self.refuse(
                    key,
                    "three rows of three finite numbers",
                    "write it like [[3, 0, 0], [0, 3, 0], [0, 0, 2]]",
                );
                Some([[f64::NAN; 3]; 3])
            }
        }
    }

    /// One finite number, or an array of them, if written.
    pub fn values(&mut self, key: &'static str) -> Option<Values> {
        let value = self.take(key)?;
        let values = match value.get_ref() {
            DeValue::Array(list) => {
                list.iter().map(|item| number(item.get_ref())).collect::<Option<Vec<f64>>>().map(Values::Each)
            }
            single => number(single).map(Values::All),
        };
        let finite = |values: &Values| match values {
            Values::All(x) => x.is_finite(),
            Values::Each(list) => list.iter().all(|x| x.is_finite()),
        };
        if !values.as_ref().is_some_and(finite) {
            self.refuse(
                key,
                "a finite number, or an array of one for each component",
                remedy_for_text(value.get_ref()),
            );
            return None;
        }
        values
    }

    /// A whole number within `range`, if it was written.
    pub fn count(&mut self, key: &'static str, range: std::ops::RangeInclusive<u64>) -> Option<u64> {
        let value = self.take(key)?;
        let count = value.get_ref().as_integer().and_then(|x| u64::from_str_radix(x.as_str(), x.radix()).ok());
        if let Some(count) = count.filter(|count| range.contains(count)) {
            return Some(count);
        }
        let remedy = match value.get_ref() {
            DeValue::Float(_) => "write it without a decimal point or exponent",
            DeValue::Integer(_) => "write a number within this range",
            other => remedy_for_text(other),
        };
        self.refuse(key, format!("a whole number from {} to {}", range.start(), range.end()), remedy);
        None
    }

    /// Text, if it was written.
    pub fn text(&mut self, key: &'static str) -> Option<&'d str> {
        let value = self.take(key)?;
        let text = value.get_ref().as_str();
        if text.is_none() {
            self.refuse(key, "text", "write it in quotes");
        }
        text
    }

    /// One of the names that `parse` knows, if it was written.
    pub fn name<T>(&mut self, key: &'static str, names: &[&str], parse: impl Fn(&str) -> Option<T>) -> Option<T> {
        let text = self.text(key)?;
        let parsed = parse(text);
        if parsed.is_none() {
            let (allowed, remedy) = choice(text, names);
            self.refuse(key, allowed, remedy);
        }
        parsed
    }

    /// A list of different names that `parse` knows, if it was written.
    pub fn names<T: PartialEq>(
        &mut self,
        key: &'static str,
        names: &[&str],
        parse: impl Fn(&str) -> Option<T>,
    ) -> Option<Vec<T>> {
        let value = self.take(key)?;
        let texts: Option<Vec<&str>> =
            value.get_ref().as_array().and_then(|list| list.iter().map(|item| item.get_ref().as_str()).collect());
        let Some(texts) = texts else {
            self.refuse(key, "an array of names", format!("write it like [{:?}]", names[0]));
            return None;
        };
        let mut parsed = Vec::with_capacity(texts.len());
        for text in texts {
            match parse(text) {
                Some(item) if parsed.contains(&item) => {
                    self.refuse(key, "different names", format!("delete the second {text:?}"));
                    return None;
                }
                Some(item) => parsed.push(item),
                None => {
                    let (allowed, remedy) = choice(text, names);
                    self.refuse(key, format!("made of names, each {allowed}"), remedy);
                    return None;
                }
            }
        }
        if parsed.is_empty() {
            self.refuse(key, "at least one name", "leave the key out for all of them");
            return None;
        }
        Some(parsed)
    }

    /// Notes every key that was written and not asked for.
    pub fn finish(&mut self) {
        let Some(table) = self.table else { return };
        for name in table.keys() {
            let name = name.get_ref();
            if self.known.iter().any(|known| known == name) {
                continue;
            }
            let remedy = match nearest(name, self.known.iter().copied()) {
                Some(meant) => format!("did you mean {meant}?"),
                None => "delete it".to_owned(),
            };
            let place = if self.path.is_empty() { "this file".to_owned() } else { format!("[{}]", self.path) };
            self.refuse(name, format!("a key of {place} ({})", self.known.join(", ")), remedy);
        }
    }
}

/// What a name must be, and which one was probably meant.
pub fn choice(written: &str, names: &[&str]) -> (String, String) {
    let remedy = match nearest(written, names.iter().copied()) {
        Some(meant) => format!("did you mean {meant:?}?"),
        None => "choose one of these".to_owned(),
    };
    (format!("one of {}", names.join(", ")), remedy)
}

/// The number that an integer or a float stands for; NaN and infinities too.
pub(super) fn number(value: &DeValue<'_>) -> Option<f64> {
    match value {
        DeValue::Float(float) => float.as_str().parse().ok(),
        DeValue::Integer(integer) => i128::from_str_radix(integer.as_str(), integer.radix()).ok().map(|x| x as f64),
        _ => None,
    }
}

fn remedy_for_text(value: &DeValue<'_>) -> &'static str {
    match value {
        DeValue::String(text) if text.trim().parse::<f64>().is_ok() => "write it without quotes",
        DeValue::Array(_) => "write one number, without brackets",
        _ => "write a number",
    }
}
