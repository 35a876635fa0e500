//! [`Verdicts`]: what the runs of a campaign say of its requirements, from the files of its rows.
//!
//! Quantiles and fractions are decided by exact counts, never by a sketch. Outside of the population, and so of every count, are samples that are
//! not physical; any other run that is not `ok` violates every requirement, and so does one without a value.
//!
//! Each look of a campaign with `[stop]` has its share of the errors (Bonferroni), and so has each requirement of those of a failure ([`failing_together`]).
//!
//! Not here: requirements at each time (`band_verdicts`). Those at all times are about a column of the rows.

use crate::analysis::accumulator::Accumulator;
use crate::analysis::assessment::Assessment;
use crate::analysis::band_verdicts::over_time;
use crate::analysis::observed::Observed;
use crate::analysis::part_columns::PartColumns;
use crate::analysis::population::Population;
use crate::analysis::statistics::Statistics;
use crate::campaign::{Plan, Requirement, ShownUnit, Statement};
use crate::ensemble::Bands;
use crate::run::Status;
use crate::statistics::binomial::Decision;
use crate::statistics::gate::{
    Gate, GateLimit, constant_gate, failing_at, failing_together, fraction_gate, mean_gate, replicate_fraction_gate,
    replicate_mean_gate,
};
use crate::statistics::looks::adjusted;
use crate::statistics::mean::MOST_SHARE;
use crate::statistics::moments::Moments;
use crate::storage::rows_reader::RowsError;

/// What the runs of a campaign say of its requirements.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Verdicts {
    /// One for each requirement, in the order of the file.
    pub list: Vec<Assessment>,
    /// Dispersed samples that are not physical: outside of the population.
    pub invalid: u64,
    /// All dispersed samples.
    pub samples: u64,
    /// At how many looks the requirements may be decided: one without `[stop]`.
    pub looks: usize,
}

impl Verdicts {
    /// The same with the values of quantiles that `statistics` have: a quantile has one value.
    #[must_use]
    pub fn with_quantiles(mut self, statistics: &Statistics) -> Self {
        for one in &mut self.list {
            if let (Statement::Quantile(p), Some(name)) = (one.requirement.statement, one.requirement.observable()) {
                let quantile = statistics.required(name, p, one.requirement.confidence);
                one.value = quantile.and_then(|quantile| quantile.value);
            }
        }
        self
    }

    /// How many requirements failed.
    pub fn failed(&self) -> usize {
        self.list.iter().filter(|one| one.gate.decision == Decision::Fail).count()
    }

    /// How many requirements are undecided.
    pub fn undecided(&self) -> usize {
        self.list.iter().filter(|one| matches!(one.gate.decision, Decision::Undecided(_))).count()
    }
}

/// What is counted of one requirement in a group of samples.
#[derive(Clone, Debug, Default)]
struct GroupRuns {
    runs: u64,
    within: u64,
    moments: Moments,
}

/// What is counted of one requirement.
#[derive(Clone, Debug)]
struct RequirementRuns {
    groups: Vec<GroupRuns>,
    /// Runs that are not `ok`.
    failed: u64,
}

impl RequirementRuns {
    fn new(groups: usize) -> Self {
        RequirementRuns { groups: vec![GroupRuns::default(); groups], failed: 0 }
    }

    fn merge(&mut self, other: &RequirementRuns) {
        for (mine, theirs) in self.groups.iter_mut().zip(&other.groups) {
            mine.runs += theirs.runs;
            mine.within += theirs.within;
            mine.moments.merge(&theirs.moments);
        }
        self.failed += other.failed;
    }

    /// The sum of a count over the groups.
    fn sum(&self, count: impl Fn(&GroupRuns) -> u64) -> u64 {
        self.groups.iter().map(count).sum()
    }
}

/// What is counted of all requirements of a campaign.
#[derive(Clone, Debug)]
pub struct RequirementCounts {
    list: Vec<RequirementRuns>,
    /// Dispersed samples that are not physical.
    invalid: u64,
    /// All dispersed samples.
    samples: u64,
}

/// RequirementRuns the requirements of a campaign.
#[derive(Clone, Debug)]
pub struct RequirementCounter {
    requirements: Vec<Requirement>,
    observed: Vec<Observed>,
    /// For each requirement what it is about, in `observed`; `None` of those over time.
    of: Vec<Option<usize>>,
    population: Population,
}

