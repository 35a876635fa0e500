//! Tests of the effect of inputs on the spread and the [`Event`]s of an outcome: distribution-free rank and table
//! tests, with p-values adjusted for all inputs (Holm).

use crate::analysis::event::{Event, are_few, distinct};
use crate::statistics::conditional::conditional_test;
use crate::statistics::contingency::{Occurrence, fisher, risk_ratio};
use crate::statistics::correlation::{Estimate, ascending_order, mid_ranks, mid_ranks_in_order};
use crate::statistics::rank_tests::{kruskal_wallis, mann_whitney, spearman_test, turns};
use crate::statistics::two_sample::holm;

/// Maximum number of cells of an input with many values, minimum rows per cell.
const CELLS: [usize; 2] = [9, 8];
/// Share of ties of an observable above which an exact test of being different replaces ranks.
const MANY_EQUAL: f64 = 0.1;
/// Share of ties of an input above which all other values form one group.
const MOSTLY_EQUAL: f64 = 0.5;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Direction {
    Rises,
    Falls,
    /// Rises in part of the input's range and falls in another.
    NotMonotonic,
}

/// Runs of one value of an input.
#[derive(Clone, Debug, PartialEq)]
pub struct Level {
    /// `None` for all values but the most frequent one.
    pub value: Option<f64>,
    /// Runs in which the event occurs.
    pub of: Occurrence,
}

#[derive(Clone, Debug, PartialEq)]
pub enum Dependence {
    /// On an input with few values, ascending.
    Levels {
        levels: Vec<Level>,
        /// Index of the level that differs most.
        most: usize,
        /// Risk ratio there against the other runs.
        ratio: Estimate,
    },
    /// On an input with many values: the event comes with large or small ones.
    Shift {
        /// Chance that a run with the event has the larger value than one without.
        chance: f64,
        /// Medians of the input with the event and without.
        medians: [f64; 2],
    },
    /// On an input with many values: the event comes far from, or near to, the middle.
    Distance {
        /// Chance that a run with the event is farther from the middle.
        chance: f64,
    },
}

#[derive(Clone, Debug, PartialEq)]
pub struct OnEvent {
    pub event: Event,
    /// Share of the variance of its occurrence; `None` for too few rows.
    pub share: Option<Estimate>,
    /// P-value of independence, adjusted for all inputs.
    pub p_value: f64,
    pub dependence: Dependence,
    /// A correlated input that the rows do not separate from this one.
    pub instead: Option<String>,
}

#[derive(Clone, Debug)]
pub struct TestedInput {
    values: Vec<f64>,
    order: Vec<usize>,
    /// For few values: group of each row, value of each group.
    groups: Option<(Vec<usize>, Vec<Option<f64>>)>,
    ranks: Vec<f64>,
    /// Ranks of the distances from the middle rank.
    distances: Vec<f64>,
}

impl TestedInput {
    /// From values and their ascending order; `None` if constant.
    pub fn new(values: &[f64], order: &[usize]) -> Option<Self> {
        let known = distinct(values, order);
        let frequent = known.iter().max_by_key(|(_, count)| *count).filter(|_| known.len() > 1)?;
        let of_values = |labels: Vec<Option<f64>>| {
            let other = labels.iter().position(Option::is_none);
            let group = |value: &f64| labels.iter().position(|label| *label == Some(*value)).or(other).unwrap_or(0);
            (values.iter().map(group).collect(), labels)
        };
        let groups = if are_few(known.len(), values.len()) {
            Some(of_values(known.iter().map(|(value, _)| Some(*value)).collect()))
        } else if frequent.1 as f64 > MOSTLY_EQUAL * values.len() as f64 {
            Some(of_values(vec![Some(frequent.0), None]))
        } else {
            None
        };
        let ranks = mid_ranks_in_order(values, order);
        let middle = 0.5 * (values.len() - 1) as f64;
        let distances = mid_ranks(&ranks.iter().map(|rank| (rank - middle).abs()).collect::<Vec<_>>());
        Some(TestedInput { values: values.to_vec(), order: order.to_vec(), groups, ranks, distances })
    }

    pub fn has_few_values(&self) -> bool {
        self.groups.is_some()
    }

    fn levels(&self, marked: &[bool]) -> Option<Vec<Level>> {
        let (groups, labels) = self.groups.as_ref()?;
        let mut levels: Vec<Level> =
            labels.iter().map(|value| Level { value: *value, of: Occurrence::default() }).collect();
        for (group, is_marked) in groups.iter().zip(marked) {
            levels[*group].of.runs += 1;
            levels[*group].of.events += u64::from(*is_marked);
        }
        Some(levels)
    }

