//! Shares of runs in words: "98.4% [91.5, 99.96]".

use crate::analysis::noise_share::NoiseShare;
use crate::findings::number::{brief, outward};
use crate::statistics::share_within::FEWEST_OTHERS;
use crate::table::Table;
use crate::table::text::Align;

/// Digits of a share in per cent, and of what is left to 100 where it is less than one.
const DIGITS: i32 = 3;

/// How many decimals of per cent show that a share is not all; `None` where it is all, or three digits show it.
fn decimals(share: f64) -> Option<usize> {
    let left = 100.0 * (1.0 - share);
    (1e-12..1.0).contains(&left).then(|| (-libm::floor(libm::log10(left))) as usize)
}

/// A share in per cent with three digits, and near 100 with as many as show that it is not all.
pub fn percent(share: f64) -> String {
    match decimals(share) {
        Some(digits) => format!("{:.digits$}", 100.0 * share),
        None => brief(100.0 * share),
    }
}

/// The ends of the interval of a share, in per cent, rounded away from each other: 99.9975 is never 100.
fn ends([low, high]: [f64; 2]) -> [String; 2] {
    let [below, above] = outward([100.0 * low, 100.0 * high], DIGITS);
    let end = |share: f64, rounded: f64, up: bool| match decimals(share) {
        Some(digits) => {
            // one digit more where rounding would show all
            let digits = digits.max(1);
            let at = |digits: usize| {
                let step = libm::exp10(digits as f64);
                let steps = 100.0 * share * step;
                let whole = libm::round(steps);
                let near = (steps - whole).abs() < 8.0 * f64::EPSILON * steps;
                (if near {
                    whole
                } else if up {
                    libm::ceil(steps)
                } else {
                    libm::floor(steps)
                }) / step
            };
            let digits = if at(digits) >= 100.0 { digits + 1 } else { digits };
            format!("{:.digits$}", at(digits))
        }
        None => brief(rounded),
    };
    [end(low, below, false), end(high, above, true)]
}

/// A share, or where runs are missing its least and largest value, with its interval in brackets where there is one.
pub fn with_interval([least, most]: [f64; 2], interval: [f64; 2]) -> String {
    let share = if least == most {
        format!("{}%", percent(least))
    } else {
        format!("{}% to {}%", percent(least), percent(most))
    };
    match interval {
        [low, high] if low.is_finite() && high.is_finite() => {
            let [low, high] = ends([low, high]);
            format!("{share} [{low}, {high}]")
        }
        _ => share,
    }
}

/// The share of one outcome, without its name.
pub fn of_noise(one: &NoiseShare) -> String {
    let scenes = one.scenes;
    match one.share {
        // no interval: of what never happened the differences are unknown
        Some(share) if share.value == 0.0 => {
            format!("noise within the loop changes it in none of {scenes} scenes, each flown twice")
        }
        Some(share) => {
            let said = with_interval([share.value; 2], [share.lower, share.upper]);
            format!("noise within the loop is {said} of the variance ({scenes} scenes, each flown twice)")
        }
        None if one.others > 0 => format!(
            "the share of noise within the loop is not known: {} of {} runs have another value than the others, and it \
            takes {FEWEST_OTHERS} ({scenes} scenes, each flown twice)",
            one.others,
            2 * scenes
        ),
        None => format!(
            "noise within the loop has no share of a variance ({scenes} scenes with a value, which do not vary)"
        ),
    }
}

/// A line for each outcome.
pub fn noise_lines(all: &[NoiseShare]) -> String {
    let mut table = Table::with([("", Align::Left), ("", Align::Sentence)]);
    all.iter().for_each(|one| table.row([one.observable.clone(), of_noise(one)]));
    table.text(usize::MAX)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::statistics::jackknife::Estimate;

    /// Law: a share is within the interval that is said of it, and of few events none is said.
    #[test]
    fn few_events_have_no_share_of_noise() {
        let share = |share: Option<Estimate>| NoiseShare { observable: "y".to_owned(), scenes: 200, others: 9, share };
        let said = of_noise(&share(Some(Estimate { value: 0.864, lower: 0.7213, upper: 0.9998 })));
        assert_eq!(said, "noise within the loop is 86.4% [72.1, 99.98] of the variance (200 scenes, each flown twice)");
        let said = of_noise(&share(None));
        assert!(said.contains("9 of 400 runs have another value") && !said.contains('%'), "{said}");
    }

    /// Law: a share that is not all is never shown as all; ends of the interval are in order.
    #[test]
    fn what_is_left_is_seen() {
        for (share, text) in [
            (0.0, "0"),
            (0.95, "95"),
            (0.982, "98.2"),
            (0.9917, "99.2"),
            (0.965_97, "96.6"),
            (0.005_027, "0.503"),
            (0.999_51, "99.95"),
            (0.999_987, "99.999"),
            (1.0, "100"),
            (1.0 - 2e-9, "99.9999998"),
        ] {
            assert_eq!(percent(share), text);
        }
        assert_eq!(with_interval([0.95; 2], [0.91, 0.975]), "95% [91, 97.5]");
        assert_eq!(with_interval([0.25, 0.98], [f64::NAN; 2]), "25% to 98%");
    }

    /// Law: the interval that is shown contains the one that was found, whatever is left to 100; it reaches 100 and 0
    /// only where that does.
    #[test]
    fn shown_intervals_contain_theirs() {
        assert_eq!(with_interval([0.999; 2], [0.994_4, 0.999_975]), "99.9% [99.4, 99.998]");
        assert_eq!(with_interval([0.984; 2], [0.914_6, 0.999_58]), "98.4% [91.4, 99.96]");
        assert_eq!(with_interval([0.005; 2], [0.000_612_3, 0.0123]), "0.500% [0.0612, 1.23]");
        let mut left = 0.6;
        while left > 1e-9 {
            for interval in [[1.0 - left, 1.0 - 0.5 * left], [0.5 * left, left]] {
                let [low, high] = ends(interval).map(|text| text.parse::<f64>().expect("a number") / 100.0);
                assert!(low <= interval[0] + 1e-13 && high >= interval[1] - 1e-13, "{interval:?}: {low} {high}");
                assert!(low > 0.0 && high < 1.0, "{interval:?}: {low} {high}");
                assert!(high - low < 4.0 * (interval[1] - interval[0]) + 0.01 * low, "{interval:?}: {low} {high}");
            }
            left *= 0.83;
        }
        assert_eq!(ends([0.0, 1.0]), ["0", "100"]);
    }
}
