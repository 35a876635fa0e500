//! [`SummaryEnd`]: the end of a campaign in a few facts.

use std::path::Path;

use crate::analysis::ending::Ending;
use crate::analysis::statistics::Statistics;
use crate::analysis::stopping::Stopping;
use crate::findings::number::counted;
use crate::findings::requirement::EndVerdict;

#[derive(Clone, Debug, PartialEq)]
pub struct SummaryEnd {
    pub rows: u64,
    /// Runs that are not `ok`.
    pub failed: u64,
    /// Audited runs whose errors exceed their estimates, if more than promised; else 0.
    pub not_covered: u64,
    pub warnings: Vec<String>,
    pub verdicts: Vec<EndVerdict>,
    /// True if a campaign with `[stop]` reached its goal; `true` without `[stop]`.
    pub is_reached: bool,
}

impl SummaryEnd {
    /// The end without warnings; quantiles get intervals only from `statistics`.
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

    pub fn without_words(&self) -> Self {
        let bare = |one: &EndVerdict| EndVerdict {
            requirement: one.requirement.clone(),
            word: one.word.clone(),
            ..EndVerdict::default()
        };
        SummaryEnd { warnings: Vec::new(), verdicts: self.verdicts.iter().map(bare).collect(), ..self.clone() }
    }

    /// One line: counts of verdicts, or of computed runs if nothing is required, and the place of the report: `3 PASS,
    /// 1 FAIL -> results/x/report.html`.
    pub fn verdict_line(&self, place: &Path) -> String {
        let mut said = self.verdicts(|count, word| format!("{count} {word}"));
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

    /// The non-zero counts of verdicts as texts, PASS first.
    pub fn verdicts(&self, text: impl Fn(usize, &str) -> String) -> Vec<String> {
        let counts = ["PASS", "FAIL", "UNDECIDED"].into_iter().map(|word| (self.count(word), word));
        counts.filter(|(count, _)| *count > 0).map(|(count, word)| text(count, word)).collect()
    }

    pub fn count(&self, word: &str) -> usize {
        self.verdicts.iter().filter(|one| one.word == word).count()
    }
}
