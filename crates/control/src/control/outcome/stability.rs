//! [`Stability`]: settling time of a mission, and relative performance error over a window.
//!
//! Source: ECSS-E-ST-60-10C, *Control performance*, 2008, section 3.2: the performance error e(t) is the rotation
//! vector from the target to the true attitude; the relative one is e(t) less its mean over the interval.

use crate::control::parameters::LoopNumbers;
use crate::loops::vector::norm;

pub struct Stability {
    /// Time since which the error has been in the band, in whatever phase, s; NaN outside it.
    pub settled_since: f64,
    /// Start of the window, s; NaN before it.
    start: f64,
    last: f64,
    count: f64,
    /// By body axis, rad: mean, sum of squared deviations, smallest and largest value.
    mean: [f64; 3],
    squares: [f64; 3],
    extremes: [[f64; 2]; 3],
}

impl Stability {
    pub const NONE: Stability = Stability {
        settled_since: f64::NAN,
        start: f64::NAN,
        last: f64::NAN,
        count: 0.0,
        mean: [0.0; 3],
        squares: [0.0; 3],
        extremes: [[f64::INFINITY, f64::NEG_INFINITY]; 3],
    };

    /// Adds a tick with the error `error`, rad; `None` in a phase without a target.
    pub fn tick(&mut self, time: f64, error: Option<[f64; 3]>, numbers: &LoopNumbers, period: f64) {
        let LoopNumbers { stability_from: from, stability_window: length, settling_band, .. } = *numbers;
        let is_settled = error.is_some_and(|error| norm(error) <= settling_band);
        if !is_settled {
            self.settled_since = f64::NAN;
        } else if self.settled_since.is_nan() {
            self.settled_since = time;
        }
        let start = if from > 0.0 { from } else { self.settled_since };
        if start.to_bits() != self.start.to_bits() {
            // leaving or re-entering the band starts a new window
            *self = Stability { settled_since: self.settled_since, start, ..Stability::NONE };
        }
        self.last = time;
        let slack = 1e-9 * period;
        if !(time >= start - slack && (length == 0.0 || time < start + length - slack)) {
            return;
        }
        // without a target the window's statistics are NaN
        let error = error.unwrap_or([f64::NAN; 3]);
        self.count += 1.0;
        for (axis, error) in error.into_iter().enumerate() {
            // B. P. Welford, Technometrics 4(3), 1962
            let departure = error - self.mean[axis];
            self.mean[axis] += departure / self.count;
            self.squares[axis] += departure * (error - self.mean[axis]);
            let [low, high] = &mut self.extremes[axis];
            (*low, *high) = (low.min(error), high.max(error));
        }
    }

    /// Root mean square magnitude and largest peak to peak about any body axis of the relative performance error over
    /// the window of the length `length` (s; zero for an endless one, which needs two ticks), rad. NaN unless the run,
    /// whose last tick lasts one period, has reached its end.
    pub fn relative_error(&self, length: f64, period: f64) -> [f64; 2] {
        let reached = self.last + (1.0 + 1e-9) * period;
        let is_complete =
            if length == 0.0 { self.count >= 2.0 } else { self.count >= 1.0 && reached >= self.start + length };
        let rms = (self.squares.iter().sum::<f64>() / self.count).sqrt();
        if !is_complete || rms.is_nan() {
            return [f64::NAN; 2];
        }
        [rms, self.extremes.iter().fold(0.0, |most: f64, [low, high]| most.max(high - low))]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const PERIOD: f64 = 0.1;

    /// Settling time, rms and peak to peak of `errors`, one per tick, over the window from `from` of length `length`.
    fn found(errors: &[Option<[f64; 3]>], from: f64, length: f64) -> [f64; 3] {
        let mut stability = Stability::NONE;
        let (delay, saturation_timeout) = (0.0, 0.0);
        let (settling_band, stability_from, stability_window) = (0.02, from, length);
        let numbers = LoopNumbers { delay, settling_band, stability_from, stability_window, saturation_timeout };
        for (tick, error) in errors.iter().enumerate() {
            stability.tick(tick as f64 * PERIOD, *error, &numbers, PERIOD);
        }
        let [rms, peak_to_peak] = stability.relative_error(length, PERIOD);
        [stability.settled_since, rms, peak_to_peak]
    }

    /// A jittery error that decays to an offset, within the band from tick 35 on.
    fn settling() -> Vec<Option<[f64; 3]>> {
        let error = |tick: usize| {
            let t = tick as f64 * PERIOD;
            [0.3 * libm::exp(-t) + 1e-3 * libm::sin(7.0 * t), 0.005 + 2e-3 * libm::cos(3.0 * t), -1e-3 * t / 20.0]
        };
        (0..200).map(|tick| Some(error(tick))).collect()
    }

    /// Law: an incomplete window, or one with a phase without a target, has no value.
    #[test]
    fn a_window_is_complete_or_has_no_value() {
        let mut errors = settling();
        for (from, length) in [(19.0, 1.1), (0.0, 18.0), (30.0, 0.0), (20.0, 1.0)] {
            assert!(found(&errors, from, length)[1..].iter().all(|value| value.is_nan()), "{from} {length}");
        }
        errors[40] = None;
        assert!(found(&errors, 1.0, 4.0)[1..].iter().all(|value| value.is_nan()));
        assert!(found(&errors, 5.0, 4.0)[1..].iter().all(|value| value.is_finite()));
        // re-entering the band restarts the window
        assert_eq!(found(&errors, 0.0, 0.0)[0], 41.0 * PERIOD);
    }
}
