//! [`Section`]: one table of a [`Document`] while it is read, key by key.

use super::document::Document;
use super::problem::nearest;
use super::units::{self, UnitProblem};
use crate::sampling::Values;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

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

/// One table of a document while it is read.
#[derive(Debug)]
pub struct Section<'d, 'a> {
    /// Where problems go.
    pub document: &'d mut Document<'a>,
    path: String,
    table: Option<&'d DeTable<'a>>,
    known: Vec<String>,
    /// The unit of what the table describes and so of its distances, `std`, `min` and so on; `1` where there is none.
    unit: &'static str,
    /// The unit of every number of the table, where all are of one kind.
    every: Option<&'static str>,
}

impl<'d, 'a> Section<'d, 'a> {
    /// The whole document.
    pub fn root(document: &'d mut Document<'a>, table: &'d DeTable<'a>) -> Self {
        Section { document, path: String::new(), table: Some(table), known: Vec::new(), unit: "1", every: None }
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
    pub(super) fn take(&mut self, key: &str) -> Option<&'d Spanned<DeValue<'a>>> {
        self.know(key);
        self.table?.get(key)
    }

    /// Makes `key` a key of this table.
    pub(super) fn know(&mut self, key: &str) {
        if !self.known.iter().any(|known| known == key) {
            self.known.push(key.to_owned());
        }
        self.note_line(key);
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
    pub fn section(&mut self, key: &str) -> Section<'_, 'a> {
        let path = self.path(key);
        let table = match self.take(key).map(Spanned::get_ref) {
            Some(DeValue::Table(table)) => Some(table),
            Some(_) => {
                self.refuse(key, "a table", format!("write [{path}] on a line of its own, and its keys below"));
                None
            }
            None => None,
        };
        // a distribution of an angle, `angle_rad = { ... }`, has its own unit
        let unit = Some(unit_in_name(key)).filter(|unit| *unit != "1").unwrap_or(self.unit);
        Section { document: &mut *self.document, path, table, known: Vec::new(), unit, every: None }
    }

    /// The tables `[[key]]`, in order, each read by `read`.
    pub fn sections<T>(&mut self, key: &str, mut read: impl FnMut(&mut Section<'_, 'a>) -> T) -> Vec<T> {
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
            let mut section = Section {
                document: &mut *self.document,
                path,
                table: Some(table),
                known: Vec::new(),
                unit: "1",
                every: None,
            };
            list.push(read(&mut section));
        }
        list
    }

    /// The plain number of `key`, if one was written, whether it is allowed or not: for examples near what else was written.
    pub fn written(&self, key: &str) -> Option<f64> {
        number(self.table?.get(key)?.get_ref(), self.unit_of(key))
    }

    /// Notes that `key` is missing, unless it was written (and is wrong in another way).
    pub fn require(&mut self, key: &str, allowed: &str, example: &str) {
        let is_reported = !self.is_present() && self.document.is_reported(&self.path);
        if !self.has(key) && !is_reported {
            let remedy = if self.path.ends_with(']') {
                format!("add {key} = {example} to this table")
            } else {
                match self.path.rsplit_once('.') {
                    // the table of a list is known by its name
                    Some((list, name)) if ["wheels", "thrusters", "body.parts"].contains(&list) => {
                        format!("add {key} = {example} to the table [[{list}]] with name = \"{name}\"")
                    }
                    _ => format!("add {key} = {example} to [{}]", self.path),
                }
            };
            let path = self.path(key);
            self.document.add(&path, None, allowed, remedy);
        }
    }

    /// A number, if it was written and is allowed.
    pub fn number(&mut self, key: &str, limit: Limit) -> Option<f64> {
        let value = self.take(key)?;
        let unit = self.unit_of(key);
        match number(value.get_ref(), unit) {
            Some(number) if (limit.test)(number) => Some(number),
            Some(_) => {
                self.refuse(key, limit.allowed, limit.remedy);
                None
            }
            None => {
                self.refuse_number(key, value.get_ref(), limit.allowed, remedy_for_text(value.get_ref()));
                None
            }
        }
    }

    /// Notes that `value` of `key` is no number or numbers: what is wrong with a unit in it, if there is one, else `allowed` and `remedy`.
    pub(super) fn refuse_number(
        &mut self,
        key: &str,
        value: &DeValue<'_>,
        allowed: impl Into<String>,
        remedy: impl Into<String>,
    ) {
        match unit_problem(value, self.unit_of(key)) {
            Some(problem) => self.refuse(key, problem.allowed, problem.remedy),
            None => self.refuse(key, allowed, remedy),
        }
    }

    /// The unit in which the numbers of `key` are: that of what the table describes, or the one at the end of the key.
    pub(super) fn unit_of(&self, key: &str) -> &'static str {
        match self.every {
            Some(unit) => unit,
            None if DISTANCES.contains(&key) => self.unit,
            None => unit_in_name(key),
        }
    }

