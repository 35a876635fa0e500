//! [`Compared`]: two compared results with their verdicts and differing keys.

use std::cmp::Ordering;

use crate::analysis::comparison::Comparison;
use crate::campaign::Plan;
use crate::campaign::difference::{KeyDifference, differences};
use crate::findings::number::brief;
use crate::findings::requirement::EndVerdict;
use crate::statistics::contingency::fisher;
use crate::statistics::two_sample::holm;

#[derive(Clone, Debug, Default, PartialEq)]
pub struct ComparedVerdict {
    pub requirement: String,
    pub verdicts: [Option<EndVerdict>; 2],
    /// Probability that two results of one campaign differ this much by chance, adjusted for the number of requirements
    /// (Holm); `None` if no test applies.
    pub p_value: Option<f64>,
    /// True if the verdicts differ but the data differ no more than chance allows.
    pub is_within_chance: bool,
}

/// Requirements of the first result in their order, then those that only the second has.
pub fn verdicts([first, second]: [Vec<EndVerdict>; 2], comparison: &Comparison) -> Vec<ComparedVerdict> {
    let verdict = |list: &[EndVerdict], name: &str| list.iter().find(|one| one.requirement == name).cloned();
    let both = first.iter().chain(second.iter().filter(|one| verdict(&first, &one.requirement).is_none()));
    let mut all: Vec<ComparedVerdict> = both
        .map(|one| {
            let verdicts = [verdict(&first, &one.requirement), verdict(&second, &one.requirement)];
            let p_value = verdicts[0].as_ref().zip(verdicts[1].as_ref()).and_then(|pair| p_of_change(pair, comparison));
            ComparedVerdict { requirement: one.requirement.clone(), verdicts, p_value, is_within_chance: false }
        })
        .collect();
    let tested: Vec<f64> = all.iter().filter_map(|one| one.p_value).collect();
    let mut adjusted = holm(&tested).into_iter();
    for one in &mut all {
        one.p_value = one.p_value.and_then(|_| adjusted.next());
        let differs = one.change().is_some_and(|change| change != Ordering::Equal);
        one.is_within_chance = differs && one.p_value.is_some_and(|p| p > comparison.level());
    }
    all
}

/// Probability that the data behind two verdicts differ this much by chance. Tests the share of violating runs (Fisher)
/// or the mean; for paired results also the differences, the runs without a value and the failed runs, which violate
/// the requirement. Bonferroni: the smallest of k p-values times k.
fn p_of_change((first, second): (&EndVerdict, &EndVerdict), comparison: &Comparison) -> Option<f64> {
    let is_its = |name: &str| first.observable.as_deref() == Some(name);
    let column = comparison.columns.iter().find(|column| is_its(column.quantity.name()));
    let of_share = first.violations.zip(second.violations).map(|(one, other)| fisher(one, other));
    let of_mean = || column.and_then(|column| column.mean).map(|mean| mean.p_value);
    let of_pairs = column.filter(|_| comparison.pairs > 0);
    let tests = [
        of_share.or_else(of_mean),
        of_pairs.and_then(|column| column.p_of_pairs()),
        of_pairs.map(|column| column.absence.p_value),
        of_pairs.map(|_| comparison.failures.p_value),
    ];
    let count = tests.iter().flatten().count() as f64;
    tests.into_iter().flatten().reduce(f64::min).map(|smallest| (count * smallest).min(1.0))
}

impl ComparedVerdict {
    /// True if the second verdict is worse, in the order FAIL, UNDECIDED, PASS; ignores chance.
    pub fn is_worse(&self) -> bool {
        self.change() == Some(Ordering::Less)
    }

    /// `PASS`, `FAIL` or `UNDECIDED` in result `which`.
    pub fn word(&self, which: usize) -> Option<&str> {
        self.verdicts[which].as_ref().map(|one| one.word.as_str())
    }

    /// The second verdict relative to the first; `None` if only one result has the requirement.
    pub fn change(&self) -> Option<Ordering> {
        let rank = |which| ["FAIL", "UNDECIDED", "PASS"].iter().position(|known| Some(*known) == self.word(which));
        rank(0).zip(rank(1)).map(|(first, second)| second.cmp(&first))
    }

    /// The change in a word, with its place in the list.
    pub fn mark(&self) -> (usize, String) {
        let p = self.p_value.map_or(String::new(), |p| format!(", p = {}", brief(p)));
        let (place, word) = match (self.change(), &self.verdicts[0]) {
            _ if self.is_within_chance => return (1, format!("within chance{p}")),
            (Some(Ordering::Less), _) => (0, "WORSE"),
            (Some(Ordering::Greater), _) => (1, "BETTER"),
            (None, None) => (2, "new"),
            (None, Some(_)) => (2, "gone"),
            (Some(Ordering::Equal), _) => (3, ""),
        };
        (place, word.to_owned())
    }

