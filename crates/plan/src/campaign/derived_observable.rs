//! [`DerivedObservable`]: an `[[observable]]` table. Statistics evaluate it from stored rows, which do not contain it.

use super::columns::parameter_quantity;
use super::known_columns::KnownColumns;
use super::parameter::named;
use super::section::Section;
use crate::run::Quantity;
use crate::sampling::expression::Expression;
use crate::sampling::keys::{ANY_TEXT, COLUMN_NAME, Kind, Row, TextLimit};
use crate::sampling::{Column, Component};
use crate::scene::{Parameter, SceneInput};

/// An expression of columns and dispersed parameters.
#[derive(Clone, Debug, PartialEq)]
pub struct DerivedObservable {
    pub name: String,
    /// Empty for a pure number.
    pub unit: String,
    pub expression: String,
}

const NAME: TextLimit = TextLimit { remedy: "write it like pointing_error_deg", ..COLUMN_NAME };

#[rustfmt::skip]
pub const ROWS: [Row; 3] = [
    Row::new("name", Kind::Text(NAME), "Its name, which must not be that of a column").required_as(NAME.allowed,
        "\"pointing_error_deg\""),
    Row::new("unit", Kind::Text(ANY_TEXT), "Its unit; default: a pure number"),
    Row::new("expression", Kind::Expression, "Arithmetic over columns of the rows and dispersed parameters")
        .required_as("arithmetic over columns and dispersed parameters", "\"2 * energy_error_max\""),
];

#[derive(Clone, Debug, PartialEq)]
pub enum Variable {
    Observable(String),
    /// A component of a dispersed parameter.
    Parameter(Parameter, usize),
}

impl Variable {
    pub fn column(&self) -> String {
        match self {
            Variable::Observable(name) => name.clone(),
            Variable::Parameter(parameter, component) => parameter.column_name(*component),
        }
    }
}

fn variable(name: &str, scene: &SceneInput, known: &KnownColumns) -> Option<Variable> {
    if known.observable(name).is_some() {
        return Some(Variable::Observable(name.to_owned()));
    }
    named(scene, name).map(|(parameter, component)| Variable::Parameter(parameter, component))
}

impl DerivedObservable {
    pub(super) fn read(table: &mut Section<'_, '_>) -> Option<Self> {
        let written = table.whole(&ROWS, &[]);
        let name = written.as_ref().and_then(|written| name(table, written.text("name")?));
        let written = written?;
        let known = table.document.known.as_ref()?;
        let expression = written.text("expression")?.to_owned();
        let parsed = Expression::parse(&expression).ok()?;
        for variable_name in parsed.variables() {
            if variable(variable_name, &table.document.scene, known).is_none() {
                let (_, remedy) = known.refusal(variable_name);
                let allowed = "made of columns of the rows and of dispersed parameters";
                table.refuse_value("expression", format!("{variable_name:?}"), allowed, remedy);
                return None;
            }
        }
        if let Some(value) = nominal_value(&parsed, &table.document.scene, known).filter(|value| !value.is_finite()) {
            let allowed = "a finite number in the nominal scene";
            let remedy = "a division by zero, or a root or logarithm of a negative number: change the expression";
            table.refuse_value("expression", format!("{value:?}"), allowed, remedy);
            return None;
        }
        let (name, unit) = (name?, written.text("unit").unwrap_or_default().to_owned());
        table.document.keep("[[observable]]", written.completed(&ROWS, &[]));
        Some(DerivedObservable { name, unit, expression })
    }

    pub fn quantity(&self) -> Quantity {
        Quantity::named(self.name.clone(), self.unit.clone(), format!("{}.", self.expression))
    }

    /// The components of parameters in the expression.
    pub fn parameters(&self, scene: &SceneInput) -> Vec<Component> {
        let expression = Expression::parse(&self.expression).ok();
        let names = expression.iter().flat_map(Expression::variables);
        names.filter_map(|name| named(scene, name)).collect()
    }

    /// The expression and its variables; `None` only for what [`DerivedObservable::read`] refuses.
    pub fn parsed(&self, scene: &SceneInput, known: &KnownColumns) -> Option<(Expression, Vec<Variable>)> {
        let expression = Expression::parse(&self.expression).ok()?;
        let variables: Option<_> = expression.variables().iter().map(|name| variable(name, scene, known)).collect();
        Some((expression, variables?))
    }

    /// The first parameter in the expression that is not among the `dispersed` columns.
    pub(super) fn undispersed(
        &self,
        scene: &SceneInput,
        known: &KnownColumns,
        dispersed: &[Column],
    ) -> Option<Component> {
        let (_, variables) = self.parsed(scene, known)?;
        let is_column = |parameter: &Parameter, component: &usize| {
            dispersed.iter().any(|column| (column.parameter, column.component) == (*parameter, *component))
        };
        variables.into_iter().find_map(|variable| match variable {
            Variable::Parameter(parameter, component) if !is_column(&parameter, &component) => {
                Some((parameter, component))
            }
            _ => None,
        })
    }
}

/// The value in the nominal scene; `None` if it depends on a run or on a missing parameter.
fn nominal_value(expression: &Expression, scene: &SceneInput, known: &KnownColumns) -> Option<f64> {
    let value = |name: &String| match variable(name, scene, known)? {
        Variable::Parameter(parameter, component) => parameter.value(scene, component),
        Variable::Observable(_) => None,
    };
    let values: Vec<f64> = expression.variables().iter().map(value).collect::<Option<_>>()?;
    // problems of the scene are reported there
    values.iter().all(|value| value.is_finite()).then(|| expression.value(|index| values[index]))
}

fn name(table: &mut Section<'_, '_>, name: &str) -> Option<String> {
    let scene = &table.document.scene;
    let of = |parameter: Parameter| (0..parameter.width()).map(move |c| parameter_quantity(parameter, c));
    let is_column = table.document.known.as_ref()?.observable(name).is_some()
        || crate::observables::table::all().any(|column| column.quantity.name() == name)
        || Parameter::all(scene).flat_map(of).any(|quantity| quantity.name() == name);
    if is_column || ["sample_id", "status", "reason"].contains(&name) {
        return table.refused("name", "a name that no column has", "choose another name");
    }
    Some(name.to_owned())
}
