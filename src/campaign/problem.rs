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
    /// What it must be (to follow the words `must be`); of a key that is unknown, what has no such key (to follow `not a key of`).
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

/// Names of more bytes than this are not compared: nobody misspelt them, and it would take their product in time.
const LONGEST_NAME: usize = 300;

/// The candidate that `written` probably means: one that contains it, or else the one with the fewest changes of letters, if
/// these are at most a third of them.
pub fn nearest<'a>(written: &str, candidates: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let is_short = |name: &&str| name.len() <= LONGEST_NAME && written.len() <= LONGEST_NAME;
    let candidates: Vec<&str> = candidates.into_iter().filter(is_short).collect();
    // a name that was not written to its end: that which lacks least
    let begun = candidates.iter().filter(|c| written.len() > 3 && c.starts_with(written));
    if let Some(whole) = begun.min_by_key(|c| c.len()) {
        return Some(whole);
    }
    let close = candidates
        .iter()
        .map(|candidate| (changes(written, candidate), *candidate))
        .min_by_key(|(changes, _)| *changes)
        .filter(|(changes, _)| *changes <= (written.chars().count() / 3).max(2))
        .map(|(_, candidate)| candidate);
    // `angular_velocity` means `initial.angular_velocity_rad_s`; a letter or two mean nothing
    close.or_else(|| candidates.into_iter().find(|c| written.len() > 3 && (c.contains(written) || written.contains(c))))
}

/// Number of letters to insert, delete, replace, or exchange with their neighbour between `a` and `b` (optimal string alignment; Damerau 1964).
fn changes(a: &str, b: &str) -> usize {
    let (a, b): (Vec<char>, Vec<char>) = (a.chars().collect(), b.chars().collect());
    let first: Vec<usize> = (0..=b.len()).collect();
    let (mut before, mut row) = (first.clone(), first);
    for (i, x) in a.iter().enumerate() {
        let mut next = vec![i + 1; b.len() + 1];
        for (j, y) in b.iter().enumerate() {
            next[j + 1] = (row[j] + usize::from(x != y)).min(row[j + 1] + 1).min(next[j] + 1);
            let is_exchanged = i > 0 && j > 0 && a[i - 1] == *y && b[j - 1] == *x && x != y;
            if is_exchanged {
                next[j + 1] = next[j + 1].min(before[j - 1] + 1);
            }
        }
        (before, row) = (row, next);
    }
    row[b.len()]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_nearest_name_is_found_and_a_far_one_is_not() {
        let names = ["samples", "seed", "duration_s", "initial.angular_velocity_rad_s"];
        assert_eq!(nearest("sampels", names), Some("samples"));
        assert_eq!(nearest("duration", names), Some("duration_s"));
        assert_eq!(nearest("angular_velocity", names), Some("initial.angular_velocity_rad_s"));
        assert_eq!(
            nearest("body.tank.density", ["body.tank.length_m", "body.tank.density_kg_m3"]),
            Some("body.tank.density_kg_m3")
        );
        assert_eq!(nearest("colour", names), None);
        assert_eq!((changes("kitten", "sitting"), changes("sampels", "samples"), changes("", "ab")), (3, 1, 2));
    }
}
