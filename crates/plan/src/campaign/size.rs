//! Limits on the size of a campaign file; large tables of numbers belong in data files.

use super::input_file::{self, InputError};
use super::problem::CampaignError;
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

pub(super) fn read(path: &Path, file: &str) -> Result<String, CampaignError> {
    let problem = |value: String, allowed, remedy| CampaignError::new(file, "file", value, allowed, remedy);
    let bytes = input_file::read(path, MOST_BYTES).map_err(|error| match error {
        InputError::Kind(kind) => {
            problem(kind.to_owned(), "a regular file", "write the campaign to a file, and name that")
        }
        InputError::Size(bytes) => too_large(file, bytes),
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

fn too_large(file: &str, bytes: u64) -> CampaignError {
    let allowed = format!("a campaign file of at most {MOST_BYTES} bytes");
    let remedy =
        "name tables of numbers as files of their own ([design] kind = \"table\", distribution = \"empirical\")";
    CampaignError::new(file, "file", format!("{bytes} bytes"), allowed, remedy)
}

pub(super) fn check_text(file: &str, bytes: u64) -> Result<(), CampaignError> {
    if bytes > MOST_BYTES { Err(too_large(file, bytes)) } else { Ok(()) }
}

pub(super) fn check_table(file: &str, table: &DeTable<'_>) -> Result<(), CampaignError> {
    let keys = keys_of(table);
    if keys <= MOST_KEYS {
        return Ok(());
    }
    let allowed = format!("a campaign file of at most {MOST_KEYS} keys");
    let remedy = "delete what the campaign does not need, or divide it into several campaigns";
    Err(CampaignError::new(file, "file", format!("{keys} keys"), allowed, remedy))
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
