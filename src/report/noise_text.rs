//! What noise within control loops makes of the outcomes, in words.

use crate::analysis::noise_share::NoiseShare;
use crate::report::number::short;
use crate::report::text_table::{Align, TextTable};

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

/// A line for each outcome, of lines of `width` characters.
pub fn lines(all: &[NoiseShare], width: usize) -> String {
    let mut table = TextTable::new([("", Align::Left), ("", Align::Sentence)]);
    all.iter().for_each(|one| table.row([one.observable.clone(), words(one)]));
    table.text(width)
}
