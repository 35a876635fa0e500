//! [`WorstRuns`]: the runs with the worst values of a quantity; [`shortfall`]: how far a run is from its requirements.

use crate::campaign::Requirement;
use crate::sampling::SampleId;
use crate::statistics::gate::GateLimit;

/// The number of requirements that a run with these values misses, plus a part below one that grows with its excess
/// over the limits, relative to them: of the missed ones together, else of the nearest. NaN without a requirement.
pub fn shortfall<'r>(judged: impl Iterator<Item = (&'r Requirement, f64)>) -> f64 {
    let (mut missed, mut excess, mut nearest) = (0.0, 0.0, f64::NAN);
    for (requirement, value) in judged {
        let limit = requirement.limit.value();
        let over = if matches!(requirement.limit, GateLimit::AtMost(_)) { value - limit } else { limit - value };
        let over = over / if limit == 0.0 { 1.0 } else { limit.abs() };
        if !requirement.is_met(value) {
            missed += 1.0;
            excess += if over.is_finite() { over } else { 0.0 };
        }
        // yes or no has no distance from its limit
        nearest = f64::max(nearest, if over < 0.0 { over } else { f64::MIN });
    }
    let over = if missed > 0.0 { excess } else { nearest };
    missed + 0.5 + 0.5 * over / (1.0 + over.abs())
}

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

    /// True if other runs may be as bad as the last one.
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
    use crate::campaign::Plan;
    use spindrift_control::control::tables::Overrides;

    /// Law: a run that misses more requirements is worse, whatever its values; of runs that miss as many, the one with
    /// the greater excess; of runs that miss none, the one nearer to a limit. A missing value exceeds nothing.
    #[test]
    fn runs_are_ordered_by_their_shortfall() {
        let text = include_str!("../../../../campaigns/net_launch.toml");
        let plan = Plan::from_text("net_launch", text, Overrides::default()).expect("valid");
        let [launched, .., impulse] = &plan.analysis.requirements[..] else { panic!("several requirements") };
        let of = |values: [f64; 2]| shortfall([launched, impulse].into_iter().zip(values));
        let ascending =
            [[1.0, 10.0], [1.0, 3999.0], [1.0, 4001.0], [1.0, 1e9], [0.0, f64::NAN], [0.0, 9e3], [-1.0, 9e3]];
        let found = ascending.map(of);
        assert!(found.windows(2).all(|pair| pair[0] < pair[1]), "{found:?}");
        assert_eq!(found.map(|worst| worst as u64), [0, 0, 1, 1, 2, 2, 2]);
        assert!(shortfall(core::iter::empty()).is_nan());
    }

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