    pub fn statement(&self) -> &str {
        self.verdicts.iter().flatten().next().map_or(&self.requirement, |one| &one.statement)
    }
}

#[derive(Clone, Debug)]
pub struct Compared<'c> {
    pub names: [String; 2],
    pub plans: [&'c Plan; 2],
    pub comparison: Comparison,
    pub keys: Vec<KeyDifference>,
    pub verdicts: Vec<ComparedVerdict>,
    /// Allowed shift, as a share of the spread.
    pub tolerance: Option<f64>,
    /// True if worse verdicts count even if chance explains them.
    pub is_strict: bool,
}

impl<'c> Compared<'c> {
    pub fn new(names: [String; 2], plans: [&'c Plan; 2], comparison: Comparison, ends: [Vec<EndVerdict>; 2]) -> Self {
        let verdicts = verdicts(ends, &comparison);
        let keys = differences(plans[0], plans[1]);
        Compared { names, plans, comparison, keys, verdicts, tolerance: None, is_strict: false }
    }

    pub fn counted(&self) -> impl Iterator<Item = &ComparedVerdict> {
        self.verdicts.iter().filter(|one| self.is_strict || !one.is_within_chance)
    }

    /// Number of worse verdicts, plus one if a shift exceeds the tolerance.
    pub fn failed(&self) -> usize {
        let is_beyond = self.tolerance.is_some_and(|tolerance| self.comparison.is_beyond(tolerance));
        self.counted().filter(|one| one.is_worse()).count() + usize::from(is_beyond)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::findings::known_truth::{comparison, rows};
    use crate::statistics::binomial::{Decision, decide};
    use crate::statistics::contingency::Occurrence;

    /// Verdicts on three requirements: each observable is at most its limit in 95% of the runs.
    fn judged(rows: &[[f64; 3]], limits: [f64; 3]) -> Vec<EndVerdict> {
        let verdict = |(place, limit): (usize, f64)| {
            let within = rows.iter().filter(|row| row[place] <= limit).count() as u64;
            let runs = rows.len() as u64;
            let word = match decide(within, runs, 0.95, 0.95) {
                Decision::Pass => "PASS",
                Decision::Fail => "FAIL",
                Decision::Undecided(_) => "UNDECIDED",
            };
            EndVerdict {
                requirement: place.to_string(),
                word: word.to_owned(),
                observable: Some(["a", "b", "c"][place].to_owned()),
                violations: Some(Occurrence { events: runs - within, runs }),
                ..EndVerdict::default()
            }
        };
        limits.into_iter().enumerate().map(verdict).collect()
    }

    fn changed(seeds: [u64; 2], noise: f64, change: impl Fn([f64; 3]) -> [f64; 3]) -> Vec<ComparedVerdict> {
        let of = |which: usize| rows(200, [seeds[which], 7000 + 2 * seeds[0] + which as u64], noise, 0.02);
        let (first, second) = (of(0), of(1).into_iter().map(change).collect::<Vec<[f64; 3]>>());
        // 97 to 98% of the runs keep each limit
        let limits = [1.96, 6.5, 3.0];
        let found = comparison([&first, &second], seeds[0] == seeds[1]);
        verdicts([judged(&first, limits), judged(&second, limits)], &found)
    }

    /// H0: nothing changed but the seed or the noise. A worse verdict beyond chance appears in at most 0.05 of
    /// campaigns: of seeds 1 to 300, at most 26 (alpha = 2e-3 for each of three settings). Counter-test: bare verdicts
    /// are worse in a fifth or more. Power: shifts of a tenth of the spread in paired runs, or of one spread in
    /// independent runs, are recognised in nine of ten worse verdicts.
    #[test]
    fn verdicts_are_seldom_worse_by_chance() {
        // campaigns with a worse verdict, and with one beyond chance, among the first requirements
        let part = |requirements: usize, noise: f64, is_same: bool, step: f64| {
            (1..=300).fold([0; 2], |[all, told], seed| {
                let found =
                    changed([seed, if is_same { seed } else { seed + 1000 }], noise, |[a, b, c]| [a + step, b, c]);
                let worse = || found[..requirements].iter().filter(|one| one.is_worse());
                let is_told = worse().any(|one| !one.is_within_chance);
                [all + u32::from(worse().count() > 0), told + u32::from(is_told)]
            })
        };
        for (noise, is_same) in [(0.0, false), (0.3, true), (1.0, true)] {
            let [worse, told] = part(3, noise, is_same, 0.0);
            println!("noise {noise}, same seed {is_same}: {worse} of 300 worse, {told} told");
            assert!(told <= 26 && worse > 60, "{noise} {is_same}: {worse} {told}");
        }
        for (is_same, step) in [(true, 0.1), (false, 1.0)] {
            let [worse, told] = part(1, 0.0, is_same, step);
            println!("changed, same seed {is_same}: {worse} of 300 worse, {told} told");
            assert!(told * 10 > worse * 9 && told > 30, "{is_same}: {worse} {told}");
        }
    }
}
