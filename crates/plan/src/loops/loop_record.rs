//! [`LoopRecord`]: a control loop's quantities over time at the observation points, for bands and requirements.
//!
//! A loop knows its errors at ticks and its torques at starts of arcs; an observation point gets the latest values. The
//! record is shared memory, because the engine owns the loops: the loop writes it, and the observer reads it after the
//! run.

use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use super::target::AttitudeError;
use crate::observables::{LawSeries, Series};

/// Quantities at a time.
#[derive(Clone, Copy, Debug)]
pub struct KnownOverTime {
    /// By index of the series in [`LawSeries`], except the pointing error; NaN if unknown.
    pub values: [f64; LawSeries::COUNT],
    /// The attitude error, if there is a target; its angle is computed at observation points only.
    pub error: Option<AttitudeError>,
}

/// Before the first tick.
pub const NOTHING_KNOWN: KnownOverTime = KnownOverTime { values: [f64::NAN; LawSeries::COUNT], error: None };

/// The index of `series`.
///
/// # Panics
/// Unless control loops record it.
pub fn place(series: Series) -> usize {
    LawSeries::place(series).expect("a control loop records the series")
}

#[derive(Debug)]
pub struct LoopRecord {
    times: Vec<f64>,
    /// First point without values.
    next: usize,
    known: KnownOverTime,
    /// By series, then by point.
    values: Vec<f64>,
}

/// A record shared by a loop and the observer of its run.
#[derive(Clone, Debug)]
pub struct SharedRecord(Arc<Mutex<LoopRecord>>);

impl SharedRecord {
    /// A record of runs observed at `times`, ascending.
    pub fn new(times: &[f64]) -> Self {
        let values = vec![f64::NAN; times.len() * LawSeries::COUNT];
        SharedRecord(Arc::new(Mutex::new(LoopRecord { times: times.to_vec(), next: 0, known: NOTHING_KNOWN, values })))
    }

    pub fn lock(&self) -> MutexGuard<'_, LoopRecord> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl LoopRecord {
    /// Clears the last run.
    pub fn restart(&mut self) {
        (self.next, self.known) = (0, NOTHING_KNOWN);
        self.values.fill(f64::NAN);
    }

    /// Sets the values from `time` on; times do not descend.
    pub fn take(&mut self, time: f64, known: &KnownOverTime) {
        self.fill_before(time);
        self.known = *known;
    }

    /// Values by series, then by point.
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