impl RequirementCounter {
    /// Of the requirements of `plan`.
    pub fn new(plan: &Plan) -> Self {
        let requirements = plan.analysis.requirements.clone();
        let observed = Observed::named(plan, requirements.iter().filter_map(Requirement::observable));
        let index = |name: &str| observed.iter().position(|observed| observed.quantity.name() == name);
        let of = requirements.iter().map(|requirement| requirement.observable().and_then(index)).collect();
        RequirementCounter { of, requirements, observed, population: Population::of(plan) }
    }
}

impl Accumulator for RequirementCounter {
    type Whole = RequirementCounts;
    type OfPart = RequirementCounts;

    fn nothing(&self) -> RequirementCounts {
        let list = vec![RequirementRuns::new(self.population.groups()); self.requirements.len()];
        RequirementCounts { list, invalid: 0, samples: 0 }
    }

    fn count(&self, part: &impl PartColumns) -> Result<RequirementCounts, RowsError> {
        let mut found = self.nothing();
        if self.requirements.is_empty() {
            return Ok(found);
        }
        let columns = self.observed.iter().map(|one| one.column(part)).collect::<Result<Vec<_>, _>>()?;
        let (samples, statuses) = (part.samples()?, part.statuses()?);
        let dispersed: Vec<usize> = (0..samples.len()).filter(|row| self.population.contains(samples[*row])).collect();
        let is_physical = |row: &&usize| statuses[**row] != Status::InvalidSample;
        for ((requirement, index), counts) in self.requirements.iter().zip(&self.of).zip(&mut found.list) {
            let mut kept = vec![Vec::new(); self.population.groups()];
            let has_mean = matches!(requirement.statement, Statement::Mean);
            for row in dispersed.iter().filter(is_physical) {
                let value = index.map_or(f64::NAN, |index| columns[index][*row]);
                let group = self.population.group(samples[*row]);
                let is_ok = statuses[*row] == Status::Done;
                counts.groups[group].runs += 1;
                counts.groups[group].within += u64::from(is_ok && requirement.limit.is_met(value));
                counts.failed += u64::from(!is_ok);
                if is_ok && has_mean && !value.is_nan() {
                    kept[group].push(value);
                }
            }
            for (group, values) in counts.groups.iter_mut().zip(&kept) {
                group.moments = Moments::of_block(values);
            }
        }
        found.samples = dispersed.len() as u64;
        found.invalid = found.samples - dispersed.iter().filter(is_physical).count() as u64;
        Ok(found)
    }

    fn merge(&self, whole: &mut RequirementCounts, part: RequirementCounts) {
        whole.list.iter_mut().zip(&part.list).for_each(|(mine, theirs)| mine.merge(theirs));
        whole.invalid += part.invalid;
        whole.samples += part.samples;
    }
}

/// What was counted of the requirements of `plan`, and its `bands`, say of them.
pub fn assess(plan: &Plan, counted: &RequirementCounts, bands: Option<&Bands>) -> Verdicts {
    let requirements = &plan.analysis.requirements;
    if requirements.is_empty() {
        return Verdicts::default();
    }
    let RequirementCounter { observed, of, population, .. } = RequirementCounter::new(plan);
    let looks = plan.looks().len();
    let assessed = |(requirement, index, counts): (&Requirement, &Option<usize>, &RequirementRuns), open: usize| {
        let confidences = [looks, looks * open].map(|tests| adjusted(requirement.confidence, tests));
        match (index, requirement.band()) {
            (None, Some(band)) => {
                let runs = [counts.sum(|group| group.runs), counts.failed];
                over_time((requirement, confidences), band, bands, runs, population)
            }
            _ => {
                let observed = index.map(|index| &observed[index]);
                let unit = observed.map_or_else(String::new, |observed| observed.quantity.unit().to_owned());
                let is_constant = observed.is_some_and(|observed| observed.is_constant(plan));
                assessment((requirement, confidences), unit, counts, population, is_constant)
            }
        }
    };
    let all = || {
        let list = requirements.iter().zip(&of).zip(&counted.list);
        list.map(|((requirement, index), counts)| (requirement, index, counts))
    };
    let at = |open: usize| all().map(|one| assessed(one, open)).collect();
    let mut list = failing_together(requirements.len(), at, |one: &Assessment| one.gate.decision == Decision::Fail);
    for one in &mut list {
        one.shown = plan.analysis.display.of(one.requirement.name(), &one.unit);
    }
    Verdicts { list, invalid: counted.invalid, samples: counted.samples, looks }
}

