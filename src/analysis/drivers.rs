//! What drives an outcome: the ranking of its inputs, for its spread and for an event of it. What screen, cards and charts say follows from
//! [`rankings`] alone.

use crate::analysis::effects::Dependence;
use crate::analysis::event::{Event, Occurs};
use crate::analysis::input_sensitivity::{InputSensitivity, LEAST_SHARE};
use crate::statistics::correlation::Estimate;

impl InputSensitivity {
    /// How strongly the input acts on the observable, as a share of its variance: the total index, where the design gives it; else the larger
    /// one of the first-order index and of the squared rank correlation, of those whose interval is above zero where one is.
    ///
    /// The first-order index alone sees that |x| matters where positive and negative x do the same, the rank correlation weak monotone influences.
    pub fn influence(&self) -> Option<Estimate> {
        let squared = self.spearman.map(|r| {
            let [lower, upper] = [r.lower * r.lower, r.upper * r.upper];
            let least = if r.lower * r.upper < 0.0 { 0.0 } else { lower.min(upper) };
            let ends = if lower.is_nan() { [f64::NAN; 2] } else { [least, lower.max(upper)] };
            Estimate { value: r.value * r.value, lower: ends[0], upper: ends[1] }
        });
        let rank = |one: &Estimate, other: &Estimate| {
            (one.lower > 0.0).cmp(&(other.lower > 0.0)).then(one.value.total_cmp(&other.value))
        };
        self.total.or_else(|| [self.first_order, squared].into_iter().flatten().max_by(rank))
    }
}

/// Least risk ratio, or its inverse, of a value that is called a driver of an event: of many runs small ratios are certain, and matter to nobody.
const LEAST_RATIO: f64 = 1.5;
/// The same of the chance of [`Dependence::Shift`], as its distance from one half.
const LEAST_CHANCE: f64 = 0.1;

/// What is asked of an outcome.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Question {
    /// What its spread comes from.
    Spread,
    /// What decides whether an event occurs.
    Event(Event),
}

/// An input in a ranking.
#[derive(Clone, Copy, Debug)]
pub struct Ranked<'a> {
    pub input: &'a InputSensitivity,
    /// Its share of the variance: of the outcome, or of whether the event occurs.
    pub share: Estimate,
    /// Whether the rows show that it acts, and that it matters.
    pub is_driver: bool,
}

/// The inputs of an outcome: first its drivers, then the others, each the greatest share first.
#[derive(Clone, Debug)]
pub struct Ranking<'a> {
    pub question: Question,
    pub inputs: Vec<Ranked<'a>>,
}

impl<'a> Ranking<'a> {
    pub fn drivers(&self) -> impl Iterator<Item = &Ranked<'a>> {
        self.inputs.iter().filter(|ranked| ranked.is_driver)
    }
}

/// The rankings of an outcome: of an event, where it has one, and of its spread, unless it has few values and the event is its spread. The tail is
/// asked only where something drives it that does not drive the spread. `alpha`: the probability that an outcome without any influence has a driver.
pub fn rankings<'a>(all: &'a [InputSensitivity], outcome: &str, alpha: f64) -> Vec<Ranking<'a>> {
    let of = || all.iter().filter(|one| one.observable == outcome);
    let on_event = |input: &'a InputSensitivity| {
        let effect = input.on_event.as_ref()?;
        let matters = match &effect.dependence {
            Dependence::Levels { ratio, .. } => !(1.0 / LEAST_RATIO..LEAST_RATIO).contains(&ratio.value),
            Dependence::Shift { chance, .. } | Dependence::Distance { chance } => (chance - 0.5).abs() >= LEAST_CHANCE,
        };
        Some(Ranked { input, share: effect.share, is_driver: matters && effect.p_value <= alpha })
    };
    let on_spread = |input: &'a InputSensitivity| {
        let share = input.influence()?;
        // a design without a population has neither tests nor intervals: the shares decide
        let is_shown = match input.p_value {
            Some(p_value) => p_value <= alpha,
            None => share.lower > 0.0 || share.lower.is_nan() && share.upper.is_nan(),
        };
        Some(Ranked { input, share, is_driver: is_shown && share.value >= LEAST_SHARE })
    };
    let sorted = |mut inputs: Vec<Ranked<'a>>| {
        inputs.sort_by(|a, b| b.is_driver.cmp(&a.is_driver).then(b.share.value.total_cmp(&a.share.value)));
        inputs
    };
    let event = of().find_map(|one| one.on_event.as_ref()).map(|effect| effect.event);
    let has_spread = event.is_none_or(|event| !event.has_few_values);
    let spread = sorted(if has_spread { of().filter_map(on_spread).collect() } else { Vec::new() });
    let mut found = Vec::new();
    if let Some(event) = event {
        let inputs = sorted(of().filter_map(on_event).collect());
        let drives_spread = |name: &str| spread.iter().any(|ranked| ranked.is_driver && ranked.input.input == name);
        let is_new = |ranked: &Ranked<'_>| ranked.is_driver && !drives_spread(&ranked.input.input);
        if !matches!(event.occurs, Occurs::Worst(_)) || inputs.iter().any(is_new) {
            found.push(Ranking { question: Question::Event(event), inputs });
        }
    }
    if !spread.is_empty() {
        found.push(Ranking { question: Question::Spread, inputs: spread });
    }
    found
}
