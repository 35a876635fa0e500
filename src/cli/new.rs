//! `spindrift new`: a starter campaign file with its JSON Schema. `spindrift schema`: the schema alone.

use std::fs::OpenOptions;
use std::io::Write;
use std::path::Path;

use crate::campaign::schema::schema;
use crate::cli::arguments::NewOptions;
use crate::cli::command_outcome::{CommandOutcome, Failure};
use crate::cli::screen;
use crate::control::tables::Loops;
use crate::findings::shell_word::quoted_path;
use crate::storage::atomic;

const START: &str = include_str!("../../assets/start.toml");

/// Placed next to the campaign file.
const SCHEMA: &str = "spindrift.schema.json";

fn schema_text() -> String {
    format!("{:#}\n", schema(&Loops))
}

pub fn print_schema() -> Result<CommandOutcome, Failure> {
    screen::print(&schema_text())?;
    Ok(CommandOutcome::Done)
}

pub fn run(options: &NewOptions) -> Result<CommandOutcome, Failure> {
    let path = &options.file;
    let name = path.file_stem().and_then(|name| name.to_str()).unwrap_or("start");
    let is_plain = name.chars().all(|letter| letter.is_ascii_alphanumeric() || "_-".contains(letter));
    let name = if is_plain && !name.starts_with('-') { name } else { "start" };
    let file = OpenOptions::new().write(true).create_new(true).open(path);
    let text = START.replace("name = \"start\"", &format!("name = \"{name}\""));
    let text = format!("#:schema {SCHEMA}\n{text}");
    let failed = |path: &Path, error| Failure::at(path, atomic::explained(path, error));
    file.and_then(|mut file| file.write_all(text.as_bytes())).map_err(|error| failed(path, error))?;
    let schema = path.with_file_name(SCHEMA);
    std::fs::write(&schema, schema_text()).map_err(|error| failed(&schema, error))?;
    let file = quoted_path(path);
    screen::print(&format!(
        "{file}: a campaign to start from; its comments say what can be changed\n  spindrift check {file}\n  spindrift \
        campaign {file}\n"
    ))?;
    Ok(CommandOutcome::Done)
}