    /// Whether `key` was written as a table.
    pub(super) fn is_table(&self, key: &str) -> bool {
        self.table.and_then(|table| table.get(key)).is_some_and(|value| value.get_ref().as_table().is_some())
    }

    /// The keys of the table `key` and their values as written.
    pub(super) fn entries(&self, key: &str) -> Vec<(String, String)> {
        match self.table.and_then(|table| table.get(key)).map(Spanned::get_ref) {
            Some(DeValue::Table(table)) => self.written_entries(table),
            _ => Vec::new(),
        }
    }

    /// The same of each of the tables `[[key]]`.
    pub(super) fn lists_of_entries(&self, key: &str) -> Vec<Vec<(String, String)>> {
        match self.table.and_then(|table| table.get(key)).map(Spanned::get_ref) {
            Some(DeValue::Array(list)) => {
                list.iter().filter_map(|item| Some(self.written_entries(item.get_ref().as_table()?))).collect()
            }
            _ => Vec::new(),
        }
    }

    fn written_entries(&self, table: &DeTable<'a>) -> Vec<(String, String)> {
        let entry = |(key, value): (&Spanned<_>, &Spanned<DeValue<'a>>)| {
            let key: &toml::de::DeString<'a> = key.get_ref();
            (key.to_string(), self.document.text_of(value).to_owned())
        };
        table.iter().map(entry).collect()
    }

    /// Says that every number of this table is in `unit`.
    pub(super) fn measures(&mut self, unit: &'static str) {
        self.every = Some(unit);
    }

    /// Says in which unit the distances of this table are.
    pub(super) fn describes(&mut self, unit: &'static str) {
        self.unit = unit;
    }

    /// Says that this table is called `path`, and no longer by its place in a list.
    pub(super) fn rename(&mut self, path: String) {
        if let Some(line) = self.document.lines.get(&self.path).copied() {
            self.document.lines.insert(path.clone(), line);
        }
        let inner: Vec<(String, usize)> = self
            .document
            .lines
            .iter()
            .filter_map(|(key, line)| Some((format!("{path}{}", key.strip_prefix(&self.path)?), *line)))
            .collect();
        self.document.lines.extend(inner);
        self.path = path;
    }

    /// Notes that `key`, of `count` numbers, is missing, unless it was written.
    pub(super) fn require_numbers(&mut self, key: &str, count: usize, example: &str) {
        self.require(key, &numbers_in_words(count), example);
    }

    /// Fills `numbers` with the finite numbers of `key`: one, a list, or for nine of them three rows; whether the key was
    /// written. What is wrong is noted, and the numbers are then NaN.
    pub(super) fn fill(&mut self, key: &str, numbers: &mut [f64]) -> bool {
        let Some(value) = self.take(key) else { return false };
        let unit = self.unit_of(key);
        let found = match numbers.len() {
            1 => number(value.get_ref(), unit).map(|number| vec![number]),
            9 => rows_of_three(value.get_ref(), unit),
            _ => list(value.get_ref(), unit),
        };
        match found.filter(|found| found.len() == numbers.len() && found.iter().all(|x| x.is_finite())) {
            Some(found) => numbers.copy_from_slice(&found),
            None => {
                let remedy = match numbers.len() {
                    1 if number(value.get_ref(), unit).is_some() => FINITE.remedy.to_owned(),
                    1 => remedy_for_text(value.get_ref()).to_owned(),
                    9 => "write it like [[3, 0, 0], [0, 3, 0], [0, 0, 2]]".to_owned(),
                    count => format!("write it like [{}]", vec!["0"; count].join(", ")),
                };
                self.refuse_number(key, value.get_ref(), numbers_in_words(numbers.len()), remedy);
                numbers.fill(f64::NAN);
            }
        }
        true
    }

    /// `N` finite numbers, if they were written; NaN each where they are wrong.
    pub fn vector<const N: usize>(&mut self, key: &str) -> Option<[f64; N]> {
        let mut vector = [f64::NAN; N];
        self.fill(key, &mut vector).then_some(vector)
    }

    /// A 3x3 matrix of finite numbers by rows, if it was written; NaN where it is wrong.
    pub fn matrix(&mut self, key: &str) -> Option<[[f64; 3]; 3]> {
        let mut matrix = [[f64::NAN; 3]; 3];
        self.fill(key, matrix.as_flattened_mut()).then_some(matrix)
    }

