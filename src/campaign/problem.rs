//! [`Problem`]: one reason why a campaign file cannot run; [`CampaignError`]: all of them.

use std::fmt::{self, Display, Formatter};

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
    /// What it must be (to follow the words `must be`).
    pub allowed: String,
    /// What to do.
    pub remedy: String,
}

impl Display for Problem {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        f.write_str(&self.file)?;
        if let Some(line) = self.line {
            write!(f, ":{line}")?;
        }
        match &self.value {
            Some(value) => write!(f, ": {} = {value}: must be {}; {}", self.key, self.allowed, self.remedy),
            None => write!(f, ": {} is missing: must be {}; {}", self.key, self.allowed, self.remedy),
        }
    }
}

/// Why a campaign file cannot run: everything at once, by line.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct CampaignError {
    /// The reasons, at least one.
    pub problems: Vec<Problem>,
}

impl Display for CampaignError {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        for (index, problem) in self.problems.iter().enumerate() {
            if index > 0 {
                f.write_str("\n")?;
            }
            problem.fmt(f)?;
        }
        Ok(())
    }
}

impl std::error::Error for CampaignError {}

/// The candidate that `written` probably means: one that contains it, or else the one with the fewest changes of letters, if
/// these are at most a third of them.
pub fn nearest<'a>(written: &str, candidates: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let candidates: Vec<&str> = candidates.into_iter().collect();
    // a name that was not written to its end
    if let Some(whole) = candidates.iter().find(|c| written.len() > 3 && c.starts_with(written)) {
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

/// Number of letters to insert, delete or replace between `a` and `b` (Levenshtein 1966).
fn changes(a: &str, b: &str) -> usize {
    let b: Vec<char> = b.chars().collect();
    let mut row: Vec<usize> = (0..=b.len()).collect();
    for (i, x) in a.chars().enumerate() {
        let mut diagonal = std::mem::replace(&mut row[0], i + 1);
        for (j, y) in b.iter().enumerate() {
            let replaced = diagonal + usize::from(x != *y);
            diagonal = row[j + 1];
            row[j + 1] = replaced.min(diagonal + 1).min(row[j] + 1);
        }
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
        assert_eq!(changes("kitten", "sitting"), 3);
    }
}
