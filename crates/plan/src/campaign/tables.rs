//! Names and declared numbers of the tables of scene and control loop.

use super::section::Section;
use super::units;
use crate::scene::table::Table;
use crate::scene::{LawParameter, Name, SceneInput};
use std::collections::HashSet;

pub fn read_keys(section: &mut Section<'_, '_>, table: Table, instance: usize, scene: &mut SceneInput) {
    // a written key may be another way to describe a body
    for key in table.keys_in(scene, instance).filter(|key| section.has(key.facts().key)) {
        if key.read(scene, instance).is_none() {
            key.open(scene, instance);
        }
    }
    for key in table.keys_in(scene, instance) {
        let (name, example) = (key.facts().key, key.facts().required);
        let Some(numbers) = key.write(scene, instance) else {
            section.know(name);
            continue;
        };
        if let Some(example) = example {
            section.require_numbers(name, numbers.len(), example);
        }
        if !section.fill(name, units::in_name(name), numbers, key.facts().limit) && example.is_some() {
            numbers.fill(f64::NAN);
        }
    }
}

/// The name of a table of a list, added to `taken`, under which the document knows it from now on; arcs need none.
pub fn read_name(section: &mut Section<'_, '_>, table: Table, taken: &mut HashSet<Name>) -> Name {
    let is_arc = table == Table::Actuation;
    if !is_arc {
        section.require("name", Name::ALLOWED, "\"a1\"");
    }
    let nameless = if is_arc { Name::NONE } else { Name::of("unnamed") };
    let Some(text) = section.text("name") else { return nameless };
    let Some(name) = Name::new(text) else {
        let remedy = if is_arc { "\"burn1\", or leave it out" } else { "\"w1\"" };
        section.refuse("name", Name::ALLOWED, format!("write a name such as {remedy}"));
        return nameless;
    };
    if !taken.insert(name) {
        let allowed = format!("another name than that of the other [[{}]] tables", table.header());
        section.refuse("name", allowed, "give each its own name");
    }
    if !is_arc {
        section.rename(table.header(), name.as_str());
    }
    name
}

/// Accepts keys of the kinds other than `chosen` without effect, so that a file can try several kinds.
pub fn ignore_others(
    section: &mut Section<'_, '_>,
    word: &str,
    chosen: Option<usize>,
    kinds: impl IntoIterator<Item = (&'static str, &'static [LawParameter])>,
) {
    let kinds: Vec<_> = kinds.into_iter().collect();
    let Some((chosen, _)) = chosen.and_then(|place| kinds.get(place)) else { return };
    for (name, parameters) in kinds.iter().filter(|(name, _)| name != chosen) {
        let keys = parameters.iter().map(|parameter| parameter.facts.key);
        let foreign: Vec<&str> = keys.filter(|key| !section.knows(key)).collect();
        section.ignore(foreign, &format!("{word} = {name:?}"));
    }
}
