//! [`Sources`]: the texts of a campaign: its file, the files that it extends (`extends = "base.toml"`) and settings
//! (`--set campaign.duration_s=20`), which are merged into one table whose values keep their places.

use super::input_file::is_unreadable;
use super::problem::CampaignError;
use super::size;
use std::borrow::Cow;
use std::ops::Range;
use std::path::{Path, PathBuf};
use toml::Spanned;
use toml::de::{DeTable, DeValue};

const MOST_FILES: usize = 8;

#[derive(Clone, Debug)]
pub(super) struct SourceText {
    pub name: String,
    /// Base folder of its paths.
    pub folder: PathBuf,
    /// The dotted key of a setting; `None` for a file.
    pub key: Option<String>,
    /// Its place in [`Sources::text`].
    pub range: Range<usize>,
}

/// All texts, highest priority first.
#[derive(Clone, Debug, Default)]
pub(super) struct Sources {
    pub list: Vec<SourceText>,
    /// All texts in turn.
    pub text: String,
    pub extended: Vec<PathBuf>,
}

impl Sources {
    /// `text` of `file` in `folder`, the files that it extends, and `settings`: dotted keys and their values.
    ///
    /// # Errors
    /// An extended file that cannot be read.
    pub fn read(
        folder: &Path,
        file: &str,
        text: &str,
        settings: &[(String, String)],
    ) -> Result<Sources, CampaignError> {
        let mut sources = Sources::default();
        sources.add(file.to_owned(), folder.to_owned(), None, text);
        let (mut folder, mut name, mut text) = (folder.to_owned(), file.to_owned(), Cow::Borrowed(text));
        while let Some((written, line)) = extended(&text) {
            let path = folder.join(&written);
            let refuse = |allowed: &str, remedy: &str| {
                let mut error = CampaignError::new(&name, "extends", format!("{written:?}"), allowed, remedy);
                error.problems[0].line = Some(line);
                Err(error)
            };
            if !path.is_file() && !path.metadata().is_err_and(|error| is_unreadable(&error)) {
                return refuse("a campaign file, by its path from the folder of this file", "check the path");
            }
            if sources.extended.len() + 1 >= MOST_FILES {
                return refuse(
                    "the last of at most 8 files that extend one another",
                    "do files extend one another in a circle?",
                );
            }
            let base = size::read(&path, &written)?;
            folder = path.parent().unwrap_or(Path::new("")).to_owned();
            sources.add(written.clone(), folder.clone(), None, &base);
            sources.extended.push(path);
            (name, text) = (written, Cow::Owned(base));
        }
        for (key, value) in settings {
            // a value that is not TOML is text: 20 rpm
            let (_, errors) = DeValue::parse_recoverable(value);
            let quoted = if errors.is_empty() { value.clone() } else { toml::Value::from(value.as_str()).to_string() };
            sources.add(format!("--set {key}"), PathBuf::new(), Some(key.clone()), &quoted);
        }
        Ok(sources)
    }

    fn add(&mut self, name: String, folder: PathBuf, key: Option<String>, text: &str) {
        let start = self.text.len();
        self.text.push_str(text);
        self.list.push(SourceText { name, folder, key, range: start..self.text.len() });
        self.text.push('\n');
    }

    pub fn at(&self, offset: usize) -> &SourceText {
        let found = self.list.iter().rfind(|source| source.range.start <= offset);
        found.unwrap_or(&self.list[0])
    }
}

/// The value of `extends` and its line.
fn extended(text: &str) -> Option<(String, usize)> {
    let (table, _) = DeTable::parse_recoverable(text);
    let (key, value) = table.get_ref().get_key_value("extends")?;
    Some((value.get_ref().as_str()?.to_owned(), text[..key.span().start].lines().count().max(1)))
}

/// `value` with all places shifted by `by` bytes.
fn moved<'a>(value: Spanned<DeValue<'a>>, by: usize) -> Spanned<DeValue<'a>> {
    let span = value.span();
    let inner = match value.into_inner() {
        DeValue::Array(list) => DeValue::Array(list.into_iter().map(|item| moved(item, by)).collect()),
        DeValue::Table(table) => DeValue::Table(moved_table(table, by)),
        other => other,
    };
    Spanned::new(span.start + by..span.end + by, inner)
}

pub(super) fn moved_table<'a>(table: DeTable<'a>, by: usize) -> DeTable<'a> {
    let entry = |(key, value): (Spanned<Cow<'a, str>>, _)| {
        let span = key.span();
        (Spanned::new(span.start + by..span.end + by, key.into_inner()), moved(value, by))
    };
    table.into_iter().map(entry).collect()
}

/// The value of `text`, at byte `by` of all texts.
pub(super) fn value_at<'a>(text: &'a str, by: usize) -> Spanned<DeValue<'a>> {
    moved(DeValue::parse_recoverable(text).0, by)
}

