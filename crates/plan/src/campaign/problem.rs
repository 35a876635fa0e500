//! [`Problem`]: one reason why a campaign file cannot run; [`CampaignError`]: all of them.

use super::excerpt::{Excerpt, printable};
use std::fmt::{self, Display, Formatter};

/// Problems shown in a message; the others are counted.
pub const SHOWN: usize = 20;

#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Problem {
    pub file: String,
    /// From 1; `None` without a line, as for a missing table.
    pub line: Option<usize>,
    /// Dotted: `actuation[1].start_s`.
    pub key: String,
    /// As written; `None` for a missing key.
    pub value: Option<String>,
    /// Follows `must be`; for an unknown key, `not a key of`.
    pub allowed: String,
    pub remedy: String,
    pub is_unknown: bool,
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

/// All problems of a campaign file, by line.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct CampaignError {
    /// At least one.
    pub problems: Vec<Problem>,
    /// Number of further problems.
    pub more: usize,
    /// A probable cause of all.
    pub note: Option<&'static str>,
    /// True if all problems are files that are unreadable now.
    pub is_unreadable: bool,
}

impl CampaignError {
    pub(super) fn of(problem: Problem) -> Self {
        CampaignError { problems: vec![problem], more: 0, note: None, is_unreadable: false }
    }

    /// A single problem, without a line.
    pub(super) fn new(
        file: &str,
        key: &str,
        value: impl Into<Option<String>>,
        allowed: impl Into<String>,
        remedy: &str,
    ) -> Self {
        CampaignError::of(Problem {
            file: file.to_owned(),
            line: None,
            key: key.to_owned(),
            value: value.into(),
            allowed: allowed.into(),
            remedy: remedy.to_owned(),
            is_unknown: false,
            excerpt: None,
        })
    }

    /// The message with the marked lines of the file.
    pub fn with_excerpts(&self) -> String {
        self.text(|problem| match &problem.excerpt {
            Some(excerpt) => format!("{problem}\n{excerpt}"),
            None => problem.to_string(),
        })
    }

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
