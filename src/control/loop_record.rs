//! [`LoopRecord`]: what a control loop records at the observation points: the quantities over time of bands and
//! requirements.
//!
//! A loop knows its errors at its ticks and its torques at the starts of arcs; an observation point has what was known
//! last. The engine holds the loops of the runs that it flies, so that a record is shared memory: the loop writes it,
//! and whoever observes the run reads it when the run has ended.

use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use crate::control::guidance::target::AttitudeError;
use crate::observables::{LawSeries, Series};

/// The quantities at a time.
#[derive(Clone, Copy, Debug)]
pub struct KnownOverTime {
    /// By the place of the series in [`LawSeries`], but for the pointing error; NaN where it is not known.
    pub values: [f64; LawSeries::COUNT],
    /// The pointing error, whose angle is computed at observation points only; `None` without a target.
    pub error: Option<AttitudeError>,
}

/// Before the first tick.
pub const NOTHING_KNOWN: KnownOverTime = KnownOverTime { values: [f64::NAN; LawSeries::COUNT], error: None };

/// The place of `series`.
///
/// # Panics
/// If no control loop records it.
pub fn place(series: Series) -> usize {
    LawSeries::place(series).expect("a control loop records the series")
}

/// The record of one run.
#[derive(Debug)]
pub struct LoopRecord {
    times: Vec<f64>,
    /// The first point without values.
    next: usize,
    known: KnownOverTime,
    /// Series by series and point by point.
    values: Vec<f64>,
}

/// A record that a loop and the observer of its run share.
#[derive(Clone, Debug)]
pub struct SharedRecord(Arc<Mutex<LoopRecord>>);

impl SharedRecord {
    /// A record of runs observed at `times`, s, ascending.
    pub fn new(times: &[f64]) -> Self {
        let values = vec![f64::NAN; times.len() * LawSeries::COUNT];
        SharedRecord(Arc::new(Mutex::new(LoopRecord { times: times.to_vec(), next: 0, known: NOTHING_KNOWN, values })))
    }

    /// The record, as long as what is returned lives.
    pub fn lock(&self) -> MutexGuard<'_, LoopRecord> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl LoopRecord {
    /// Clears what an earlier run has left.
    pub fn restart(&mut self) {
        (self.next, self.known) = (0, NOTHING_KNOWN);
        self.values.fill(f64::NAN);
    }

    /// `known` is what is known from `time` on, s; times do not descend.
    pub fn take(&mut self, time: f64, known: &KnownOverTime) {
        self.fill_before(time);
        self.known = *known;
    }

    /// The values at all points, series by series and point by point.
    pub fn values(&mut self) -> &[f64] {
        self.fill_before(f64::INFINITY);
        &self.values
    }

    fn fill_before(&mut self, time: f64) {
        let points = self.times.len();
        if self.next == points || self.times[self.next] >= time {
            return;
        }
        let mut known = self.known.values;
        known[place(Series::PointingError)] = self.known.error.map_or(f64::NAN, |error| error.angle());
        while self.next < points && self.times[self.next] < time {
            for (place, value) in known.iter().enumerate() {
                self.values[place * points + self.next] = *value;
            }
            self.next += 1;
        }
    }
}
