//! What drives an observable: how strongly each input acts, from the measures of its sensitivity, and which inputs the rows show to act.

use crate::analysis::sensitivity::InputSensitivity;
use crate::statistics::correlation::Estimate;

impl InputSensitivity {
    /// How strongly the input acts on the observable, as a share of its variance: the total index, where the design gives it; else the larger
    /// one of the first-order index and of the squared rank correlation, of those whose interval is above zero where one is.
    ///
    /// The first-order index alone sees that |x| matters where positive and negative x do the same, the rank correlation weak monotone influences.
    pub fn influence(&self) -> Option<Estimate> {
        let squared = self.spearman.map(|r| {
            let [lower, upper] = [r.lower * r.lower, r.upper * r.upper];
            let least = if r.lower * r.upper < 0.0 { 0.0 } else { lower.min(upper) };
            let ends = if lower.is_nan() { [f64::NAN; 2] } else { [least, lower.max(upper)] };
            Estimate { value: r.value * r.value, lower: ends[0], upper: ends[1] }
        });
        let rank = |one: &Estimate, other: &Estimate| {
            (one.lower > 0.0).cmp(&(other.lower > 0.0)).then(one.value.total_cmp(&other.value))
        };
        self.total.or_else(|| [self.first_order, squared].into_iter().flatten().max_by(rank))
    }

    /// Whether the observable rises (or falls) with the input; `None` where the rows do not show it.
    pub fn rises(&self) -> Option<bool> {
        self.spearman.filter(|r| r.lower * r.upper > 0.0).map(|r| r.value > 0.0)
    }
}

/// Least share of the variance of an input that is called a driver: less matters to nobody, and among many inputs some show it by chance.
const LEAST_SHARE: f64 = 0.01;

/// The inputs that drive `observable` by [`InputSensitivity::influence`], the strongest first: those of a hundredth of the variance or more whose
/// interval, where the design gives one, is above zero. What the screen and the page say follows from this alone.
pub fn drivers<'a>(all: &'a [InputSensitivity], observable: &str) -> Vec<(&'a InputSensitivity, Estimate)> {
    let of = all.iter().filter(|one| one.observable == observable);
    let mut found: Vec<_> = of.filter_map(|one| Some((one, one.influence()?))).collect();
    let has_interval = |one: &Estimate| !(one.lower.is_nan() && one.upper.is_nan());
    found.retain(|(_, one)| one.value >= LEAST_SHARE && (one.lower > 0.0 || !has_interval(one)));
    found.sort_by(|a, b| b.1.value.total_cmp(&a.1.value));
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Law: the observable is driven by what its first-order index or its rank correlation shows, whichever is more, the strongest first; what
    /// neither shows drives nothing; without intervals the values decide.
    #[test]
    fn drivers_are_what_either_measure_shows() {
        let estimate = |value: f64, half: f64| Some(Estimate { value, lower: value - half, upper: value + half });
        let of = |input: &str, first_order, spearman| InputSensitivity {
            observable: "y".to_owned(),
            input: input.to_owned(),
            first_order,
            spearman,
            ..InputSensitivity::default()
        };
        let all = [
            of("nothing", estimate(0.01, 0.1), estimate(-0.05, 0.1)),
            of("falls", estimate(0.2, 0.1), estimate(-0.5, 0.1)),
            of("magnitude", estimate(0.45, 0.1), estimate(0.01, 0.1)),
            of("weak", estimate(0.5, 0.6), estimate(0.2, 0.1)),
            of("certain, and nothing", estimate(0.004, 0.001), estimate(0.05, 0.01)),
        ];
        let names =
            |all: &[InputSensitivity]| drivers(all, "y").iter().map(|(one, _)| one.input.clone()).collect::<Vec<_>>();
        assert_eq!(names(&all), ["magnitude", "falls", "weak"]);
        let rises = all.each_ref().map(InputSensitivity::rises);
        assert_eq!(rises, [None, Some(false), None, Some(true), Some(true)]);
        let falls = all[1].influence().expect("an influence");
        assert!((falls.value - 0.25).abs() < 1e-15 && (falls.lower - 0.16).abs() < 1e-15, "{falls:?}");
        let chosen =
            [of("x", estimate(0.3, f64::NAN), estimate(0.9, f64::NAN)), of("z", estimate(0.004, f64::NAN), None)];
        assert_eq!(names(&chosen), ["x"]);
        let total = [InputSensitivity { total: estimate(0.3, 0.1), ..of("x", estimate(0.9, 0.1), None) }];
        assert_eq!(total[0].influence(), estimate(0.3, 0.1));
        assert!(drivers(&all, "another").is_empty());
    }
}
