//! [`Chosen`]: the samples that a campaign runs, where it does not run all of them (`campaign.only`).
//!
//! The rows of such a campaign are those samples in ascending order, each the same pure function of the plan and its
//! number as in the whole campaign. Which sample a row is: `plan_rows`.

use std::sync::Arc;

use super::document::Document;
use crate::sampling::keys::{Counts, Value, Written};

/// Most samples that are listed one by one.
pub const MOST_CHOSEN: usize = 100_000;

/// The numbers of the samples that run: ascending, different, at least one.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Chosen(Arc<[u64]>);

impl Chosen {
    /// A list of samples; `None` where it is not ascending, empty, or too long.
    pub fn of(samples: Vec<u64>) -> Option<Self> {
        let is_allowed = (1..=MOST_CHOSEN).contains(&samples.len()) && samples.windows(2).all(|pair| pair[0] < pair[1]);
        is_allowed.then(|| Chosen(samples.into()))
    }

    pub(super) fn of_written(campaign: &Written) -> Option<Self> {
        match campaign.get("only")? {
            Value::Counts(Counts::Each(samples)) => Chosen::of(samples.clone()),
            _ => None,
        }
    }

    /// Notes what is wrong with the list in a campaign of `samples` samples, `stops` where it has `[stop]`.
    pub(super) fn check(&self, samples: u64, stops: bool, document: &mut Document<'_>) {
        if self.0.last().is_some_and(|last| *last >= samples) {
            let allowed = format!("made of numbers below campaign.samples ({samples})");
            let last = self.0.last().map(ToString::to_string);
            document.add("campaign.only", last, allowed, "delete the numbers of samples that there are not");
        }
        if stops {
            let allowed = "left out with campaign.only: the samples that run are chosen";
            document.add("stop", Some("[stop]".to_owned()), allowed, "delete one of both");
        }
    }

    pub fn samples(&self) -> &[u64] {
        &self.0
    }
}
