//! [`Verdicts`]: verdicts on the requirements of a campaign from exact counts of its rows, never from sketches.
//!
//! Unphysical samples are outside of the population; any other run that is not `ok` violates every requirement, as does
//! one whose subject never happened, unless the key `never` says otherwise. A value that is not a number neither meets
//! nor violates.
//!
//! Each look of `[stop]` has its share of the errors (Bonferroni), each requirement its share of the errors of failures
//! ([`failing_together`]). Verdicts on single counts are in `row_verdicts`, over time in `band_verdicts`.

use super::accumulator::Accumulator;
use super::observed::Observed;
use super::part_columns::PartColumns;
use super::population::Population;
use crate::analysis::assessment::Assessment;
use crate::analysis::band_verdicts::over_time;
use crate::analysis::row_verdicts::{Judged, RequirementRuns, assessment};
use crate::analysis::statistics::Statistics;
use crate::analysis::statuses::Statuses;
use crate::campaign::{Plan, Requirement, Statement};
use crate::ensemble::Bands;
use crate::run::Status;
use crate::statistics::binomial::Decision;
use crate::statistics::gate::failing_together;
use crate::statistics::looks::adjusted;
use crate::statistics::moments::Moments;
use crate::storage::rows_reader::Result;

#[derive(Clone, Debug, Default, PartialEq)]
pub struct Verdicts {
    pub list: Vec<Assessment>,
    /// Unphysical dispersed samples.
    pub invalid: u64,
    pub samples: u64,
    /// One without `[stop]`.
    pub looks: usize,
    /// Confidence of the two-sided intervals.
    pub confidence: f64,
}

impl Verdicts {
    /// Adopts the quantiles of `statistics`, so that each has one value.
    #[must_use]
    pub fn with_quantiles(mut self, statistics: &Statistics) -> Self {
        for one in &mut self.list {
            // undefined values leave the quantile open
            let is_known = one.gate.estimate.is_finite() && one.requirement.observable().is_some();
            if let (Statement::Quantile(_), true) = (one.requirement.statement, is_known) {
                one.value = statistics.required(&one.requirement).and_then(|quantile| quantile.value);
            }
        }
        self
    }

    pub fn failed(&self) -> usize {
        self.list.iter().filter(|one| one.gate.decision == Decision::Fail).count()
    }

    pub fn undecided(&self) -> usize {
        self.list.iter().filter(|one| matches!(one.gate.decision, Decision::Undecided(_))).count()
    }
}

pub type RequirementCounts = Vec<RequirementRuns>;

#[derive(Clone, Debug)]
pub struct RequirementCounter {
    requirements: Vec<Requirement>,
    observed: Vec<Observed>,
    /// Index in `observed` of each requirement; `None` over time.
    of: Vec<Option<usize>>,
    population: Population,
}

impl RequirementCounter {
    pub fn new(plan: &Plan) -> Self {
        let requirements = plan.analysis.requirements.clone();
        let observed = Observed::named(plan, requirements.iter().filter_map(Requirement::observable));
        let index = |name: &str| observed.iter().position(|observed| observed.name() == name);
        let of = requirements.iter().map(|requirement| requirement.observable().and_then(index)).collect();
        RequirementCounter { of, requirements, observed, population: Population::of(plan) }
    }
}

impl Accumulator for RequirementCounter {
    type Whole = RequirementCounts;
    type OfPart = RequirementCounts;

    fn nothing(&self) -> RequirementCounts {
        vec![RequirementRuns::new(self.population.groups()); self.requirements.len()]
    }

