//! How distributions and designs read and write their keys: [`KeyReader`], [`KeyWriter`], and the values of keys.
//!
//! Campaign files implement both; so a distribution or a design needs no code outside its own file and the list.

use crate::scene::Parameter;
use std::sync::Arc;

/// One number for all components, or one for each.
#[derive(Clone, Debug, PartialEq)]
pub enum Values {
    /// The same for all.
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
}

/// One whole number for all dimensions, or one for each.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Counts {
    /// The same for all.
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

/// A table of a campaign file while it is read. A value that is wrong is noted and read as `None`, as one that is not written;
/// [`KeyReader::has`] tells the two apart.
pub trait KeyReader {
    /// Whether `key` was written.
    fn has(&self, key: &str) -> bool;
    /// Notes that `key` is missing, unless it was written.
    fn require(&mut self, key: &'static str, allowed: &str, example: &str);
    /// Notes that the value of `key` is wrong.
    fn refuse(&mut self, key: &str, allowed: &str, remedy: &str);
    /// A finite number.
    fn number(&mut self, key: &'static str) -> Option<f64>;
    /// A finite number, or an array of one for each component.
    fn values(&mut self, key: &'static str) -> Option<Values>;
    /// Finite numbers, any count.
    fn numbers(&mut self, key: &'static str) -> Option<Vec<f64>>;
    /// Three finite numbers.
    fn vector(&mut self, key: &'static str) -> Option<[f64; 3]>;
    /// Three rows of three finite numbers.
    fn matrix(&mut self, key: &'static str) -> Option<[[f64; 3]; 3]>;
    /// Index of one of `names`.
    fn choice(&mut self, key: &'static str, names: &[&str]) -> Option<usize>;
    /// A whole number from 1 to `most`.
    fn count(&mut self, key: &'static str, most: u64) -> Option<u64>;
    /// Whole numbers of at least 1: one for all, or a list.
    fn counts(&mut self, key: &'static str) -> Option<Counts>;
    /// A table within this one, read by `read`; whether it was written.
    fn table(&mut self, key: &'static str, read: &mut dyn FnMut(&mut dyn KeyReader)) -> bool;
    /// The one of `names` that `key` gives; it must be there.
    fn kind(&mut self, key: &'static str, names: &[&'static str], example: &str) -> Option<&'static str>;
    /// The column `column` of the file `file`.
    fn column(&mut self) -> Option<DataColumn>;
    /// The columns of the file `file` that are parameters: those in `parameters`, else all; where `columns` names them, under these names.
    fn columns(&mut self) -> Option<Vec<DataColumn>>;
}

impl dyn KeyReader + '_ {
    /// Whether exactly one of `keys` was written; notes where not.
    pub fn is_one_of(&mut self, keys: &[&'static str], example: &str) -> bool {
        let written: Vec<&'static str> = keys.iter().copied().filter(|key| self.has(key)).collect();
        match written[..] {
            [_] => true,
            [] => {
                self.require(keys[0], &format!("given ({})", keys.join(" or ")), example);
                false
            }
            [_, second, ..] => {
                self.refuse(second, &format!("the only one of {}", keys.join(", ")), "delete all but one of them");
                false
            }
        }
    }

    /// Values that must be there.
    pub fn required(&mut self, key: &'static str, example: &str) -> Option<Values> {
        self.require(key, "a finite number, or an array of one for each component", example);
        self.values(key)
    }

    /// Values that may be left out; `None` where they are wrong.
    pub fn optional(&mut self, key: &'static str) -> Option<Option<Values>> {
        let values = self.values(key);
        if self.has(key) && values.is_none() { None } else { Some(values) }
    }

    /// `min` and `max`, both required.
    pub fn ends(&mut self) -> Option<(Values, Values)> {
        let min = self.required("min", "0.0");
        let max = self.required("max", "1.0");
        min.zip(max)
    }

    /// `min` and `max`, where one of them was written; the other is then required.
    pub fn ends_together(&mut self, examples: [&str; 2]) -> Option<(Values, Values)> {
        if self.has("min") || self.has("max") {
            self.require("min", "given together with max", examples[0]);
            self.require("max", "given together with min", examples[1]);
        }
        let min = self.values("min");
        min.zip(self.values("max"))
    }

    /// An axis, if it was written; `None` where it is wrong.
    pub fn axis(&mut self) -> Option<Option<[f64; 3]>> {
        let axis = self.vector("axis");
        if self.has("axis") && axis.is_none() { None } else { Some(axis) }
    }
}

/// A table of canonical text while it is written. Tables within it come last.
pub trait KeyWriter {
    /// A key and its value, whose Debug form is TOML: floats, lists of floats, whole numbers, plain text.
    fn key(&mut self, key: &str, value: &dyn std::fmt::Debug);
    /// Starts the table `key` within this one.
    fn table(&mut self, key: &str);
}

impl dyn KeyWriter + '_ {
    /// Values.
    pub fn values(&mut self, key: &str, values: &Values) {
        match values {
            Values::All(value) => self.key(key, value),
            Values::Each(list) => self.key(key, list),
        }
    }

    /// Values that may be left out.
    pub fn optional(&mut self, key: &str, values: Option<&Values>) {
        if let Some(values) = values {
            self.values(key, values);
        }
    }

    /// Columns of one file, each for one number of the scene.
    pub fn columns(&mut self, columns: &[DataColumn]) {
        let Some(first) = columns.first() else { return };
        self.key("file", &first.file);
        self.key("sha256", &first.sha256);
        let names: Vec<String> = columns.iter().map(DataColumn::target_name).collect();
        let own: Vec<&str> = columns.iter().map(|column| column.column.as_str()).collect();
        self.key("parameters", &names);
        if names != own {
            self.key("columns", &own);
        }
    }

    /// `min` and `max`.
    pub fn ends(&mut self, min: &Values, max: &Values) {
        self.values("min", min);
        self.values("max", max);
    }
}
