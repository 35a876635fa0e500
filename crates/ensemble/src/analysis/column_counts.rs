//! [`Collector`]: counts the values of observables, part by part, on any thread. Parts are merged in order and sketches
//! hold counts: results do not depend on threads.

use super::accumulator::Accumulator;
use super::observed::Observed;
use super::part_columns::PartColumns;
use super::population::Population;
use crate::campaign::Plan;
use crate::ensemble::threads::unpoisoned;
use crate::run::Status;
use crate::sampling::SampleId;
use crate::statistics::moments::Moments;
use crate::statistics::sketch::Sketch;
use crate::storage::rows_reader::Result;
use std::borrow::Cow;
use std::sync::Mutex;

#[derive(Clone, Debug, Default)]
pub struct ColumnCounts {
    /// `ok` runs without a value.
    pub without_value: u64,
    pub moments: Moments,
    /// By group ([`Population::group`]).
    pub groups: Vec<GroupCounts>,
}

#[derive(Clone, Debug, Default)]
pub struct GroupCounts {
    pub moments: Moments,
    /// If kept.
    pub values: Vec<f64>,
    /// If not kept.
    pub sketch: Sketch,
}

/// The counts of a part, without sketches and moments of columns, or of all parts.
#[derive(Clone, Debug)]
pub struct Collected {
    pub columns: Vec<ColumnCounts>,
    /// Physical runs that are not `ok`, by group; their values could be anything.
    pub lost: Vec<u64>,
}

/// Dispersed rows at the start of a campaign that determine the references of sketches.
pub const REFERENCE_ROWS: usize = 16;

/// Values whose range over their median is below this are sketched about the median. Otherwise sketching about zero
/// resolves a hundredth of the standard deviation with a third of the memory.
pub(super) const CLOSE: f64 = 0.25;

/// The value about which each of `observed` is sketched: the median over the first rows, in `parts` (the nominal value
/// may be far from the others), or zero if there are none or they differ by a quarter of it.
pub fn references<P: PartColumns>(
    observed: &[Observed],
    population: Population,
    parts: impl IntoIterator<Item = Result<P>>,
) -> Result<Vec<f64>> {
    let mut first = vec![Vec::new(); observed.len()];
    let mut left = REFERENCE_ROWS;
    for part in parts {
        let part = part?;
        let (samples, statuses) = (part.samples()?, part.statuses()?);
        let dispersed = (0..samples.len()).filter(|row| population.contains(samples[*row]));
        let dispersed: Vec<usize> = dispersed.take(left).collect();
        left -= dispersed.len();
        for (values, observed) in first.iter_mut().zip(observed) {
            let column = observed.column(&part)?;
            let ok = dispersed.iter().filter(|row| statuses[**row] == Status::Done);
            values.extend(ok.map(|row| column[*row]).filter(|value| !value.is_nan()));
        }
    }
    let reference = |mut values: Vec<f64>| {
        values.sort_by(f64::total_cmp);
        let Some(last) = values.len().checked_sub(1) else { return 0.0 };
        let median = values[last / 2];
        if values[last] - values[0] < CLOSE * median.abs() { median } else { 0.0 }
    };
    Ok(first.into_iter().map(reference).collect())
}

pub const MOST_EXACT: u64 = 100_000;

/// True if the quantiles of `plan` come from the values themselves.
pub fn is_exact(plan: &Plan) -> bool {
    plan.dispersed_rows() <= MOST_EXACT
}

/// Values in memory: 64 MB.
const VALUES_AT_A_TIME: u64 = 8 << 20;
/// Sketches in memory, mostly below 0.1 MB each.
const SKETCHES_AT_A_TIME: u64 = 512;

/// The observables of `plan` in batches for one pass over the rows each, so that memory does not depend on their
/// number.
pub fn batches(plan: &Plan) -> Vec<Vec<Observed>> {
    let at_a_time = if is_exact(plan) {
        VALUES_AT_A_TIME / plan.rows().max(1)
    } else {
        SKETCHES_AT_A_TIME / Population::of(plan).groups() as u64
    };
    Observed::all(plan).chunks(at_a_time.max(1) as usize).map(<[Observed]>::to_vec).collect()
}

#[derive(Debug)]
pub struct Collector {
    observed: Vec<Observed>,
    population: Population,
    is_exact: bool,
    /// By observable and group; the order of additions does not matter.
    sketches: Vec<Mutex<Vec<Sketch>>>,
}

