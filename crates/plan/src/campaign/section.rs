//! [`Section`]: one table of a [`Document`] while it is read: tables, texts, names; [`super::numbers`] reads numbers.

use super::document::{Document, Spans};
use super::meaning::meant;
use super::units;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

#[derive(Debug)]
pub struct Section<'d, 'a> {
    pub document: &'d mut Document<'a>,
    path: String,
    /// Name in messages of a named table of a list.
    title: Option<String>,
    table: Option<&'d DeTable<'a>>,
    /// Place of a table in its list.
    pub(super) index: usize,
    known: Vec<String>,
    /// Keys to accept without effect.
    ignored: Vec<&'static str>,
    /// Unit of the quantity that the table is about, and so of `std`, `min` and so on; `1` for none.
    pub(super) unit: &'static str,
    /// Name of this quantity if it may be shown in another unit.
    pub(super) about: Option<String>,
}

impl<'d, 'a> Section<'d, 'a> {
    pub fn root(document: &'d mut Document<'a>, table: &'d DeTable<'a>) -> Self {
        Section::of(document, String::new(), Some(table))
    }

    fn of(document: &'d mut Document<'a>, path: String, table: Option<&'d DeTable<'a>>) -> Self {
        let (known, ignored) = (Vec::new(), Vec::new());
        Section { document, path, title: None, table, index: 0, known, ignored, unit: "1", about: None }
    }

    pub fn path(&self, key: &str) -> String {
        if self.path.is_empty() { key.to_owned() } else { format!("{}.{key}", self.path) }
    }

    pub fn is_present(&self) -> bool {
        self.table.is_some()
    }

    pub fn has(&self, key: &str) -> bool {
        self.table.is_some_and(|table| table.contains_key(key))
    }

    /// The written value of `key`, which becomes a known key.
    pub(super) fn take(&mut self, key: &str) -> Option<&'d Spanned<DeValue<'a>>> {
        self.know(key);
        self.value(key)
    }

    pub fn value(&self, key: &str) -> Option<&'d Spanned<DeValue<'a>>> {
        self.table?.get(key)
    }

    pub fn knows(&self, key: &str) -> bool {
        self.known.iter().any(|known| known == key)
    }

    pub fn know(&mut self, key: &str) {
        if !self.knows(key) {
            self.known.push(key.to_owned());
        }
        self.note_line(key);
    }

    fn note_line(&mut self, key: &str) {
        if let Some((name, value)) = self.table.and_then(|table| table.get_key_value(key)) {
            let value = if value.get_ref().is_table() { 0..0 } else { value.span() };
            self.document.spans.insert(self.path(key), Spans { key: name.span(), value });
        }
    }

    /// Notes that `value`, which follows from `key`, is wrong.
    pub fn refuse_value(&mut self, key: &str, value: String, allowed: impl Into<String>, remedy: impl Into<String>) {
        self.note_line(key);
        let path = self.path(key);
        self.document.add(&path, Some(value), allowed, remedy);
    }

    pub fn refuse(&mut self, key: &str, allowed: impl Into<String>, remedy: impl Into<String>) {
        let value = self.value(key).map(|value| self.document.written(value));
        self.note_line(key);
        let path = self.path(key);
        self.document.add(&path, value, allowed, remedy);
    }

    pub(super) fn refuse_table(&mut self, allowed: &str, remedy: &str) {
        let (path, header) = (self.path.clone(), format!("[{}]", self.path));
        self.document.add(&path, Some(header), allowed, remedy);
    }

    /// The table `key`; a missing one reads as empty.
    pub fn section(&mut self, key: &str) -> Section<'_, 'a> {
        let path = self.path(key);
        let table = match self.take(key).map(Spanned::get_ref) {
            Some(DeValue::Table(table)) => Some(table),
            Some(_) => {
                // `disperse[0]` is not TOML
                let remedy = if path.contains('[') {
                    format!("write {key} = {{ distribution = \"uniform\", min = 0, max = 1 }}")
                } else {
                    format!("write [{path}] on a line of its own, and its keys below")
                };
                self.refuse(key, "a table", remedy);
                None
            }
            None => None,
        };
        // `angle_rad = { ... }` has a unit of its own
        let unit = Some(units::in_name(key)).filter(|unit| *unit != "1").unwrap_or(self.unit);
        Section { unit, ..Section::of(&mut *self.document, path, table) }
    }

