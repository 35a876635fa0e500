//! [`Delayed`]: a filter that takes measurements of the past at their time.
//!
//! The last states are kept, with what they were propagated by and what was measured at each. A measurement that is
//! late is taken at its time, and all steps after it are made again: the estimate is that of a filter to which nothing
//! came late.

use std::collections::VecDeque;
use std::fmt::Debug;

use super::kalman::NormalizedSquare;

/// A filter that steps from tick to tick.
pub trait Filter: Clone {
    /// The input of a propagation over a tick.
    type Step: Clone + Debug;
    /// A measurement.
    type Observation: Clone + Debug;

    /// Moves on by a tick.
    fn propagate(&mut self, step: &Self::Step);

    /// Takes a measurement; the normalised square of the innovation. `None`, and nothing changes, where the filter is
    /// already certain.
    fn update(&mut self, observation: &Self::Observation) -> Option<NormalizedSquare>;
}

/// The state at one tick.
#[derive(Clone, Debug)]
struct Past<F: Filter> {
    /// The step that led to it; `None` at the start.
    step: Option<F::Step>,
    observations: Vec<F::Observation>,
    state: F,
}

/// A filter and its last states.
#[derive(Clone, Debug)]
pub struct Delayed<F: Filter> {
    past: VecDeque<Past<F>>,
    now: F,
    /// The largest age of a measurement, in ticks.
    oldest: usize,
}

impl<F: Filter> Delayed<F> {
    /// The filter `start`, for measurements of up to `oldest` ticks ago.
    pub fn new(start: F, oldest: usize) -> Self {
        let first = Past { step: None, observations: Vec::new(), state: start.clone() };
        Delayed { past: VecDeque::from([first]), now: start, oldest }
    }

    /// The state at this tick.
    pub fn now(&self) -> &F {
        &self.now
    }

    /// The state `age` ticks ago, after all measurements of that time that have arrived; the oldest that is kept, where
    /// that is younger.
    pub fn at(&self, age: usize) -> &F {
        &self.past[self.past.len().saturating_sub(age + 1)].state
    }

    /// Moves on by a tick.
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

    /// Takes a measurement of `age` ticks ago. `None`, and nothing changes, where it is older than all that is kept, or
    /// the filter was already certain.
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
