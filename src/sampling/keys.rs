//! The keys of a table of a campaign file as data: [`Row`], one key; [`Rule`], what several keys have to do with each
//! other; [`Written`], what a file says.
//!
//! A distribution and a design list their rows. Reading, error messages, canonical text and the tables of the documents
//! follow from them.

use crate::scene::{Name, Parameter};
use std::collections::BTreeMap;
use std::ops::{Bound, RangeBounds};
use std::sync::Arc;

/// The words of a list of words and what they mean.
pub const fn words<T, const N: usize>(list: &[(&'static str, T); N]) -> [&'static str; N] {
    let (mut words, mut place) = ([""; N], 0);
    while place < N {
        words[place] = list[place].0;
        place += 1;
    }
    words
}

/// What a number may be.
#[derive(Clone, Copy, Debug)]
pub struct NumberLimit {
    /// In words, to follow `must be`.
    pub allowed: &'static str,
    pub remedy: &'static str,
    pub range: Range,
}

impl NumberLimit {
    /// Whether a number is allowed.
    pub fn holds(&self, number: f64) -> bool {
        self.range.contains(&number)
    }
}

/// The ends of a range of numbers.
pub type Range = (Bound<f64>, Bound<f64>);

/// All numbers.
pub const ANY: Range = (Bound::Unbounded, Bound::Unbounded);

/// Numbers above `least`.
pub const fn above(least: f64) -> Range {
    (Bound::Excluded(least), Bound::Unbounded)
}

/// Numbers from `least` on.
pub const fn at_least(least: f64) -> Range {
    (Bound::Included(least), Bound::Unbounded)
}

/// Numbers from `least` to `most`.
pub const fn between(least: f64, most: f64) -> Range {
    (Bound::Included(least), Bound::Included(most))
}

/// Numbers between `least` and `most`, which are not among them.
pub const fn inside(least: f64, most: f64) -> Range {
    (Bound::Excluded(least), Bound::Excluded(most))
}

/// What a text may be.
#[derive(Clone, Copy, Debug)]
pub struct TextLimit {
    /// In words, to follow `must be`.
    pub allowed: &'static str,
    pub remedy: &'static str,
    /// Whether a text is allowed.
    pub test: fn(&str) -> bool,
}

pub const ANY_TEXT: TextLimit = TextLimit { allowed: "text", remedy: "write it in quotes", test: |_| true };

/// Whether `text` is a name of at most `most` lower-case letters, digits and underscores, the first a letter.
pub fn is_name(text: &str, most: usize) -> bool {
    let is_letter = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '_';
    text.starts_with(|c: char| c.is_ascii_lowercase()) && text.chars().all(is_letter) && text.len() <= most
}

/// What several numbers may be together.
#[derive(Clone, Copy, Debug)]
pub struct ListLimit {
    /// In words, to follow `must be`.
    pub allowed: &'static str,
    pub remedy: &'static str,
    /// Whether finite numbers are allowed.
    pub test: fn(&[f64]) -> bool,
}

/// What the value of a key is.
#[derive(Clone, Copy, Debug)]
pub enum Kind {
    /// A finite number, in the unit of what the table is about.
    Amount,
    Numbers(ListLimit),
    /// The name of an observable; the table is about it.
    Observable,
    Observables,
    /// The name of a quantity over time that has bands; the table is about it.
    Band,
    Expression,
    /// `true` or `false`.
    Flag,
    /// `true`, where it is written.
    Yes,
    Units,
    /// A table with the units of columns and parameters.
    UnitsByName,
    /// A finite number, or an array of one for each component, in the unit of what is dispersed.
    Amounts,
    /// The same of pure numbers, or in the unit at the end of the key.
    Values,
    /// An array of finite numbers, in the unit of what is dispersed.
    AmountList,
    /// An array of pure finite numbers.
    List,
    Number,
    Vector,
    /// Three rows of three finite numbers.
    Matrix,
    /// A whole number between these two.
    Count([u64; 2]),
    /// Whole numbers from 1 to this one: one for all dimensions, or a list.
    Counts(u64),
    /// Different numbers of samples, ascending, at most so many.
    Samples(usize),
    Text(TextLimit),
    /// One of these words; the first one where the key is left out.
    Word(&'static [&'static str]),
    /// The name of a table of the file.
    Name,
    /// Different names of tables of the file.
    Names,
    /// One correlation of all pairs, or a row of numbers for each parameter.
    Correlations,
    /// A table of numbers by the names of tables of the file.
    ByName,
    /// One of the kinds of a list, as far as the file can have them.
    OneOf(fn() -> Vec<&'static str>),
    /// Different ones of these words, at least one; and what holds where the key is left out, in words.
    Words(&'static [&'static str], fn() -> String),
    /// One of these words, or three numbers of a direction; the first word where the key is left out.
    WordOrDirection(&'static [&'static str]),
    /// A table with a distribution of one number.
    Distribution,
    /// A file of numbers: with the keys `sha256` and `column`, one column of it.
    Column,
    /// A file of numbers: with the keys `sha256`, `parameters` and `columns`, the columns of it that are parameters.
    Columns,
}

