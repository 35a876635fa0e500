//! [`FirstRows`]: the first rows of a campaign, for input sensitivities.

use super::accumulator::Accumulator;
use super::observed::Observed;
use super::part_columns::PartColumns;
use crate::analysis::outcomes::{named, outcomes, unique};
use crate::campaign::Plan;
use crate::observables::headlines::headlines;
use crate::run::Status;
use crate::sampling::Design;
use crate::storage::rows_reader::Result;
use std::borrow::Cow;
use std::sync::atomic::{AtomicBool, Ordering};

/// Maximum rows if the file names observables.
pub const MOST_ROWS: usize = 65_536;
/// Maximum rows if it names none.
const FEWER_ROWS: usize = 16_384;
fn wanted(plan: &Plan) -> (Vec<String>, usize) {
    let named = named(plan);
    if !named.is_empty() {
        return (named, MOST_ROWS);
    }
    let columns = plan.request().columns();
    let main = headlines(&plan.request()).into_iter().map(|index| columns[index].quantity.name().to_owned());
    (unique(outcomes(plan).into_iter().chain(main)), FEWER_ROWS)
}

/// The first rows of dispersed, physical samples.
#[derive(Clone, Debug, Default)]
pub struct RowTable {
    pub(super) samples: Vec<u64>,
    pub(super) inputs: Vec<Vec<f64>>,
    /// NaN in runs that are not `ok`.
    pub(super) observables: Vec<Vec<f64>>,
    pub(super) is_ok: Vec<bool>,
}

impl RowTable {
    pub(super) fn column(&self, plan: &Plan, name: &str) -> Option<&[f64]> {
        let place = FirstRows::new(plan).observed.iter().position(|one| one.name() == name)?;
        Some(&self.observables[place])
    }
}

/// Collects inputs and required or named observables, else the main ones.
#[derive(Debug)]
pub struct FirstRows {
    inputs: Vec<String>,
    pub(super) observed: Vec<Observed>,
    most: usize,
    is_full: AtomicBool,
}

impl FirstRows {
    pub fn new(plan: &Plan) -> Self {
        let (names, most) = wanted(plan);
        let observed = Observed::named(plan, names.iter().map(String::as_str));
        let (inputs, most) = match plan.design {
            Design::Saltelli(_) => (Vec::new(), MOST_ROWS),
            _ => (inputs(plan), most),
        };
        FirstRows { inputs, observed, most, is_full: AtomicBool::new(false) }
    }
}

/// Observables with estimated sensitivities; none without inputs.
pub fn explained(plan: &Plan) -> Vec<String> {
    let observed = if inputs(plan).is_empty() { Vec::new() } else { FirstRows::new(plan).observed };
    observed.into_iter().map(|one| one.name().to_owned()).collect()
}

pub(super) fn inputs(plan: &Plan) -> Vec<String> {
    let columns = plan.dispersions.columns().iter().enumerate();
    let drawn = columns.filter(|(index, _)| plan.dispersions.expression_of(*index).is_none());
    drawn.map(|(_, column)| column.name()).collect()
}

impl Accumulator for FirstRows {
    type Whole = RowTable;
    type OfPart = RowTable;

    fn nothing(&self) -> RowTable {
        let empty = |count: usize| vec![Vec::new(); count];
        RowTable {
            samples: Vec::new(),
            inputs: empty(self.inputs.len()),
            observables: empty(self.observed.len()),
            is_ok: Vec::new(),
        }
    }

    fn count(&self, part: &impl PartColumns) -> Result<RowTable> {
        if self.is_full.load(Ordering::Relaxed) {
            return Ok(self.nothing());
        }
        let (samples, statuses) = (part.samples()?, part.statuses()?);
        let of_population = |row: &usize| samples[*row].0 > 0 && statuses[*row] != Status::InvalidSample;
        let rows: Vec<usize> = (0..samples.len()).filter(of_population).take(self.most).collect();
        let is_ok: Vec<bool> = rows.iter().map(|row| statuses[*row] == Status::Done).collect();
        let taken = |column: Cow<'_, [f64]>| rows.iter().map(|row| column[*row]).collect::<Vec<f64>>();
        let computed = |column: Cow<'_, [f64]>| {
            let of_row = |(value, is_ok): (f64, &bool)| if *is_ok { value } else { f64::NAN };
            taken(column).into_iter().zip(&is_ok).map(of_row).collect::<Vec<f64>>()
        };
        Ok(RowTable {
            samples: rows.iter().map(|row| samples[*row].0).collect(),
            inputs: self.inputs.iter().map(|name| part.numbers(name).map(taken)).collect::<Result<_, _>>()?,
            observables: self.observed.iter().map(|one| one.column(part).map(computed)).collect::<Result<_, _>>()?,
            is_ok,
        })
    }

    fn merge(&self, whole: &mut RowTable, part: RowTable) {
        let left = self.most - whole.samples.len();
        whole.samples.extend(part.samples.into_iter().take(left));
        whole.is_ok.extend(part.is_ok.into_iter().take(left));
        let columns = whole.inputs.iter_mut().chain(&mut whole.observables);
        columns
            .zip(part.inputs.into_iter().chain(part.observables))
            .for_each(|(mine, theirs)| mine.extend(theirs.into_iter().take(left)));
        self.is_full.store(whole.samples.len() == self.most, Ordering::Relaxed);
    }
}
