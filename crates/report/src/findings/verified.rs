//! The outcome of verifying a result.

use crate::findings::finding::{Finding, Kind};
use crate::findings::number::counted;

#[derive(Clone, Debug)]
pub struct Checked {
    pub what: String,
    /// Number of problems, all repaired.
    pub problems: usize,
    pub is_finished: bool,
    /// Missing parts of an unfinished result.
    pub missing: usize,
    /// Files of an unfinished result without a reference.
    pub unchecked: Vec<String>,
}

impl Checked {
    /// Sound and finished, or the next step. `is_completed`: a repair finished it.
    pub fn finding(&self, is_completed: bool) -> Finding {
        let unfinished = "what was compared is sound, and the result is not finished";
        let end = match (is_completed, self.problems) {
            (true, 0) => "sound, and finished now".to_owned(),
            (true, problems) => format!("{}, repaired", counted(problems, "problem")),
            (false, _) if self.is_finished => "sound".to_owned(),
            (false, _) if self.missing > 0 => {
                let parts = counted(self.missing, "part");
                format!("{unfinished}: {parts} not made yet; the campaign's command makes the rest")
            }
            (false, _) if self.unchecked.is_empty() => {
                format!("{unfinished}: _SUCCESS is missing, or not empty; the campaign's command finishes it")
            }
            (false, _) => format!(
                "{unfinished}; not compared, since nothing says what should be in them: {}; the campaign's command \
                 finishes it and makes them again",
                self.unchecked.join(", ")
            ),
        };
        Finding::new(Kind::Note, "verified", "", format!("{}: {end}", self.what))
    }
}
