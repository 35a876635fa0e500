//! [`Delayed`]: a filter that applies late measurements at the time they were taken.
//!
//! It keeps its last states with their inputs; a late measurement is applied to its state and all later steps are
//! repeated. The estimate equals that of a filter without latency.

use std::collections::VecDeque;

use super::kalman::NormalizedSquare;

/// A filter that steps from tick to tick.
pub trait Filter: Clone {
    type Step;
    type Observation;

    fn propagate(&mut self, step: &Self::Step);

    /// Applies a measurement; the normalised square of its innovation. `None`, with no change, if the innovation's
    /// covariance is singular to rounding.
    fn update(&mut self, observation: &Self::Observation) -> Option<NormalizedSquare>;
}

struct Past<F: Filter> {
    /// The step that led to it; `None` at the start.
    step: Option<F::Step>,
    observations: Vec<F::Observation>,
    state: F,
}

pub struct Delayed<F: Filter> {
    /// From the oldest state kept to that of this tick.
    past: VecDeque<Past<F>>,
    /// Largest age of a measurement, ticks.
    oldest: usize,
    pub innovations: Innovations,
}

/// Normalised squares of innovations.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Innovations {
    /// Sum of this tick's.
    pub of_tick: Option<NormalizedSquare>,
    /// Sum and number of squares per degree of freedom since the start.
    pub sum: f64,
    pub count: f64,
}

impl<F: Filter> Delayed<F> {
    /// Starts at `start`, for measurements up to `oldest` ticks old.
    pub fn new(start: F, oldest: usize) -> Self {
        let first = Past { step: None, observations: Vec::new(), state: start };
        Delayed { past: VecDeque::from([first]), oldest, innovations: Innovations::default() }
    }

    /// The state `age` ticks ago, after all measurements delivered since; the oldest kept if that is younger.
    pub fn at(&self, age: usize) -> &F {
        &self.past[self.past.len().saturating_sub(age + 1)].state
    }

    pub fn propagate(&mut self, step: F::Step) {
        self.innovations.of_tick = None;
        let mut state = self.at(0).clone();
        state.propagate(&step);
        let mut observations = Vec::new();
        if self.past.len() > self.oldest
            && let Some(first) = self.past.pop_front()
        {
            observations = first.observations;
            observations.clear();
        }
        self.past.push_back(Past { step: Some(step), observations, state });
    }

    /// Applies a measurement `age` ticks old, unless it is older than all kept states or its innovation's covariance is
    /// singular to rounding.
    pub fn update(&mut self, observation: F::Observation, age: usize) {
        let Some(index) = self.past.len().checked_sub(age + 1) else { return };
        let at = &mut self.past[index];
        let Some(square) = at.state.update(&observation) else { return };
        at.observations.push(observation);
        let mut state = at.state.clone();
        for past in self.past.range_mut(index + 1..) {
            if let Some(step) = &past.step {
                state.propagate(step);
            }
            for observation in &past.observations {
                state.update(observation);
            }
            past.state = state.clone();
        }
        let Innovations { of_tick, sum, count } = &mut self.innovations;
        (*sum, *count) = (*sum + square.value / square.degrees as f64, *count + 1.0);
        *of_tick = Some(of_tick.map_or(square, |before| before.with(square)));
    }
}
