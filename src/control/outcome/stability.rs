//! [`Stability`]: settling time of a mission, and relative performance error over a window.
//!
//! Source: ECSS-E-ST-60-10C, *Control performance*, 2008, section 3.2: the performance error e(t) is the rotation
//! vector from the target to the true attitude; the relative one is e(t) less its mean over the interval.

use super::criteria::MissionCriteria;
use crate::control::vector::norm;

#[derive(Clone, Copy, Debug)]
pub struct Stability {
    /// Time since which the error has been in the band, in whatever phase, s; NaN outside it.
    settled_since: f64,
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
    pub fn tick(&mut self, time: f64, error: Option<[f64; 3]>, criteria: &MissionCriteria) {
        let [from, length] = criteria.stability;
        let is_settled = error.is_some_and(|error| norm(error) <= criteria.settling_band);
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
        let slack = 1e-9 * criteria.period;
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

    /// Time since which the mission has been settled, s; NaN if it is not.
    pub fn settled_since(&self) -> f64 {
        self.settled_since
    }

    /// Root mean square magnitude of the relative performance error over the window, rad; NaN unless completed.
    pub fn rms(&self, criteria: &MissionCriteria) -> f64 {
        if self.is_complete(criteria) { (self.squares.iter().sum::<f64>() / self.count).sqrt() } else { f64::NAN }
    }

    /// Largest peak to peak of the error about any body axis over the window, rad; NaN unless completed.
    pub fn peak_to_peak(&self, criteria: &MissionCriteria) -> f64 {
        if !self.is_complete(criteria) || self.squares.iter().any(|square| square.is_nan()) {
            return f64::NAN;
        }
        self.extremes.iter().fold(0.0, |most: f64, [low, high]| most.max(high - low))
    }

    /// True if the run has reached the end of the window, the last tick lasting one period; an endless window needs two
    /// ticks.
    fn is_complete(&self, criteria: &MissionCriteria) -> bool {
        let [_, length] = criteria.stability;
        let reached = self.last + (1.0 + 1e-9) * criteria.period;
        if length == 0.0 { self.count >= 2.0 } else { self.count >= 1.0 && reached >= self.start + length }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::control::net_launch::geometry::LaunchState;
    use crate::control::net_launch::launch::PlumeCone;

    const PERIOD: f64 = 0.1;

    fn criteria(from: f64, length: f64) -> MissionCriteria {
        MissionCriteria {
            launch: LaunchState { distance: 10.0, least_speed: 0.01, approach_axis: [0.0; 3], mu: None },
            keep_out: 0.0,
            plume: PlumeCone { range: 0.0, half_angle: 0.0 },
            settling_band: 0.02,
            stability: [from, length],
            period: PERIOD,
            isp: 0.0,
        }
    }

    /// Settling time, rms and peak to peak of `errors`, one per tick.
    fn found(errors: &[Option<[f64; 3]>], criteria: &MissionCriteria) -> [f64; 3] {
        let mut stability = Stability::NONE;
        for (tick, error) in errors.iter().enumerate() {
            stability.tick(tick as f64 * PERIOD, *error, criteria);
        }
        [stability.settled_since(), stability.rms(criteria), stability.peak_to_peak(criteria)]
    }

    /// A jittery error that decays to an offset, within the band from tick 35 on.
    fn settling() -> Vec<Option<[f64; 3]>> {
        let error = |tick: usize| {
            let t = tick as f64 * PERIOD;
            [0.3 * libm::exp(-t) + 1e-3 * libm::sin(7.0 * t), 0.005 + 2e-3 * libm::cos(3.0 * t), -1e-3 * t / 20.0]
        };
        (0..200).map(|tick| Some(error(tick))).collect()
    }

    /// Law: a mission has settled once its error stays in the band to the end, whatever the phase; a tick without a
    /// target is not settled.
    #[test]
    fn a_mission_settles_where_the_error_stays_in_the_band() {
        let mut errors = settling();
        let first = (0..200).find(|tick| errors[*tick..].iter().flatten().all(|error| norm(*error) <= 0.02)).unwrap();
        assert!((20..40).contains(&first));
        let plain = criteria(0.0, 0.0);
        assert_eq!(found(&errors, &plain)[0], first as f64 * PERIOD);
        errors[120] = Some([0.0, 0.021, 0.0]);
        assert_eq!(found(&errors, &plain)[0], 121.0 * PERIOD);
        errors[150] = None;
        assert_eq!(found(&errors, &plain)[0], 151.0 * PERIOD);
        errors[199] = Some([0.0, 0.0, 0.03]);
        assert!(found(&errors, &plain).iter().all(|value| value.is_nan()));
    }

    /// Law: an incomplete window, or one with a phase without a target, has no value.
    #[test]
    fn a_window_is_complete_or_has_no_value() {
        let mut errors = settling();
        for (from, length) in [(19.0, 1.1), (0.0, 18.0), (30.0, 0.0), (20.0, 1.0)] {
            assert!(found(&errors, &criteria(from, length))[1..].iter().all(|value| value.is_nan()), "{from} {length}");
        }
        errors[40] = None;
        assert!(found(&errors, &criteria(1.0, 4.0))[1..].iter().all(|value| value.is_nan()));
        assert!(found(&errors, &criteria(5.0, 4.0))[1..].iter().all(|value| value.is_finite()));
        // re-entering the band restarts the window
        assert_eq!(found(&errors, &criteria(0.0, 0.0))[0], 41.0 * PERIOD);
    }
}
