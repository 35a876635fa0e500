//! [`Missions`]: shares of the missions of a control loop by their end: launched, failed for a reason, or neither.

use super::accumulator::Accumulator;
use super::part_columns::PartColumns;
use super::population::Population;
use crate::analysis::order_statistics::share_interval;
use crate::campaign::Plan;
use crate::loops::failure::Failure;
use crate::run::Status;
use crate::scene::Name;
use crate::storage::rows_reader::Result;

#[derive(Clone, Debug, PartialEq)]
pub struct MissionShare {
    /// `launched`, a failure, or `flying` if neither; `not_failed` in a loop without a launch.
    pub end: &'static str,
    /// Phases that timed out, with counts.
    pub phases: Vec<(Name, u64)>,
    pub count: u64,
    pub runs: u64,
    /// Runs not computed.
    pub missing: u64,
    /// At the confidence of the statistics, wherever missing runs are; NaN for dependent samples.
    pub interval: [f64; 2],
}

impl MissionShare {
    /// Minimum and maximum share, which differ by the missing runs.
    pub fn shares(&self) -> [f64; 2] {
        [self.count, self.count + self.missing].map(|count| count as f64 / self.runs.max(1) as f64)
    }
}

#[derive(Clone, Debug)]
pub struct MissionCounter {
    has_loop: bool,
    launches: bool,
    phases: Vec<Name>,
    population: Population,
    confidence: f64,
}

#[derive(Clone, Debug, PartialEq, Eq)]
pub struct MissionCounts {
    /// `ok` runs by end: launched, flying, then by failure.
    ends: [u64; 2 + Failure::NAMES.len()],
    timeouts: Vec<u64>,
    /// Physical samples without an `ok` run.
    missing: u64,
}

/// The ends that occur, in the order of the codes.
pub type Missions = Vec<MissionShare>;

impl MissionCounter {
    pub fn new(plan: &Plan) -> Self {
        let spec = plan.loop_spec();
        MissionCounter {
            phases: spec.map_or_else(Vec::new, |spec| spec.phases.iter().map(|phase| phase.name).collect()),
            has_loop: spec.is_some(),
            launches: spec.is_some_and(|spec| spec.launches()),
            population: Population::of(plan),
            confidence: plan.analysis.confidence,
        }
    }

    pub fn finished(&self, counts: &MissionCounts) -> Missions {
        let MissionCounts { ends, timeouts, missing } = counts;
        let runs = ends.iter().sum::<u64>() + missing;
        let timeouts = self.phases.iter().copied().zip(timeouts.iter().copied()).filter(|(_, count)| *count > 0);
        let timeouts: Vec<(Name, u64)> = timeouts.collect();
        let neither = if self.launches { "flying" } else { "not_failed" };
        let names = ["launched", neither].into_iter().chain(Failure::NAMES);
        let has_intervals = self.population == Population::Independent;
        let share = |(end, count): (&'static str, &u64)| MissionShare {
            end,
            phases: if end == Failure::NAMES[Failure::Timeout as usize] { timeouts.clone() } else { Vec::new() },
            count: *count,
            runs,
            missing: *missing,
            interval: match has_intervals {
                true => share_interval(*count, [runs - missing, *missing], self.confidence),
                false => [f64::NAN; 2],
            },
        };
        names.zip(ends).filter(|(_, count)| **count > 0).map(share).collect()
    }
}

impl Accumulator for MissionCounter {
    type Whole = MissionCounts;
    type OfPart = MissionCounts;

    fn nothing(&self) -> MissionCounts {
        MissionCounts { ends: [0; 2 + Failure::NAMES.len()], timeouts: vec![0; self.phases.len()], missing: 0 }
    }

    fn count(&self, part: &impl PartColumns) -> Result<MissionCounts> {
        let mut found = self.nothing();
        if !self.has_loop {
            return Ok(found);
        }
        let (failures, phases) = (part.numbers("failure")?, part.numbers("phase_final")?);
        let launched = if self.launches { Some(part.numbers("launched")?) } else { None };
        let (samples, statuses) = (part.samples()?, part.statuses()?);
        for row in (0..part.rows()).filter(|row| self.population.contains(samples[*row])) {
            if statuses[row] != Status::Done {
                found.missing += u64::from(statuses[row] != Status::InvalidSample);
                continue;
            }
            let has_launched = launched.as_ref().is_some_and(|launched| launched[row] == 1.0);
            let failure = failures[row] as usize;
            if failure == Failure::Timeout as usize
                && let Some(count) = found.timeouts.get_mut(phases[row] as usize)
            {
                *count += 1;
            }
            let end = match failure {
                _ if has_launched => 0,
                0 => 1,
                failure => 2 + failure,
            };
            found.ends[end] += 1;
        }
        Ok(found)
    }

    fn merge(&self, whole: &mut MissionCounts, part: MissionCounts) {
        whole.ends.iter_mut().zip(part.ends).for_each(|(mine, theirs)| *mine += theirs);
        whole.timeouts.iter_mut().zip(part.timeouts).for_each(|(mine, theirs)| *mine += theirs);
        whole.missing += part.missing;
    }
}
