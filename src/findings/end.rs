//! [`SummaryEnd`]: how a campaign ended, in a few facts.

use std::path::Path;

use crate::analysis::ending::Ending;
use crate::analysis::statistics::Statistics;
use crate::analysis::stopping::Stopping;
use crate::findings::number::counted;
use crate::findings::requirement::EndVerdict;

/// How a campaign ended, as its rows and its summary both say.
#[derive(Clone, Debug, PartialEq)]
pub struct SummaryEnd {
    pub rows: u64,
    /// Number of runs that are not `ok`.
    pub failed: u64,
    /// Audited runs whose errors are larger than their estimates, where these are more than promised; else 0.
    pub not_covered: u64,
    /// What comes before every number, as the summary says it.
    pub warnings: Vec<String>,
    /// The requirements, each with its verdict.
    pub verdicts: Vec<EndVerdict>,
    /// Whether a campaign with `[stop]` has reached what it says; `true` of others.
    pub is_reached: bool,
}

impl SummaryEnd {
    /// What the summary of a campaign says that ended like this, without its warnings; quantiles have intervals with
    /// `statistics` only.
    pub fn of(ending: &Ending, statistics: Option<&Statistics>) -> Self {
        SummaryEnd {
            rows: ending.rows,
            failed: ending.failed,
            not_covered: ending.not_covered,
            warnings: Vec::new(),
            verdicts: ending.verdicts.list.iter().map(|one| EndVerdict::of(one, statistics)).collect(),
            is_reached: ending.stopping.as_ref().is_none_or(Stopping::is_reached),
        }
    }

    /// The same without the words from which nothing follows: warnings, and the requirements in short.
    pub fn without_words(&self) -> Self {
        let bare = |one: &EndVerdict| EndVerdict {
            requirement: one.requirement.clone(),
            word: one.word.clone(),
            ..EndVerdict::default()
        };
        SummaryEnd { warnings: Vec::new(), verdicts: self.verdicts.iter().map(bare).collect(), ..self.clone() }
    }

    /// The verdicts of the campaign in one line, or how many runs were computed where nothing is required, and where
    /// the rest stands: `3 PASS, 1 FAIL ->
    /// results/x/report.html`.
    pub fn verdict_line(&self, place: &Path) -> String {
        let count = |word: &&str| (self.count(word), word.to_string());
        let found = ["PASS", "FAIL", "UNDECIDED"].iter().map(count).filter(|(count, _)| *count > 0);
        let mut said: Vec<String> = found.map(|(count, word)| format!("{count} {word}")).collect();
        let (rows, ok) = (self.rows, self.rows - self.failed);
        if said.is_empty() || self.failed > 0 {
            let of = if self.failed > 0 { format!("{ok} of ") } else { String::new() };
            said.push(format!("{of}{} computed", counted(rows, "run")));
        }
        if self.not_covered > 0 {
            said.push("audit FAILED".to_owned());
        }
        if !self.is_reached {
            said.push("[stop] not reached".to_owned());
        }
        format!("{} -> {}", said.join(", "), place.display())
    }

    /// The number of requirements with the verdict `word`.
    pub fn count(&self, word: &str) -> usize {
        self.verdicts.iter().filter(|one| one.word == word).count()
    }
}
