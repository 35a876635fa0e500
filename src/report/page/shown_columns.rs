//! What names of columns mean to a reader of the page: which are errors, what they are called, which interval a quantile has.

use crate::run::Quantity;
use crate::statistics::quantile::interval_ranks;
use crate::statistics::sketch::{Sketch, middle};

/// Confidence of the intervals on the page.
pub const CONFIDENCE: f64 = 0.95;

/// Whether the column `name` is an error of the computation, which should be small and is never negative.
pub fn is_error(name: &str) -> bool {
    let is_largest =
        name.contains("_max") && ["_error", "residual_", "orthonormality"].iter().any(|mark| name.contains(mark));
    is_largest || name.ends_with("error_estimate")
}

/// The name of a column as words: `energy_error_max` is "maximum energy error"; the unit is left out.
pub fn words(quantity: &Quantity) -> String {
    let suffix = match quantity.unit() {
        "" => String::new(),
        "1/s" => "_per_s".to_owned(),
        unit => format!("_{}", unit.to_lowercase().replace([' ', '/'], "_").replace('^', "")),
    };
    let name = quantity.name().strip_suffix(suffix.as_str()).unwrap_or(quantity.name());
    let (stem, statistic) = [
        ("_peak_to_peak", "peak-to-peak "),
        ("_max", "maximum "),
        ("_min", "minimum "),
        ("_mean", "mean "),
        ("_final", "final "),
        ("_rms", "rms "),
    ]
    .into_iter()
    .find_map(|(suffix, words)| Some((name.strip_suffix(suffix)?, words)))
    .unwrap_or((name, ""));
    let stem = stem.strip_prefix("exchange_").map_or(stem.to_owned(), |rest| format!("energy transfer of {rest}"));
    format!("{statistic}{}", stem.replace('_', " "))
}

/// The distribution-free interval of the `p`-quantile (order statistics); NaN where there are too few runs for an end.
pub fn interval(sketch: &Sketch, p: f64, confidence: f64) -> [f64; 2] {
    let count = sketch.count();
    if count == 0 {
        return [f64::NAN; 2];
    }
    let ranks = interval_ranks(count, p, confidence);
    [ranks.lower, ranks.upper].map(|rank| rank.and_then(|rank| ranked(sketch, rank)).unwrap_or(f64::NAN))
}

/// The value of rank `rank` from 1.
pub fn ranked(sketch: &Sketch, rank: u64) -> Option<f64> {
    sketch.ranks().bounds(rank).map(middle)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_become_words() {
        let words = |name: &'static str, unit: &'static str| words(&Quantity::new(name, unit, "A column."));
        assert_eq!(words("energy_error_max", ""), "maximum energy error");
        assert_eq!(words("exchange_body_peak_to_peak_j", "J"), "peak-to-peak energy transfer of body");
        assert_eq!(words("angular_rate_max_rad_s", "rad/s"), "maximum angular rate");
        assert_eq!(words("steps", ""), "steps");
    }

    /// Law: the interval is made of the order statistics that the binomial distribution names; too few values have no end.
    #[test]
    fn intervals_are_order_statistics() {
        let mut sketch = Sketch::default();
        (1..=1000).for_each(|value| sketch.add(f64::from(value)));
        let ranks = interval_ranks(1000, 0.9, CONFIDENCE);
        let [low, high] = interval(&sketch, 0.9, CONFIDENCE);
        // the sketch answers within 0.05%
        assert!((low - ranks.lower.unwrap() as f64).abs() < 0.5 && (high - ranks.upper.unwrap() as f64).abs() < 0.5);
        assert!(interval(&sketch, 0.9999, CONFIDENCE)[1].is_nan(), "1000 runs do not bound that quantile from above");
    }
}
