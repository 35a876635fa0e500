//! [`Delayed`]: a filter that applies late measurements at the time they were taken.
//!
//! It keeps its last states with their inputs; a late measurement is applied to its state and all later steps are
//! repeated. The estimate equals that of a filter without latency.

use std::collections::VecDeque;
use std::fmt::Debug;

use super::kalman::NormalizedSquare;

/// A filter that steps from tick to tick.
pub trait Filter: Clone {
    type Step: Clone + Debug;
    type Observation: Clone + Debug;

    fn propagate(&mut self, step: &Self::Step);

    /// Applies a measurement; the normalised square of its innovation. `None`, with no change, if the innovation's
    /// covariance is singular to rounding.
    fn update(&mut self, observation: &Self::Observation) -> Option<NormalizedSquare>;
}

#[derive(Clone, Debug)]
struct Past<F: Filter> {
    /// The step that led to it; `None` at the start.
    step: Option<F::Step>,
    observations: Vec<F::Observation>,
    state: F,
}

#[derive(Clone, Debug)]
pub struct Delayed<F: Filter> {
    past: VecDeque<Past<F>>,
    now: F,
    /// Largest age of a measurement, ticks.
    oldest: usize,
}

impl<F: Filter> Delayed<F> {
    /// Starts at `start`, for measurements up to `oldest` ticks old.
    pub fn new(start: F, oldest: usize) -> Self {
        let first = Past { step: None, observations: Vec::new(), state: start.clone() };
        Delayed { past: VecDeque::from([first]), now: start, oldest }
    }

    pub fn now(&self) -> &F {
        &self.now
    }

    /// The state `age` ticks ago, after all measurements delivered since; the oldest kept if that is younger.
    pub fn at(&self, age: usize) -> &F {
        &self.past[self.past.len().saturating_sub(age + 1)].state
    }

    pub fn propagate(&mut self, step: F::Step) {
        self.now.propagate(&step);
        let mut observations = Vec::new();
        if self.past.len() > self.oldest
            && let Some(first) = self.past.pop_front()
        {
            observations = first.observations;
            observations.clear();
        }
        self.past.push_back(Past { step: Some(step), observations, state: self.now.clone() });
    }

    /// Applies a measurement `age` ticks old. `None`, with no change, if it is older than all kept states or its
    /// innovation's covariance is singular to rounding.
    pub fn update(&mut self, observation: F::Observation, age: usize) -> Option<NormalizedSquare> {
        let index = self.past.len().checked_sub(age + 1)?;
        let at = &mut self.past[index];
        let square = at.state.update(&observation)?;
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
        self.now = state;
        Some(square)
    }
}
