//! `bootstrap`: the `parameters` of one row of a `file`, each row as likely as the others, drawn with replacement (B.
//! Efron, *Ann. Stat.* 7 (1979) 1). Numbers of a draw are those of one observation: their joint distribution is that of
//! the file.

use super::target::JointTarget;
use super::traits::{Map, NumberWords, Together};
use crate::sampling::error::DispersionError;
use crate::sampling::keys::{FILE_OF_PARAMETERS, Row};
use std::sync::Arc;

#[derive(Clone, Copy, Debug)]
pub struct Bootstrap;

/// Ready to be drawn: a row of a file.
#[derive(Clone, Debug, PartialEq)]
pub struct BootstrapMap {
    file: String,
    /// The numbers of each column, row by row; as many in each, at least one.
    columns: Vec<Arc<[f64]>>,
}

impl BootstrapMap {
    /// The numbers of the row `row`, below [`BootstrapMap::rows`].
    pub fn values_of(&self, row: usize, values: &mut [f64]) {
        for (value, column) in values.iter_mut().zip(&self.columns) {
            *value = column[row];
        }
    }

    pub fn rows(&self) -> usize {
        self.columns.iter().map(|column| column.len()).min().unwrap_or(0)
    }
}

impl Together for Bootstrap {
    const NAME: &'static str = "bootstrap";
    const KEYS: &'static [Row] = &[FILE_OF_PARAMETERS];
    type Map = BootstrapMap;

    fn map(target: &JointTarget<'_>) -> Result<BootstrapMap, DispersionError> {
        let columns = target.written.columns();
        let map = BootstrapMap {
            file: columns.first().map_or_else(String::new, |column| column.file.clone()),
            columns: columns.iter().map(|column| column.values.clone()).collect(),
        };
        if map.rows() == 0 {
            return target.refused("file", format!("{:?}", map.file), "a file with rows", "add rows to the file");
        }
        Ok(map)
    }
}

impl Map for BootstrapMap {
    fn dimensions(&self) -> usize {
        1
    }

    fn dimension_name(&self, _dimension: usize) -> String {
        "row".to_owned()
    }

    fn components(&self) -> usize {
        self.columns.len()
    }

    /// Row k of n, counted from zero, for u from k/n to (k + 1)/n.
    fn values(&self, u: &[f64], values: &mut [f64]) {
        let rows = self.rows();
        self.values_of(((u[0] * rows as f64) as usize).min(rows - 1), values);
    }

    fn text(&self, _words: NumberWords<'_>) -> String {
        let together = match self.columns.len() {
            1 => String::new(),
            count => format!(", {count} numbers together"),
        };
        format!("one of the {} rows of {}{together}", self.rows(), self.file)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_row_has_an_equal_part_of_the_unit_interval() {
        let columns = vec![[5.0, 1.0, 2.0].into(), [-5.0, -1.0, -2.0].into()];
        let map = BootstrapMap { file: "data.csv".to_owned(), columns };
        let row = |u: f64| {
            let mut values = [0.0; 2];
            map.values(&[u], &mut values);
            values
        };
        // the least and the greatest u that a design gives; the numbers of a row stay together, in the order of the
        // file
        assert_eq!([f64::MIN_POSITIVE, 0.33].map(row), [[5.0, -5.0]; 2]);
        assert_eq!([0.34, 0.66].map(row), [[1.0, -1.0]; 2]);
        assert_eq!([0.67, 1.0 - 0.5 * f64::EPSILON].map(row), [[2.0, -2.0]; 2]);
        assert_eq!(
            map.text(NumberWords { amount: &|x| x.to_string(), angle: &|x| x.to_string(), number: &|x| x.to_string() }),
            "one of the 3 rows of data.csv, 2 numbers together"
        );
    }
}
