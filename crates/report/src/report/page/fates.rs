//! [`Fate`]: success of a run, for the colours of figures.

use crate::analysis::survey::{FAILURE, Survey};
use crate::campaign::{Plan, Requirement};
use crate::run::Status;

/// The fate of a run with regard to the limits of a figure.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fate {
    Met,
    /// Violates a requirement on runs, or its mission failed.
    Missed,
    NotComputed,
}

impl Fate {
    pub const fn place(self) -> f64 {
        match self {
            Fate::Met => 0.0,
            Fate::Missed => 1.0,
            Fate::NotComputed => 2.0,
        }
    }
}

/// The fate of each run of the thinned table by all requirements.
pub fn fates(plan: &Plan, survey: &Survey) -> Vec<Fate> {
    let failure = survey.outcome(FAILURE).map(|(index, _)| &survey.thinned.outcomes[index][..]);
    judged(survey, plan.analysis.requirements.iter(), failure)
}

/// As [`fates`], by one requirement, or none.
pub fn of_one(survey: &Survey, requirement: Option<&Requirement>) -> Vec<Fate> {
    judged(survey, requirement.into_iter(), None)
}

/// The requirement with the limit of the outcome `name`; `None` without one, or with several limits.
pub fn only_limit<'p>(plan: &'p Plan, name: &str) -> Option<&'p Requirement> {
    let mut all = plan.analysis.requirements.iter().filter(|one| one.of_runs() == Some(name));
    let first = all.next()?;
    all.all(|other| other.limit == first.limit && other.never_meets == first.never_meets).then_some(first)
}

/// Labels of the fates in order; without requirements they describe missions.
pub fn words(plan: &Plan) -> [&'static str; 3] {
    match plan.analysis.requirements.is_empty() {
        true => ["mission did not fail", "mission failed", "not computed"],
        false => ["meets the requirements", "misses a requirement", "not computed"],
    }
}

fn judged<'p>(survey: &Survey, all: impl Iterator<Item = &'p Requirement>, failure: Option<&[f64]>) -> Vec<Fate> {
    let thinned = &survey.thinned;
    let values = |one: &'p Requirement| {
        let (index, _) = survey.outcome(one.of_runs()?)?;
        Some((one, &thinned.outcomes[index]))
    };
    let limits: Vec<(&Requirement, &Vec<f64>)> = all.filter_map(values).collect();
    let fate = |row: usize| {
        if thinned.statuses[row] != Status::Done {
            return Fate::NotComputed;
        }
        let is_missed = limits.iter().any(|(one, values)| !one.is_met(values[row]));
        if is_missed || failure.is_some_and(|codes| codes[row] >= 1.0) { Fate::Missed } else { Fate::Met }
    };
    (0..thinned.samples.len()).map(fate).collect()
}
