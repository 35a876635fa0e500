//! [`FailureReasons`]: reasons of failed runs, counted.

use std::cmp::Reverse;
use std::collections::BTreeMap;

use crate::ensemble::rows::Rows;
use crate::run::Status;
use crate::sampling::SampleId;

/// Runs that failed for one reason: the same status, and texts that differ only in numbers.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FailureReason {
    pub status: Status,
    pub count: u64,
    /// The smallest sample.
    pub first: SampleId,
    /// The reason of that sample.
    pub text: String,
}

/// The reasons of any rows, in whatever order they are added.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct FailureReasons(BTreeMap<(&'static str, String), FailureReason>);

impl FailureReasons {
    /// Adds the runs of `rows` that failed.
    pub fn add(&mut self, rows: &Rows) {
        rows.reasons().iter().for_each(|(row, text)| self.add_run(rows.samples()[*row], rows.statuses()[*row], text));
    }

    /// Adds a run that failed.
    pub fn add_run(&mut self, sample: SampleId, status: Status, text: &str) {
        let new = || FailureReason { status, count: 0, first: sample, text: text.to_owned() };
        let group = self.0.entry((status.name(), without_numbers(text))).or_insert_with(new);
        group.count += 1;
        if sample < group.first {
            (group.first, group.text) = (sample, text.to_owned());
        }
    }

    /// The reasons, the most frequent first.
    pub fn groups(&self) -> Vec<&FailureReason> {
        let mut groups: Vec<&FailureReason> = self.0.values().collect();
        groups.sort_by_key(|group| (Reverse(group.count), group.first));
        groups
    }
}

/// `text` with a mark for each number.
fn without_numbers(text: &str) -> String {
    with_numbers(text, |_| "#".to_owned())
}

/// `text` with its numbers in the format `shown`. Digits within a name (`w1`) are part of it.
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
        // the sign of an exponent follows its e
        while let Some(next) = chars.next_if(|next| {
            next.is_ascii_digit() || matches!(next, '.' | 'e') || matches!(next, '+' | '-') && number.ends_with('e')
        }) {
            number.push(next);
        }
        kept += &shown(&number);
    }
    kept
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ensemble::{Part, PartId, Shape};

    /// Law: reasons that differ only in numbers are one, in a name they are not; the example is the smallest sample's,
    /// whatever the order of the rows.
    #[test]
    fn reasons_are_counted_without_their_numbers() {
        let part = |first: u64, reasons: &[(Status, &str)]| {
            let mut rows = Rows::new(Shape { parameters: 0, observables: 0 }, reasons.len());
            rows.start(Part { id: PartId(0), first: SampleId(first), count: reasons.len() });
            for (row, (status, reason)) in reasons.iter().enumerate() {
                rows.set_result(row, *status, &[]);
                if *status != Status::Done {
                    rows.set_reason(row, (*reason).to_owned());
                }
            }
            rows
        };
        let (limit, invalid) = (Status::StepLimit, Status::InvalidSample);
        let parts = [
            part(0, &[(limit, "reached at 0.5 s"), (Status::Done, ""), (limit, "reached at 1.25e-3 s")]),
            part(
                7,
                &[
                    (invalid, "wheels.w1.mass_kg is -0.1"),
                    (invalid, "wheels.w2.mass_kg is 1e-7"),
                    (limit, "reached at 9 s"),
                ],
            ),
            part(3, &[(invalid, "wheels.w1.mass_kg is 12.5"), (invalid, "reached at 9 s")]),
        ];
        let found = |order: [usize; 3]| {
            let mut reasons = FailureReasons::default();
            order.iter().for_each(|index| reasons.add(&parts[*index]));
            reasons
        };
        let reason = |status, count, first, text: &str| FailureReason {
            status,
            count,
            first: SampleId(first),
            text: text.to_owned(),
        };
        let expected = [
            reason(limit, 3, 0, "reached at 0.5 s"),
            reason(invalid, 2, 3, "wheels.w1.mass_kg is 12.5"),
            reason(invalid, 1, 4, "reached at 9 s"),
            reason(invalid, 1, 8, "wheels.w2.mass_kg is 1e-7"),
        ];
        assert_eq!(found([0, 1, 2]).groups(), expected.iter().collect::<Vec<_>>());
        assert_eq!(found([2, 1, 0]), found([0, 1, 2]));
    }
}