    fn p_of_spread(&self, y: &TestedSpread) -> f64 {
        let rows = self.values.len();
        if let Some(levels) = y.is_other.as_ref().and_then(|is_other| self.levels(is_other)) {
            return of_levels(&levels).1;
        }
        if let Some((groups, labels)) = &self.groups {
            return kruskal_wallis(&y.ranks, groups, labels.len()).unwrap_or(1.0);
        }
        let monotonic = spearman_test(&self.ranks, &y.ranks)[1];
        let cells = CELLS[0].min(rows / CELLS[1]).min(y.others / CELLS[1]);
        let mut cell = vec![0; rows];
        self.order.iter().enumerate().for_each(|(place, row)| cell[*row] = place * cells / rows);
        let any = if cells > 2 { kruskal_wallis(&y.ranks, &cell, cells) } else { None };
        any.map_or(monotonic, |any| (2.0 * monotonic.min(any)).min(1.0))
    }

    /// Dependence of an event on the input, with its unadjusted p-value.
    fn on_event(&self, marked: &[bool], confidence: f64) -> Option<(Dependence, f64)> {
        if let Some(levels) = self.levels(marked) {
            let (most, p_value) = of_levels(&levels);
            let ratio = risk_ratio(levels[most].of, rest(&levels, most), confidence)?;
            return Some((Dependence::Levels { levels, most, ratio }, p_value));
        }
        let shift = mann_whitney(&self.ranks, marked)?;
        let distance = mann_whitney(&self.distances, marked).filter(|distance| distance.p_value < shift.p_value);
        let p_value = (2.0 * distance.map_or(shift.p_value, |distance| distance.p_value)).min(1.0);
        let dependence = match distance {
            Some(distance) => Dependence::Distance { chance: distance.chance },
            None => {
                let median = |of: bool| {
                    let rows: Vec<usize> = self.order.iter().copied().filter(|row| marked[*row] == of).collect();
                    0.5 * (self.values[rows[(rows.len() - 1) / 2]] + self.values[rows[rows.len() / 2]])
                };
                Dependence::Shift { chance: shift.chance, medians: [median(true), median(false)] }
            }
        };
        Some((dependence, p_value))
    }

    /// P-value of an influence on an observable with these ranks, given the correlated inputs `others`.
    fn p_beside(&self, others: &[&TestedInput], y_ranks: &[f64]) -> f64 {
        let given: Vec<_> = others.iter().map(|one| (one.order.as_slice(), one.ranks.as_slice())).collect();
        conditional_test(y_ranks, &[&self.ranks, &self.distances], &given)
    }

    /// The trend of `y` with the input; `None` if not significant at level `alpha`.
    pub fn direction(&self, y: &[f64], alpha: f64) -> Option<Direction> {
        if turns(&self.order, &self.values, y, alpha) {
            return Some(Direction::NotMonotonic);
        }
        let [r, p_value] = spearman_test(&self.ranks, &mid_ranks(y));
        (p_value <= alpha).then_some(if r > 0.0 { Direction::Rises } else { Direction::Falls })
    }
}

struct TestedSpread {
    ranks: Vec<f64>,
    /// Rows that differ from the most frequent value, if ties are too many for ranks.
    is_other: Option<Vec<bool>>,
    others: usize,
}

impl TestedSpread {
    /// `None` if constant, or of fewer than four rows.
    fn new(values: &[f64]) -> Option<Self> {
        let order = ascending_order(values);
        let known = distinct(values, &order);
        let is_tested = known.len() > 1 && values.len() >= 4;
        let (frequent, count) = *known.iter().max_by_key(|(_, count)| *count).filter(|_| is_tested)?;
        let has_many_equal = count as f64 > MANY_EQUAL * values.len() as f64;
        Some(TestedSpread {
            ranks: mid_ranks_in_order(values, &order),
            is_other: has_many_equal.then(|| values.iter().map(|value| *value != frequent).collect()),
            others: values.len() - count,
        })
    }
}

fn rest(levels: &[Level], but: usize) -> Occurrence {
    let others = levels.iter().enumerate().filter(|(place, _)| *place != but).map(|(_, level)| level.of);
    others
        .fold(Occurrence::default(), |sum, of| Occurrence { events: sum.events + of.events, runs: sum.runs + of.runs })
}

