//! Declared keys of campaign tables: [`Row`], one key; [`Rule`], a relation of several keys; [`Written`], the values of
//! a file. Reading, messages, canonical text and documents follow from them.

use super::columns::Component;
use crate::scene::Name;
use std::collections::BTreeMap;
use std::fmt::Debug;
use std::ops::{Bound, RangeBounds};
use std::sync::Arc;

/// The words of a list of words and their meanings.
pub const fn words<T, const N: usize>(list: &[(&'static str, T); N]) -> [&'static str; N] {
    let (mut words, mut place) = ([""; N], 0);
    while place < N {
        words[place] = list[place].0;
        place += 1;
    }
    words
}

#[derive(Clone, Copy, Debug)]
pub struct NumberLimit {
    /// Follows `must be`.
    pub allowed: &'static str,
    pub remedy: &'static str,
    pub range: Range,
}

impl NumberLimit {
    pub fn holds(&self, number: f64) -> bool {
        self.range.contains(&number)
    }
}

pub type Range = (Bound<f64>, Bound<f64>);

pub const ANY: Range = (Bound::Unbounded, Bound::Unbounded);

pub const fn above(least: f64) -> Range {
    (Bound::Excluded(least), Bound::Unbounded)
}

pub const fn at_least(least: f64) -> Range {
    (Bound::Included(least), Bound::Unbounded)
}

pub const fn between(least: f64, most: f64) -> Range {
    (Bound::Included(least), Bound::Included(most))
}

/// Both ends are excluded.
pub const fn inside(least: f64, most: f64) -> Range {
    (Bound::Excluded(least), Bound::Excluded(most))
}

#[derive(Clone, Copy, Debug)]
pub struct TextLimit {
    /// Follows `must be`.
    pub allowed: &'static str,
    pub remedy: &'static str,
    pub test: fn(&str) -> bool,
}

pub const ANY_TEXT: TextLimit = TextLimit { allowed: "text", remedy: "write it in quotes", test: |_| true };

pub const COLUMN_NAME: TextLimit = TextLimit {
    allowed: "1 to 60 lower-case letters, digits and underscores, the first a letter",
    remedy: "write it like pointing_error_max_rad",
    test: |name| is_name(name, 60),
};

/// True if `text` is at most `most` lower-case letters, digits and underscores, the first a letter.
pub fn is_name(text: &str, most: usize) -> bool {
    let is_letter = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '_';
    text.starts_with(|c: char| c.is_ascii_lowercase()) && text.chars().all(is_letter) && text.len() <= most
}

#[derive(Clone, Copy, Debug)]
pub struct ListLimit {
    /// Follows `must be`.
    pub allowed: &'static str,
    pub remedy: &'static str,
    /// For finite numbers.
    pub test: fn(&[f64]) -> bool,
}

#[derive(Clone, Copy, Debug)]
pub enum Kind {
    /// A finite number in the unit of the table's subject.
    Amount,
    Numbers(ListLimit),
    /// The name of an observable, which becomes the table's subject.
    Observable,
    Observables,
    /// The name of a quantity with bands, which becomes the table's subject.
    Band,
    Expression,
    /// The name of a parameter, as a whole or of a component.
    Parameter,
    Parameters,
    Flag,
    /// Only `true`.
    Yes,
    Units,
    /// Units by column and parameter.
    UnitsByName,
    /// A finite number, or an array of one for each component, in the unit of the dispersed parameter.
    Amounts,
    /// As `Amounts`, of pure numbers or in the unit at the end of the key.
    Values,
    /// Finite numbers in the unit of the dispersed parameter.
    AmountList,
    /// Pure finite numbers.
    List,
    Number,
    Vector,
    Matrix,
    /// Both ends are included.
    Count([u64; 2]),
    /// From 1: one for all dimensions, or a list.
    Counts(u64),
    /// Sample numbers, ascending, at most so many.
    Samples(usize),
    Text(TextLimit),
    /// One of these words, by default the first.
    Word(&'static [&'static str]),
    /// The name of a table.
    Name,
    /// Different names of tables.
    Names,
    /// One correlation, or a row of numbers for each parameter.
    Correlations,
    /// Numbers by the names of tables.
    ByName,
    /// One of the kinds that the file can have.
    OneOf(fn() -> Vec<&'static str>),
    /// At least one of these words; and the default in words.
    Words(&'static [&'static str], fn() -> String),
    /// One of these words, by default the first, or the components of a direction.
    WordOrDirection(&'static [&'static str]),
    /// A table with a distribution of one number.
    Distribution,
    /// A data file, with `sha256` and `column`.
    Column,
    /// A data file for parameters, with `sha256`, `parameters` and `columns`.
    Columns,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Presence {
    Required {
        /// Follows `must be`.
        allowed: &'static str,
        example: &'static str,
    },
    /// Its meaning or a rule states the default.
    Optional,
    /// The default.
    Or(f64),
    /// The nominal value is the default.
    OrNominal,
}

#[derive(Clone, Copy, Debug)]
pub struct Row {
    pub key: &'static str,
    pub kind: Kind,
    pub presence: Presence,
    /// Limit of its finite numbers.
    pub limit: Option<NumberLimit>,
    /// For a multiple of another key: that key and the divisor.
    pub multiple_of: Option<(&'static str, f64)>,
    pub meaning: &'static str,
    /// True if canonical text omits its default.
    pub is_sparse: bool,
}

impl Row {
    /// An optional key.
    pub const fn new(key: &'static str, kind: Kind, meaning: &'static str) -> Self {
        Row { key, kind, presence: Presence::Optional, limit: None, multiple_of: None, meaning, is_sparse: false }
    }

    /// Numbers in the unit of the dispersed parameter.
    pub const fn amounts(key: &'static str, meaning: &'static str) -> Self {
        Row::new(key, Kind::Amounts, meaning)
    }

    /// Pure numbers, or numbers in the unit at the end of the key.
    pub const fn values(key: &'static str, meaning: &'static str) -> Self {
        Row::new(key, Kind::Values, meaning)
    }

    /// A required key of one number, or one for each component.
    #[must_use]
    pub const fn required(self, example: &'static str) -> Self {
        self.required_as("a finite number, or an array of one for each component", example)
    }

    /// A required key of other values, which `allowed` describes.
    #[must_use]
    pub const fn required_as(mut self, allowed: &'static str, example: &'static str) -> Self {
        self.presence = Presence::Required { allowed, example };
        self
    }

    #[must_use]
    pub const fn or(mut self, presence: Presence) -> Self {
        self.presence = presence;
        self
    }

    /// Canonical text omits the default.
    #[must_use]
    pub const fn sparse(mut self) -> Self {
        self.is_sparse = true;
        self
    }

    /// The default number, flag or word.
    pub fn default(&self) -> Option<Value> {
        match (self.kind, self.presence) {
            (_, Presence::Or(number)) => Some(number.into()),
            (_, Presence::Required { .. }) => None,
            (Kind::Flag, _) => Some(false.into()),
            (Kind::Word(words), _) => words.first().map(|word| (*word).into()),
            _ => None,
        }
    }

    #[must_use]
    pub const fn within(mut self, allowed: &'static str, remedy: &'static str, range: Range) -> Self {
        self.limit = Some(NumberLimit { allowed, remedy, range });
        self
    }

    #[must_use]
    pub const fn limited(mut self, limit: NumberLimit) -> Self {
        self.limit = Some(limit);
        self
    }

    #[must_use]
    pub const fn not_negative(self) -> Self {
        self.within(">= 0", "drop the minus sign", at_least(0.0))
    }

    #[must_use]
    pub const fn scale(self) -> Self {
        self.within("> 0", "write it in the parameter's unit", above(0.0))
    }
}

pub const FILE_OF_PARAMETERS: Row = Row::new(
    "file",
    Kind::Columns,
    "File of numbers; with `parameters` (default: all columns of the file), `columns` (default: the names of the \
    parameters), and `sha256`, the checksum of the file",
);

#[derive(Clone, Copy, Debug)]
pub enum Rule {
    /// Exactly one of several ways to give a value, each with its keys; an example for the first key, and the remedy
    /// for several ways.
    One(&'static [&'static [&'static str]], &'static str, &'static str),
    AtMostOne(&'static [&'static str]),
    /// All or none, each with an example.
    Together([(&'static str, &'static str); 2]),
    /// Keys that only have a meaning under conditions.
    Only {
        keys: &'static [&'static str],
        /// All of them must hold.
        with: &'static [Condition],
        /// Otherwise: `left out ...`.
        allowed: &'static str,
        remedy: &'static str,
    },
}

pub const ALL_BUT_ONE: &str = "delete all but one of them";

#[derive(Clone, Copy, Debug)]
pub enum Condition {
    Has(&'static str),
    /// The key has another word.
    IsNot(&'static str, &'static str),
    Is(&'static str, &'static str),
}

impl Condition {
    /// True if it holds in a table with these keys and words.
    pub fn holds<'t>(&self, has: impl Fn(&str) -> bool, word: impl Fn(&str) -> Option<&'t str>) -> bool {
        match self {
            Condition::Has(key) => has(key),
            Condition::IsNot(key, other) => word(key) != Some(*other),
            Condition::Is(key, own) => word(key) == Some(*own),
        }
    }
}

/// One value, a list, or rows; Debug writes them as a campaign file does.
#[derive(Clone, PartialEq)]
pub enum Values<T = f64> {
    One(T),
    /// In the order of the components or of the file.
    Each(Vec<T>),
    Rows(Vec<Vec<T>>),
}

impl<T: Debug> Debug for Values<T> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Values::One(value) => value.fmt(f),
            Values::Each(list) => list.fmt(f),
            Values::Rows(rows) => rows.fmt(f),
        }
    }
}

