//! `bootstrap`: the `parameters` of one row of a `file`, drawn with replacement (B. Efron, *Ann. Stat.* 7 (1979) 1),
//! which keeps their joint distribution.

use super::prelude::*;
use std::sync::Arc;

/// A row of a file.
#[derive(Clone, Debug, PartialEq)]
pub struct Bootstrap {
    file: String,
    /// The numbers of each column, row by row; equally many in each, at least one.
    columns: Vec<Arc<[f64]>>,
}

impl Bootstrap {
    /// The numbers of row `row`, below [`Bootstrap::rows`].
    pub fn values_of(&self, row: usize, values: &mut [f64]) {
        values.iter_mut().zip(&self.columns).for_each(|(value, column)| *value = column[row]);
    }

    pub fn rows(&self) -> usize {
        self.columns.iter().map(|column| column.len()).min().unwrap_or(0)
    }
}

impl Together for Bootstrap {
    const NAME: &'static str = "bootstrap";
    const KEYS: &'static [Row] = &[FILE_OF_PARAMETERS];

    fn map(target: &Target<'_>) -> Result<Self> {
        let columns = target.written.columns();
        let map = Bootstrap {
            file: columns.first().map_or_else(String::new, |column| column.file.clone()),
            columns: columns.iter().map(|column| column.values.clone()).collect(),
        };
        if map.rows() == 0 {
            return target.refused("file", format!("{:?}", map.file), "a file with rows", "add rows to the file");
        }
        Ok(map)
    }
}

impl Map for Bootstrap {
    fn dimensions(&self) -> usize {
        1
    }

    fn dimension_name(&self, _dimension: usize) -> String {
        "row".to_owned()
    }

    /// Row k of n, counted from zero, for u from k/n to (k + 1)/n.
    fn values(&self, u: &[f64], values: &mut [f64]) {
        let row = ((u[0] * self.rows() as f64) as usize).min(self.rows() - 1);
        self.values_of(row, values);
    }

    fn text(&self, _words: NumberWords<'_>) -> String {
        let together = match self.columns.len() {
            1 => String::new(),
            count => format!(", {count} numbers together"),
        };
        format!("one of the {} rows of {}{together}", self.rows(), self.file)
    }
}
