//! [`Fate`]: whether a run is as the campaign wants it, by which figures colour their runs.

use crate::analysis::survey::{FAILURE, Survey};
use crate::campaign::{Plan, Requirement, Statement};
use crate::run::Status;
use crate::statistics::gate::GateLimit;

/// What became of a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fate {
    /// It is within all limits, or nothing is required of it.
    Met,
    /// It misses the limit of a requirement on runs, or its mission failed.
    Missed,
    NotComputed,
}

impl Fate {
    /// Its number in the page.
    pub const fn place(self) -> f64 {
        match self {
            Fate::Met => 0.0,
            Fate::Missed => 1.0,
            Fate::NotComputed => 2.0,
        }
    }
}

/// What became of each run of the thinned table.
pub fn fates(plan: &Plan, survey: &Survey) -> Vec<Fate> {
    let thinned = &survey.thinned;
    let column = |name: &str| survey.outcome(name).map(|(index, _)| &thinned.outcomes[index][..]);
    // a mean is no limit of single runs, and a band is at one time
    let of_runs = |one: &&Requirement| one.statement != Statement::Mean && one.band().is_none();
    let limits: Vec<(&[f64], GateLimit)> = plan
        .analysis
        .requirements
        .iter()
        .filter(of_runs)
        .filter_map(|one| Some((column(one.observable()?)?, one.limit)))
        .collect();
    let failure = column(FAILURE);
    let fate = |row: usize| {
        if thinned.statuses[row] != Status::Done {
            return Fate::NotComputed;
        }
        let is_missed = limits.iter().any(|(values, limit)| !limit.is_met(values[row]));
        if is_missed || failure.is_some_and(|codes| codes[row] >= 1.0) { Fate::Missed } else { Fate::Met }
    };
    (0..thinned.samples.len()).map(fate).collect()
}