impl<T: Clone> Values<T> {
    /// True if they are a number, three rows of three, or a list of `count` numbers.
    pub fn are(&self, count: usize) -> bool {
        match (count, self) {
            (1, values) => matches!(values, Values::One(_)),
            (9, Values::Rows(rows)) => rows.len() == 3 && rows.iter().all(|row| row.len() == 3),
            (count, Values::Each(list)) => count != 9 && list.len() == count,
            _ => false,
        }
    }

    #[must_use]
    pub fn map(&self, of: impl Fn(&T) -> T) -> Self {
        match self {
            Values::One(value) => Values::One(of(value)),
            Values::Each(list) => Values::Each(list.iter().map(of).collect()),
            Values::Rows(rows) => Values::Rows(rows.iter().map(|row| row.iter().map(&of).collect()).collect()),
        }
    }

    /// All values in turn.
    pub fn flat(&self) -> Vec<T> {
        match self {
            Values::One(value) => vec![value.clone()],
            Values::Each(list) => list.clone(),
            Values::Rows(rows) => rows.concat(),
        }
    }
}

#[derive(Clone, Debug, PartialEq)]
pub struct DataColumn {
    /// As written.
    pub file: String,
    pub sha256: String,
    /// Its name in the file; without `target`, also that of its number.
    pub column: String,
    /// Its number of the scene, if the table names several.
    pub target: Option<Component>,
    /// In the order of the file.
    pub values: Arc<[f64]>,
}

