//! [`ResultRows`]: the rows of a result; [`pairs`]: rows of two results with the same draws.

use crate::analysis::column_counts::MOST_EXACT;
use crate::campaign::Plan;
use crate::campaign::common_draws::draw_alike;
use crate::run::Status;
use crate::sampling::Column;
use crate::storage::rows_reader::{PartReader, Result, RowsReader};

/// Rows compared one by one: the nominal sample and the first [`MOST_EXACT`].
pub const MOST_ROWS: usize = MOST_EXACT as usize + 1;

#[derive(Clone, Copy, Debug)]
pub struct ResultRows<'r> {
    pub plan: &'r Plan,
    pub reader: &'r RowsReader,
}

/// Rows, among the first, of samples that both results drew alike; none if neither the random numbers nor the drawn
/// values agree.
pub fn pairs(first: ResultRows<'_>, second: ResultRows<'_>, statuses: [&[Status]; 2]) -> Result<Vec<[usize; 2]>> {
    let mut shared = shared_rows(first.plan, second.plan);
    shared.retain(|[row, other]| *row < statuses[0].len() && *other < statuses[1].len());
    if !(draw_alike(first.plan, second.plan) || drew_same_values(first, second, &shared)?) {
        shared.clear();
    }
    Ok(shared)
}

fn drew_same_values(first: ResultRows<'_>, second: ResultRows<'_>, shared: &[[usize; 2]]) -> Result<bool> {
    let names = |plan: &Plan| -> Vec<String> { plan.dispersions.columns().iter().map(Column::name).collect() };
    let (of_first, of_second) = (names(first.plan), names(second.plan));
    if of_first.len() != of_second.len() || !of_first.iter().all(|name| of_second.contains(name)) {
        return Ok(false);
    }
    let drawn = |result: ResultRows<'_>, name: &str| result.first(|part| part.numbers(name));
    for name in &of_first {
        let (a, b) = (drawn(first, name)?, drawn(second, name)?);
        let bits = |column: &[f64], row: usize| column.get(row).map(|value| value.to_bits());
        if shared.iter().any(|[row, other]| bits(&a, *row) != bits(&b, *other)) {
            return Ok(false);
        }
    }
    Ok(true)
}

impl ResultRows<'_> {
    fn first<T>(self, of: impl Fn(&PartReader) -> Result<Vec<T>>) -> Result<Vec<T>> {
        let mut all = Vec::new();
        for part in self.reader.first_parts(MOST_ROWS) {
            all.extend(of(&part?)?);
        }
        all.truncate(MOST_ROWS);
        Ok(all)
    }

    /// The statuses of the first rows.
    pub fn statuses(self) -> Result<Vec<Status>> {
        self.first(PartReader::statuses)
    }
}

/// Rows of each plan with the same dispersed sample, among the first.
fn shared_rows(first: &Plan, second: &Plan) -> Vec<[usize; 2]> {
    let planned = |plan: &Plan| usize::try_from(plan.rows()).unwrap_or(usize::MAX).min(MOST_ROWS);
    let (mut row, mut other, mut shared) = (first_dispersed(first), first_dispersed(second), Vec::new());
    while row < planned(first) && other < planned(second) {
        let (a, b) = (first.sample(row as u64), second.sample(other as u64));
        if a == b {
            shared.push([row, other]);
        }
        row += usize::from(a <= b);
        other += usize::from(b <= a);
    }
    shared
}

pub fn first_dispersed(plan: &Plan) -> usize {
    usize::from(plan.dispersed_rows() < plan.rows())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::analysis::small_plan::small_plan;

    #[test]
    fn rows_of_the_same_sample_are_paired() {
        let plan = |samples: u64| small_plan(samples, "");
        assert_eq!(shared_rows(&plan(7), &plan(4)), [[1, 1], [2, 2], [3, 3]]);
        assert_eq!(shared_rows(&plan(1), &plan(4)), Vec::<[usize; 2]>::new());
    }
}
