//! Stopping once a quantile is known well enough, with looks at growing numbers of runs.
//!
//! Stopping at the first narrow interval covers less often than a single look. With L looks each interval has the
//! confidence 1 - (1 - c)/L (Bonferroni); the numbers of runs double to keep L small.

use super::quantile::{interval_ranks, quantile};

/// Condition for stopping.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Goal {
    /// Level of the quantile, in (0, 1).
    pub quantile: f64,
    /// Half-width of the interval at which to stop.
    pub half_width: f64,
    /// Confidence of the interval at the look that stops.
    pub confidence: f64,
}

/// Result of a look.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Look {
    /// True if the campaign may stop.
    pub stops: bool,
    /// The sample quantile (type 7).
    pub estimate: Option<f64>,
    /// Its interval; `None` with too few runs.
    pub interval: [Option<f64>; 2],
    /// Confidence of the interval, corrected for the looks.
    pub confidence: f64,
}

/// Numbers of runs of the looks: `first`, doubled up to `most`.
pub fn looks(first: u64, most: u64) -> Vec<u64> {
    let doubled = std::iter::successors(Some(first.max(1)), |runs| runs.checked_mul(2));
    let mut list: Vec<u64> = doubled.take_while(|runs| *runs < most).collect();
    list.push(most);
    list
}

/// Confidence of the interval of each of `looks` looks.
pub fn adjusted(confidence: f64, looks: usize) -> f64 {
    1.0 - (1.0 - confidence) / looks.max(1) as f64
}

/// One of `looks` looks at the values so far, except NaN. The caller stops at the last look in any case.
pub fn decision(values: &[f64], goal: Goal, looks: usize) -> Look {
    let mut ascending: Vec<f64> = values.iter().copied().filter(|value| !value.is_nan()).collect();
    ascending.sort_unstable_by(f64::total_cmp);
    let confidence = adjusted(goal.confidence, looks);
    let ranks = interval_ranks(ascending.len() as u64, goal.quantile, confidence);
    let end = |rank: Option<u64>| rank.map(|rank| ascending[rank as usize - 1]);
    let interval = [end(ranks.lower), end(ranks.upper)];
    let stops = match interval {
        [Some(lower), Some(upper)] => 0.5 * (upper - lower) <= goal.half_width,
        _ => false,
    };
    Look { stops, estimate: quantile(&ascending, goal.quantile), interval, confidence }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn looks_double_up_to_the_last() {
        assert_eq!(looks(1000, 8000), [1000, 2000, 4000, 8000]);
        assert_eq!(looks(1000, 7000), [1000, 2000, 4000, 7000]);
        assert_eq!(looks(1000, 1000), [1000]);
        assert_eq!(looks(1 << 52, 1 << 53).len(), 2);
        assert!((adjusted(0.95, 5) - 0.99).abs() < 5e-16);
    }

    /// Law: a look stops if and only if both ends exist and are close enough; NaN does not count.
    #[test]
    fn a_look_stops_at_a_narrow_interval() {
        let values: Vec<f64> = (0..1000).map(|k| f64::from((k * 617) % 1000)).chain([f64::NAN; 5]).collect();
        let goal = Goal { quantile: 0.5, half_width: 40.0, confidence: 0.95 };
        let found = decision(&values, goal, 1);
        // ranks 469 and 532 of 1000 numbers equal to their ranks from zero
        assert_eq!((found.interval, found.estimate), ([Some(468.0), Some(531.0)], Some(499.5)));
        assert!(found.stops && !decision(&values, Goal { half_width: 31.0, ..goal }, 1).stops);
        let corrected = decision(&values, goal, 20);
        assert!(corrected.interval[0] < found.interval[0] && !corrected.stops, "{corrected:?}");
        let few = decision(&values[..50], Goal { quantile: 0.99, ..goal }, 1);
        assert_eq!((few.interval[1], few.stops), (None, false));
    }
}