/// What `counts` say of a requirement that passes at the first of two confidences and fails at the second; `is_constant`: every run has the
/// same value.
fn assessment(
    (requirement, confidences): (&Requirement, [f64; 2]),
    unit: String,
    counts: &RequirementRuns,
    population: Population,
    is_constant: bool,
) -> Assessment {
    let (runs, within) = (counts.sum(|group| group.runs), counts.sum(|group| group.within));
    let limit = requirement.limit;
    let mut whole = Moments::default();
    counts.groups.iter().for_each(|group| whole.merge(&group.moments));
    let target = match requirement.statement {
        Statement::Quantile(p) => Some(limit.fraction(p)),
        Statement::Fraction(fraction) => Some(fraction),
        Statement::Mean => None,
    };
    let of_target = |target| move |confidence| of_fraction(counts, target, confidence, population);
    let mut gate = match target {
        Some(target) => failing_at(confidences, |fraction| fraction >= target, of_target(target)),
        None if is_constant && whole.min() == whole.max() => constant_gate(whole.mean().unwrap_or(f64::NAN), limit),
        None => {
            let of_mean = |confidence| of_mean(counts, &whole, limit, confidence, population);
            failing_at(confidences, |mean| limit.is_met(mean), of_mean)
        }
    };
    let is_undecided = matches!(gate.decision, Decision::Undecided(_));
    let mut reason = (is_undecided && target.is_none() && whole.count() > 1 && whole.min() == whole.max())
        .then(|| "all values are equal, and a rare event would not show".to_owned());
    let mut note = (target.is_none() && whole.largest_share(2) > MOST_SHARE)
        .then(|| format!("heavy tail: one run makes {:.0}% of the variance", 100.0 * whole.largest_share(2)));
    // a mean over all runs is not known where a run has no value
    let missing = if target.is_none() { runs - whole.count() } else { 0 };
    if missing > 0 {
        gate.decision = Decision::Fail;
        reason = Some(format!("{missing} runs without a value violate it"));
    }
    if !population.has_intervals() {
        gate = Gate { decision: Decision::Undecided(None), bounds: [f64::NAN; 2], ..gate };
        reason = Some(format!("intervals: {}", population.intervals()));
        note = None;
    } else if runs == 0 {
        reason = Some("there are no runs that count".to_owned());
    }
    let value = matches!(requirement.statement, Statement::Mean).then(|| whole.mean()).flatten();
    Assessment {
        requirement: requirement.clone(),
        confidences,
        shown: ShownUnit::own(&unit),
        unit,
        gate,
        value,
        runs,
        violations: runs - within,
        failed: counts.failed,
        worst: None,
        reason,
        note,
    }
}

/// The gate on the fraction of runs within the limit.
fn of_fraction(counts: &RequirementRuns, target: f64, confidence: f64, population: Population) -> Gate {
    let (runs, within) = (counts.sum(|group| group.runs), counts.sum(|group| group.within));
    if let Population::Replicated(_) = population {
        let groups = counts.groups.iter().filter(|group| group.runs > 0);
        let fractions: Vec<f64> = groups.map(|group| group.within as f64 / group.runs as f64).collect();
        return replicate_fraction_gate(&fractions, runs, target, confidence);
    }
    fraction_gate(within, runs, target, confidence)
}

