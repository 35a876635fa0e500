//! Which input of a campaign matters for which observable, from the files of its rows.
//!
//! Correlations, regression and given-data indices from the runs that are `ok`, in the order of their samples; first-order and total indices of
//! Sobol from the blocks of a `saltelli` design. A pure function of plan and files.

use std::borrow::Cow;
use std::num::NonZeroUsize;
use std::sync::atomic::{AtomicBool, Ordering};

use crate::analysis::accumulator::Accumulator;
use crate::analysis::block_indices::of_blocks;
use crate::analysis::drivers::LEAST_SHARE;
use crate::analysis::effects::{Direction, OnEvent, TestedInput, on_event, on_spread};
use crate::analysis::event::Event;
use crate::analysis::observed::Observed;
use crate::analysis::outcomes::{named, outcomes};
use crate::analysis::part_columns::PartColumns;
use crate::analysis::population::{LISTED, Population};
use crate::campaign::Plan;
use crate::observables::headlines::headlines;
use crate::run::Status;
use crate::sampling::Design;
use crate::statistics::correlation::{
    Estimate, ascending_order, correlation, matrix, mid_ranks, mid_ranks_in_order, standardised,
};
use crate::statistics::regression::{Regressors, independent_inputs};
use crate::statistics::sensitivity::{Samples, first_order_index_in_order};
use crate::storage::parallel::in_parallel;
use crate::storage::rows_reader::RowsError;

/// Most rows for observables that a campaign file names.
pub const MOST_ROWS: usize = 65_536;
/// Most rows for the main observables, where the file names none.
const FEWER_ROWS: usize = 16_384;
/// A rank correlation of two inputs above this, and above what chance makes, is told.
const NOTABLE_CORRELATION: f64 = 0.05;
/// Standard deviations of a chance correlation, beyond which it is none: of 10,000 pairs one passes by chance in a thousand campaigns.
const CHANCE: f64 = 5.5;

/// The name of the outcome whether a run is computed: 1 where it is `ok`, else 0.
pub const COMPUTED: &str = "computed";

/// What one input means for one observable. What does not apply is `None`.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct InputSensitivity {
    /// The observable.
    pub observable: String,
    /// The input: a column of the rows, or for a `saltelli` design what one distribution disperses.
    pub input: String,
    /// Number of rows.
    pub rows: u64,
    /// Pearson's correlation.
    pub pearson: Option<Estimate>,
    /// Spearman's rank correlation.
    pub spearman: Option<Estimate>,
    /// Rank correlation with the other inputs held fixed.
    pub partial_rank: Option<Estimate>,
    /// Standardised regression coefficient.
    pub regression: Option<Estimate>,
    /// Share of the variance that the regression on all inputs explains, corrected for their number.
    pub r_squared: Option<Estimate>,
    /// First-order index: share of the variance that this input explains alone.
    pub first_order: Option<Estimate>,
    /// Total index: share that this input and its interactions explain.
    pub total: Option<Estimate>,
    /// Probability of an influence on the spread as strong as this one where no input has any, of all inputs together (Holm).
    pub p_value: Option<f64>,
    /// How the observable goes with the input, where it is a driver of the spread and the rows show it.
    pub direction: Option<Direction>,
    /// What the input means for an event of the observable.
    pub on_event: Option<OnEvent>,
    /// The input that it is most correlated with, and their rank correlation, where that is notable.
    pub correlated_with: Option<(String, f64)>,
    /// What to know about these numbers.
    pub note: Option<String>,
}

/// The names of the observables, and how many rows they are from.
fn wanted(plan: &Plan) -> (Vec<String>, usize) {
    let named = named(plan);
    if !named.is_empty() {
        return (named, MOST_ROWS);
    }
    let columns = plan.request().columns();
    let main = headlines(&plan.request()).into_iter().map(|index| columns[index].quantity.name().to_owned());
    let of_motion = outcomes(plan).into_iter().chain(main).fold(Vec::new(), |mut names: Vec<String>, name| {
        if !names.contains(&name) {
            names.push(name);
        }
        names
    });
    (of_motion, FEWER_ROWS)
}

/// The first rows of dispersed samples that are `ok`, in the order of the samples.
#[derive(Clone, Debug, Default)]
pub struct RowTable {
    pub(super) samples: Vec<u64>,
    pub(super) inputs: Vec<Vec<f64>>,
    pub(super) observables: Vec<Vec<f64>>,
}

/// Keeps the first rows: inputs, and the observables that a campaign file requires or names (the main ones, where it names none).
#[derive(Debug)]
pub struct FirstRows {
    inputs: Vec<String>,
    observed: Vec<Observed>,
    most: usize,
    /// Whether it keeps rows of all physical samples with whether each is computed, in place of observables.
    of_failures: bool,
    /// Whether the rows are there, so that no further part adds any.
    is_full: AtomicBool,
}