/// The level that differs most from the rest, with the p-value over all levels: Fisher's exact test of each against the
/// rest, with Bonferroni's correction beyond two.
fn of_levels(levels: &[Level]) -> (usize, f64) {
    let share = |place: usize| levels[place].of.events as f64 / levels[place].of.runs.max(1) as f64;
    if levels.len() == 2 {
        return (usize::from(share(1) > share(0)), fisher(levels[0].of, levels[1].of));
    }
    let p_values = levels.iter().enumerate().map(|(place, level)| fisher(level.of, rest(levels, place)));
    let found = p_values.enumerate().min_by(|a, b| a.1.total_cmp(&b.1));
    found.map_or((0, 1.0), |(most, p_value)| (most, (levels.len() as f64 * p_value).min(1.0)))
}

/// P-values adjusted by Holm, for `questions` about the same runs.
fn of_all(p_values: &[Option<f64>], questions: usize) -> Vec<Option<f64>> {
    let known: Vec<f64> = p_values.iter().flatten().map(|p| (questions as f64 * p).min(1.0)).collect();
    let mut adjusted = holm(&known).into_iter();
    p_values.iter().map(|p| p.and_then(|_| adjusted.next())).collect()
}

/// P-values of each input's influence on the spread of `y`, one of `questions` about the same runs.
pub fn on_spread(inputs: &[Option<TestedInput>], y: &[f64], questions: usize) -> Vec<Option<f64>> {
    let Some(y) = TestedSpread::new(y) else { return vec![None; inputs.len()] };
    let p_values: Vec<Option<f64>> =
        inputs.iter().map(|input| input.as_ref().map(|input| input.p_of_spread(&y))).collect();
    of_all(&p_values, questions)
}

/// The effect of each input on an event that occurs in the `marked` rows; `share` gives shares of the variance.
pub fn on_event(
    inputs: &[Option<TestedInput>],
    (event, marked): (Event, &[bool]),
    share: impl Fn(usize) -> Option<Estimate>,
    questions: usize,
    confidence: f64,
) -> Vec<Option<OnEvent>> {
    let found: Vec<Option<(Dependence, f64)>> =
        inputs.iter().map(|input| input.as_ref().and_then(|input| input.on_event(marked, confidence))).collect();
    let p_values = of_all(&found.iter().map(|one| one.as_ref().map(|(_, p)| *p)).collect::<Vec<_>>(), questions);
    let dependences = found.into_iter().map(|one| one.map(|(dependence, _)| dependence));
    let effects = dependences.zip(p_values).enumerate().map(|(input, (dependence, p_value))| {
        Some(OnEvent { event, share: share(input), p_value: p_value?, dependence: dependence?, instead: None })
    });
    effects.collect()
}

/// Raises the p-values of correlated inputs (`related`) that add nothing to the significant ones at level `alpha`, so
/// that those with an effect of their own remain; returns for each the input that the rows do not separate from it.
/// `tests`: number of p-values.
pub fn beside_others(
    inputs: &[Option<TestedInput>],
    y: &[f64],
    related: impl Fn(usize, usize) -> bool,
    p_values: &mut [Option<f64>],
    tests: usize,
    alpha: f64,
) -> Vec<Option<usize>> {
    let (ranks, mut instead) = (mid_ranks(y), vec![None; inputs.len()]);
    let p_beside = |one: usize, others: &[usize]| {
        let others: Vec<&TestedInput> = others.iter().filter_map(|other| inputs[*other].as_ref()).collect();
        tests as f64 * inputs[one].as_ref().map_or(1.0, |input| input.p_beside(&others, &ranks))
    };
    loop {
        let shown: Vec<usize> = (0..inputs.len()).filter(|one| p_values[*one].is_some_and(|p| p <= alpha)).collect();
        let beside = |one: &usize| {
            let others: Vec<usize> =
                shown.iter().copied().filter(|other| other != one && related(*one, *other)).collect();
            (!others.is_empty()).then(|| (*one, p_beside(*one, &others), others))
        };
        let weakest = shown.iter().filter_map(beside).max_by(|a, b| a.1.total_cmp(&b.1));
        let Some((one, p_value, others)) = weakest.filter(|(_, p_value, _)| *p_value > alpha) else { return instead };
        p_values[one] = Some(p_value.min(1.0));
        for other in others.into_iter().filter(|other| p_beside(*other, &[one]) > alpha) {
            instead[other] = Some(one);
        }
    }
}