/// Whether a key must be written, and what holds where it is not.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Presence {
    Required {
        /// What it must be, in words.
        allowed: &'static str,
        example: &'static str,
    },
    /// It may be left out; the meaning, or a rule of the table, says what holds then.
    Optional,
    /// Where it is left out, this number holds.
    Or(f64),
    /// Where it is left out, the nominal value holds.
    OrNominal,
}

/// One key of a table.
#[derive(Clone, Copy, Debug)]
pub struct Row {
    pub key: &'static str,
    pub kind: Kind,
    /// Whether it must be written.
    pub presence: Presence,
    /// What its numbers must satisfy, beside being finite.
    pub limit: Option<NumberLimit>,
    /// Where its numbers are multiples of those of another key: that key, and what they are divided by.
    pub multiple_of: Option<(&'static str, f64)>,
    pub meaning: &'static str,
    /// Whether canonical text leaves it out where it has its default.
    pub is_sparse: bool,
}

impl Row {
    /// A key that may be left out.
    pub const fn new(key: &'static str, kind: Kind, meaning: &'static str) -> Self {
        Row { key, kind, presence: Presence::Optional, limit: None, multiple_of: None, meaning, is_sparse: false }
    }

    /// Numbers in the unit of what is dispersed.
    pub const fn amounts(key: &'static str, meaning: &'static str) -> Self {
        Row::new(key, Kind::Amounts, meaning)
    }

    /// Pure numbers, or numbers in the unit at the end of the key.
    pub const fn values(key: &'static str, meaning: &'static str) -> Self {
        Row::new(key, Kind::Values, meaning)
    }

    /// The same row of a key that must be written, with the example `example`.
    #[must_use]
    pub const fn required(self, example: &'static str) -> Self {
        self.required_as("a finite number, or an array of one for each component", example)
    }

    /// The same where the value is not one number or one for each component; `allowed` says what it is.
    #[must_use]
    pub const fn required_as(mut self, allowed: &'static str, example: &'static str) -> Self {
        self.presence = Presence::Required { allowed, example };
        self
    }

    /// The same row where a number or the nominal value holds for a key that is left out.
    #[must_use]
    pub const fn or(mut self, presence: Presence) -> Self {
        self.presence = presence;
        self
    }

    /// The same row, which canonical text leaves out where it has its default.
    #[must_use]
    pub const fn sparse(mut self) -> Self {
        self.is_sparse = true;
        self
    }

    /// The number, flag or word that holds where the key is left out.
    pub fn default(&self) -> Option<Value> {
        match (self.kind, self.presence) {
            (_, Presence::Or(number)) => Some(number.into()),
            (_, Presence::Required { .. }) => None,
            (Kind::Flag, _) => Some(false.into()),
            (Kind::Word(words), _) => words.first().map(|word| Value::Word(word)),
            _ => None,
        }
    }

    /// The same row with a limit.
    #[must_use]
    pub const fn within(mut self, allowed: &'static str, remedy: &'static str, range: Range) -> Self {
        self.limit = Some(NumberLimit { allowed, remedy, range });
        self
    }

    /// The same row with a limit that has a name.
    #[must_use]
    pub const fn limited(mut self, limit: NumberLimit) -> Self {
        self.limit = Some(limit);
        self
    }

    /// The same row of zero or more.
    #[must_use]
    pub const fn not_negative(self) -> Self {
        self.within(">= 0", "drop the minus sign", at_least(0.0))
    }

