//! Sensitivities of observables to inputs, a function of plan and files: correlations, regression and given-data
//! indices from the `ok` runs in sample order, first-order and total Sobol indices from the blocks of a `saltelli`
//! design.

use super::observed::Observed;
use super::population::Population;
use crate::analysis::block_indices::of_blocks;
use crate::analysis::effects::{OnEvent, TestedInput, beside_others, on_event, on_spread};
use crate::analysis::event::Event;
use crate::analysis::first_rows::{FirstRows, RowTable, inputs};
use crate::analysis::input_sensitivity::{COMPUTED, InputSensitivity};
use crate::analysis::population::{LISTED, Loss};
use crate::campaign::Plan;
use crate::ensemble::threads::Threads;
use crate::sampling::Design;
use crate::statistics::correlation::{
    Estimate, ascending_order, correlation, matrix, mid_ranks, mid_ranks_in_order, standardised,
};
use crate::statistics::regression::{Regressors, independent_inputs};
use crate::statistics::sensitivity::{Samples, first_order_index, has_tails, share_of_parabola};
use crate::storage::parallel::in_parallel;
use std::num::NonZeroUsize;

/// Minimum rank correlation of two inputs to be noted, if beyond chance.
const NOTABLE_CORRELATION: f64 = 0.05;
/// Weight of ranks in the order of inputs without shares, unless an input has tails.
const WEIGHT_OF_RANKS: f64 = 0.25;
/// Standard deviations of chance correlations: one of 10,000 pairs exceeds this in one of a thousand campaigns.
const CHANCE: f64 = 5.5;

/// Sensitivities of the required or named observables of `plan`, else of the main ones, from its first rows. After a
/// big `loss` the `ok` rows are no sample of all, and have no intervals.
pub fn compute(plan: &Plan, table: &RowTable, loss: Loss, threads: Threads) -> Vec<InputSensitivity> {
    let observed = FirstRows::new(plan).observed;
    let names: Vec<&str> = observed.iter().map(Observed::name).collect();
    let found = of_table(plan, &names, table, &table.observables, threads);
    if loss.is_big() { found.into_iter().map(|one| one.without_intervals(true)).collect() } else { found }
}

/// The sensitivity of being computed ([`COMPUTED`]), from the first rows; none if all are, or none is.
pub fn of_failures(plan: &Plan, table: &RowTable, threads: Threads) -> Vec<InputSensitivity> {
    let is_computed = table.is_ok.iter().map(|is_ok| f64::from(u8::from(*is_ok))).collect();
    let varies = [true, false].iter().all(|flag| table.is_ok.contains(flag));
    if varies { of_table(plan, &[COMPUTED], table, &[is_computed], threads) } else { Vec::new() }
}

fn of_table(
    plan: &Plan,
    names: &[&str],
    table: &RowTable,
    observables: &[Vec<f64>],
    threads: Threads,
) -> Vec<InputSensitivity> {
    if let Design::Saltelli(_) = plan.design {
        return of_blocks(plan, names, &table.samples, observables);
    }
    let inputs = inputs(plan);
    if let Some(note) = plan.bound_inputs(table.samples.len() as u64) {
        return untold(names, &inputs, table.samples.len() as u64, &note);
    }
    let all = Prepared::new((plan, &inputs), table.inputs.clone(), threads);
    // ranks depend on the set of rows
    let has_failed = names != [COMPUTED] && table.is_ok.contains(&false);
    let ok: Vec<usize> = (0..table.is_ok.len()).filter(|row| table.is_ok[*row]).collect();
    let computed = has_failed.then(|| all.of_rows(&ok, threads));
    let of_observable = |(name, y): (&&str, &Vec<f64>)| match &computed {
        None => all.explained(name, y),
        Some(computed) => {
            let missed = Event::missed(plan, name, y, &table.is_ok);
            computed.explained_beside(name, &at(&ok, y), &all, missed)
        }
    };
    let work: Vec<_> = names.iter().zip(observables).collect();
    in_parallel(work, threads, of_observable).into_iter().flatten().collect()
}

fn at(rows: &[usize], values: &[f64]) -> Vec<f64> {
    rows.iter().map(|row| values[*row]).collect()
}

fn untold(names: &[&str], inputs: &[String], rows: u64, note: &str) -> Vec<InputSensitivity> {
    let of = |name: &&str, input: &String| InputSensitivity {
        observable: (*name).to_owned(),
        input: input.clone(),
        rows,
        note: Some(note.to_owned()),
        ..InputSensitivity::default()
    };
    names.iter().flat_map(|name| inputs.iter().map(move |input| of(name, input))).collect()
}

