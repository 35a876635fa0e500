//! [`Derivation`]: a `[[derive]]` table; [`Derived`]: a column computed from others.

use super::columns::Columns;
use super::correlation::components_of;
use super::error::{DispersionError, GIVE_KEY, HAS_KEY, Table, error_of};
use super::expression::Expression;
use super::keys::Written;
use crate::scene::parameter::Shape;
use crate::scene::{Parameter, SceneInput};

#[derive(Clone, Debug, PartialEq)]
pub struct Derivation {
    pub parameter: Parameter,
    /// One component; `None` for all.
    pub component: Option<usize>,
    pub expression: String,
    /// The table as in canonical text.
    pub written: Written,
}

impl Derivation {
    pub fn inputs(&self, scene: &SceneInput) -> Vec<(Parameter, usize)> {
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
    /// The same in every sample.
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

/// Relative difference between the expression in the nominal scene and the nominal value.
const NOMINAL_SLACK: f64 = 1e-9;

/// Adds the columns of `list` to `columns`, each after its sources; returns them and the errors.
pub(super) fn derived(
    list: &[Derivation],
    columns: &mut Columns,
    is_drawn: impl Fn(&Columns, (Parameter, usize)) -> bool,
    nominal: &SceneInput,
) -> (Vec<Derived>, Vec<DispersionError>) {
    let mut found = Vec::new();
    let mut errors = Vec::new();
    let mut open: Vec<(usize, (Parameter, usize), Expression, &str)> = Vec::new();
    for (index, derivation) in list.iter().enumerate() {
        let parameter = derivation.parameter;
        let components = components_of(&(parameter, derivation.component));
        let mut refuse = |key, value: String, allowed: String, remedy: &str| {
            errors.push(error_of(Table::Derive(index), key, value, allowed, remedy));
        };
        let expression = match Expression::parse(&derivation.expression) {
            Ok(expression) => expression,
            Err(allowed) => {
                let remedy = "operators are + - * / ^ and comparisons; names are those of parameters";
                refuse("expression", format!("{:?}", derivation.expression), allowed, remedy);
                continue;
            }
        };
        for (_, component) in components {
            let shown = format!("{:?}", parameter.component_name(component));
            let is_taken = is_drawn(columns, (parameter, component))
                || open.iter().any(|(_, target, ..)| *target == (parameter, component));
            if !parameter.exists(nominal) {
                refuse("parameter", shown, HAS_KEY.to_owned(), GIVE_KEY);
            } else if parameter.shape() == Shape::Quaternion {
                let allowed = "other than an attitude, which changes as a whole".to_owned();
                refuse("parameter", shown, allowed, "disperse the attitude");
            } else if is_taken {
                refuse(
                    "parameter",
                    shown,
                    "given a value once".to_owned(),
                    "delete one of the tables that give it one",
                );
            } else {
                open.push((index, (parameter, component), expression.clone(), &derivation.expression));
                continue;
            }
            break;
        }
    }
    // errors of variables
    open.retain(|(index, _, expression, _)| {
        let wrong = expression.variables().iter().find_map(|name| variable(name, nominal).err().map(|why| (name, why)));
        if let Some((name, (allowed, remedy))) = &wrong {
            errors.push(error_of(
                Table::Derive(*index),
                "expression",
                format!("{name:?}"),
                allowed.clone(),
                remedy.clone(),
            ));
        }
        wrong.is_none()
    });
    while !open.is_empty() && errors.is_empty() {
        let waits = |target: &(Parameter, usize)| open.iter().any(|(_, other, ..)| other == target);
        let ready = open.iter().position(|(_, _, expression, _)| {
            !expression.variables().iter().any(|name| variable(name, nominal).is_ok_and(|(target, _)| waits(&target)))
        });
        let Some(ready) = ready else {
            let (index, target, _, text) = &open[0];
            let allowed =
                format!("made of values that do not depend on {} themselves", target.0.component_name(target.1));
            let remedy = "break the cycle: one of them needs a value of its own";
            errors.push(error_of(Table::Derive(*index), "expression", format!("{text:?}"), allowed, remedy));
            break;
        };
        let (index, (parameter, component), expression, text) = open.remove(ready);
        let sources = expression
            .variables()
            .iter()
            .filter_map(|name| variable(name, nominal).ok())
            .map(|(target, value)| match columns.find(target) {
                Some(column) => DerivedInput::Column(column),
                None => DerivedInput::Nominal(value),
            })
            .collect();
        let column = columns.add(parameter, component, nominal);
        let derived = Derived { column, expression, sources, text: text.to_owned() };
        let at_nominal = derived.value(|column| columns.list()[column].nominal);
        let written = columns.list()[column].nominal;
        let near = (at_nominal - written).abs() <= NOMINAL_SLACK * at_nominal.abs().max(written.abs());
        // NaN is the scene's error
        if !at_nominal.is_finite() && written.is_finite() {
            let allowed = "a finite number in the nominal scene".to_owned();
            let remedy = "a division by zero, or a root or logarithm of a negative number: change the expression";
            errors.push(error_of(Table::Derive(index), "expression", format!("{at_nominal:?}"), allowed, remedy));
        } else if !near && written.is_finite() {
            let allowed = format!(
                "equal to the nominal {} = {written:?} in the nominal scene",
                parameter.component_name(component)
            );
            let remedy = format!("write the nominal value {at_nominal:?}, or change the expression");
            errors.push(error_of(Table::Derive(index), "expression", format!("{at_nominal:?}"), allowed, remedy));
        }
        found.push(derived);
    }
    (found, errors)
}

/// The parameter of a name in an expression and its nominal value; or allowed names and the remedy.
fn variable(name: &str, nominal: &SceneInput) -> Result<((Parameter, usize), f64), (String, String)> {
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
