//! [`Missions`]: how the missions of a campaign under a control loop ended: launched, failed for a reason, or neither, each a share of the runs with its interval.

use crate::analysis::accumulator::Accumulator;
use crate::analysis::part_columns::PartColumns;
use crate::analysis::population::Population;
use crate::campaign::Plan;
use crate::control::guidance::Failure;
use crate::run::Status;
use crate::statistics::binomial::interval;
use crate::storage::rows_reader::RowsError;

/// One way in which missions ended.
#[derive(Clone, Debug, PartialEq)]
pub struct MissionShare {
    /// `launched`, the name of a failure, or `flying` where the run ended before either; `not_failed` in a loop that launches nothing.
    pub end: &'static str,
    pub count: u64,
    pub runs: u64,
    /// Runs of those that were not computed, which may have ended in this way or not.
    pub missing: u64,
    /// The interval of the share at the confidence of the statistics, whatever the missing runs would have done; NaN where samples are not independent.
    pub interval: [f64; 2],
}

impl MissionShare {
    /// The least and the largest share of all runs that ended in this way: they differ by the missing ones.
    pub fn shares(&self) -> [f64; 2] {
        [self.count, self.count + self.missing].map(|count| count as f64 / self.runs.max(1) as f64)
    }
}

#[derive(Clone, Debug)]
pub struct MissionCounter {
    has_loop: bool,
    launches: bool,
    population: Population,
    confidence: f64,
}

/// How many runs that are `ok` ended in each way: launched, flying, then by failure; and how many physical samples have no such run.
pub type MissionCounts = ([u64; 2 + Failure::NAMES.len()], u64);

/// How the missions of a campaign ended, those that occur, in the order of the codes.
pub type Missions = Vec<MissionShare>;

impl MissionCounter {
    /// Of the runs of `plan`.
    pub fn new(plan: &Plan) -> Self {
        let spec = plan.law.as_ref().and_then(|law| law.spec());
        MissionCounter {
            has_loop: spec.is_some(),
            launches: spec.is_some_and(|spec| spec.launches()),
            population: Population::of(plan),
            confidence: plan.analysis.confidence,
        }
    }

    pub fn finished(&self, counts: &MissionCounts) -> Missions {
        let (counts, missing) = counts;
        let runs = counts.iter().sum::<u64>() + missing;
        let neither = if self.launches { "flying" } else { "not_failed" };
        let names = ["launched", neither].into_iter().chain(Failure::NAMES);
        let has_intervals = self.population == Population::Independent;
        let share = |(end, count): (&'static str, &u64)| MissionShare {
            end,
            count: *count,
            runs,
            missing: *missing,
            interval: match has_intervals {
                true => {
                    [interval(*count, runs, self.confidence)[0], interval(count + missing, runs, self.confidence)[1]]
                }
                false => [f64::NAN; 2],
            },
        };
        names.zip(counts).filter(|(_, count)| **count > 0).map(share).collect()
    }
}

impl Accumulator for MissionCounter {
    type Whole = MissionCounts;
    type OfPart = MissionCounts;

    fn nothing(&self) -> MissionCounts {
        ([0; 2 + Failure::NAMES.len()], 0)
    }

    fn count(&self, part: &impl PartColumns) -> Result<MissionCounts, RowsError> {
        let mut found = self.nothing();
        if !self.has_loop {
            return Ok(found);
        }
        let failures = part.numbers("failure")?;
        let launched = if self.launches { Some(part.numbers("launched")?) } else { None };
        let (samples, statuses) = (part.samples()?, part.statuses()?);
        for row in (0..part.rows()).filter(|row| self.population.contains(samples[*row])) {
            match statuses[row] {
                Status::Done => {}
                Status::InvalidSample => continue,
                _ => {
                    found.1 += 1;
                    continue;
                }
            }
            let has_launched = launched.as_ref().is_some_and(|launched| launched[row] == 1.0);
            let failure = failures[row] as usize;
            found.0[if has_launched {
                0
            } else if failure == 0 {
                1
            } else {
                2 + failure
            }] += 1;
        }
        Ok(found)
    }

    fn merge(&self, whole: &mut MissionCounts, part: MissionCounts) {
        whole.0.iter_mut().zip(part.0).for_each(|(mine, theirs)| *mine += theirs);
        whole.1 += part.1;
    }
}