pub struct Prepared<'p> {
    plan: &'p Plan,
    names: &'p [String],
    rows: usize,
    /// Inputs that vary and do not depend linearly on those before, as values and as ranks.
    kept: [Vec<bool>; 2],
    values: Vec<Vec<f64>>,
    standardised: Vec<Vec<f64>>,
    ranks: Vec<Vec<f64>>,
    /// Regressors of the kept inputs, as values and as ranks.
    regressors: [Option<Regressors>; 2],
    orders: Vec<Vec<usize>>,
    tested: Vec<Option<TestedInput>>,
    /// Inputs with many values and tails that the rows may not show.
    with_tails: Vec<bool>,
    correlations: Vec<Vec<f64>>,
}

/// Everything that depends on one input alone.
struct Forms {
    standardised: Vec<f64>,
    ranks: Vec<f64>,
    order: Vec<usize>,
    tested: Option<TestedInput>,
}

impl Forms {
    fn of(input: &[f64]) -> Self {
        let order = ascending_order(input);
        let ranks = standardised(&mid_ranks_in_order(input, &order));
        Forms { standardised: standardised(input), ranks, tested: TestedInput::new(input, &order), order }
    }
}

impl<'p> Prepared<'p> {
    /// Of inputs with these `names`.
    pub fn new((plan, names): (&'p Plan, &'p [String]), values: Vec<Vec<f64>>, threads: Threads) -> Self {
        let forms = in_parallel(values.iter().collect(), threads, |input| Forms::of(input));
        let (mut scaled, mut ranks, mut orders, mut tested) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
        for form in forms {
            scaled.push(form.standardised);
            ranks.push(form.ranks);
            orders.push(form.order);
            tested.push(form.tested);
        }
        // as values and as ranks
        let of = |columns: &Vec<Vec<f64>>| {
            let kept = independent_inputs(columns);
            let inputs = columns.iter().zip(&kept).filter(|(_, kept)| **kept).map(|(column, _)| column.clone());
            let regressors = Some(inputs.collect()).filter(|inputs: &Vec<_>| !inputs.is_empty());
            (kept, regressors.and_then(Regressors::new))
        };
        let mut of_both = in_parallel(vec![&scaled, &ranks], threads, of).into_iter();
        let [(values_kept, of_values), (ranks_kept, of_ranks)] = [(); 2].map(|()| of_both.next().expect("both"));
        Prepared {
            plan,
            names,
            rows: values.first().map_or(0, Vec::len),
            regressors: [of_values, of_ranks],
            correlations: matrix(&ranks),
            kept: [values_kept, ranks_kept],
            orders,
            with_tails: values.iter().zip(&tested).map(|(values, of)| tails_of(values, of.as_ref())).collect(),
            tested,
            values,
            standardised: scaled,
            ranks,
        }
    }

    /// True if two inputs have a notable correlation, by `[[correlate]]` or beyond chance.
    fn is_notable(&self, [one, other]: [usize; 2]) -> bool {
        let is_written = || {
            self.plan.correlated.iter().any(|table| {
                let columns: Vec<String> = table.components().iter().map(|(of, at)| of.column_name(*at)).collect();
                [one, other].iter().all(|input| columns.contains(&self.names[*input]))
            })
        };
        let r = self.correlations[one][other].abs();
        one != other && r > NOTABLE_CORRELATION && (r > CHANCE / libm::sqrt(self.rows as f64) || is_written())
    }

    fn correlated_with(&self, index: usize) -> Option<(String, f64)> {
        let others = (0..self.names.len()).filter(|other| self.is_notable([index, *other]));
        let r = |other: &usize| self.correlations[index][*other];
        let other = others.max_by(|a, b| r(a).abs().total_cmp(&r(b).abs()))?;
        Some((self.names[other].clone(), r(&other)))
    }

    /// The first-order index: unknown if some input does not vary in these rows. Unless the outcome is bounded, unseen
    /// tails of another input may reduce it to nothing.
    fn first_order(&self, index: usize, y: &[f64], is_bounded: bool) -> Option<Estimate> {
        let (order, x) = (&self.orders[index], &self.values[index]);
        let found = first_order_index(order, x, y, samples(self.plan), self.plan.analysis.confidence)?;
        let all_vary = self.tested.iter().all(Option::is_some);
        let is_hidden = |(other, has_tails): (usize, &bool)| other != index && *has_tails;
        let has_hidden = !is_bounded && self.with_tails.iter().enumerate().any(is_hidden);
        let lower = if has_hidden { found.lower.min(0.0) } else { found.lower };
        Some(if all_vary { Estimate { lower, ..found } } else { Estimate { lower: 0.0, upper: 1.0, ..found } })
    }

