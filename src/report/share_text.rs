//! Shares of runs in words.

use crate::report::number::brief;

/// A share in per cent with three digits, and near 100 with as many as show that it is not all.
fn percent(share: f64) -> String {
    let (percent, left) = (100.0 * share, 100.0 * (1.0 - share));
    if (1e-12..1.0).contains(&left) {
        let digits = (-libm::floor(libm::log10(left))) as usize;
        return format!("{percent:.digits$}");
    }
    brief(percent)
}

/// A share, or where runs are missing its least and largest value, with its interval in brackets where there is one.
pub fn with_interval([least, most]: [f64; 2], interval: [f64; 2]) -> String {
    let share = if least == most {
        format!("{}%", percent(least))
    } else {
        format!("{}% to {}%", percent(least), percent(most))
    };
    match interval {
        [low, high] if low.is_finite() && high.is_finite() => format!("{share} [{}, {}]", percent(low), percent(high)),
        _ => share,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

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
}