impl FirstRows {
    /// Of the campaign `plan`.
    pub fn new(plan: &Plan) -> Self {
        let (names, most) = wanted(plan);
        let observed = Observed::named(plan, names.iter().map(String::as_str));
        // the blocks of a `saltelli` design tell inputs by their places
        let (inputs, most) = match plan.design {
            Design::Saltelli(_) => (Vec::new(), MOST_ROWS),
            _ => (inputs(plan), most),
        };
        FirstRows { inputs, observed, most, of_failures: false, is_full: AtomicBool::new(false) }
    }

    /// Of the campaign `plan`, for what decides whether a run is computed.
    pub fn of_failures(plan: &Plan) -> Self {
        FirstRows { observed: Vec::new(), most: FEWER_ROWS, of_failures: true, ..Self::new(plan) }
    }
}

/// The names of the observables whose inputs are estimated; none where there are no inputs.
pub fn explained(plan: &Plan) -> Vec<String> {
    let observed = if inputs(plan).is_empty() { Vec::new() } else { FirstRows::new(plan).observed };
    observed.into_iter().map(|one| one.quantity.name().to_owned()).collect()
}

/// The columns of the inputs: what follows from other inputs by an expression is none.
fn inputs(plan: &Plan) -> Vec<String> {
    let columns = plan.dispersions.columns().iter().enumerate();
    let drawn = columns.filter(|(index, _)| plan.dispersions.expression_of(*index).is_none());
    drawn.map(|(_, column)| column.parameter.column_name(column.component)).collect()
}

impl Accumulator for FirstRows {
    type Whole = RowTable;
    type OfPart = RowTable;

    fn nothing(&self) -> RowTable {
        let empty = |count: usize| vec![Vec::new(); count];
        RowTable {
            samples: Vec::new(),
            inputs: empty(self.inputs.len()),
            observables: empty(self.observed.len() + usize::from(self.of_failures)),
        }
    }

    fn count(&self, part: &impl PartColumns) -> Result<RowTable, RowsError> {
        if self.is_full.load(Ordering::Relaxed) {
            return Ok(self.nothing());
        }
        let (samples, statuses) = (part.samples()?, part.statuses()?);
        let is_kept = |status| status == Status::Done || self.of_failures && status != Status::InvalidSample;
        let of_population = |row: &usize| samples[*row].0 > 0 && is_kept(statuses[*row]);
        let rows: Vec<usize> = (0..samples.len()).filter(of_population).take(self.most).collect();
        let taken = |column: Cow<'_, [f64]>| rows.iter().map(|row| column[*row]).collect::<Vec<f64>>();
        Ok(RowTable {
            samples: rows.iter().map(|row| samples[*row].0).collect(),
            inputs: self.inputs.iter().map(|name| part.numbers(name).map(taken)).collect::<Result<_, _>>()?,
            observables: match self.of_failures {
                true => vec![rows.iter().map(|row| f64::from(u8::from(statuses[*row] == Status::Done))).collect()],
                false => self.observed.iter().map(|one| one.column(part).map(taken)).collect::<Result<_, _>>()?,
            },
        })
    }

    fn merge(&self, whole: &mut RowTable, part: RowTable) {
        let left = self.most - whole.samples.len();
        whole.samples.extend(part.samples.into_iter().take(left));
        let columns = whole.inputs.iter_mut().chain(&mut whole.observables);
        columns
            .zip(part.inputs.into_iter().chain(part.observables))
            .for_each(|(mine, theirs)| mine.extend(theirs.into_iter().take(left)));
        self.is_full.store(whole.samples.len() == self.most, Ordering::Relaxed);
    }
}

/// What every input of `plan` means for the observables that its file requires or names (the main ones, where it names none), from its first rows.
pub fn compute(plan: &Plan, table: &RowTable, threads: Option<NonZeroUsize>) -> Vec<InputSensitivity> {
    let observed = FirstRows::new(plan).observed;
    let names: Vec<&str> = observed.iter().map(|one| one.quantity.name()).collect();
    of_table(plan, &names, table, threads)
}

/// What every input of `plan` means for whether a run is computed ([`COMPUTED`]), from the rows of [`FirstRows::of_failures`]; nothing where all are, or none.
pub fn of_failures(plan: &Plan, table: &RowTable, threads: Option<NonZeroUsize>) -> Vec<InputSensitivity> {
    let varies = table.observables.iter().any(|flags| flags.iter().any(|flag| *flag != flags[0]));
    if varies { of_table(plan, &[COMPUTED], table, threads) } else { Vec::new() }
}

