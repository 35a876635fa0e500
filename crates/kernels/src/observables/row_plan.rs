//! [`RowPlan`]: the columns of a request as index lists, resolved once per worker.

use super::reduction::Reduction;
use super::request::Request;
use super::table::{DirectValue, Series, Value};

#[derive(Clone, Debug)]
pub struct Statistics(Box<[[f64; Reduction::COUNT]; Series::COUNT]>);

/// Index of a statistic in [`Statistics`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Slot(u16);

impl Slot {
    pub const fn of((series, reduction): (Series, Reduction)) -> Self {
        Slot((series.index() * Reduction::COUNT + reduction.index()) as u16)
    }
}

impl Statistics {
    pub fn unknown() -> Self {
        Statistics(Box::new([[f64::NAN; Reduction::COUNT]; Series::COUNT]))
    }

    #[inline(always)]
    pub fn get(&self, slot: Slot) -> f64 {
        self.0.as_flattened()[usize::from(slot.0)]
    }

    /// A scale; one if it is zero (errors are then absolute) or there is none.
    #[inline(always)]
    pub fn scale(&self, of: Option<(Series, Reduction)>) -> f64 {
        match of.map(|of| self.get(Slot::of(of))) {
            None | Some(0.0) => 1.0,
            Some(scale) => scale,
        }
    }

    #[inline(always)]
    pub fn of(&mut self, series: Series) -> &mut [f64; Reduction::COUNT] {
        &mut self.0[series.index()]
    }
}

#[derive(Clone, Debug)]
pub struct RowPlan {
    /// Statistic of each column; arbitrary for a direct value or a window.
    slots: Vec<Slot>,
    direct_values: Vec<(usize, DirectValue, u8)>,
    /// By column: true if a failed run has it.
    known_after_failure: Vec<bool>,
}

impl RowPlan {
    pub fn of(request: &Request) -> Self {
        let values: Vec<Value> = request.ids().map(|id| id.value).collect();
        let known_after_failure = values.iter().map(|value| value.is_known_after_failure()).collect();
        let mut plan = RowPlan { slots: Vec::new(), direct_values: Vec::new(), known_after_failure };
        for (place, value) in values.into_iter().enumerate() {
            plan.slots.push(match value {
                Value::Of(series, reduction) => Slot::of((series, reduction)),
                Value::Direct(value, wheel) => {
                    plan.direct_values.push((place, value, wheel));
                    Slot(0)
                }
                Value::Window(..) | Value::Law(_) => Slot(0),
            });
        }
        plan
    }

    pub fn columns(&self) -> usize {
        self.slots.len()
    }

    #[inline(always)]
    pub fn fill(&self, statistics: &Statistics, direct: impl Fn(DirectValue, u8) -> f64, row: &mut [f64]) {
        for (value, slot) in row.iter_mut().zip(&self.slots) {
            *value = statistics.get(*slot);
        }
        for (place, value, wheel) in &self.direct_values {
            row[*place] = direct(*value, *wheel);
        }
    }

    /// Sets the values that a failed run does not have to NaN.
    pub fn clear_unknown(&self, row: &mut [f64]) {
        for (value, known) in row.iter_mut().zip(&self.known_after_failure) {
            *value = if *known { *value } else { f64::NAN };
        }
    }
}