    /// Reads the tables `[[key]]` in order, at most `most` of them; more are refused.
    pub fn sections<T>(&mut self, key: &str, most: usize, mut read: impl FnMut(&mut Section<'_, 'a>) -> T) -> Vec<T> {
        let Some(value) = self.take(key) else { return Vec::new() };
        let tables: Option<Vec<_>> = value.get_ref().as_array().and_then(|list| {
            list.iter().map(|item| item.get_ref().as_table().map(|table| (item.span(), table))).collect()
        });
        let Some(tables) = tables else {
            self.refuse(key, "a list of tables", format!("write [[{key}]] with two brackets"));
            return Vec::new();
        };
        if tables.len() > most {
            let (path, count) = (self.path(key), format!("{} tables", tables.len()));
            self.document.add(&path, Some(count), format!("at most {most} tables"), "delete some of them");
        }
        let mut list = Vec::with_capacity(tables.len().min(most));
        for (index, (span, table)) in tables.into_iter().take(most).enumerate() {
            let path = format!("{}[{index}]", self.path(key));
            self.document.spans.insert(path.clone(), Spans { key: span, value: 0..0 });
            list.push(read(&mut Section { index, ..Section::of(&mut *self.document, path, Some(table)) }));
        }
        list
    }

    /// Notes a missing `key`.
    pub fn require(&mut self, key: &str, allowed: &str, example: &str) {
        let is_reported = !self.is_present() && self.document.is_reported(&self.path);
        if !self.has(key) && !is_reported {
            let place = match &self.title {
                Some(title) => format!("the table {title}"),
                None if self.path.ends_with(']') => "this table".to_owned(),
                None => format!("[{}]", self.path),
            };
            let remedy = format!("add {key} = {example} to {place}");
            let path = self.path(key);
            self.document.add(&path, None, allowed, remedy);
        }
    }

