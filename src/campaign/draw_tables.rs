//! [`DrawTables`]: the tables of draws of a campaign file, each with its place in the file.

use crate::sampling::{Correlation, Derivation, Dispersion, Table};

/// The tables of draws that could be read, each with its index in the file: errors name a table by its index
/// among those that could be read.
pub(super) struct DrawTables {
    pub(super) dispersed: (Vec<usize>, Vec<Dispersion>),
    pub(super) correlated: (Vec<usize>, Vec<Correlation>),
    pub(super) derived: (Vec<usize>, Vec<Derivation>),
}

impl DrawTables {
    pub(super) fn of(
        disperse: &[Option<Dispersion>],
        correlate: &[Option<Correlation>],
        derive: &[Option<Derivation>],
    ) -> Self {
        fn indexed<T: Clone>(list: &[Option<T>]) -> (Vec<usize>, Vec<T>) {
            list.iter().enumerate().filter_map(|(index, item)| item.clone().map(|item| (index, item))).unzip()
        }
        DrawTables { dispersed: indexed(disperse), correlated: indexed(correlate), derived: indexed(derive) }
    }

    /// The dotted path of a key in the file.
    pub(super) fn path(&self, table: Table, key: &str) -> String {
        let table = match table {
            Table::Disperse(index) => Table::Disperse(self.dispersed.0[index]),
            Table::Correlate(index) => Table::Correlate(self.correlated.0[index]),
            Table::Derive(index) => Table::Derive(self.derived.0[index]),
            other => other,
        };
        format!("{table}.{key}")
    }
}