fn of_table(plan: &Plan, names: &[&str], table: &RowTable, threads: Option<NonZeroUsize>) -> Vec<InputSensitivity> {
    if let Design::Saltelli(_) = plan.design {
        return of_blocks(plan, names, table);
    }
    let inputs = inputs(plan);
    let prepared = Prepared::new(table.inputs.clone(), threads);
    let of_observable = |(name, y): (&&str, &Vec<f64>)| prepared.explained(plan, &inputs, name, y);
    let work: Vec<_> = names.iter().zip(&table.observables).collect();
    in_parallel(work, threads, of_observable).into_iter().flatten().collect()
}

/// Inputs in all forms that are needed.
pub(super) struct Prepared {
    rows: usize,
    /// Which inputs vary and are no linear combination of those before them, as values and as ranks.
    kept: [Vec<bool>; 2],
    values: Vec<Vec<f64>>,
    standardised: Vec<Vec<f64>>,
    ranks: Vec<Vec<f64>>,
    /// Those that are kept; `None` where there are none.
    regressors: [Option<Regressors>; 2],
    orders: Vec<Vec<usize>>,
    /// For the tests.
    tested: Vec<Option<TestedInput>>,
    /// Rank correlations of the inputs.
    correlations: Vec<Vec<f64>>,
}

/// One input in the forms that follow from it alone.
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

impl Prepared {
    /// Of inputs with these values.
    pub(super) fn new(values: Vec<Vec<f64>>, threads: Option<NonZeroUsize>) -> Self {
        let forms = in_parallel(values.iter().collect(), threads, |input| Forms::of(input));
        let (mut scaled, mut ranks, mut orders, mut tested) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
        for form in forms {
            scaled.push(form.standardised);
            ranks.push(form.ranks);
            orders.push(form.order);
            tested.push(form.tested);
        }
        // of values and of ranks
        let of = |columns: &Vec<Vec<f64>>| {
            let kept = independent_inputs(columns);
            let inputs = columns.iter().zip(&kept).filter(|(_, kept)| **kept).map(|(column, _)| column.clone());
            let regressors = Some(inputs.collect()).filter(|inputs: &Vec<_>| !inputs.is_empty());
            (kept, regressors.and_then(Regressors::new))
        };
        let mut of_both = in_parallel(vec![&scaled, &ranks], threads, of).into_iter();
        let [(values_kept, of_values), (ranks_kept, of_ranks)] = [(); 2].map(|()| of_both.next().expect("both"));
        Prepared {
            rows: values.first().map_or(0, Vec::len),
            regressors: [of_values, of_ranks],
            correlations: matrix(&ranks),
            kept: [values_kept, ranks_kept],
            orders,
            tested,
            values,
            standardised: scaled,
            ranks,
        }
    }

    /// The notable correlation of input `index` with another.
    fn correlated_with(&self, index: usize, names: &[String]) -> Option<(String, f64)> {
        let others = self.correlations[index].iter().enumerate().filter(|(other, _)| *other != index);
        let (other, r) = others.max_by(|a, b| a.1.abs().total_cmp(&b.1.abs()))?;
        let chance = CHANCE / libm::sqrt(self.rows as f64);
        (r.abs() > chance.max(NOTABLE_CORRELATION)).then(|| (names[other].clone(), *r))
    }

    /// What every input means for an observable with the values `y`, NaN where a row has none: for its spread, and for the event of it.
    pub(super) fn explained(
        &self,
        plan: &Plan,
        names: &[String],
        observable: &str,
        y: &[f64],
    ) -> Vec<InputSensitivity> {
        let has_tests = !matches!(Population::of(plan), Population::Chosen(_) | Population::Nominal);
        let event = if has_tests { Event::of(plan, observable, y) } else { None };
        // the spread, and the event
        let asked = 1 + usize::from(event.as_ref().is_some_and(|(event, _)| !event.has_few_values));
        let tests = has_tests.then_some(asked);
        let mut found = if y.iter().all(|value| value.is_finite()) {
            self.sensitivities(plan, names, observable, y, tests)
        } else {
            // other rows have other ranks
            let rows: Vec<usize> = (0..y.len()).filter(|row| y[*row].is_finite()).collect();
            let y: Vec<f64> = rows.iter().map(|row| y[*row]).collect();
            let of_rows = |input: &Vec<f64>| rows.iter().map(|row| input[*row]).collect();
            let finite = Prepared::new(self.values.iter().map(of_rows).collect(), NonZeroUsize::new(1));
            finite.sensitivities(plan, names, observable, &y, tests)
        };
        if let Some((event, marked)) = event {
            let effects = self.on_event(plan, (event, &marked), asked);
            found.iter_mut().zip(effects).for_each(|(one, effect)| one.on_event = effect);
        }
        found
    }