/// Merges `over` into `base`: tables key by key, lists of tables by `name`, `parameter` or `phase`. A table with
/// another `kind`, `distribution` or `shape` and all other values replace the earlier ones.
pub(super) fn lay_over<'a>(base: &mut DeTable<'a>, over: DeTable<'a>) {
    for (key, value) in over {
        let place = base.remove(key.get_ref().as_ref());
        let value = match place {
            Some(below) => laid(below, value),
            None => value,
        };
        base.insert(key, value);
    }
}

fn laid<'a>(below: Spanned<DeValue<'a>>, over: Spanned<DeValue<'a>>) -> Spanned<DeValue<'a>> {
    let span = over.span();
    let inner = match (below.into_inner(), over.into_inner()) {
        (DeValue::Table(mut below), DeValue::Table(over)) if !is_other_kind(&below, &over) => {
            lay_over(&mut below, over);
            DeValue::Table(below)
        }
        (DeValue::Array(mut below), DeValue::Array(over)) if is_named(&below) && is_named(&over) => {
            for item in over {
                match below.iter().position(|other| identity(other) == identity(&item)) {
                    Some(place) => {
                        let of_base =
                            std::mem::replace(&mut below.as_mut()[place], Spanned::new(0..0, DeValue::Boolean(false)));
                        below.as_mut()[place] = laid(of_base, item);
                    }
                    None => below.push(item),
                }
            }
            DeValue::Array(below)
        }
        (_, over) => over,
    };
    Spanned::new(span, inner)
}

fn is_other_kind(below: &DeTable<'_>, over: &DeTable<'_>) -> bool {
    let text =
        |table: &DeTable<'_>, key: &str| table.get(key).and_then(|value| value.get_ref().as_str().map(str::to_owned));
    ["kind", "distribution", "shape"]
        .iter()
        .any(|key| text(over, key).is_some_and(|kind| text(below, key) != Some(kind)))
}

/// The name of a table of a list.
fn identity<'v>(item: &'v Spanned<DeValue<'_>>) -> Option<&'v str> {
    let table = item.get_ref().as_table()?;
    ["name", "parameter", "phase"].iter().find_map(|key| table.get(*key)?.get_ref().as_str())
}

fn is_named(list: &[Spanned<DeValue<'_>>]) -> bool {
    list.iter().all(|item| identity(item).is_some())
}

/// Sets `value` at the dotted `path` through tables and lists of tables, by name (`wheels.w1.rate_rad_s`) or number
/// (`require[0].at_most`). Missing tables are added.
///
/// # Errors
/// The missing part of the path.
pub(super) fn put<'a>(table: &mut DeTable<'a>, path: &str, value: Spanned<DeValue<'a>>) -> Result<(), String> {
    let (first, rest) = match path.split_once('.') {
        Some((first, rest)) => (first, Some(rest)),
        None => (path, None),
    };
    let (key, index) = match first.strip_suffix(']').and_then(|first| first.split_once('[')) {
        Some((key, index)) => (key, Some(index.parse::<usize>().map_err(|_| format!("{index:?} is not a number"))?)),
        None => (first, None),
    };
    if key.is_empty() {
        return Err("a key is empty".to_owned());
    }
    let named = |value: Spanned<DeValue<'a>>| (Spanned::new(value.span(), Cow::Owned(key.to_owned())), value);
    let Some(rest) = rest else {
        if index.is_some() {
            return Err(format!("{first} is a table: name a key in it"));
        }
        table.remove(key);
        let (key, value) = named(value);
        table.insert(key, value);
        return Ok(());
    };
    if !table.contains_key(key) {
        let (key, value) = named(Spanned::new(value.span(), DeValue::Table(DeTable::new())));
        table.insert(key, value);
    }
    match table.get_mut(key).map(Spanned::get_mut) {
        Some(DeValue::Table(inner)) if index.is_none() => put(inner, rest, value),
        Some(DeValue::Array(list)) => {
            let (place, rest) = match (index, rest.split_once('.')) {
                (Some(index), _) => (Some(index).filter(|index| *index < list.len()), rest),
                (None, Some((name, rest))) => (list.iter().position(|item| identity(item) == Some(name)), rest),
                (None, None) => return Err(format!("{key} is a list: name a table of it and a key")),
            };
            match place.map(|place| list.as_mut()[place].get_mut()) {
                Some(DeValue::Table(inner)) => put(inner, rest, value),
                _ => {
                    let names: Vec<&str> = list.iter().filter_map(identity).collect();
                    let known = if names.is_empty() { String::new() } else { format!(": it has {}", names.join(", ")) };
                    Err(format!("there is no such table in [[{key}]]{known}"))
                }
            }
        }
        _ => Err(format!("{key} is not a table")),
    }
}