/// The gate on the mean.
fn of_mean(
    counts: &RequirementRuns,
    whole: &Moments,
    limit: GateLimit,
    confidence: f64,
    population: Population,
) -> Gate {
    match population {
        Population::Replicated(_) => {
            let means: Vec<f64> = counts.groups.iter().filter_map(|group| group.moments.mean()).collect();
            replicate_mean_gate(&means, whole, limit, confidence)
        }
        _ => mean_gate(whole, limit, confidence),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::campaign::requirement::Subject;

    fn requirement(statement: Statement, limit: GateLimit) -> Requirement {
        Requirement { subject: Subject::Observable("x".to_owned()), statement, limit, confidence: 0.95 }
    }

    /// RequirementRuns of groups: runs, runs within the limit, values.
    fn counts(groups: &[(u64, u64, &[f64])]) -> RequirementRuns {
        let mut counts = RequirementRuns::new(0);
        for (runs, within, values) in groups {
            let moments = Moments::of_block(values);
            counts.groups.push(GroupRuns { runs: *runs, within: *within, moments });
        }
        counts
    }

    /// Published: 59 runs within the limit show p95, 58 do not; a violation more and 59 do not.
    #[test]
    fn counts_decide() {
        let p95 = requirement(Statement::Quantile(0.95), GateLimit::AtMost(1.0));
        let of = |runs, within| {
            let counts = counts(&[(runs, within, &[])]);
            assessment((&p95, [0.95; 2]), "J".to_owned(), &counts, Population::Independent, false)
        };
        let found = of(59, 59);
        assert_eq!(found.word(), "PASS");
        assert_eq!(found.sentence(), "p95 of x at most 1.0 J, with 95% confidence");
        assert_eq!((of(58, 58).word(), of(59, 58).word(), of(59, 10).word()), ("UNDECIDED", "UNDECIDED", "FAIL"));
        assert_eq!(of(58, 58).gate.decision, Decision::Undecided(Some(59)));
        assert_eq!(of(0, 0).reason.as_deref(), Some("there are no runs that count"));
    }

    /// Law: a run without a value violates a requirement on the mean; designs without a population decide nothing, nor do equal values of
    /// an observable that need not be constant.
    #[test]
    fn what_numbers_cannot_say_is_not_decided_by_them() {
        let mean = requirement(Statement::Mean, GateLimit::AtMost(9.0));
        let of = |runs, population| {
            let counts = counts(&[(runs, runs, &[1.0, 2.0, 3.0].repeat(10))]);
            assessment((&mean, [0.95; 2]), String::new(), &counts, population, false)
        };
        assert_eq!(of(30, Population::Independent).word(), "PASS");
        let missing = of(31, Population::Independent);
        assert_eq!((missing.word(), missing.reason.as_deref()), ("FAIL", Some("1 runs without a value violate it")));
        for population in [Population::Dependent("sobol"), Population::Chosen("grid"), Population::Nominal] {
            let found = of(30, population);
            assert!(found.word() == "UNDECIDED" && found.reason.is_some_and(|reason| reason.contains("none")));
        }
        for (is_constant, word) in [(false, "UNDECIDED"), (true, "PASS")] {
            let equal = counts(&[(100, 100, &[0.0; 100])]);
            let found = assessment((&mean, [0.95; 2]), String::new(), &equal, Population::Independent, is_constant);
            assert_eq!((found.word(), found.reason.is_some()), (word, !is_constant));
        }
    }

    /// Law: replicates decide by their spread, and by the least spread of counts where they agree.
    #[test]
    fn replicates_decide_by_their_spread() {
        let p90 = requirement(Statement::Fraction(0.9), GateLimit::AtMost(1.0));
        let of = |groups: &[(u64, u64, &[f64])]| {
            assessment((&p90, [0.95; 2]), String::new(), &counts(groups), Population::Replicated(4), false).word()
        };
        assert_eq!(of(&[(10, 10, &[]), (10, 10, &[]), (10, 10, &[]), (10, 10, &[])]), "PASS");
        assert_eq!(of(&[(2, 2, &[]), (2, 2, &[]), (2, 2, &[]), (2, 2, &[])]), "UNDECIDED");
        assert_eq!(of(&[(100, 98, &[]), (100, 96, &[]), (100, 97, &[]), (100, 97, &[])]), "PASS");
        assert_eq!(of(&[(100, 80, &[]), (100, 99, &[]), (100, 85, &[]), (100, 98, &[])]), "UNDECIDED");
        assert_eq!(of(&[(100, 80, &[]), (100, 81, &[]), (100, 82, &[]), (100, 79, &[])]), "FAIL");
        // 380 of 400 runs would show 90% if they were independent; one replicate of four misses it
        let spread: [(u64, u64, &[f64]); 4] = [(100, 100, &[]), (100, 100, &[]), (100, 100, &[]), (100, 80, &[])];
        assert_eq!(of(&spread), "UNDECIDED");
        let independent =
            assessment((&p90, [0.95; 2]), String::new(), &counts(&spread), Population::Independent, false);
        assert_eq!(independent.word(), "PASS", "the counter-test");
    }
}
