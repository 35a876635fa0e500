//! Names of parameters in campaign files.

use super::meaning::meant;
use super::section::Section;
use crate::sampling::Component;
use crate::sampling::keys::{Kind, Row, Value};
use crate::scene::{EnvironmentInput, LawParameter, Parameter, SceneInput};

/// The key for the subject of a table.
pub const PARAMETER: Row = Row::new("parameter", Kind::Parameter, "A number of the scene or of the control loop")
    .required_as("a numeric key of scene or initial state", "\"initial.angular_velocity_rad_s\"");

/// The parameter that `key` names, by its whole name or that of a component.
pub(super) fn parameter(table: &mut Section<'_, '_>, key: &str) -> Option<Value> {
    let name = table.text(key)?;
    let found = Parameter::find(&table.document.scene, name);
    if found.is_none() && !table.document.may_be_of_loop(name) {
        let (allowed, remedy) = unknown_parameter(&table.document.scene, name);
        table.refuse(key, allowed, remedy);
    }
    if let Some((allowed, remedy)) = found.and_then(|(parameter, _)| without_effect(table, parameter)) {
        table.refuse(key, allowed, remedy);
    }
    found.map(|found| name_of(found).as_str().into())
}

pub(super) fn parameters(table: &mut Section<'_, '_>, key: &str) -> Option<Value> {
    let names = table.texts(key, "[\"wheels.w1.radius_m\", \"wheels.w1.length_m\"]")?;
    let mut found = Vec::with_capacity(names.len());
    for name in names {
        let Some(parameter) = Parameter::find(&table.document.scene, &name) else {
            refuse_unknown(table, key, &name);
            return None;
        };
        found.push(name_of(parameter));
    }
    Some(Value::Texts(found))
}

/// Notes that `name`, in the list of `key`, is not a parameter.
pub(super) fn refuse_unknown(table: &mut Section<'_, '_>, key: &str, name: &str) {
    if !table.document.may_be_of_loop(name) {
        let (allowed, remedy) = unknown_parameter(&table.document.scene, name);
        table.refuse_value(key, format!("{name:?}"), format!("made of names, each {allowed}"), remedy);
    }
}

/// The name of a parameter, or of one component.
pub(super) fn name_of((parameter, component): (Parameter, Option<usize>)) -> String {
    component.map_or_else(|| parameter.name(), |component| parameter.component_name(component))
}

/// The setting without which a key of the table `header` has no effect.
pub fn lacking(environment: &EnvironmentInput, header: &str, key: &str) -> Option<&'static str> {
    let (acts, setting) = match (header, key) {
        ("environment", "density_scale") | ("plates", "drag_coefficient") => (environment.drag, "drag = true"),
        ("environment", "solar_pressure_n_m2" | "shadow") | ("plates", "specular" | "diffuse" | "cell_efficiency") => {
            (environment.solar_pressure, "solar_pressure = true")
        }
        ("environment", "area_scale") | ("plates", _) => {
            (environment.acts_on_plates(), "drag = true or solar_pressure = true")
        }
        _ => return None,
    };
    (!acts).then_some(setting)
}

/// Why draws of `parameter` change no run, and the remedy: its effect does not act, or a filter believes the file's
/// number.
pub(super) fn without_effect(table: &Section<'_, '_>, parameter: Parameter) -> Option<(String, &'static str)> {
    let (name, environment) = (parameter.name(), &table.document.scene.environment);
    let header = name.split('.').next().unwrap_or_default();
    if let Some(setting) = lacking(environment, header, parameter.facts().key) {
        let allowed = format!("a parameter that acts, which {name} does with environment.{setting} alone");
        return Some((allowed, "add that line to [environment], or delete this table"));
    }
    let kind = table.document.law.as_ref()?.spec()?.estimator;
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

/// Allowed names and remedy for an unknown parameter.
pub(super) fn unknown_parameter(scene: &SceneInput, name: &str) -> (String, String) {
    let names: Vec<String> = Parameter::all(scene).map(Parameter::name).collect();
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

/// The component with this dotted name or name of a column.
pub(super) fn named(scene: &SceneInput, name: &str) -> Option<Component> {
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
