//! Limits on the size of a campaign file; large tables of numbers belong in data files.

use super::input_file::{self, InputError};
use super::problem::{CampaignError, Problem};
use std::path::Path;
use toml::de::{DeTable, DeValue};

/// A schedule of 20,000 arcs has 1.5 MB.
pub const MOST_BYTES: u64 = 8 << 20;
/// A schedule of 20,000 arcs has 100,000.
pub const MOST_KEYS: usize = 400_000;
/// Most tables of a list such as `[[disperse]]`, each of which may be about any other. Lists of the scene have their
/// own limits, `[[actuation]]` none.
pub const MOST_TABLES: usize = 1000;
/// The TOML parser's limit on nesting.
const MOST_LEVELS: usize = 80;

pub(super) fn too_large(file: &str, bytes: u64) -> Problem {
    Problem {
        file: file.to_owned(),
        line: None,
        key: "file".to_owned(),
        value: Some(format!("{bytes} bytes")),
        allowed: format!("a campaign file of at most {MOST_BYTES} bytes"),
        remedy:
            "name tables of numbers as files of their own ([design] kind = \"table\", distribution = \"empirical\")"
                .to_owned(),
        is_unknown: false,
        excerpt: None,
    }
}

pub(super) fn read(path: &Path, file: &str) -> Result<String, CampaignError> {
    let problem = |value: String, allowed: &str, remedy: &str| {
        CampaignError::of(Problem {
            file: file.to_owned(),
            line: None,
            key: "file".to_owned(),
            value: Some(value),
            allowed: allowed.to_owned(),
            remedy: remedy.to_owned(),
            is_unknown: false,
            excerpt: None,
        })
    };
    let bytes = input_file::read(path, MOST_BYTES).map_err(|error| match error {
        InputError::Kind(kind) => {
            problem(kind.to_owned(), "a regular file", "write the campaign to a file, and name that")
        }
        InputError::Size(bytes) => CampaignError::of(too_large(file, bytes)),
        InputError::Io(error) => CampaignError {
            is_unreadable: input_file::is_unreadable(&error),
            ..problem(error.to_string(), "a readable text file (UTF-8)", "check the path")
        },
    })?;
    String::from_utf8(bytes).map_err(|error| {
        let value = format!("invalid UTF-8 at byte {}", error.utf8_error().valid_up_to());
        problem(value, "a readable text file (UTF-8)", "is this a campaign file? If so, save it as UTF-8")
    })
}

pub(super) fn of_text(file: &str, text: &str) -> Option<Problem> {
    let bytes = text.len() as u64;
    (bytes > MOST_BYTES).then(|| too_large(file, bytes))
}

pub(super) fn of_table(file: &str, table: &DeTable<'_>) -> Option<Problem> {
    let keys = keys_of(table);
    (keys > MOST_KEYS).then(|| Problem {
        file: file.to_owned(),
        line: None,
        key: "file".to_owned(),
        value: Some(format!("{keys} keys")),
        allowed: format!("a campaign file of at most {MOST_KEYS} keys"),
        remedy: "delete what the campaign does not need, or divide it into several campaigns".to_owned(),
        is_unknown: false,
        excerpt: None,
    })
}

fn keys_of(table: &DeTable<'_>) -> usize {
    table.iter().map(|(_, value)| 1 + keys_in(value.get_ref())).sum()
}

fn keys_in(value: &DeValue<'_>) -> usize {
    match value {
        DeValue::Table(table) => keys_of(table),
        DeValue::Array(list) => list.iter().map(|item| keys_in(item.get_ref())).sum(),
        _ => 0,
    }
}

/// The TOML parser's message, in plain words about nesting.
pub(super) fn plain(message: &str) -> String {
    if message.contains("recurs") {
        format!("tables and arrays within one another at most {MOST_LEVELS} deep")
    } else {
        message.to_owned()
    }
}
