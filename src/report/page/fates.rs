//! [`Fate`]: success of a run, for the colours of figures.

use crate::analysis::survey::{FAILURE, Survey};
use crate::campaign::{Plan, Requirement, Statement};
use crate::run::Status;

/// The fate of a run with regard to the limits of a figure.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fate {
    /// Within all limits.
    Met,
    /// Violates a requirement on runs, or its mission failed.
    Missed,
    NotComputed,
}

impl Fate {
    /// Code in the page.
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
    judged(survey, &limits(plan, survey, |_| true), failure)
}

/// As [`fates`], by the limits on the outcome `name` only.
pub fn of_outcome(plan: &Plan, survey: &Survey, name: &str) -> Vec<Fate> {
    judged(survey, &limits(plan, survey, |one| one.observable() == Some(name)), None)
}

/// Labels of the fates in order; without requirements they describe missions.
pub fn words(plan: &Plan) -> [&'static str; 3] {
    match plan.analysis.requirements.is_empty() {
        true => ["mission did not fail", "mission failed", "not computed"],
        false => ["meets the requirements", "misses a requirement", "not computed"],
    }
}

/// The violated limit on the outcome `name` in words.
pub fn limit_word(plan: &Plan, name: &str) -> &'static str {
    let all = plan.analysis.requirements.iter().filter(|one| one.observable() == Some(name));
    let limits = all.map(|one| (one.limit, one.never_meets));
    let mut other = limits.clone().skip(1);
    let is_one = limits.take(1).all(|first| other.all(|limit| limit == first));
    if is_one { "its limit" } else { "a limit" }
}

/// The selected requirements, each with the values of its observable.
fn limits<'s, 'p>(
    plan: &'p Plan,
    survey: &'s Survey,
    is_wanted: impl Fn(&Requirement) -> bool,
) -> Vec<(&'s [f64], &'p Requirement)> {
    // neither a mean nor a band limits single runs
    let is_of_runs = |one: &&Requirement| one.statement != Statement::Mean && one.band().is_none() && is_wanted(one);
    let of_column = |one: &'p Requirement| {
        let (index, _) = survey.outcome(one.observable()?)?;
        Some((&survey.thinned.outcomes[index][..], one))
    };
    plan.analysis.requirements.iter().filter(is_of_runs).filter_map(of_column).collect()
}

fn judged(survey: &Survey, limits: &[(&[f64], &Requirement)], failure: Option<&[f64]>) -> Vec<Fate> {
    let thinned = &survey.thinned;
    let fate = |row: usize| {
        if thinned.statuses[row] != Status::Done {
            return Fate::NotComputed;
        }
        let is_missed = limits.iter().any(|(values, one)| !one.is_met(values[row]));
        if is_missed || failure.is_some_and(|codes| codes[row] >= 1.0) { Fate::Missed } else { Fate::Met }
    };
    (0..thinned.samples.len()).map(fate).collect()
}
