//! [`Observed`]: an observable as a column of the rows, or an expression over columns. An `ok` run has no value if its
//! subject never happened, or if the value is not a number ([`Observed::undefined`]).

use crate::analysis::part_columns::PartColumns;
use crate::campaign::Plan;
use crate::campaign::known_columns::KnownColumns;
use crate::observables::ColumnKind;
use crate::run::Quantity;
use crate::sampling::expression::Expression;
use crate::storage::rows_reader::Result;
use std::borrow::Cow;

#[derive(Clone, Debug, PartialEq)]
struct Source {
    column: String,
    absence: Absence,
}

/// Meaning of a missing value in an `ok` run.
#[derive(Clone, Debug, PartialEq)]
enum Absence {
    /// The subject never happened.
    Never,
    /// The event never happened; if its count is missing too, its quantity is not a number.
    Event { count: String },
    /// An extreme from `delay_s` after `after` (time and count of an event) is not a number, unless the event never
    /// happened or the run ended before.
    Extreme { after: Option<[String; 2]>, delay_s: f64, end: End },
}

#[derive(Clone, Debug, PartialEq)]
enum End {
    At(f64),
    Column(&'static str),
}

impl Absence {
    fn of(plan: &Plan, column: &str) -> Self {
        let count = |event: &str| format!("{event}_count");
        let time = |event: &str| format!("{event}_time_s");
        let of_event =
            plan.events.iter().map(|event| &event.name).find(|name| column == time(name) || column == count(name));
        if let Some(name) = of_event {
            return Absence::Event { count: count(name) };
        }
        let is_total = |text: &str| Expression::parse(text).is_ok_and(|expression| expression.is_total());
        let extreme = plan.extremes.iter().find(|one| one.name == column && !is_total(&one.quantity));
        let Some(extreme) = extreme else { return Absence::Never };
        let after = extreme.after.as_ref().map(|name| [time(name), count(name)]);
        let has_end = plan.request().columns().iter().any(|column| column.quantity.name() == TIME_REACHED);
        let end = if has_end { End::Column(TIME_REACHED) } else { End::At(plan.grid.duration()) };
        Absence::Extreme { after, delay_s: extreme.delay_s, end }
    }

    fn undefined(&self, part: &impl PartColumns) -> Result<Vec<bool>> {
        let rows = part.rows();
        Ok(match self {
            Absence::Never => vec![false; rows],
            Absence::Event { count } => part.numbers(count)?.iter().map(|count| count.is_nan()).collect(),
            Absence::Extreme { after, delay_s, end } => {
                let [times, counts] = match after {
                    Some([time, count]) => [part.numbers(time)?, part.numbers(count)?],
                    None => [Cow::Owned(vec![0.0; rows]), Cow::Owned(vec![0.0; rows])],
                };
                let ends = match end {
                    End::At(end) => Cow::Owned(vec![*end; rows]),
                    End::Column(name) => part.numbers(name)?,
                };
                // also true for NaN
                (0..rows).map(|row| counts[row].is_nan() || times[row] + delay_s <= ends[row]).collect()
            }
        })
    }
}

/// Column with the end of a run.
const TIME_REACHED: &str = "time_reached_s";

#[derive(Clone, Debug, PartialEq)]
pub struct Observed {
    pub quantity: Quantity,
    pub is_count: bool,
    derived: Option<Expression>,
    /// Variables of the expression, or its own column.
    sources: Vec<Source>,
}

impl Observed {
    /// Observables of `plan`: in the rows, in order, then derived ones.
    pub fn all(plan: &Plan) -> Vec<Observed> {
        let request = plan.request();
        let known = KnownColumns::new(request);
        let source = |column: String| Source { absence: Absence::of(plan, &column), column };
        let of_rows = request.columns().into_iter().map(|column| Observed {
            is_count: column.kind == ColumnKind::Count,
            derived: None,
            sources: vec![source(column.quantity.name().to_owned())],
            quantity: column.quantity,
        });
        let derived = plan.analysis.derived.iter().map(|derived| {
            let (expression, variables) =
                derived.parsed(&plan.nominal, &known).expect("a plan's expressions were parsed when the plan was made");
            let sources = variables.iter().map(|variable| source(variable.column())).collect();
            Observed { quantity: derived.quantity(), is_count: false, derived: Some(expression), sources }
        });
        of_rows.chain(derived).collect()
    }

