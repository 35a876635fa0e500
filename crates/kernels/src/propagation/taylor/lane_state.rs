//! [`SeriesLane`]: progress of one lane in its run.

use super::period::Period;
use super::truncation::TruncationSums;
use crate::dynamics::gyrostat::{IMPULSE, IMPULSE_INTEGRAL, WITH_ANGLES, WITH_THRUST};
use crate::ode::{PACE_STEPS, is_out_of_reach};
use crate::run::Grid;

#[derive(Clone, Copy, Debug)]
pub struct SeriesLane {
    pub run: usize,
    /// Unit of time, s: a power of two near the time scale of the motion, so that conversions are exact.
    pub unit: f64,
    /// Start and end of the arc, s.
    pub start: f64,
    pub end: f64,
    pub is_last: bool,
    /// Length of the arc, units.
    pub length: f64,
    /// Next observation point to evaluate.
    pub point: usize,
    /// Step at which the arc began; series since then are kept during the search for a return.
    pub begun: usize,
    /// Steps of the run before the arc.
    pub steps_before: u64,
    /// Largest number of periods by which an arc of the run is unfolded, at least one.
    pub periods: f64,
    /// True during the search for a return.
    pub is_searching: bool,
    /// Set while the lane waits for its points to be evaluated with those of other lanes.
    pub waiting: Option<Waiting>,
    /// Quadrature states (components without series of their own) at the start of the arc.
    pub quadratures: [f64; QUADRATURES],
}

#[derive(Clone, Copy, Debug)]
pub struct Waiting {
    /// The period; `None` if the run ended before one was found.
    pub period: Option<Period>,
    /// Step after which the lane began to wait.
    pub since: usize,
    /// Truncation of the run's steps up to then.
    pub truncation: TruncationSums,
}

/// Number of components without series of their own.
pub const QUADRATURES: usize = WITH_THRUST - WITH_ANGLES;

impl SeriesLane {
    pub fn new(run: usize, unit: f64, clock: usize) -> Self {
        SeriesLane {
            run,
            unit,
            start: 0.0,
            end: 0.0,
            is_last: false,
            length: 0.0,
            point: 0,
            begun: clock,
            steps_before: 0,
            periods: 1.0,
            is_searching: false,
            waiting: None,
            quadratures: [0.0; QUADRATURES],
        }
    }

    /// Step up to which the lane waits for most of the others.
    pub fn patience(&self, waiting: &Waiting) -> usize {
        waiting.since + 2 + (waiting.since - self.begun) / 4
    }

    pub fn steps(&self, clock: usize) -> u64 {
        let until = self.waiting.map_or(clock, |waiting| waiting.since);
        self.steps_before + (until - self.begun) as u64
    }

    /// Step after `clock` at which [`SeriesLane::gives_up`] is next checked.
    pub fn judged(&self, clock: usize, max_steps: u64) -> u64 {
        let begun = self.begun as u64;
        let limit = begun.saturating_add(max_steps.saturating_sub(self.steps_before));
        if (clock as u64) < begun + PACE_STEPS { limit.min(begun + PACE_STEPS) } else { limit }
    }

    /// True if the run has used up its steps or cannot reach the end of the arc with the rest.
    pub fn gives_up(&self, clock: usize, time: f64, max_steps: u64) -> bool {
        let steps = self.steps(clock);
        let is_judged = steps - self.steps_before == PACE_STEPS;
        steps >= max_steps || is_judged && is_out_of_reach(max_steps - self.steps_before, time, self.length)
    }

    /// Next observation point since the start of the arc, units; infinite if none, or during the search for a return.
    pub fn next_point(&self, grid: &Grid) -> f64 {
        match grid.times().get(self.point) {
            Some(time) if !self.is_searching && (self.is_last || *time <= self.end) => (time - self.start) / self.unit,
            _ => f64::INFINITY,
        }
    }

    /// Quadrature states `time` units after the start of an arc without actuation.
    pub fn quadratures_after<const N: usize, const J: usize>(&self, time: f64) -> [f64; QUADRATURES] {
        let mut quadratures = self.quadratures;
        if N >= WITH_THRUST {
            for i in 0..3 {
                let path = IMPULSE_INTEGRAL + i - J;
                quadratures[path] = time.mul_add(self.quadratures[IMPULSE + i - J], quadratures[path]);
            }
        }
        quadratures
    }
}
