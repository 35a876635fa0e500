//! [`Derivation`]: a `[[derive]]` table; [`Derived`]: a column computed from others.

use super::columns::{Columns, Component};
use super::correlation::components_of;
use super::error::{DispersionError, GIVE_KEY, HAS_KEY, Table, error_of};
use super::expression::Expression;
use super::keys::Written;
use crate::scene::parameter::Shape;
use crate::scene::{Parameter, SceneInput};

#[derive(Clone, Debug, PartialEq)]
pub struct Derivation {
    /// Index of its table in the file.
    pub table: usize,
    pub parameter: Parameter,
    /// One component; `None` for all.
    pub component: Option<usize>,
    pub expression: String,
    /// The table as in canonical text.
    pub written: Written,
}

impl Derivation {
    pub fn inputs(&self, scene: &SceneInput) -> Vec<Component> {
        let Ok(expression) = Expression::parse(&self.expression) else { return Vec::new() };
        let found = expression.variables().iter().filter_map(|name| Parameter::find(scene, name));
        found.map(|(parameter, component)| (parameter, component.unwrap_or(0))).collect()
    }
}

#[derive(Clone, Debug, PartialEq)]
pub struct Derived {
    pub column: usize,
    expression: Expression,
    sources: Vec<DerivedInput>,
    pub text: String,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum DerivedInput {
    Column(usize),
    /// A number that is equal in every sample.
    Nominal(f64),
}

impl Derived {
    pub fn value(&self, column: impl Fn(usize) -> f64) -> f64 {
        self.expression.value(|index| match self.sources[index] {
            DerivedInput::Column(index) => column(index),
            DerivedInput::Nominal(value) => value,
        })
    }
}

/// Relative tolerance of nominal values.
const NOMINAL_SLACK: f64 = 1e-9;

/// A component that waits for its inputs, each with its nominal value.
struct Open<'l> {
    table: usize,
    target: Component,
    expression: Expression,
    inputs: Vec<(Component, f64)>,
    text: &'l str,
}

/// Adds the columns of `list` to `columns`, each after its sources; returns them and the errors.
pub(super) fn derived(
    list: &[Derivation],
    columns: &mut Columns,
    is_drawn: impl Fn(&Columns, Component) -> bool,
    nominal: &SceneInput,
) -> (Vec<Derived>, Vec<DispersionError>) {
    let (mut found, mut errors, mut open) = (Vec::new(), Vec::new(), Vec::<Open<'_>>::new());
    for Derivation { table, parameter, component, expression: text, .. } in list {
        let mut refuse = |key, value: String, allowed: String, remedy: &str| {
            errors.push(error_of(Table::Derive(*table), key, value, allowed, remedy));
        };
        let expression = match Expression::parse(text) {
            Ok(expression) => expression,
            Err(allowed) => {
                let remedy = "operators are + - * / ^ and comparisons; names are those of parameters";
                refuse("expression", format!("{text:?}"), allowed, remedy);
                continue;
            }
        };
        for target in components_of(&(*parameter, *component)) {
            let (allowed, remedy) = if !parameter.exists(nominal) {
                (HAS_KEY, GIVE_KEY)
            } else if parameter.shape() == Shape::Quaternion {
                ("other than an attitude, which changes as a whole", "disperse the attitude")
            } else if is_drawn(columns, target) || open.iter().any(|other| other.target == target) {
                ("given a value once", "delete one of the tables that give it one")
            } else {
                open.push(Open { table: *table, target, expression: expression.clone(), inputs: Vec::new(), text });
                continue;
            };
            refuse("parameter", format!("{:?}", parameter.component_name(target.1)), allowed.to_owned(), remedy);
            break;
        }
    }
    open.retain_mut(|one| {
        for name in one.expression.variables() {
            match variable(name, nominal) {
                Ok(input) => one.inputs.push(input),
                Err((allowed, remedy)) => {
                    let value = format!("{name:?}");
                    errors.push(error_of(Table::Derive(one.table), "expression", value, allowed, remedy));
                    return false;
                }
            }
        }
        true
    });
    while !open.is_empty() && errors.is_empty() {
        let waits =
            |one: &Open<'_>| open.iter().any(|other| one.inputs.iter().any(|(input, _)| *input == other.target));
        let Some(ready) = open.iter().position(|one| !waits(one)) else {
            let Open { table, target, text, .. } = &open[0];
            let allowed =
                format!("made of values that do not depend on {} themselves", target.0.component_name(target.1));
            let remedy = "break the cycle: one of them needs a value of its own";
            errors.push(error_of(Table::Derive(*table), "expression", format!("{text:?}"), allowed, remedy));
            break;
        };
        let Open { table, target: (parameter, component), expression, inputs, text } = open.remove(ready);
        let source = |(input, value)| columns.find(input).map_or(DerivedInput::Nominal(value), DerivedInput::Column);
        let sources = inputs.into_iter().map(source).collect();
        let column = columns.add(parameter, component, nominal);
        let derived = Derived { column, expression, sources, text: text.to_owned() };
        let at_nominal = derived.value(|column| columns.list()[column].nominal);
        let written = columns.list()[column].nominal;
        let slack = NOMINAL_SLACK * at_nominal.abs().max(written.abs());
        let is_near = at_nominal.is_finite() && (at_nominal - written).abs() <= slack;
        // NaN is the scene's error
        if !is_near && written.is_finite() {
            let name = parameter.component_name(component);
            let (allowed, remedy) = if at_nominal.is_finite() {
                (
                    format!("equal to the nominal {name} = {written:?} in the nominal scene"),
                    format!("write the nominal value {at_nominal:?}, or change the expression"),
                )
            } else {
                let remedy = "a division by zero, or a root or logarithm of a negative number: change the expression";
                ("a finite number in the nominal scene".to_owned(), remedy.to_owned())
            };
            errors.push(error_of(Table::Derive(table), "expression", format!("{at_nominal:?}"), allowed, remedy));
        }
        found.push(derived);
    }
    (found, errors)
}

/// The parameter of a name in an expression and its nominal value; or allowed names and the remedy.
fn variable(name: &str, nominal: &SceneInput) -> Result<(Component, f64), (String, String)> {
    let Some((parameter, component)) = Parameter::find(nominal, name) else {
        let allowed = "a numeric key of scene or initial state, one component of it".to_owned();
        return Err((allowed, "write names as in this file, wheels.w1.radius_m or initial.position_m.x".to_owned()));
    };
    if parameter.shape() == Shape::Quaternion {
        let allowed = "other than an attitude, whose components are normalised after they were drawn".to_owned();
        return Err((allowed, "leave it out".to_owned()));
    }
    let component = match component {
        Some(component) => component,
        None if parameter.width() == 1 => 0,
        None => {
            let remedy = format!("write {} or another", parameter.component_name(0));
            return Err(("one component of a parameter".to_owned(), remedy));
        }
    };
    match parameter.value(nominal, component) {
        Some(value) => Ok(((parameter, component), value)),
        None => Err((HAS_KEY.to_owned(), GIVE_KEY.to_owned())),
    }
}