    /// The same row of a scale, which is above zero.
    #[must_use]
    pub const fn scale(self) -> Self {
        self.within("> 0", "write it in the parameter's unit", above(0.0))
    }
}

/// The key of a file with columns that are parameters.
pub const FILE_OF_PARAMETERS: Row = Row::new(
    "file",
    Kind::Columns,
    "File of numbers; with `parameters` (default: all columns of the file), `columns` (default: the names of the \
    parameters), and `sha256`, the checksum of the file",
);

/// What several keys of a table have to do with each other.
#[derive(Clone, Copy, Debug)]
pub enum Rule {
    /// Exactly one of several ways to say something is written, each with one or several keys; an example for the first
    /// key, and what to do where there are several.
    One(&'static [&'static [&'static str]], &'static str, &'static str),
    /// At most one of these is written.
    AtMostOne(&'static [&'static str]),
    /// All of these are written, or none; each with an example.
    Together([(&'static str, &'static str); 2]),
    /// Some keys have a meaning under conditions alone.
    Only {
        keys: &'static [&'static str],
        /// The conditions, all of which hold.
        with: &'static [Condition],
        /// What the keys must be otherwise: `left out ...`.
        allowed: &'static str,
        remedy: &'static str,
    },
}

/// What to do where only one of several keys may be there.
pub const ALL_BUT_ONE: &str = "delete all but one of them";

#[derive(Clone, Copy, Debug)]
pub enum Condition {
    Has(&'static str),
    /// The key does not say this word.
    IsNot(&'static str, &'static str),
    /// The key says this word.
    Is(&'static str, &'static str),
}

impl Condition {
    /// Whether it holds in a table that `has` keys, which say a `word`.
    pub fn holds<'t>(&self, has: impl Fn(&str) -> bool, word: impl Fn(&str) -> Option<&'t str>) -> bool {
        match self {
            Condition::Has(key) => has(key),
            Condition::IsNot(key, other) => word(key) != Some(*other),
            Condition::Is(key, own) => word(key) == Some(*own),
        }
    }
}

/// One number for all components, or one for each.
#[derive(Clone, Debug, PartialEq)]
pub enum Values {
    All(f64),
    /// One each, in the order of the components.
    Each(Vec<f64>),
}

impl Values {
    /// As in a campaign file.
    pub fn text(&self) -> String {
        match self {
            Values::All(value) => format!("{value:?}"),
            Values::Each(list) => format!("{list:?}"),
        }
    }

    pub fn numbers(&self) -> &[f64] {
        match self {
            Values::All(value) => std::slice::from_ref(value),
            Values::Each(list) => list,
        }
    }

    /// The numbers divided by `divisor`.
    pub fn over(self, divisor: f64) -> Self {
        match self {
            Values::All(value) => Values::All(value / divisor),
            Values::Each(list) => Values::Each(list.into_iter().map(|value| value / divisor).collect()),
        }
    }
}

/// One whole number for all dimensions, or one for each.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Counts {
    All(u64),
    /// One each, in the order of the file.
    Each(Vec<u64>),
}

/// A column of a file of numbers.
#[derive(Clone, Debug, PartialEq)]
pub struct DataColumn {
    /// The file, as written.
    pub file: String,
    /// SHA-256 of the file's bytes, hexadecimal.
    pub sha256: String,
    /// The column's name; the name of the number that it is for, where the two are one.
    pub column: String,
    /// The number of the scene that it is for, where its table names several.
    pub target: Option<(Parameter, usize)>,
    /// Its numbers, in the order of the file.
    pub values: Arc<[f64]>,
}

impl DataColumn {
    /// The name of the number that it is for.
    pub fn target_name(&self) -> String {
        self.target.map_or_else(|| self.column.clone(), |(parameter, component)| parameter.component_name(component))
    }
}

