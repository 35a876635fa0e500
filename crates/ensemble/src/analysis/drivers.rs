//! The ranking of the inputs of an outcome, for its spread and for its events; screen, cards and charts all use
//! [`rankings`].

use crate::analysis::effects::{Dependence, OnEvent};
use crate::analysis::event::{Event, Occurs};
use crate::analysis::input_sensitivity::InputSensitivity;
use crate::analysis::outcomes::unique;
use crate::statistics::correlation::Estimate;

/// Minimum share of the variance, or squared rank correlation, of a driver: removing it reduces the standard deviation
/// by 5%.
pub const LEAST_SHARE: f64 = 0.1;
/// Widest interval of a share that is shown.
const MOST_WIDTH: f64 = 0.7;

impl InputSensitivity {
    /// The total index if the design gives one, else the first-order index.
    pub fn share(&self) -> Option<Estimate> {
        self.total.or(self.first_order)
    }

    /// True if the rows show a notable effect on the spread at level `alpha`. Without a population, and so without
    /// tests and intervals, the shares decide.
    pub fn drives_spread(&self, alpha: f64) -> bool {
        let rank = self.spearman.map_or(0.0, |r| r.value * r.value);
        let is_shown = match (self.p_value, self.share()) {
            (Some(p_value), _) => p_value <= alpha,
            (None, share) => share.is_none_or(|share| share.lower > 0.0 || share.lower.is_nan()),
        };
        // a significant effect in few rows is not small
        let is_known = self.p_value.is_none() || self.share().is_some();
        is_shown && (!is_known || self.share().map_or(rank, |share| share.value.max(rank)) >= LEAST_SHARE)
    }
}

pub fn is_known(share: &Estimate) -> bool {
    share.upper - share.lower <= MOST_WIDTH
}

/// Minimum risk ratio, or its inverse, of a driver: with many runs small ratios become significant.
const LEAST_RATIO: f64 = 1.5;
/// Minimum distance from one half of the chance in [`Dependence::Shift`].
pub const LEAST_CHANCE: f64 = 0.1;

#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Question {
    Spread,
    Event(Event),
}

#[derive(Clone, Copy, Debug)]
pub struct Ranked<'a> {
    pub input: &'a InputSensitivity,
    /// `None` for a spread.
    pub effect: Option<&'a OnEvent>,
    /// Share of the variance of the outcome or event; `None` for too few rows.
    pub share: Option<Estimate>,
    pub is_driver: bool,
}

impl Ranked<'_> {
    pub fn instead(&self) -> Option<&str> {
        self.effect.map_or(&self.input.instead, |effect| &effect.instead).as_deref()
    }

    /// True if its share is known, or has no interval.
    fn has_share(&self) -> bool {
        self.share.is_some_and(|share| is_known(&share) || share.lower.is_nan())
    }

    /// Sort key: for a spread, shares if all are known (`by_share`), else the share that a parabola explains; for an
    /// event, its share, else its p-value.
    fn strength(&self, by_share: bool) -> f64 {
        let share = self.share.map(|share| share.value);
        let found = match self.effect {
            Some(effect) => share.or(Some(-effect.p_value)),
            None if by_share => share,
            None => self.input.parabola.or(share),
        };
        found.unwrap_or(f64::NEG_INFINITY)
    }
}

/// The inputs of an outcome: drivers first, each group in descending strength.
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

/// The rankings of an outcome for each of its events, and for its spread unless an event of few values is the spread.
/// The tail is ranked only if it has a new driver. `alpha`: the probability of a driver if nothing has an influence.
pub fn rankings<'a>(all: &'a [InputSensitivity], outcome: &str, alpha: f64) -> Vec<Ranking<'a>> {
    let of = || all.iter().filter(|one| one.observable == outcome);
    let on_event = |input: &'a InputSensitivity, event: Event| {
        let effect = input.on_events.iter().find(|effect| effect.event == event)?;
        let matters = match &effect.dependence {
            Dependence::Levels { ratio, .. } => !(1.0 / LEAST_RATIO..LEAST_RATIO).contains(&ratio.value),
            Dependence::Shift { chance, .. } | Dependence::Distance { chance } => (chance - 0.5).abs() >= LEAST_CHANCE,
        };
        let is_driver = matters && effect.p_value <= alpha;
        Some(Ranked { input, effect: Some(effect), share: effect.share, is_driver })
    };
    let on_spread = |input: &'a InputSensitivity| Ranked {
        input,
        effect: None,
        share: input.share(),
        is_driver: input.drives_spread(alpha),
    };
    let sorted = |mut inputs: Vec<Ranked<'a>>| {
        let by_share = inputs.iter().filter(|one| one.is_driver).all(Ranked::has_share);
        let strength = |one: &Ranked<'_>| one.strength(by_share);
        inputs.sort_by(|a, b| b.is_driver.cmp(&a.is_driver).then_with(|| strength(b).total_cmp(&strength(a))));
        inputs
    };
    let events = unique(of().flat_map(|one| &one.on_events).map(|effect| effect.event));
    let has_spread = events.iter().all(|event| !event.has_few_values);
    let spread = sorted(if has_spread { of().map(on_spread).collect() } else { Vec::new() });
    let mut found = Vec::new();
    for event in events {
        let inputs = sorted(of().filter_map(|input| on_event(input, event)).collect());
        let drives_spread = |name: &str| spread.iter().any(|ranked| ranked.is_driver && ranked.input.input == name);
        // inputs that the rows do not separate from drivers of the spread are not new
        let is_known =
            |ranked: &Ranked<'_>| drives_spread(&ranked.input.input) || ranked.instead().is_some_and(drives_spread);
        let is_new = |ranked: &Ranked<'_>| ranked.is_driver && !is_known(ranked);
        if !matches!(event.occurs, Occurs::Worst(_)) || inputs.iter().any(is_new) {
            found.push(Ranking { question: Question::Event(event), inputs });
        }
    }
    if !spread.is_empty() {
        found.push(Ranking { question: Question::Spread, inputs: spread });
    }
    found
}