impl DataColumn {
    pub fn target_name(&self) -> String {
        self.target.map_or_else(|| self.column.clone(), |(parameter, component)| parameter.component_name(component))
    }
}

#[derive(Clone, Debug, PartialEq)]
pub enum Value {
    Numbers(Values),
    Counts(Values<u64>),
    Text(String),
    Texts(Vec<String>),
    /// Name and keys.
    Distribution(&'static str, Written),
    Column(DataColumn),
    /// Columns of one file, each for one number of the scene.
    Columns(Vec<DataColumn>),
    Flag(bool),
    ByName(Vec<(Name, f64)>),
    /// By column and parameter.
    Units(BTreeMap<String, &'static str>),
}

impl Value {
    pub fn text(&self) -> Option<&str> {
        if let Value::Text(text) = self { Some(text) } else { None }
    }

    fn is_empty(&self) -> bool {
        match self {
            Value::Text(text) => text.is_empty(),
            Value::Texts(list) => list.is_empty(),
            Value::Units(list) => list.is_empty(),
            _ => false,
        }
    }
}

impl From<f64> for Value {
    fn from(number: f64) -> Self {
        Value::Numbers(Values::One(number))
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
        Value::Counts(Values::One(count))
    }
}

impl From<&str> for Value {
    fn from(text: &str) -> Self {
        Value::Text(text.to_owned())
    }
}

/// The written keys of a table, in the order of their rows.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Written(Vec<(&'static str, Value)>);

impl Written {
    pub const NONE: Written = Written(Vec::new());

    /// The table with `key` set.
    #[must_use]
    pub fn with(mut self, key: &'static str, value: impl Into<Value>) -> Self {
        self.set(key, value);
        self
    }

    pub fn extend(&mut self, other: Written) {
        other.0.into_iter().for_each(|(key, value)| self.set(key, value));
    }

    pub fn set(&mut self, key: &'static str, value: impl Into<Value>) {
        let value = value.into();
        match self.0.iter_mut().find(|(known, _)| *known == key) {
            Some((_, known)) => *known = value,
            None => self.0.push((key, value)),
        }
    }

    /// The keys of canonical text, in the order of `rows`: with the defaults that act under `rules`, without empty
    /// lists and texts and without sparse keys at their default.
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

    pub fn has(&self, key: &str) -> bool {
        self.get(key).is_some()
    }

    pub fn get(&self, key: &str) -> Option<&Value> {
        self.0.iter().find(|(known, _)| *known == key).map(|(_, value)| value)
    }

    pub fn values(&self, key: &str) -> Option<&Values> {
        self.get(key).and_then(|value| if let Value::Numbers(values) = value { Some(values) } else { None })
    }

    pub fn numbers(&self, key: &str) -> Option<&[f64]> {
        match self.values(key)? {
            Values::One(number) => Some(std::slice::from_ref(number)),
            Values::Each(list) => Some(list),
            Values::Rows(_) => None,
        }
    }

    pub fn matrix(&self, key: &str) -> Option<[[f64; 3]; 3]> {
        if let Values::Rows(rows) = self.values(key)? { rows.concat().as_chunks().0.try_into().ok() } else { None }
    }

    pub fn vector(&self, key: &str) -> Option<[f64; 3]> {
        self.numbers(key)?.try_into().ok()
    }

    pub fn columns(&self) -> &[DataColumn] {
        let columns = self.0.iter().find_map(|(_, value)| match value {
            Value::Columns(columns) => Some(columns.as_slice()),
            _ => None,
        });
        columns.unwrap_or_default()
    }

    pub fn number(&self, key: &str) -> Option<f64> {
        if let Values::One(number) = self.values(key)? { Some(*number) } else { None }
    }

    pub fn count(&self, key: &str) -> Option<u64> {
        if let Value::Counts(Values::One(count)) = self.get(key)? { Some(*count) } else { None }
    }

    pub fn flag(&self, key: &str) -> bool {
        self.get(key) == Some(&Value::Flag(true))
    }

    pub fn text(&self, key: &str) -> Option<&str> {
        self.get(key)?.text()
    }

    /// The meaning of the word of `key` in a list of words.
    pub fn meaning<T: Copy>(&self, key: &str, words: &[(&'static str, T)]) -> Option<T> {
        words.iter().find(|(word, _)| self.text(key) == Some(word)).map(|(_, meaning)| *meaning)
    }

    pub fn texts(&self, key: &str) -> &[String] {
        if let Some(Value::Texts(texts)) = self.get(key) { texts } else { &[] }
    }

    pub fn entries(&self) -> impl Iterator<Item = (&'static str, &Value)> {
        self.0.iter().map(|(key, value)| (*key, value))
    }
}
