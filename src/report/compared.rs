//! [`Compared`]: two results compared, with what is said of them beside their numbers.

use std::cmp::Ordering;

use crate::analysis::comparison::Comparison;
use crate::campaign::Plan;
use crate::campaign::difference::KeyDifference;
use crate::report::summary::EndVerdict;

/// A requirement of either result with its verdict in each, where it has one.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ComparedVerdict {
    /// The requirement as a sentence.
    pub requirement: String,
    pub verdicts: [Option<EndVerdict>; 2],
}

impl ComparedVerdict {
    /// Whether the second verdict is worse than the first: FAIL is worse than UNDECIDED, which is worse than PASS. A requirement that only one result
    /// has is not compared.
    pub fn is_worse(&self) -> bool {
        self.change() == Some(Ordering::Less)
    }

    /// `PASS`, `FAIL` or `UNDECIDED` in the first or in the second result.
    pub fn word(&self, which: usize) -> Option<&str> {
        self.verdicts[which].as_ref().map(|one| one.word.as_str())
    }

    /// How the second verdict compares with the first; `None` where only one result has the requirement.
    pub fn change(&self) -> Option<Ordering> {
        let rank = |which| ["FAIL", "UNDECIDED", "PASS"].iter().position(|known| Some(*known) == self.word(which));
        rank(0).zip(rank(1)).map(|(first, second)| second.cmp(&first))
    }

    /// The change in a word; and its place among those that are listed.
    pub fn mark(&self) -> (usize, &'static str) {
        match (self.change(), &self.verdicts[0]) {
            (Some(Ordering::Less), _) => (0, "WORSE"),
            (Some(Ordering::Greater), _) => (1, "BETTER"),
            (None, None) => (2, "new"),
            (None, Some(_)) => (2, "gone"),
            (Some(Ordering::Equal), _) => (3, ""),
        }
    }

    /// The requirement in a few words.
    pub fn statement(&self) -> &str {
        self.verdicts.iter().flatten().next().map_or(&self.requirement, |one| &one.statement)
    }
}

/// Two results compared, with what is said of them beside their numbers.
#[derive(Clone, Copy, Debug)]
pub struct Compared<'c> {
    /// What the results are called.
    pub names: &'c [String; 2],
    pub plans: [&'c Plan; 2],
    pub comparison: &'c Comparison,
    /// The keys in which the plans differ.
    pub keys: &'c [KeyDifference],
    pub verdicts: &'c [ComparedVerdict],
    /// The shift that is allowed, where one is.
    pub tolerance: Option<f64>,
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Law: of every pair of verdicts those are worse that go down from PASS by UNDECIDED to FAIL; one that is in one result only is compared with nothing.
    #[test]
    fn worse_verdicts_go_down() {
        let verdict = |word: &str| EndVerdict { word: word.to_owned(), ..EndVerdict::default() };
        let words = [Some("PASS"), Some("UNDECIDED"), Some("FAIL"), None].map(|word| word.map(verdict));
        for (place, first) in words.iter().enumerate() {
            for (other, second) in words.iter().enumerate() {
                let one = ComparedVerdict { requirement: String::new(), verdicts: [first.clone(), second.clone()] };
                assert_eq!(one.is_worse(), place < other && other < 3, "{one:?}");
                let is_better = one.change() == Some(Ordering::Greater);
                assert_eq!(is_better, other < place && place < 3, "{one:?}");
                let mark = match (place, other) {
                    (3, 3) | (3, _) => "new",
                    (_, 3) => "gone",
                    _ if is_better => "BETTER",
                    _ if one.is_worse() => "WORSE",
                    _ => "",
                };
                assert_eq!(one.mark().1, mark, "{one:?}");
            }
        }
    }
}
