//! [`Lines`]: canonical text while it is written.

use crate::scene::SceneInput;
use crate::scene::schema::limit::shown;
use crate::scene::table::Table;

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

    /// `value` in its Debug form, which is TOML for numbers, lists and plain text.
    pub(super) fn key(&mut self, key: &str, value: impl std::fmt::Debug) {
        self.0.push_str(&format!("{key} = {value:?}\n"));
    }

    pub(super) fn raw(&mut self, key: &str, value: &str) {
        self.0.push_str(&format!("{key} = {value}\n"));
    }

    /// A key with any text.
    pub(super) fn text_key(&mut self, key: &str, text: &str) {
        self.0.push_str(&format!("{key} = {}\n", toml::Value::from(text)));
    }

    pub(super) fn note(&mut self, text: &str) {
        self.0.push_str(&format!("# {text}\n"));
    }

    pub(super) fn keys(&mut self, table: Table, instance: usize, scene: &SceneInput) {
        for key in table.keys_in(scene, instance) {
            if let Some(numbers) = key.read(scene, instance) {
                self.0.push_str(&format!("{} = {}\n", key.facts().key, shown(numbers)));
            }
        }
    }

    pub(super) fn into_text(self) -> String {
        self.0
    }
}
