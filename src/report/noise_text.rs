//! What noise within control loops makes of the outcomes, in words.

use crate::analysis::noise_share::NoiseShare;
use crate::report::number::short;

/// The share of one outcome, without its name.
pub fn words(one: &NoiseShare) -> String {
    let scenes = one.scenes;
    match one.share {
        // no interval: of what never happened the differences are unknown
        Some(share) if share.value == 0.0 => {
            format!("noise within the loop changes it in none of {scenes} scenes, each flown twice")
        }
        Some(share) => {
            let [value, lower, upper] =
                [share.value, share.lower, share.upper].map(|part| short(100.0 * part.clamp(0.0, 1.0)));
            format!(
                "noise within the loop is {value}% [{lower}, {upper}] of the variance ({scenes} scenes, each flown twice)"
            )
        }
        None => format!(
            "noise within the loop has no share of a variance ({scenes} scenes with a value, which do not vary)"
        ),
    }
}

/// A line for each outcome.
pub fn lines(all: &[NoiseShare]) -> String {
    let width = all.iter().map(|one| one.observable.len()).max().unwrap_or(0);
    all.iter().map(|one| format!("  {:<width$}  {}\n", one.observable, words(one))).collect()
}
