//! [`Problem`]: one reason why a campaign file cannot run; [`CampaignError`]: all of them.

use super::excerpt::{Excerpt, printable};
use std::fmt::{self, Display, Formatter};

/// Problems that a message shows; the others are counted.
pub const SHOWN: usize = 20;

/// One reason why a campaign cannot run.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Problem {
    /// The file, as it was named.
    pub file: String,
    /// The line, from 1; `None` where the file has no line for it (a table that is missing).
    pub line: Option<usize>,
    /// The dotted key, `actuation[1].start_s`.
    pub key: String,
    /// The value as written; `None` where the key is missing.
    pub value: Option<String>,
    /// What it must be (to follow the words `must be`); of a key that is unknown, what has no such key (to follow `not
    /// a key of`).
    pub allowed: String,
    pub remedy: String,
    /// Whether it is the key that is wrong: nothing has it.
    pub is_unknown: bool,
    /// The line with a mark under what is wrong, where the file has it.
    pub excerpt: Option<Excerpt>,
}

impl Display for Problem {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        f.write_str(&printable(&self.file))?;
        if let Some(line) = self.line {
            write!(f, ":{line}")?;
        }
        let (key, allowed, remedy) = (printable(&self.key), printable(&self.allowed), printable(&self.remedy));
        match &self.value {
            Some(value) if self.is_unknown => {
                write!(f, ": {key} = {}: not a key of {allowed}; {remedy}", printable(value))
            }
            None if self.is_unknown => write!(f, ": {key}: not a key of {allowed}; {remedy}"),
            Some(value) => write!(f, ": {key} = {}: must be {allowed}; {remedy}", printable(value)),
            None => write!(f, ": {key} is missing: must be {allowed}; {remedy}"),
        }
    }
}

/// Why a campaign file cannot run: everything at once, by line.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct CampaignError {
    /// The reasons, at least one.
    pub problems: Vec<Problem>,
    /// Number of further reasons, which are not in the list.
    pub more: usize,
    /// What that many reasons probably mean.
    pub note: Option<&'static str>,
    /// Whether the only reason is that files cannot be read now: nothing is known to be wrong with the campaign.
    pub is_unreadable: bool,
}

impl CampaignError {
    pub(super) fn of(problem: Problem) -> Self {
        CampaignError { problems: vec![problem], more: 0, note: None, is_unreadable: false }
    }

    /// The message with the lines of the file, each with a mark under what is wrong in it.
    pub fn with_excerpts(&self) -> String {
        self.text(|problem| match &problem.excerpt {
            Some(excerpt) => format!("{problem}\n{excerpt}"),
            None => problem.to_string(),
        })
    }

    /// The first reasons, each as `shown` has it, and how many more there are.
    fn text(&self, shown: impl Fn(&Problem) -> String) -> String {
        let mut lines: Vec<String> = self.problems.iter().take(SHOWN).map(shown).collect();
        let more = self.more + self.problems.len().saturating_sub(SHOWN);
        if more > 0 {
            lines.push(format!("and {more} more problem{}", if more == 1 { "" } else { "s" }));
        }
        lines.extend(self.note.map(str::to_owned));
        lines.join("\n")
    }
}

impl Display for CampaignError {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        f.write_str(&self.text(Problem::to_string))
    }
}

impl std::error::Error for CampaignError {}
