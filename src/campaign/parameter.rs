//! Names of parameters in campaign files.

use super::meaning::meant;
use super::section::Section;
use crate::scene::{LawParameter, Parameter, SceneInput};

/// The parameter, and the component if one is meant, that `key` names.
pub(super) fn parameter(table: &mut Section<'_, '_>, key: &'static str) -> Option<(Parameter, Option<usize>)> {
    table.require(key, "a numeric key of scene or initial state", "\"initial.angular_velocity_rad_s\"");
    let name = table.text(key)?;
    let found = Parameter::find(&table.document.scene, name);
    if found.is_none() && !table.document.may_be_of_loop(name) {
        let (allowed, remedy) = unknown_parameter(&table.document.scene, name);
        table.refuse(key, allowed, remedy);
    }
    if let Some((allowed, remedy)) = found.and_then(|(parameter, _)| without_effect(table, parameter)) {
        table.refuse(key, allowed, remedy);
    }
    found
}

/// Why no draw of `parameter` would change a run, and what to do instead: it is a number that a filter takes from the
/// file.
pub(super) fn without_effect(table: &Section<'_, '_>, parameter: Parameter) -> Option<(String, &'static str)> {
    let kind = table.document.law.as_ref()?.spec()?.estimator_kind();
    let is_own = |own: &LawParameter| parameter.name().strip_prefix("control.") == Some(own.facts.key);
    kind.parameters.iter().any(is_own).then(|| {
        let name = kind.name;
        let allowed = format!(
            "a parameter that acts: the filter of control.estimator = {name:?} believes the numbers of the file in \
            every \
             run"
        );
        (allowed, "delete this table, and fly the campaign once for each value, by --set")
    })
}

/// What is said of a name that is no parameter: what is allowed, and what was probably meant.
pub(super) fn unknown_parameter(scene: &SceneInput, name: &str) -> (String, String) {
    let names: Vec<String> = Parameter::all(scene).map(Parameter::name).collect();
    // a component by its index: its name is said
    let indexed = name.strip_suffix(']').and_then(|rest| rest.split_once('[')).and_then(|(stem, index)| {
        let (parameter, _) = Parameter::find(scene, stem)?;
        let component = index.parse().ok().filter(|index: &usize| *index < parameter.width())?;
        Some(format!("components have names: write {:?}", parameter.component_name(component)))
    });
    let remedy = indexed.unwrap_or_else(|| match meant(name, names.iter().map(String::as_str)) {
        Some(meant) => meant.remedy(),
        None => "write table and key as in this file, \"wheels.w1.radius_m\"".to_owned(),
    });
    ("a numeric key of scene or initial state, as a whole or with a component (.x)".to_owned(), remedy)
}

/// The component that a name means: dotted, or as a column of rows.
pub(super) fn named(scene: &SceneInput, name: &str) -> Option<(Parameter, usize)> {
    let flat = || {
        Parameter::all(scene).find_map(|parameter| {
            (0..parameter.width()).map(|k| (parameter, k)).find(|(parameter, k)| parameter.column_name(*k) == name)
        })
    };
    match Parameter::find(scene, name) {
        Some((parameter, Some(component))) => Some((parameter, component)),
        Some((parameter, None)) if parameter.width() == 1 => Some((parameter, 0)),
        _ => flat(),
    }
}
