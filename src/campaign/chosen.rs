//! [`Chosen`]: the samples of `campaign.only`, in ascending order, each with the row that it has in the whole campaign.

use std::sync::Arc;

use super::document::Document;
use crate::sampling::keys::{Counts, Value, Written};

pub const MOST_CHOSEN: usize = 100_000;

/// Ascending, different, at least one.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Chosen(Arc<[u64]>);

impl Chosen {
    /// `None` if not ascending, empty or too long.
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

    /// Checks the list against the number of samples and `[stop]`.
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
