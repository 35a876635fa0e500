//! `table`: the rows of a file, for the parameters that are its columns; other parameters are drawn as by the random design.

use super::random::RandomPoints;
use super::traits::{Dimensions, Kind, Size};
use crate::sampling::keys::{DataColumn, KeyReader, KeyWriter};

/// Rows of a file.
#[derive(Clone, Debug, PartialEq)]
pub struct TableDesign(pub Vec<DataColumn>);

impl Kind for TableDesign {
    const NAME: &'static str = "table";
    const HAS_SIZE: bool = true;
    type Points = RandomPoints;

    fn read(keys: &mut dyn KeyReader) -> Option<Self> {
        keys.columns().map(TableDesign)
    }

    fn write(&self, keys: &mut dyn KeyWriter) {
        keys.columns(&self.0);
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