    /// The unit in the text of `key`, or in the first text of its list.
    pub(super) fn unit_written(&self, key: &str) -> Option<&'static str> {
        let value = self.value(key)?.get_ref();
        let first = value.as_array().and_then(|list| list.iter().find_map(|item| item.get_ref().as_str()));
        units::written(value.as_str().or(first)?)
    }

    pub(super) fn is_table(&self, key: &str) -> bool {
        self.value(key).is_some_and(|value| value.get_ref().as_table().is_some())
    }

    pub(super) fn entries(&self, key: &str) -> Vec<(String, String)> {
        let table = self.value(key).and_then(|value| value.get_ref().as_table());
        let entries = table.into_iter().flat_map(DeTable::iter);
        entries.map(|(key, value)| (key.get_ref().to_string(), self.document.text_of(value).to_owned())).collect()
    }

    /// Names this table of `[[header]]`, which was known by its place.
    pub fn rename(&mut self, header: &str, name: &str) {
        let path = format!("{header}.{name}");
        if let Some(spans) = self.document.spans.get(&self.path).cloned() {
            self.document.spans.insert(path.clone(), spans);
        }
        let inner: Vec<(String, Spans)> = self
            .document
            .spans
            .range(format!("{}.", self.path)..)
            .map_while(|(key, spans)| Some((format!("{path}{}", key.strip_prefix(&self.path)?), spans.clone())))
            .collect();
        self.document.spans.extend(inner);
        self.path = path;
        let key = if header == "guidance" { "phase" } else { "name" };
        self.title = Some(format!("[[{header}]] with {key} = \"{name}\""));
    }

    pub fn text(&mut self, key: &str) -> Option<&'d str> {
        self.parsed(key, DeValue::as_str, "text", "write it in quotes")
    }

    /// Texts, if written.
    pub fn texts(&mut self, key: &str, example: &str) -> Option<Vec<String>> {
        let texts = |value: &DeValue<'_>| {
            value.as_array()?.iter().map(|item| item.get_ref().as_str().map(str::to_owned)).collect()
        };
        self.parsed(key, texts, "an array of texts", format!("write it like {example}"))
    }

    /// The value of `key` as `parse` reads it, if written; noted as wrong if it gives `None`.
    pub(super) fn parsed<T>(
        &mut self,
        key: &str,
        parse: impl FnOnce(&'d DeValue<'a>) -> Option<T>,
        allowed: impl Into<String>,
        remedy: impl Into<String>,
    ) -> Option<T> {
        let parsed = parse(self.take(key)?.get_ref());
        if parsed.is_none() {
            self.refuse(key, allowed, remedy);
        }
        parsed
    }

    /// Refuses each of `keys` that is written.
    pub(super) fn refuse_written<'k>(&mut self, keys: impl IntoIterator<Item = &'k str>, allowed: &str, remedy: &str) {
        for key in keys {
            if self.has(key) {
                self.refuse(key, allowed, remedy);
            }
        }
    }

    /// Notes that the value of `key` is wrong; `None`.
    pub fn refused<T>(&mut self, key: &str, allowed: impl Into<String>, remedy: impl Into<String>) -> Option<T> {
        self.refuse(key, allowed, remedy);
        None
    }

    /// A name that `parse` knows, if written.
    pub fn name<T>(&mut self, key: &str, names: &[&str], parse: impl Fn(&str) -> Option<T>) -> Option<T> {
        let text = self.text(key)?;
        let parsed = parse(text);
        if parsed.is_none() {
            let (allowed, remedy) = choice(text, names);
            self.refuse(key, allowed, remedy);
        }
        parsed
    }

    /// A list of different names that `parse` knows, if written. `default` describes the value without the key.
    pub fn names<T: PartialEq>(
        &mut self,
        key: &str,
        names: &[&str],
        parse: impl Fn(&str) -> Option<T>,
        default: &str,
    ) -> Option<Vec<T>> {
        let value = self.take(key)?;
        let texts: Option<Vec<&str>> =
            value.get_ref().as_array().and_then(|list| list.iter().map(|item| item.get_ref().as_str()).collect());
        let Some(texts) = texts else {
            return self.refused(key, "an array of names", format!("write it like [{:?}]", names[0]));
        };
        let mut parsed = Vec::with_capacity(texts.len());
        for text in texts {
            match parse(text) {
                Some(item) if parsed.contains(&item) => {
                    return self.refused(key, "different names", format!("delete the second {text:?}"));
                }
                Some(item) => parsed.push(item),
                None => {
                    let (allowed, remedy) = choice(text, names);
                    return self.refused(key, format!("made of names, each {allowed}"), remedy);
                }
            }
        }
        if parsed.is_empty() {
            return self.refused(key, "at least one name", format!("leave the key out for {default}"));
        }
        Some(parsed)
    }

    /// The text of `key`, which does not become a known key.
    pub(super) fn plain_text(&self, key: &str) -> Option<&'d str> {
        self.value(key)?.get_ref().as_str()
    }

    /// Accepts `keys`; written ones are noted as having no effect without `setting`.
    pub fn ignore(&mut self, keys: impl IntoIterator<Item = &'static str>, setting: &str) {
        let written: Vec<&str> = keys.into_iter().filter(|key| self.has(key)).collect();
        if !written.is_empty() {
            let (first, have) = (self.path(written[0]), if written.len() == 1 { "has" } else { "have" });
            let all = [vec![first.as_str()], written[1..].to_vec()].concat().join(", ");
            self.document.ignored.push(format!("{all} {have} no effect without {setting}"));
            self.ignored.extend(written);
        }
    }

    /// Notes all unknown keys.
    pub fn finish(&mut self) {
        let Some(table) = self.table else { return };
        for name in table.keys() {
            let name = name.get_ref();
            if self.knows(name) || self.ignored.iter().any(|ignored| ignored == name) {
                continue;
            }
            if self.document.is_full() {
                self.document.add(name, Some(String::new()), "", ""); // counted only
                continue;
            }
            let path = self.path(name);
            let span = self.table.and_then(|table| table.get_key_value(&**name)).map_or(0..0, |(key, _)| key.span());
            let is_root = self.path.is_empty();
            // the whole path of a setting may be wrong
            let of_setting = if is_root { self.document.setting_meant(span.start) } else { None };
            let written = self.value(name).map(|value| self.document.written(value));
            let meant = of_setting.or_else(|| meant(name, self.known.iter().map(String::as_str)));
            let meant = meant.map(|meant| meant.remedy_of_key(written.as_deref().unwrap_or_default()));
            let mut place = match &self.title {
                Some(title) => title.clone(),
                None if is_root => "a campaign file".to_owned(),
                None => format!("[{}]", self.path),
            };
            let remedy = match meant {
                Some(remedy) => remedy,
                None => {
                    place += &format!(" ({})", self.known.join(", "));
                    "delete it".to_owned()
                }
            };
            let is_table = self.is_table(name) && is_root;
            let value = written.filter(|_| !is_table);
            self.document.spans.insert(path.clone(), Spans { key: span, value: 0..0 });
            self.document.add_unknown(&path, value, place, remedy);
        }
    }
}

/// Names of other programs.
const SYNONYMS: [(&str, &str); 7] = [
    ("gaussian", "normal"),
    ("gauss", "normal"),
    ("lhs", "latin_hypercube"),
    ("monte_carlo", "random"),
    ("rk4", "runge_kutta_4"),
    ("rk45", "dormand_prince"),
    ("ode45", "dormand_prince"),
];

/// The allowed names, and the one that was probably meant.
pub fn choice(written: &str, names: &[&str]) -> (String, String) {
    let synonym = SYNONYMS.iter().find(|(other, name)| written.eq_ignore_ascii_case(other) && names.contains(name));
    let meant =
        synonym.map(|(_, name)| *name).or_else(|| meant(written, names.iter().copied()).map(|meant| meant.name));
    let remedy = match meant {
        Some(meant) => format!("did you mean {meant:?}?"),
        None => "choose one of these".to_owned(),
    };
    (format!("one of {}", names.join(", ")), remedy)
}
