//! What the tables of the scene and of its control loop have in common: their names, and numbers as the schema has
//! them.

use super::section::Section;
use crate::scene::table::Table;
use crate::scene::{LawParameter, Name, SceneInput};

/// Reads the keys of one table into the scene.
pub(super) fn read_keys(section: &mut Section<'_, '_>, table: Table, instance: usize, scene: &mut SceneInput) {
    // a key that is written may be another way to describe a body
    for key in table.keys_in(scene, instance).filter(|key| section.has(key.facts().key)) {
        if key.read(scene, instance).is_none() {
            key.open(scene, instance);
        }
    }
    for key in table.keys_in(scene, instance) {
        let (name, example) = (key.facts().key, key.required());
        let Some(numbers) = key.write(scene, instance) else {
            section.know(name);
            continue;
        };
        if let Some(example) = example {
            section.require_numbers(name, numbers.len(), example);
        }
        if !section.fill(name, numbers, key.facts().limit) && example.is_some() {
            numbers.fill(f64::NAN);
        }
    }
}

/// The name of one of a list of tables, different from `taken`; the table is called by it from now on.
pub(super) fn read_name(section: &mut Section<'_, '_>, table: Table, taken: &[Name]) -> Name {
    section.require("name", Name::ALLOWED, "\"a1\"");
    let Some(text) = section.text("name") else { return Name::of("unnamed") };
    let Some(name) = Name::new(text) else {
        section.refuse("name", Name::ALLOWED, "write a name such as \"w1\"");
        return Name::of("unnamed");
    };
    if taken.contains(&name) {
        let allowed = format!("another name than that of the other [[{}]] tables", table.header());
        section.refuse("name", allowed, "give each its own name");
    }
    section.rename(table.header(), name.as_str());
    name
}

/// Lets the keys of the kinds other than that of place `chosen` be there without effect: of a file in which another one
/// is tried.
pub(super) fn ignore_others(
    section: &mut Section<'_, '_>,
    word: &str,
    chosen: Option<usize>,
    kinds: impl IntoIterator<Item = (&'static str, &'static [LawParameter])>,
) {
    let kinds: Vec<_> = kinds.into_iter().collect();
    let Some((chosen, _)) = chosen.and_then(|place| kinds.get(place)) else { return };
    for (name, parameters) in kinds.iter().filter(|(name, _)| name != chosen) {
        let keys = parameters.iter().map(|parameter| parameter.facts.key);
        section.ignore(keys, &format!("{word} = {name:?}"), &format!("{chosen:?}"));
    }
}