impl Collector {
    /// For `observed` of a `population`; values are sketched about `references` ([`references`]), or kept without them.
    pub fn new(observed: Vec<Observed>, population: Population, references: Option<Vec<f64>>) -> Self {
        let is_exact = references.is_none();
        let references = references.unwrap_or_else(|| vec![0.0; observed.len()]);
        let sketches = |reference: f64| Mutex::new(vec![Sketch::about(reference); population.groups()]);
        Collector { observed, population, is_exact, sketches: references.into_iter().map(sketches).collect() }
    }

    /// The moments of `values` of group `index`, and the values if kept; else adds them to the group's sketch.
    fn group(&self, values: Cow<'_, [f64]>, sketches: &Mutex<Vec<Sketch>>, index: usize) -> GroupCounts {
        let moments = Moments::of_block(&values);
        if self.is_exact {
            return GroupCounts { moments, values: values.into_owned(), ..GroupCounts::default() };
        }
        unpoisoned(sketches.lock())[index].add_block(&values, &moments);
        GroupCounts { moments, ..GroupCounts::default() }
    }

    pub fn finish(self, mut collected: Collected) -> Collected {
        for (column, sketches) in collected.columns.iter_mut().zip(self.sketches) {
            let sketches = unpoisoned(sketches.into_inner());
            column.groups.iter_mut().zip(sketches).for_each(|(group, sketch)| group.sketch = sketch);
        }
        collected
    }
}

impl Accumulator for Collector {
    type Whole = Collected;
    type OfPart = Collected;

    fn nothing(&self) -> Collected {
        let groups = vec![GroupCounts::default(); self.population.groups()];
        let column = ColumnCounts { groups, ..ColumnCounts::default() };
        Collected { columns: vec![column; self.observed.len()], lost: vec![0; self.population.groups()] }
    }

    fn count(&self, part: &impl PartColumns) -> Result<Collected> {
        let (samples, ended) = (part.samples()?, part.statuses()?);
        let group = |(sample, status): (&SampleId, &Status)| {
            let is_counted = self.population.contains(*sample) && *status == Status::Done;
            is_counted.then(|| self.population.group(*sample))
        };
        let rows: Vec<Option<usize>> = samples.iter().zip(ended.iter()).map(group).collect();
        let mut lost = vec![0; self.population.groups()];
        for (sample, status) in samples.iter().zip(ended.iter()) {
            let is_lost = !matches!(status, Status::Done | Status::InvalidSample) && self.population.contains(*sample);
            lost[self.population.group(*sample)] += u64::from(is_lost);
        }
        let are_all_of_one = self.population.groups() == 1 && !rows.contains(&None);
        let of_column = |(observed, sketches): (&Observed, &Mutex<Vec<Sketch>>)| {
            let values = observed.column(part)?;
            if are_all_of_one && !values.iter().any(|value| value.is_nan()) {
                return Ok(ColumnCounts { groups: vec![self.group(values, sketches, 0)], ..ColumnCounts::default() });
            }
            let mut of_groups = vec![Vec::new(); self.population.groups()];
            let mut without_value = 0;
            for (value, group) in values.iter().zip(&rows) {
                match group {
                    Some(_) if value.is_nan() => without_value += 1,
                    Some(group) => of_groups[*group].push(*value),
                    None => {}
                }
            }
            let of_group = |(index, values)| self.group(Cow::Owned(values), sketches, index);
            let groups = of_groups.into_iter().enumerate().map(of_group).collect();
            Ok(ColumnCounts { without_value, groups, ..ColumnCounts::default() })
        };
        let columns = self.observed.iter().zip(&self.sketches).map(of_column).collect::<Result<_>>()?;
        Ok(Collected { columns, lost })
    }

    fn merge(&self, whole: &mut Collected, part: Collected) {
        whole.lost.iter_mut().zip(&part.lost).for_each(|(lost, more)| *lost += more);
        for (column, of_part) in whole.columns.iter_mut().zip(part.columns) {
            column.without_value += of_part.without_value;
            let mut of_groups = Moments::default();
            for (group, more) in column.groups.iter_mut().zip(of_part.groups) {
                of_groups.merge(&more.moments);
                group.moments.merge(&more.moments);
                group.values.extend(more.values);
            }
            column.moments.merge(&of_groups);
        }
    }
}