    fn count(&self, part: &impl PartColumns) -> Result<RequirementCounts> {
        let mut found = self.nothing();
        if self.requirements.is_empty() {
            return Ok(found);
        }
        let columns = self.observed.iter().map(|one| one.column(part)).collect::<Result<Vec<_>, _>>()?;
        let (samples, statuses) = (part.samples()?, part.statuses()?);
        let dispersed: Vec<usize> = (0..samples.len()).filter(|row| self.population.contains(samples[*row])).collect();
        let is_physical = |row: &&usize| statuses[**row] != Status::InvalidSample;
        let has_value = |index: usize, row: usize| statuses[row] != Status::Done || !columns[index][row].is_nan();
        let mut undefined = Vec::with_capacity(columns.len());
        for (index, observed) in self.observed.iter().enumerate() {
            let is_complete = dispersed.iter().all(|row| has_value(index, *row));
            undefined.push(if is_complete { Vec::new() } else { observed.undefined(part)? });
        }
        for ((requirement, index), counts) in self.requirements.iter().zip(&self.of).zip(&mut found) {
            let mut kept = vec![Vec::new(); self.population.groups()];
            let has_mean = matches!(requirement.statement, Statement::Mean);
            for row in dispersed.iter().filter(is_physical) {
                let value = index.map_or(f64::NAN, |index| columns[index][*row]);
                let group = self.population.group(samples[*row]);
                let is_ok = statuses[*row] == Status::Done;
                counts.groups[group].runs += 1;
                let is_undefined =
                    is_ok && value.is_nan() && index.is_some_and(|index| undefined[index].get(*row) == Some(&true));
                if is_undefined {
                    counts.groups[group].undefined += 1;
                    continue;
                }
                let is_met = is_ok && requirement.is_met(value);
                counts.groups[group].within += u64::from(is_met);
                counts.missing += u64::from(!is_ok || value.is_nan() && !is_met);
                if is_ok && has_mean && !value.is_nan() {
                    kept[group].push(value);
                }
            }
            for (group, values) in counts.groups.iter_mut().zip(&kept) {
                group.moments = Moments::of_block(values);
            }
        }
        Ok(found)
    }

    fn merge(&self, whole: &mut RequirementCounts, part: RequirementCounts) {
        whole.iter_mut().zip(&part).for_each(|(mine, theirs)| mine.merge(theirs));
    }
}

pub fn assess(plan: &Plan, ended: &Statuses, counted: &[RequirementRuns], bands: Option<&Bands>) -> Verdicts {
    let requirements = &plan.analysis.requirements;
    if requirements.is_empty() {
        return Verdicts::default();
    }
    let RequirementCounter { observed, of, population, .. } = RequirementCounter::new(plan);
    let looks = plan.looks().len();
    let failed = ended.loss().missing;
    let assessed = |(requirement, index, counts): (&Requirement, &Option<usize>, &RequirementRuns), open: usize| {
        let confidences = [looks, looks * open].map(|tests| adjusted(requirement.confidence, tests));
        let judged = Judged { requirement, confidences, interval: plan.analysis.confidence, failed };
        match (index, requirement.band()) {
            (None, Some(band)) => over_time(judged, band, bands, counts.sum(|group| group.runs), population),
            _ => {
                let observed = index.map(|index| &observed[index]);
                let unit = observed.map_or_else(String::new, |observed| observed.quantity.unit().to_owned());
                let is_constant = observed.is_some_and(|observed| observed.is_constant(plan));
                assessment(judged, unit, counts, population, is_constant)
            }
        }
    };
    let all = || {
        let list = requirements.iter().zip(&of).zip(counted);
        list.map(|((requirement, index), counts)| (requirement, index, counts))
    };
    let at = |open: usize| all().map(|one| assessed(one, open)).collect();
    let mut list = failing_together(requirements.len(), at, |one: &Assessment| one.gate.decision == Decision::Fail);
    for one in &mut list {
        one.shown = plan.analysis.display.of(one.requirement.name(), &one.unit);
    }
    let (confidence, samples) = (plan.analysis.confidence, ended.of_population().iter().sum());
    Verdicts { list, invalid: samples - ended.loss().runs, samples, looks, confidence }
}
