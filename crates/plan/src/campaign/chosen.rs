//! The samples of `campaign.only`, ascending and different, each with the row that it has in the whole campaign.

use super::document::Document;

pub const MOST_CHOSEN: usize = 100_000;

/// Checks the list against the number of samples and `[stop]`.
pub(super) fn check(chosen: &[u64], samples: u64, stops: bool, document: &mut Document<'_>) {
    if let Some(last) = chosen.last().filter(|last| **last >= samples) {
        let allowed = format!("made of numbers below campaign.samples ({samples})");
        let remedy = "delete the numbers of samples that there are not";
        document.add("campaign.only", Some(last.to_string()), allowed, remedy);
    }
    if stops {
        let allowed = "left out with campaign.only: the samples that run are chosen";
        document.add("stop", Some("[stop]".to_owned()), allowed, "delete one of both");
    }
}
