//! Counts and verdict of one requirement on a number of each run.

use super::population::Population;
use crate::analysis::assessment::Assessment;
use crate::analysis::statistics::is_yes_or_no;
use crate::campaign::{Requirement, ShownUnit, Statement};
use crate::statistics::binomial::Decision;
use crate::statistics::gate::{
    Gate, bounded_mean_gate, constant_gate, failing_at, fraction_gate, mean_gate, replicate_fraction_gate,
    replicate_mean_gate,
};
use crate::statistics::mean::MOST_SHARE;
use crate::statistics::moments::Moments;

#[derive(Clone, Debug, Default)]
pub struct GroupRuns {
    pub(super) runs: u64,
    pub(super) within: u64,
    /// Runs whose value is not a number, on an unknown side of the limit.
    pub(super) undefined: u64,
    pub(super) moments: Moments,
}

#[derive(Clone, Debug)]
pub struct RequirementRuns {
    pub(super) groups: Vec<GroupRuns>,
    /// Violations without a value: runs not `ok`, or without the event.
    pub(super) missing: u64,
}

impl RequirementRuns {
    pub(super) fn new(groups: usize) -> Self {
        RequirementRuns { groups: vec![GroupRuns::default(); groups], missing: 0 }
    }

    pub(super) fn merge(&mut self, other: &RequirementRuns) {
        for (mine, theirs) in self.groups.iter_mut().zip(&other.groups) {
            mine.runs += theirs.runs;
            mine.within += theirs.within;
            mine.undefined += theirs.undefined;
            mine.moments.merge(&theirs.moments);
        }
        self.missing += other.missing;
    }

    pub(super) fn sum(&self, count: impl Fn(&GroupRuns) -> u64) -> u64 {
        self.groups.iter().map(count).sum()
    }
}

#[derive(Clone, Copy)]
pub(super) struct Judged<'r> {
    pub requirement: &'r Requirement,
    /// Confidence of a pass and of a failure.
    pub confidences: [f64; 2],
    pub interval: f64,
    pub failed: u64,
}

impl Judged<'_> {
    pub(super) fn of_an_end(&self) -> f64 {
        0.5 + 0.5 * self.interval
    }
}

/// The verdict of `counts`; `is_constant`: every run has the same value.
pub(super) fn assessment(
    judged: Judged<'_>,
    unit: String,
    counts: &RequirementRuns,
    population: Population,
    is_constant: bool,
) -> Assessment {
    let Judged { requirement, confidences, .. } = judged;
    let (runs, within) = (counts.sum(|group| group.runs), counts.sum(|group| group.within));
    let limit = requirement.limit;
    let mut whole = Moments::default();
    counts.groups.iter().for_each(|group| whole.merge(&group.moments));
    let target = requirement.share();
    let at = |confidence| match target {
        Some(target) => of_fraction(counts, target, confidence, population),
        None if is_constant && whole.min() == whole.max() => constant_gate(whole.mean().unwrap_or(f64::NAN), limit),
        None => of_mean(counts, &whole, requirement, confidence, population),
    };
    let is_met = |estimate| target.map_or_else(|| limit.is_met(estimate), |target| estimate >= target);
    let mut gate = failing_at(confidences, is_met, at);
    let mut interval = at(judged.of_an_end()).bounds;
    let is_undecided = matches!(gate.decision, Decision::Undecided(_));
    let is_tailed = target.is_none() && requirement.bounded.is_none();
    let mut reason = (is_undecided && is_tailed && whole.count() > 1 && whole.min() == whole.max())
        .then(|| "all values are equal, and a rare event would not show".to_owned());
    let mut note = (is_tailed && whole.largest_share(2) > MOST_SHARE && !is_yes_or_no(&whole))
        .then(|| format!("heavy tail: one run makes {:.0}% of the variance", 100.0 * whole.largest_share(2)));
    // a missing value leaves the mean of all runs unknown
    let undefined = counts.sum(|group| group.undefined);
    let missing = if target.is_none() { runs - whole.count() - undefined } else { 0 };
    let outside = requirement.bounded.and_then(|[low, high]| {
        let ends = [whole.min().filter(|min| *min < low), whole.max().filter(|max| *max > high)];
        ends.into_iter()
            .flatten()
            .next()
            .map(|value| format!("{value:?} is outside of bounded = [{low:?}, {high:?}] {unit}"))
    });
    if let Some(outside) = outside {
        gate.decision = Decision::Fail;
        reason = Some(format!("{}, which no run may be", outside.trim_end()));
        interval = [f64::NAN; 2];
    }
    if undefined > 0 {
        let name = requirement.name();
        let said = match undefined {
            1 => format!("{name} is not a number in 1 run"),
            _ => format!("{name} is not a number in {undefined} runs"),
        };
        if target.is_none() {
            gate = Gate { decision: Decision::Undecided(None), bounds: [f64::NAN; 2], estimate: f64::NAN };
            interval = [f64::NAN; 2];
        }
        if matches!(gate.decision, Decision::Undecided(_)) {
            gate = Gate { decision: Decision::Undecided(None), estimate: f64::NAN, ..gate };
            reason = Some(said);
        } else {
            note = Some(format!("{said}, counted as violations; the verdict is the same if they are not"));
        }
    }
    if missing > 0 {
        gate.decision = Decision::Fail;
        let runs = if missing == 1 {
            "1 run without a value violates".to_owned()
        } else {
            format!("{missing} runs without a value violate")
        };
        reason = Some(format!("{runs} it"));
        interval = [f64::NAN; 2];
    }
    if !population.has_intervals() {
        gate = Gate { decision: Decision::Undecided(None), bounds: [f64::NAN; 2], ..gate };
        interval = [f64::NAN; 2];
        reason = Some(population.about_intervals());
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
        interval: interval.map(|end| if end.is_finite() { end } else { f64::NAN }),
        value,
        runs,
        violations: runs - within,
        missing: counts.missing,
        failed: judged.failed,
        worst: None,
        reason,
        note,
    }
}

