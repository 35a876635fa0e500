//! [`FailureReasons`]: reasons of failed runs, counted.

use crate::run::Status;
use crate::sampling::SampleId;
use std::cmp::Reverse;
use std::collections::BTreeMap;

/// Runs that failed with one status, and texts that differ only in numbers.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FailureReason {
    pub status: Status,
    pub count: u64,
    pub first: SampleId,
    pub text: String,
}

/// Independent of the order of additions.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct FailureReasons(BTreeMap<(&'static str, String), FailureReason>);

impl FailureReasons {
    pub fn add(&mut self, sample: SampleId, status: Status, text: &str) {
        let new = || FailureReason { status, count: 0, first: sample, text: text.to_owned() };
        let group = self.0.entry((status.name(), with_numbers(text, |_| "#".to_owned()))).or_insert_with(new);
        group.count += 1;
        if sample < group.first {
            (group.first, group.text) = (sample, text.to_owned());
        }
    }

    /// Most frequent first.
    pub fn groups(&self) -> Vec<&FailureReason> {
        let mut groups: Vec<&FailureReason> = self.0.values().collect();
        groups.sort_by_key(|group| (Reverse(group.count), group.first));
        groups
    }
}

/// `text` with its numbers as `shown`; digits in a name (`w1`) are no number.
pub fn with_numbers(text: &str, shown: impl Fn(&str) -> String) -> String {
    let mut kept = String::with_capacity(text.len());
    let mut chars = text.chars().peekable();
    while let Some(c) = chars.next() {
        let is_in_name = kept.chars().last().is_some_and(|last| last.is_alphanumeric() || last == '_');
        if !c.is_ascii_digit() || is_in_name {
            kept.push(c);
            continue;
        }
        let mut number = if kept.ends_with('-') { kept.pop().into_iter().collect() } else { String::new() };
        number.push(c);
        while let Some(next) = chars.next_if(|next| {
            next.is_ascii_digit() || matches!(next, '.' | 'e') || matches!(next, '+' | '-') && number.ends_with('e')
        }) {
            number.push(next);
        }
        kept += &shown(&number);
    }
    kept
}
