//! [`Observed`]: an observable of a campaign with the way to its values in the files of rows: a column, or an expression over columns.

use std::borrow::Cow;

use crate::analysis::part_columns::PartColumns;
use crate::campaign::Plan;
use crate::campaign::known_columns::KnownColumns;
use crate::observables::ColumnKind;
use crate::run::Quantity;
use crate::sampling::expression::Expression;
use crate::storage::rows_reader::RowsError;

#[derive(Clone, Debug, PartialEq)]
pub struct Observed {
    /// Name, unit and meaning.
    pub quantity: Quantity,
    /// Whether its values are counts.
    pub is_count: bool,
    /// What it is computed from, where no row has it.
    derived: Option<(Expression, Vec<String>)>,
}

impl Observed {
    /// Every observable of `plan`: those of the rows in their order, then those that its file derives.
    pub fn all(plan: &Plan) -> Vec<Observed> {
        let request = plan.request();
        let known = KnownColumns::new(request);
        let of_rows = request.columns().into_iter().map(|column| Observed {
            is_count: column.kind == ColumnKind::Count,
            quantity: column.quantity,
            derived: None,
        });
        let derived = plan.analysis.derived.iter().map(|derived| {
            let (expression, variables) =
                derived.parsed(&plan.nominal, &known).expect("a plan's expressions were parsed when the plan was made");
            let columns = variables.iter().map(|variable| variable.column()).collect();
            Observed { quantity: derived.quantity(), is_count: false, derived: Some((expression, columns)) }
        });
        of_rows.chain(derived).collect()
    }

    /// The observables of `plan` with these names, in the order of [`Observed::all`].
    pub fn named<'a>(plan: &Plan, names: impl Iterator<Item = &'a str>) -> Vec<Observed> {
        let names: Vec<&str> = names.collect();
        let mut all = Self::all(plan);
        all.retain(|observed| names.contains(&observed.quantity.name()));
        all
    }

    /// Whether no draw of `plan` enters it, so that every run has the same value.
    pub fn is_constant(&self, plan: &Plan) -> bool {
        let has_no_column = self.derived.as_ref().is_some_and(|(_, columns)| columns.is_empty());
        has_no_column || plan.dispersions.columns().is_empty()
    }

    /// Its values in a part, row by row; NaN where a row has none.
    ///
    /// # Errors
    /// Where they cannot be read.
    pub fn column<'p>(&self, part: &'p impl PartColumns) -> Result<Cow<'p, [f64]>, RowsError> {
        let Some((expression, columns)) = &self.derived else { return part.numbers(self.quantity.name()) };
        let columns: Vec<Cow<'_, [f64]>> = columns.iter().map(|name| part.numbers(name)).collect::<Result<_, _>>()?;
        // what is not known makes the value unknown, also behind `if` and in comparisons
        let value = |row: usize| match columns.iter().any(|column| column[row].is_nan()) {
            true => f64::NAN,
            false => expression.value(|place| columns[place][row]),
        };
        Ok((0..part.rows()).map(value).collect())
    }

    /// The same as a list.
    ///
    /// # Errors
    /// Where they cannot be read.
    pub fn values(&self, part: &impl PartColumns) -> Result<Vec<f64>, RowsError> {
        self.column(part).map(Cow::into_owned)
    }

    /// Its value in a row whose column of a name has the value `of`; `None` where the row has no such column.
    pub fn value(&self, of: impl Fn(&str) -> Option<f64>) -> Option<f64> {
        let Some((expression, columns)) = &self.derived else { return of(self.quantity.name()) };
        let values: Vec<f64> = columns.iter().map(|name| of(name)).collect::<Option<_>>()?;
        Some(if values.iter().any(|value| value.is_nan()) { f64::NAN } else { expression.value(|place| values[place]) })
    }
}