    /// Tests each correlated input given the others; names those that the rows do not separate.
    fn beside_others(&self, y: &[f64], p_values: &mut [Option<f64>], questions: usize) -> Vec<Option<String>> {
        let related = |one: usize, other: usize| self.is_notable([one, other]);
        let tests = questions * self.names.len();
        let instead = beside_others(&self.tested, y, related, p_values, tests, 1.0 - self.plan.analysis.confidence);
        instead.into_iter().map(|other| other.map(|other| self.names[other].clone())).collect()
    }

    fn of_rows(&self, rows: &[usize], threads: Threads) -> Self {
        Prepared::new((self.plan, self.names), self.values.iter().map(|input| at(rows, input)).collect(), threads)
    }

    /// Sensitivities of the spread and events of an observable with values `y`, NaN for none.
    pub fn explained(&self, observable: &str, y: &[f64]) -> Vec<InputSensitivity> {
        let missed = Event::missed(self.plan, observable, y, &vec![true; y.len()]);
        self.explained_beside(observable, y, self, missed)
    }

    /// As [`Prepared::explained`], with missed requirements in the rows of `all`.
    fn explained_beside(
        &self,
        observable: &str,
        y: &[f64],
        all: &Self,
        missed: Vec<(Event, Vec<bool>)>,
    ) -> Vec<InputSensitivity> {
        let has_tests = !matches!(Population::of(self.plan), Population::Chosen(_) | Population::Nominal);
        let (rows, events) = match missed {
            _ if !has_tests => (self, Vec::new()),
            none if none.is_empty() => (self, Event::of_values(self.plan, observable, y)),
            missed => (all, missed),
        };
        // events, and the spread
        let questions = events.len() + usize::from(events.iter().all(|(event, _)| !event.has_few_values));
        let tests = has_tests.then_some(questions);
        let mut found = if y.iter().all(|value| value.is_finite()) {
            self.sensitivities(observable, y, tests)
        } else {
            let finite: Vec<usize> = (0..y.len()).filter(|row| y[*row].is_finite()).collect();
            let of_finite = self.of_rows(&finite, NonZeroUsize::new(1));
            of_finite.sensitivities(observable, &at(&finite, y), tests)
        };
        for (event, marked) in events {
            let effects = rows.on_event((event, &marked), questions);
            found.iter_mut().zip(effects).for_each(|(one, effect)| one.on_events.extend(effect));
        }
        // chosen samples have correlations, but no population
        if has_tests { found } else { found.into_iter().map(|one| one.without_intervals(false)).collect() }
    }

    fn on_event(&self, (event, marked): (Event, &[bool]), questions: usize) -> Vec<Option<OnEvent>> {
        let indicator: Vec<f64> = marked.iter().map(|is_marked| f64::from(*is_marked)).collect();
        let share = |input: usize| self.first_order(input, &indicator, true);
        let mut effects = on_event(&self.tested, (event, marked), share, questions, self.plan.analysis.confidence);
        let mut p_values: Vec<Option<f64>> = effects.iter().map(|one| one.as_ref().map(|one| one.p_value)).collect();
        let instead = self.beside_others(&indicator, &mut p_values, questions);
        for (effect, (p_value, instead)) in effects.iter_mut().zip(p_values.into_iter().zip(instead)) {
            if let Some((effect, p_value)) = effect.as_mut().zip(p_value) {
                (effect.p_value, effect.instead) = (p_value, instead);
            }
        }
        effects
    }

