//! [`WorstRuns`]: the runs with the worst values of a quantity.

use crate::sampling::SampleId;

/// Largest magnitudes, descending, or smallest values, ascending, if `is_low`; ties by ascending number.
#[derive(Clone, Debug, PartialEq)]
pub struct WorstRuns {
    most: usize,
    pub is_low: bool,
    pub runs: Vec<(SampleId, f64)>,
}

impl WorstRuns {
    pub fn new(most: usize, is_low: bool) -> Self {
        WorstRuns { most, is_low, runs: Vec::new() }
    }

    /// Whether other runs may be as bad as the last one.
    pub fn is_full(&self) -> bool {
        self.runs.len() >= self.most
    }

    /// Adds a run; ignores NaN.
    pub fn add(&mut self, sample: SampleId, value: f64) {
        let badness = |value: f64| if self.is_low { -value } else { value.abs() };
        let bad = badness(value);
        let is_before =
            |(other, value): &(SampleId, f64)| badness(*value) > bad || badness(*value) == bad && *other < sample;
        let has_room = self.runs.len() < self.most;
        if !bad.is_nan() && (has_room || self.runs.last().is_some_and(|last| !is_before(last))) {
            self.runs.insert(self.runs.partition_point(is_before), (sample, value));
            self.runs.truncate(self.most);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Law: the worst runs are listed in any order of arrival, ties by number; NaN is ignored.
    #[test]
    fn the_worst_are_listed() {
        let mut values = [(4, 7.0), (0, -99.0), (1, 2.0), (3, 7.0), (5, 1.0), (6, f64::NAN), (7, -8.0)];
        for turn in 0..values.len() {
            values.rotate_left(turn);
            let found = |is_low: bool| {
                let mut worst = WorstRuns::new(4, is_low);
                values.iter().for_each(|(sample, value)| worst.add(SampleId(*sample), *value));
                worst.runs.into_iter().map(|(sample, value)| (sample.0, value)).collect::<Vec<_>>()
            };
            assert_eq!(found(false), [(0, -99.0), (7, -8.0), (3, 7.0), (4, 7.0)]);
            assert_eq!(found(true), [(0, -99.0), (7, -8.0), (5, 1.0), (1, 2.0)]);
        }
    }
}
