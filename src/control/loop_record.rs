//! [`LoopRecord`]: what a control loop records at the observation points: the quantities over time of bands and
//! requirements.
//!
//! A loop knows its errors at its ticks and its torques at the starts of arcs; an observation point has what was known
//! last. The engine holds the loops of the runs that it flies, so that a record is shared memory: the loop writes it,
//! and whoever observes the run reads it when the run has ended.

use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use crate::control::guidance::target::AttitudeError;
use crate::observables::{LawSeries, Series};

/// What is known at a time.
#[derive(Clone, Copy, Debug)]
pub struct KnownOverTime {
    /// By the place of the series in [`LawSeries`], but for the pointing error; NaN where it is not known.
    pub values: [f64; LawSeries::COUNT],
    /// The pointing error, whose angle is computed at observation points only; `None` without a target.
    pub error: Option<AttitudeError>,
}

/// Nothing is known.
pub const NOTHING_KNOWN: KnownOverTime = KnownOverTime { values: [f64::NAN; LawSeries::COUNT], error: None };

/// The place of `series`.
///
/// # Panics
/// Where no control loop records it.
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
    /// Of runs observed at `times`, s, ascending.
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

#[cfg(test)]
mod tests {
    use super::*;

    /// Law: a point has what was known last at its time or before, NaN before the first; the next run begins anew.
    #[test]
    fn a_point_has_what_was_known_last() {
        let record = SharedRecord::new(&[0.0, 0.3, 0.5, 1.0, 2.0]);
        let value = |record: &SharedRecord, series: Series| -> Vec<f64> {
            record.lock().values()[5 * LawSeries::place(series).unwrap()..][..5].to_vec()
        };
        let known = |error: f64, torque: f64| {
            let mut known = NOTHING_KNOWN;
            let [w, x] = [libm::cos(0.05 * error), libm::sin(0.05 * error)];
            known.error = Some(AttitudeError { q_ts: [w, x, 0.0, 0.0], ..AttitudeError::NONE });
            known.values[place(Series::MotorTorque.of_wheel(7))] = torque;
            known
        };
        for (time, error) in [(0.2, 1.0), (0.5, 2.0), (0.5, 3.0), (0.9, 4.0), (1.5, 5.0)] {
            record.lock().take(time, &known(error, -error));
        }
        let errors = value(&record, Series::PointingError);
        assert!(errors[0].is_nan());
        for (found, expected) in errors[1..].iter().zip([1.0, 3.0, 4.0, 5.0]) {
            // a tenth of it, as an angle of a quaternion: some roundings
            assert!((10.0 * found - expected).abs() < 1e-14, "{found} {expected}");
        }
        assert_eq!(value(&record, Series::MotorTorque.of_wheel(7))[1..], [-1.0, -3.0, -4.0, -5.0]);
        assert!(value(&record, Series::MotorTorque).iter().all(|torque| torque.is_nan()));
        record.lock().restart();
        record.lock().take(0.0, &known(6.0, 7.0));
        assert!(value(&record, Series::PointingError).iter().all(|error| (10.0 * error - 6.0).abs() < 1e-14));
    }
}
