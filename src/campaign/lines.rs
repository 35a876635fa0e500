//! [`Lines`]: canonical text while it is written, table by table and key by key.

use crate::scene::SceneInput;
use crate::scene::schema::limit::shown;
use crate::scene::table::Table;

/// A table's lines while they are written.
#[derive(Default)]
pub(super) struct Lines(String);

impl Lines {
    pub(super) fn table(&mut self, header: &str) {
        if !self.0.is_empty() {
            self.0.push('\n');
        }
        self.0.push_str(header);
        self.0.push('\n');
    }

    /// `value` in its Debug form: of floats, lists of floats, whole numbers and plain text that form is TOML.
    pub(super) fn key(&mut self, key: &str, value: impl std::fmt::Debug) {
        self.0.push_str(&format!("{key} = {value:?}\n"));
    }

    /// A comment on a line of its own.
    pub(super) fn note(&mut self, text: &str) {
        self.0.push_str(&format!("# {text}\n"));
    }

    /// A table of the scene: every key that `scene` has.
    pub(super) fn keys_of(&mut self, header: &str, table: Table, instance: usize, scene: &SceneInput) {
        self.table(header);
        for key in table.keys() {
            if let Some(numbers) = key.read(scene, instance) {
                self.0.push_str(&format!("{} = {}\n", key.facts().key, shown(numbers)));
            }
        }
    }

    /// The text.
    pub(super) fn into_text(self) -> String {
        self.0
    }
}