/// The gate on the fraction within the limit; undecided if runs on an unknown side matter.
fn of_fraction(counts: &RequirementRuns, target: f64, confidence: f64, population: Population) -> Gate {
    let runs = counts.sum(|group| group.runs);
    let of = |within: &dyn Fn(&GroupRuns) -> u64| {
        if let Population::Replicated(_) = population {
            let groups = counts.groups.iter().filter(|group| group.runs > 0);
            let fractions: Vec<f64> = groups.map(|group| within(group) as f64 / group.runs as f64).collect();
            return replicate_fraction_gate(&fractions, runs, target, confidence);
        }
        fraction_gate(counts.sum(within), runs, target, confidence)
    };
    let least = of(&|group| group.within);
    if counts.sum(|group| group.undefined) == 0 {
        return least;
    }
    let most = of(&|group| group.within + group.undefined);
    let decision = match (least.decision, most.decision) {
        (Decision::Pass, _) => Decision::Pass,
        (_, Decision::Fail) => Decision::Fail,
        _ => Decision::Undecided(None),
    };
    Gate { decision, estimate: least.estimate, bounds: [least.bounds[0], most.bounds[1]] }
}

fn of_mean(
    counts: &RequirementRuns,
    whole: &Moments,
    requirement: &Requirement,
    confidence: f64,
    population: Population,
) -> Gate {
    let limit = requirement.limit;
    let means = || counts.groups.iter().filter_map(|group| group.moments.mean());
    match (population, requirement.bounded) {
        // means of replicates share the bounds of the values
        (Population::Replicated(_), Some(range)) => bounded_mean_gate(&Moments::of(means()), range, limit, confidence),
        (Population::Replicated(_), None) => {
            replicate_mean_gate(&means().collect::<Vec<f64>>(), whole, limit, confidence)
        }
        (_, Some(range)) => bounded_mean_gate(whole, range, limit, confidence),
        (_, None) => mean_gate(whole, limit, confidence),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::campaign::requirement::Subject;
    use crate::statistics::gate::GateLimit;

    fn asked(requirement: &Requirement) -> Judged<'_> {
        Judged { requirement, confidences: [0.95; 2], interval: 0.95, failed: 0 }
    }

    fn judged(requirement: &Requirement, counts: &RequirementRuns) -> Assessment {
        assessment(asked(requirement), "J".to_owned(), counts, Population::Independent, false)
    }

    fn requirement(statement: Statement, limit: GateLimit) -> Requirement {
        Requirement {
            subject: Subject::Observable("x".to_owned()),
            statement,
            limit,
            bounded: None,
            never_meets: false,
            confidence: 0.95,
        }
    }

    fn counts(groups: &[(u64, u64, &[f64])]) -> RequirementRuns {
        let mut counts = RequirementRuns::new(0);
        for (runs, within, values) in groups {
            let moments = Moments::of_block(values);
            counts.groups.push(GroupRuns { runs: *runs, within: *within, moments, ..GroupRuns::default() });
        }
        counts
    }

    /// Law: a bound is named if and only if the verdict is decided while the two-sided interval contains the limit, and
    /// it is on the deciding side, for shares of 400 runs and for means.
    #[test]
    fn hidden_bounds_are_those_that_decide() {
        let p95 = requirement(Statement::Fraction(0.95), GateLimit::AtMost(1.0));
        let mut seen = [0; 3];
        for within in 330..=400 {
            let counts = counts(&[(400, within, &[])]);
            let found = judged(&p95, &counts);
            let has_limit = found.interval[0] < 0.95 && 0.95 < found.interval[1];
            match (found.word(), found.hidden_bound()) {
                ("PASS", Some(([bound, _], is_lower))) => {
                    assert!(has_limit && is_lower && bound >= 0.95);
                    seen[0] += 1;
                }
                ("FAIL", Some(([bound, _], is_lower))) => {
                    assert!(has_limit && !is_lower && bound < 0.95);
                    seen[1] += 1;
                }
                (word, None) => {
                    assert!(word == "UNDECIDED" || !has_limit, "{within}");
                    seen[2] += 1;
                }
                other => panic!("{other:?}"),
            }
        }
        assert!(seen.iter().all(|count| *count > 0), "{seen:?}");
        let values: Vec<f64> = (0..100).map(|k| f64::from(k % 10)).collect();
        for step in 0..400 {
            let at = 3.5 + 0.005 * f64::from(step);
            for limit in [GateLimit::AtMost(at), GateLimit::AtLeast(at)] {
                let mean = requirement(Statement::Mean, limit);
                let found = judged(&mean, &counts(&[(100, 100, &values)]));
                let Some(([bound, limit_there], is_lower)) = found.hidden_bound() else { continue };
                assert_eq!(limit_there, at);
                assert_eq!(is_lower, bound > at, "{at}: {bound}");
                assert_eq!(limit.is_met(bound), found.word() == "PASS", "{at}: {bound}");
            }
        }
    }

    /// Law: a missing value violates a requirement on the mean; designs without a population, and equal values of a
    /// variable observable, decide nothing.
    #[test]
    fn what_numbers_cannot_say_is_not_decided_by_them() {
        let mean = requirement(Statement::Mean, GateLimit::AtMost(9.0));
        let of = |runs, population| {
            let counts = counts(&[(runs, runs, &[1.0, 2.0, 3.0].repeat(10))]);
            assessment(asked(&mean), String::new(), &counts, population, false)
        };
        assert_eq!(of(30, Population::Independent).word(), "PASS");
        let missing = of(31, Population::Independent);
        assert_eq!((missing.word(), missing.reason.as_deref()), ("FAIL", Some("1 run without a value violates it")));
        for population in [Population::Dependent("sobol"), Population::Chosen("grid"), Population::Nominal] {
            let found = of(30, population);
            assert!(
                found.word() == "UNDECIDED" && found.reason.is_some_and(|reason| reason.starts_with("no intervals: "))
            );
        }
        for (is_constant, word) in [(false, "UNDECIDED"), (true, "PASS")] {
            let equal = counts(&[(100, 100, &[0.0; 100])]);
            let found = assessment(asked(&mean), String::new(), &equal, Population::Independent, is_constant);
            assert_eq!((found.word(), found.reason.is_some()), (word, !is_constant));
        }
    }

    /// Law: the interval of a share is Clopper and Pearson's two-sided one, whatever the confidence of the requirement.
    #[test]
    fn intervals_are_two_sided() {
        let p95 = Requirement { confidence: 0.99, ..requirement(Statement::Fraction(0.95), GateLimit::AtMost(1.0)) };
        let asked = Judged { requirement: &p95, confidences: [0.99; 2], interval: 0.9, failed: 0 };
        let counts = counts(&[(499, 490, &[])]);
        let found = assessment(asked, String::new(), &counts, Population::Independent, false);
        let [lower, upper] = found.interval;
        let tails = [
            crate::statistics::binomial::at_least(490, 499, lower),
            crate::statistics::binomial::at_most(490, 499, upper),
        ];
        assert!(tails.iter().all(|tail| (tail - 0.05).abs() < 1e-9), "{tails:?}");
        assert!((crate::statistics::binomial::at_least(490, 499, found.gate.bounds[0]) - 0.01).abs() < 1e-9);
    }

    /// Law: bounded values decide a mean for any tail and without spread; a value outside fails it. Without bounds the
    /// room for rare events is the distance from the bound to the limit.
    #[test]
    fn bounded_means_assume_no_tail() {
        let mean = |bounded, limit| Requirement { bounded, ..requirement(Statement::Mean, GateLimit::AtMost(limit)) };
        let of = |requirement: &Requirement, values: &[f64]| {
            let runs = values.len() as u64;
            judged(requirement, &counts(&[(runs, runs, values)]))
        };
        let spread: Vec<f64> = (0..1000).map(|k| f64::from(k % 10) / 10.0).collect();
        let (bounded, free) = (of(&mean(Some([0.0, 1.0]), 0.5), &spread), of(&mean(None, 0.5), &spread));
        assert_eq!((bounded.word(), free.word()), ("PASS", "PASS"));
        assert_eq!(bounded.room_for_rare_events(), None);
        let room = free.room_for_rare_events().expect("an assumption");
        assert!((room - (0.5 - free.gate.bounds[1])).abs() < 1e-15 && room > 0.0, "{room}");
        assert!(bounded.gate.bounds[1] > free.gate.bounds[1], "what assumes nothing is wider");
        let equal = [0.25; 1000];
        assert_eq!(
            (of(&mean(Some([0.0, 1.0]), 0.5), &equal).word(), of(&mean(None, 0.5), &equal).word()),
            ("PASS", "UNDECIDED")
        );
        for range in [[0.0, 0.8], [0.05, 1.0]] {
            let outside = of(&mean(Some(range), 0.5), &spread);
            assert!(
                outside.word() == "FAIL" && outside.reason.is_some_and(|reason| reason.contains("outside of bounded"))
            );
        }
        assert_eq!(of(&mean(Some([0.0, 1.0]), 0.5), &[0.1, 0.2]).word(), "UNDECIDED");
    }
}