    /// The effects on an event that occurs in the rows that are marked, one of `asked` questions.
    fn on_event(&self, plan: &Plan, (event, marked): (Event, &[bool]), asked: usize) -> Vec<Option<OnEvent>> {
        let confidence = plan.analysis.confidence;
        let indicator: Vec<f64> = marked.iter().map(|is_marked| f64::from(*is_marked)).collect();
        let scaled = standardised(&indicator);
        let share = |input: usize| {
            let (order, x) = (&self.orders[input], &self.values[input]);
            let first_order = first_order_index_in_order(order, x, &indicator, samples(plan), confidence);
            let spearman = (self.rows > 3).then(|| correlation(&self.ranks[input], &scaled, 0, confidence));
            InputSensitivity { first_order, spearman, ..InputSensitivity::default() }.influence()
        };
        on_event(&self.tested, (event, marked), share, asked, confidence)
    }

    /// What every input means for an observable with the values `y`, one of `asked` questions; without tests where that is `None`.
    fn sensitivities(
        &self,
        plan: &Plan,
        names: &[String],
        observable: &str,
        y: &[f64],
        asked: Option<usize>,
    ) -> Vec<InputSensitivity> {
        let confidence = plan.analysis.confidence;
        let population = Population::of(plan);
        let p_values = asked.map_or_else(|| vec![None; names.len()], |asked| on_spread(&self.tested, y, asked));
        let (scaled, ranked) = (standardised(y), standardised(&mid_ranks(y)));
        let varies = scaled.iter().any(|value| *value != 0.0);
        let regressor = |which: usize| self.regressors[which].as_ref().filter(|_| varies);
        let linear = regressor(0).and_then(|of| of.regression(&scaled));
        let rank = regressor(1).and_then(|of| of.regression(&ranked));
        let r_squared = linear.as_ref().map(|of| of.r_squared(confidence));
        let place = |which: usize, index: usize| {
            self.kept[which][index].then(|| self.kept[which][..index].iter().filter(|kept| **kept).count())
        };
        // chosen samples have correlations with each other, and none in a population
        let with_interval = |estimate: Estimate| match population {
            Population::Chosen(_) | Population::Nominal => Estimate { lower: f64::NAN, upper: f64::NAN, ..estimate },
            _ => estimate,
        };
        let of_input = |(index, name): (usize, &String)| {
            let input_varies = self.standardised[index].iter().any(|value| *value != 0.0);
            let is_asked = varies && input_varies && self.rows > 3;
            let correlated = |x: &[f64], y: &[f64]| is_asked.then(|| with_interval(correlation(x, y, 0, confidence)));
            let partial = rank.as_ref().zip(place(1, index)).map(|(of, at)| of.partial(at, confidence));
            let coefficient = linear.as_ref().zip(place(0, index)).map(|(of, at)| of.coefficient(at, confidence));
            let (order, x) = (&self.orders[index], &self.values[index]);
            let correlated_with = self.correlated_with(index, names);
            let mut found = InputSensitivity {
                observable: observable.to_owned(),
                input: name.clone(),
                rows: self.rows as u64,
                pearson: correlated(&self.standardised[index], &scaled),
                spearman: correlated(&self.ranks[index], &ranked),
                partial_rank: partial.map(with_interval),
                // an end that the rows do not bound is none
                regression: coefficient.map(with_interval).map(|of| {
                    let [lower, upper] = [of.lower, of.upper].map(|end| if end.is_finite() { end } else { f64::NAN });
                    Estimate { lower, upper, ..of }
                }),
                r_squared: r_squared.map(with_interval),
                first_order: first_order_index_in_order(order, x, y, samples(plan), confidence).map(with_interval),
                total: None,
                note: note(population, varies, input_varies, self.kept[0][index], correlated_with.as_ref()),
                correlated_with,
                p_value: p_values[index],
                direction: None,
                on_event: None,
            };
            let alpha = 1.0 - confidence;
            let is_driver = found.p_value.is_some_and(|p| p <= alpha)
                && found.influence().is_some_and(|influence| influence.value >= LEAST_SHARE);
            if is_driver && let Some(input) = &self.tested[index] {
                found.direction = input.direction(y, alpha);
            }
            found
        };
        names.iter().enumerate().map(of_input).collect()
    }
}

/// How the samples of `plan` fill the space of the inputs.
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
            "correlated with {other} (rank correlation {r:.2}): correlations and first-order index contain its effect, and indices do not add up; the partial correlation holds it fixed"
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
