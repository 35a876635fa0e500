//! `table`: the rows of a file, for the parameters that are its columns; other parameters are drawn as by the random
//! design.

use super::random::RandomPoints;
use super::traits::{Dimensions, Kind, Size};
use crate::sampling::keys::{DataColumn, FILE_OF_PARAMETERS, Row, Value, Written};

#[derive(Clone, Debug, PartialEq)]
pub struct TableDesign(pub Vec<DataColumn>);

impl Kind for TableDesign {
    const NAME: &'static str = "table";
    const KEYS: &'static [Row] = &[FILE_OF_PARAMETERS];
    const HAS_SIZE: bool = true;
    type Points = RandomPoints;

    fn of(written: &Written) -> Self {
        TableDesign(written.columns().to_vec())
    }

    fn written(&self) -> Written {
        Written::default().with("file", Value::Columns(self.0.clone()))
    }

    fn size(&self, _dimensions: usize) -> Size {
        self.0.first().map_or(Size::Any, |column| Size::Points(column.values.len() as u64))
    }

    fn columns(&self) -> &[DataColumn] {
        &self.0
    }

    fn points(&self, dimensions: Dimensions<'_>) -> RandomPoints {
        RandomPoints::new(dimensions)
    }
}