    pub fn name(&self) -> &str {
        self.quantity.name()
    }

    /// The observables called `names`, in the order of [`Observed::all`].
    pub fn named<'a>(plan: &Plan, names: impl Iterator<Item = &'a str>) -> Vec<Observed> {
        let names: Vec<&str> = names.collect();
        let mut all = Self::all(plan);
        all.retain(|observed| names.contains(&observed.name()));
        all
    }

    /// True if every run has the same value because no draw enters it.
    pub fn is_constant(&self, plan: &Plan) -> bool {
        self.sources.is_empty() || plan.dispersions.columns().is_empty()
    }

    /// Values in a part; NaN for none.
    pub fn column<'p>(&self, part: &'p impl PartColumns) -> Result<Cow<'p, [f64]>> {
        let Some(expression) = &self.derived else { return part.numbers(self.name()) };
        let columns = self.columns(part)?;
        let value = |row: usize| known(expression, |place| columns[place][row]);
        Ok((0..part.rows()).map(value).collect())
    }

    fn columns<'p>(&self, part: &'p impl PartColumns) -> Result<Vec<Cow<'p, [f64]>>> {
        self.sources.iter().map(|source| part.numbers(&source.column)).collect()
    }

    /// Rows of `part`, all `ok`, with an undefined value, such as the root of a negative number; in other rows without
    /// a value the subject never happened.
    pub fn undefined(&self, part: &impl PartColumns) -> Result<Vec<bool>> {
        let columns = self.columns(part)?;
        let own = |row: usize| match &self.derived {
            Some(expression) if columns.iter().all(|column| !column[row].is_nan()) => {
                expression.value(|place| columns[place][row]).is_nan()
            }
            _ => false,
        };
        let mut found: Vec<bool> = (0..part.rows()).map(own).collect();
        for (source, column) in self.sources.iter().zip(&columns).filter(|(source, _)| source.absence != Absence::Never)
        {
            let undefined = source.absence.undefined(part)?;
            let rows = found.iter_mut().zip(undefined.into_iter().zip(column.iter()));
            rows.for_each(|(found, (undefined, value))| *found |= undefined && value.is_nan());
        }
        Ok(found)
    }

    /// The value in a row, given its columns by name; `None` if a column is missing.
    pub fn value(&self, of: impl Fn(&str) -> Option<f64>) -> Option<f64> {
        let Some(expression) = &self.derived else { return of(self.name()) };
        let values: Vec<f64> = self.sources.iter().map(|source| of(&source.column)).collect::<Option<_>>()?;
        Some(known(expression, |place| values[place]))
    }

    /// Range of its values, from the expression and the `bounded` of requirements on its mean.
    pub fn range(&self, plan: &Plan) -> [f64; 2] {
        let not_negative = if self.is_count { 0.0 } else { f64::NEG_INFINITY };
        let of_text = match &self.derived {
            Some(expression) => expression.range(|_| [f64::NEG_INFINITY, f64::INFINITY]),
            None => [not_negative, f64::INFINITY],
        };
        let own = plan.analysis.requirements_on(self.name());
        let declared = own.filter_map(|one| one.bounded);
        declared.fold(of_text, |[low, high], [least, most]| [low.max(least), high.min(most)])
    }
}

/// NaN if any variable is unknown, even one without influence.
fn known(expression: &Expression, value: impl Fn(usize) -> f64) -> f64 {
    match (0..expression.variables().len()).any(|place| value(place).is_nan()) {
        true => f64::NAN,
        false => expression.value(value),
    }
}
