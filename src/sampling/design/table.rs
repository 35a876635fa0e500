//! `table`: the rows of a file, for the parameters in its columns; other parameters are drawn as in the random design.

use super::random::Random;
use super::traits::{BLOCK, Dimensions, Facts, Kind, Options, PointSource, Size};
use crate::sampling::keys::{DataColumn, FILE_OF_PARAMETERS, Value, Written};

#[derive(Debug)]
pub struct TableRows(Random);

impl Options for Vec<DataColumn> {
    fn read(written: &Written) -> Self {
        written.columns().to_vec()
    }

    fn written(&self) -> Written {
        Written::default().with("file", Value::Columns(self.clone()))
    }

    fn columns(&self) -> &[DataColumn] {
        self
    }
}

impl PointSource for TableRows {
    fn fill(&mut self, block: u64, u: &mut [[f64; BLOCK]]) {
        self.0.fill(block, u);
    }
}

impl Kind for TableRows {
    const FACTS: Facts = Facts::new("table", &[FILE_OF_PARAMETERS], &[]);
    type Options = Vec<DataColumn>;

    fn size(columns: &Vec<DataColumn>, _dimensions: usize) -> Size {
        columns.first().map_or(Size::Any, |column| Size::Points(column.values.len() as u64))
    }

    fn points(_: &Vec<DataColumn>, dimensions: Dimensions<'_>) -> Self {
        TableRows(Random::points(&(), dimensions))
    }
}
