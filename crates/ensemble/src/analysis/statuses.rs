//! [`Statuses`]: counts of the statuses of a campaign, for summary, page, statistics and verdicts.

use super::accumulator::Accumulator;
use super::part_columns::PartColumns;
use super::population::Population;
use crate::analysis::population::Loss;
use crate::campaign::Plan;
use crate::ensemble::FailureReasons;
use crate::run::Status;
use crate::sampling::SampleId;
use crate::storage::rows_reader::Result;
use std::collections::BTreeMap;

/// Maximum number of failed samples listed per status.
const KEPT: usize = 10;

#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Ended {
    pub status: Status,
    pub count: u64,
    /// Samples among them that statistics count.
    pub of_population: u64,
    /// The first of them, ascending, with reasons; none for `ok`.
    pub first: Vec<(SampleId, String)>,
}

#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Statuses {
    list: [Ended; Status::ALL.len()],
    reasons: FailureReasons,
    population: Population,
}

/// Samples of a part, statuses, and reasons by row.
pub type StatusPart = (Vec<SampleId>, Vec<Status>, Vec<(usize, String)>);

impl Statuses {
    pub fn none(population: Population) -> Self {
        let none = |status| Ended { status, count: 0, of_population: 0, first: Vec::new() };
        Statuses { list: Status::ALL.map(none), reasons: FailureReasons::default(), population }
    }

    pub fn add(&mut self, sample: SampleId, status: Status, reason: &str) {
        let of_population = self.population.contains(sample);
        for ended in self.list.iter_mut().filter(|ended| ended.status == status) {
            ended.count += 1;
            ended.of_population += u64::from(of_population);
            let at = ended.first.partition_point(|(other, _)| *other < sample);
            if status != Status::Done && at < KEPT {
                ended.first.insert(at, (sample, reason.to_owned()));
                ended.first.truncate(KEPT);
            }
        }
        if !reason.is_empty() {
            self.reasons.add(sample, status, reason);
        }
    }

    /// In the order of [`Status::ALL`].
    pub fn list(&self) -> &[Ended] {
        &self.list
    }

    pub fn failed(&self) -> impl Iterator<Item = &Ended> {
        self.list.iter().filter(|ended| ended.status != Status::Done && ended.count > 0)
    }

    pub fn runs(&self) -> u64 {
        self.list.iter().map(|ended| ended.count).sum()
    }

    pub fn ok(&self) -> u64 {
        self.runs() - self.failed().map(|ended| ended.count).sum::<u64>()
    }

    /// Samples that statistics count, in the order of [`Status::ALL`].
    pub fn of_population(&self) -> [u64; Status::ALL.len()] {
        self.list.each_ref().map(|ended| ended.of_population)
    }

    /// True if the nominal run is `ok` and not counted.
    pub fn has_nominal(&self) -> bool {
        self.list.iter().any(|ended| ended.status == Status::Done && ended.of_population < ended.count)
    }

    pub fn loss(&self) -> Loss {
        Loss::of(&self.of_population())
    }

    pub fn reasons(&self) -> &FailureReasons {
        &self.reasons
    }
}

#[derive(Clone, Copy, Debug)]
pub struct StatusCounter(Population);

impl StatusCounter {
    pub fn new(plan: &Plan) -> Self {
        StatusCounter(Population::of(plan))
    }
}

impl Accumulator for StatusCounter {
    type Whole = Statuses;
    type OfPart = StatusPart;

    fn nothing(&self) -> Statuses {
        Statuses::none(self.0)
    }

    fn count(&self, part: &impl PartColumns) -> Result<StatusPart> {
        let (samples, statuses) = (part.samples()?, part.statuses()?.into_owned());
        let has_failed = statuses.iter().any(|status| *status != Status::Done);
        let reasons = if has_failed { part.reasons()?.into_owned() } else { Vec::new() };
        Ok((samples, statuses, reasons))
    }

    fn merge(&self, whole: &mut Statuses, (samples, statuses, reasons): StatusPart) {
        // lanes end in any order
        let mut reasons: BTreeMap<usize, String> = reasons.into_iter().collect();
        for (row, (sample, status)) in samples.into_iter().zip(statuses).enumerate() {
            whole.add(sample, status, &reasons.remove(&row).unwrap_or_default());
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Law: every sample is counted; the first failed ones are listed in any order of the rows; statistics count
    /// dispersed ones.
    #[test]
    fn samples_are_counted_and_the_first_failed_ones_listed() {
        let mut statuses = Statuses::none(Population::Independent);
        for sample in [5, 1, 9, 0, 3, 20, 21, 22, 23, 24, 25, 26] {
            statuses.add(SampleId(sample), Status::NonFinite, &format!("at {sample} s"));
        }
        statuses.add(SampleId(2), Status::Done, "");
        let failed: Vec<&Ended> = statuses.failed().collect();
        assert_eq!((failed.len(), failed[0].count, failed[0].of_population), (1, 12, 11));
        let first: Vec<u64> = failed[0].first.iter().map(|(sample, _)| sample.0).collect();
        assert_eq!((first, &*failed[0].first[2].1), (vec![0, 1, 3, 5, 9, 20, 21, 22, 23, 24], "at 3 s"));
        assert_eq!(
            (statuses.runs(), statuses.ok(), statuses.loss()),
            (13, 1, Loss { missing: 11, runs: 12, outside: 0 })
        );
        assert_eq!(statuses.reasons().groups()[0].count, 12);
    }
}