    /// Sensitivities of an observable with values `y`, one of `questions`; `None`: without tests.
    fn sensitivities(&self, observable: &str, y: &[f64], questions: Option<usize>) -> Vec<InputSensitivity> {
        let (names, confidence) = (self.names, self.plan.analysis.confidence);
        let population = Population::of(self.plan);
        let mut p_values = questions.map_or_else(|| vec![None; names.len()], |count| on_spread(&self.tested, y, count));
        let instead = self.beside_others(y, &mut p_values, questions.unwrap_or(1));
        let (scaled, ranked) = (standardised(y), standardised(&mid_ranks(y)));
        let varies = scaled.iter().any(|value| *value != 0.0);
        let regressor = |which: usize| self.regressors[which].as_ref().filter(|_| varies);
        let linear = regressor(0).and_then(|of| of.regression(&scaled));
        let rank = regressor(1).and_then(|of| of.regression(&ranked));
        let r_squared = linear.as_ref().map(|of| of.r_squared(confidence));
        let place = |which: usize, index: usize| {
            self.kept[which][index].then(|| self.kept[which][..index].iter().filter(|kept| **kept).count())
        };
        let of_input = |(index, name): (usize, &String)| {
            let input_varies = self.standardised[index].iter().any(|value| *value != 0.0);
            let both_vary = varies && input_varies && self.rows > 3;
            let correlated = |x: &[f64], y: &[f64]| both_vary.then(|| correlation(x, y, 0, confidence));
            let partial = rank.as_ref().zip(place(1, index)).map(|(of, at)| of.partial(at, confidence));
            let coefficient = linear.as_ref().zip(place(0, index)).map(|(of, at)| of.coefficient(at, confidence));
            let correlated_with = self.correlated_with(index);
            let mut found = InputSensitivity {
                observable: observable.to_owned(),
                input: name.clone(),
                rows: self.rows as u64,
                pearson: correlated(&self.standardised[index], &scaled),
                spearman: correlated(&self.ranks[index], &ranked),
                partial_rank: partial,
                regression: coefficient.map(|of| {
                    let [lower, upper] = [of.lower, of.upper].map(|end| if end.is_finite() { end } else { f64::NAN });
                    Estimate { lower, upper, ..of }
                }),
                r_squared,
                first_order: self.first_order(index, y, false),
                parabola: both_vary.then(|| {
                    let of = |y: &[f64]| share_of_parabola(&self.standardised[index], y);
                    let ranks = if self.with_tails.contains(&true) { 0.0 } else { WEIGHT_OF_RANKS };
                    (1.0 - ranks) * of(&scaled) + ranks * of(&ranked)
                }),
                total: None,
                note: note(population, varies, input_varies, self.kept[0][index], correlated_with.as_ref()),
                correlated_with,
                p_value: p_values[index],
                direction: None,
                on_events: Vec::new(),
                instead: instead[index].clone(),
            };
            let alpha = 1.0 - confidence;
            if found.p_value.is_some() && found.drives_spread(alpha) {
                found.direction = self.tested[index].as_ref().and_then(|input| input.direction(y, alpha));
            }
            found
        };
        names.iter().enumerate().map(of_input).collect()
    }
}

/// True if an input has many values, and tails. Limits are higher than for the outcome, since one of many inputs may
/// exceed them by chance.
fn tails_of(values: &[f64], tested: Option<&TestedInput>) -> bool {
    tested.is_some_and(|tested| !tested.has_few_values()) && has_tails(values, [1.5; 2])
}

/// Evenness with which the samples of `plan` fill the space of inputs.
fn samples(plan: &Plan) -> Samples {
    match plan.design {
        Design::Sobol(_) | Design::Halton(_) => Samples::Even,
        _ => Samples::Independent,
    }
}

fn note(
    population: Population,
    varies: bool,
    input_varies: bool,
    is_independent: bool,
    correlated: Option<&(String, f64)>,
) -> Option<String> {
    let mut notes = Vec::new();
    if !varies {
        notes.push("the observable does not vary".to_owned());
    }
    if !input_varies {
        notes.push("the input does not vary".to_owned());
    } else if !is_independent {
        notes.push("a linear combination of the inputs before it: no regression".to_owned());
    }
    if let Some((other, r)) = correlated {
        notes.push(format!(
            "correlated with {other} (rank correlation {r:.2}): correlations and first-order index contain its effect, \
            and indices do not add up; the partial correlation holds it fixed"
        ));
    }
    match population {
        Population::Dependent(_) | Population::Replicated(_) => {
            notes.push("intervals are those of independent samples, mostly too wide for this design".to_owned());
        }
        Population::Chosen(LISTED) => notes.push(format!("chosen samples ({LISTED}): no population, no interval")),
        Population::Chosen(design) => notes.push(format!("design \"{design}\": no population, no interval")),
        Population::Independent | Population::Nominal | Population::Incomplete(_) => {}
    }
    (!notes.is_empty()).then(|| notes.join("; "))
}
