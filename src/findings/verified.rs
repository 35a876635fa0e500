//! What a result is that was verified.

use crate::findings::finding::{Finding, Kind};
use crate::findings::number::counted;

/// What was found when a result was verified.
#[derive(Clone, Debug)]
pub struct Checked {
    /// What was compared: files, rows.
    pub what: String,
    /// How many problems there were; all are repaired.
    pub problems: usize,
    /// Whether the result is finished.
    pub is_finished: bool,
    /// How many parts of a result that is not finished are not made yet.
    pub missing: usize,
    /// Of a result that is not finished: files that were not compared, since nothing says what should be in them.
    pub unchecked: Vec<String>,
}

impl Checked {
    /// Whether the result is sound and finished, or what is to be done. `is_completed`: a repair has finished it.
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