/// The value of a key.
#[derive(Clone, Debug, PartialEq)]
pub enum Value {
    /// Numbers: one, one for each component, a list, a vector.
    Numbers(Values),
    Matrix([[f64; 3]; 3]),
    Counts(Counts),
    Text(String),
    Word(&'static str),
    Words(Vec<&'static str>),
    /// A distribution: its name and its keys.
    Distribution(&'static str, Written),
    /// A column of a file.
    Column(DataColumn),
    /// Columns of one file, each for one number of the scene.
    Columns(Vec<DataColumn>),
    Flag(bool),
    /// Numbers by name.
    ByName(Vec<(Name, f64)>),
    Texts(Vec<String>),
    /// Units by the names of what is shown in them.
    Units(BTreeMap<String, &'static str>),
}

impl Value {
    /// The text or the word.
    pub fn text(&self) -> Option<&str> {
        match self {
            Value::Text(text) => Some(text),
            Value::Word(word) => Some(word),
            _ => None,
        }
    }

    /// Whether it is an empty list or text.
    fn is_empty(&self) -> bool {
        match self {
            Value::Text(text) => text.is_empty(),
            Value::Words(list) => list.is_empty(),
            Value::Texts(list) => list.is_empty(),
            Value::Units(list) => list.is_empty(),
            _ => false,
        }
    }
}

impl From<f64> for Value {
    fn from(number: f64) -> Self {
        Value::Numbers(Values::All(number))
    }
}

impl From<&[f64]> for Value {
    fn from(list: &[f64]) -> Self {
        Value::Numbers(Values::Each(list.to_vec()))
    }
}

impl From<bool> for Value {
    fn from(flag: bool) -> Self {
        Value::Flag(flag)
    }
}

impl From<u64> for Value {
    fn from(count: u64) -> Self {
        Value::Counts(Counts::All(count))
    }
}

impl From<&str> for Value {
    fn from(text: &str) -> Self {
        Value::Text(text.to_owned())
    }
}

/// What a campaign file says of the keys of a table, in the order of their rows.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Written(Vec<(&'static str, Value)>);

impl Written {
    pub const NONE: Written = Written(Vec::new());

    /// The same table in which `key` is written.
    #[must_use]
    pub fn with(mut self, key: &'static str, value: impl Into<Value>) -> Self {
        self.set(key, value);
        self
    }

    /// Writes the keys of `other`, too.
    pub fn extend(&mut self, other: Written) {
        other.0.into_iter().for_each(|(key, value)| self.set(key, value));
    }

    /// Writes `key`, instead of what was there.
    pub fn set(&mut self, key: &'static str, value: impl Into<Value>) {
        let value = value.into();
        match self.0.iter_mut().find(|(known, _)| *known == key) {
            Some((_, known)) => *known = value,
            None => self.0.push((key, value)),
        }
    }

    /// The keys `rows` in their order, as canonical text has them: with the defaults of those that have a meaning under
    /// `rules`; without empty lists and texts, and without keys that are sparse and have their default.
    #[must_use]
    pub fn completed(&self, rows: &[Row], rules: &[Rule]) -> Written {
        let acts = |row: &Row| {
            rules.iter().all(|rule| match rule {
                Rule::Only { keys, with, .. } if keys.contains(&row.key) => {
                    with.iter().all(|condition| condition.holds(|key| self.has(key), |key| self.text(key)))
                }
                _ => true,
            })
        };
        let entry = |row: &Row| {
            let default = row.default();
            let value = self.get(row.key).or(default.as_ref()).filter(|_| acts(row))?;
            let is_left_out = value.is_empty() || row.is_sparse && default.as_ref() == Some(value);
            (!is_left_out).then(|| (row.key, value.clone()))
        };
        Written(rows.iter().filter_map(entry).collect())
    }

    /// Whether `key` is written.
    pub fn has(&self, key: &str) -> bool {
        self.get(key).is_some()
    }

    /// The value of `key`.
    pub fn get(&self, key: &str) -> Option<&Value> {
        self.0.iter().find(|(known, _)| *known == key).map(|(_, value)| value)
    }

    /// The numbers of `key`.
    pub fn values(&self, key: &str) -> Option<&Values> {
        self.get(key).and_then(|value| if let Value::Numbers(values) = value { Some(values) } else { None })
    }

    /// The numbers of `key`, one after the other.
    pub fn numbers(&self, key: &str) -> Option<&[f64]> {
        self.values(key).map(Values::numbers)
    }

    /// The rows of the matrix of `key`.
    pub fn matrix(&self, key: &str) -> Option<[[f64; 3]; 3]> {
        if let Value::Matrix(rows) = self.get(key)? { Some(*rows) } else { None }
    }

    /// The three numbers of `key`.
    pub fn vector(&self, key: &str) -> Option<[f64; 3]> {
        self.numbers(key)?.try_into().ok()
    }

    /// The columns of a file that are parameters.
    pub fn columns(&self) -> &[DataColumn] {
        let columns = self.0.iter().find_map(|(_, value)| match value {
            Value::Columns(columns) => Some(columns.as_slice()),
            _ => None,
        });
        columns.unwrap_or_default()
    }

    /// The number of `key`.
    pub fn number(&self, key: &str) -> Option<f64> {
        if let Value::Numbers(Values::All(number)) = self.get(key)? { Some(*number) } else { None }
    }

    /// The whole number of `key`.
    pub fn count(&self, key: &str) -> Option<u64> {
        if let Value::Counts(Counts::All(count)) = self.get(key)? { Some(*count) } else { None }
    }

    /// Whether `key` says yes.
    pub fn flag(&self, key: &str) -> bool {
        self.get(key) == Some(&Value::Flag(true))
    }

    /// The text or the word of `key`.
    pub fn text(&self, key: &str) -> Option<&str> {
        self.get(key)?.text()
    }

    /// The texts of `key`; none where it is not written.
    pub fn texts(&self, key: &str) -> &[String] {
        if let Some(Value::Texts(texts)) = self.get(key) { texts } else { &[] }
    }

    /// The keys that are written.
    pub fn entries(&self) -> impl Iterator<Item = (&'static str, &Value)> {
        self.0.iter().map(|(key, value)| (*key, value))
    }
}