    /// One finite number, or an array of them, if written.
    pub fn values(&mut self, key: &str) -> Option<Values> {
        let value = self.take(key)?;
        let unit = self.unit_of(key);
        let values = match value.get_ref() {
            DeValue::Array(_) => list(value.get_ref(), unit).map(Values::Each),
            single => number(single, unit).map(Values::All),
        };
        let finite = |values: &Values| match values {
            Values::All(x) => x.is_finite(),
            Values::Each(list) => list.iter().all(|x| x.is_finite()),
        };
        if !values.as_ref().is_some_and(finite) {
            self.refuse_number(
                key,
                value.get_ref(),
                "a finite number, or an array of one for each component",
                remedy_for_text(value.get_ref()),
            );
            return None;
        }
        values
    }

    /// A whole number within `range`, if it was written.
    pub fn count(&mut self, key: &str, range: std::ops::RangeInclusive<u64>) -> Option<u64> {
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
    pub fn text(&mut self, key: &str) -> Option<&'d str> {
        let value = self.take(key)?;
        let text = value.get_ref().as_str();
        if text.is_none() {
            self.refuse(key, "text", "write it in quotes");
        }
        text
    }

    /// One of the names that `parse` knows, if it was written.
    pub fn name<T>(&mut self, key: &str, names: &[&str], parse: impl Fn(&str) -> Option<T>) -> Option<T> {
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
        key: &str,
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

    /// Whether `key` was written and is one of `names`.
    pub(super) fn is_name_of(&self, key: &str, names: &[&str]) -> bool {
        let value = self.table.and_then(|table| table.get(key)).and_then(|value| value.get_ref().as_str());
        value.is_some_and(|name| names.contains(&name))
    }

    /// Notes every key that was written and not asked for.
    pub fn finish(&mut self) {
        let Some(table) = self.table else { return };
        for name in table.keys() {
            let name = name.get_ref();
            if self.known.iter().any(|known| known == name) {
                continue;
            }
            let remedy = match nearest(name, self.known.iter().map(String::as_str)) {
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

/// Keys of distributions whose values are in the unit of what is dispersed.
const DISTANCES: [&str; 14] = [
    "min",
    "max",
    "mode",
    "mean",
    "median",
    "std",
    "half_width",
    "lower",
    "upper",
    "offset",
    "value",
    "values",
    "scale",
    "location",
];

/// The unit at the end of a key; `1` where there is none.
fn unit_in_name(key: &str) -> &'static str {
    const ENDINGS: [(&str, &str); 11] = [
        ("_rad_s", "rad/s"),
        ("_kg_m3", "kg/m^3"),
        ("_kg_m2", "kg m^2"),
        ("_m_s", "m/s"),
        ("_n_m", "N m"),
        ("_rad", "rad"),
        ("_kg", "kg"),
        ("_n", "N"),
        ("_s", "s"),
        ("_m", "m"),
        ("_j", "J"),
    ];
    ENDINGS.iter().find(|(ending, _)| key.ends_with(ending)).map_or("1", |(_, unit)| unit)
}

/// The number of an integer, a float, or a text with a unit, in the SI unit `unit`; NaN and infinities too.
pub(super) fn number(value: &DeValue<'_>, unit: &str) -> Option<f64> {
    match value {
        DeValue::Float(float) => float.as_str().parse().ok(),
        DeValue::Integer(integer) => i128::from_str_radix(integer.as_str(), integer.radix()).ok().map(|x| x as f64),
        DeValue::String(text) => units::parsed(text, unit).ok(),
        _ => None,
    }
}

/// What is wrong with the first text in a value, if it should be a number of the SI unit `unit`.
fn unit_problem(value: &DeValue<'_>, unit: &str) -> Option<UnitProblem> {
    match value {
        DeValue::String(text) => units::parsed(text, unit).err(),
        DeValue::Array(list) => list.iter().find_map(|item| unit_problem(item.get_ref(), unit)),
        _ => None,
    }
}

/// A list of numbers.
fn list(value: &DeValue<'_>, unit: &str) -> Option<Vec<f64>> {
    value.as_array()?.iter().map(|item| number(item.get_ref(), unit)).collect()
}

/// Three lists of three numbers, one after the other.
fn rows_of_three(value: &DeValue<'_>, unit: &str) -> Option<Vec<f64>> {
    let rows: Option<Vec<Vec<f64>>> = value.as_array()?.iter().map(|item| list(item.get_ref(), unit)).collect();
    rows.filter(|rows| rows.len() == 3 && rows.iter().all(|row| row.len() == 3)).map(|rows| rows.concat())
}

/// What a value of `count` numbers must be.
fn numbers_in_words(count: usize) -> String {
    match count {
        1 => FINITE.allowed.to_owned(),
        9 => "three rows of three finite numbers".to_owned(),
        count => format!("an array of {count} finite numbers"),
    }
}

fn remedy_for_text(value: &DeValue<'_>) -> &'static str {
    match value {
        DeValue::String(text) if text.trim().parse::<f64>().is_ok() => "write it without quotes",
        DeValue::Array(_) => "write one number, without brackets",
        _ => "write a number",
    }
}
