//! [`Columns`]: the dispersed and derived components of parameters, in the order of their values.

use crate::scene::{Parameter, SceneInput};

/// One number of a parameter.
pub type Component = (Parameter, usize);

#[derive(Clone, Debug, PartialEq)]
pub struct Column {
    pub parameter: Parameter,
    pub component: usize,
    pub nominal: f64,
}

impl Column {
    /// Its name in rows.
    pub fn name(&self) -> String {
        self.parameter.column_name(self.component)
    }
}

#[derive(Clone, Debug, Default, PartialEq)]
pub struct Columns(Vec<Column>);

impl Columns {
    pub fn list(&self) -> &[Column] {
        &self.0
    }

    pub fn find(&self, (parameter, component): Component) -> Option<usize> {
        self.0.iter().position(|column| (column.parameter, column.component) == (parameter, component))
    }

    /// The index of a component, added if absent.
    pub fn add(&mut self, parameter: Parameter, component: usize, nominal: &SceneInput) -> usize {
        self.find((parameter, component)).unwrap_or_else(|| {
            let nominal = parameter.value(nominal, component).unwrap_or(f64::NAN);
            self.0.push(Column { parameter, component, nominal });
            self.0.len() - 1
        })
    }
}
