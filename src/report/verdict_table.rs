//! [`text`]: verdicts as a table: word, requirement, what was found, notes. Where that is too wide, what was found is
//! below what is required.

use crate::table::Table;
use crate::table::text::{Align, Text};
use crate::table::wrapped::wrapped;

/// A requirement with its verdict, in words.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct VerdictRow {
    /// `PASS`, `FAIL` or `UNDECIDED`.
    pub word: String,
    pub required: String,
    pub found: String,
    pub notes: String,
}

/// The lines of `rows`, below the heads of what is required and what was found where there are any.
pub fn text([required, found]: [&str; 2], rows: &[VerdictRow], width: usize) -> String {
    let heads = [("", Align::Left), (required, Align::Left), (found, Align::Left), ("", Align::Sentence)];
    let mut table = Table::with(heads);
    let longest = rows.iter().map(|one| one.word.len()).max().unwrap_or(0);
    let mut lines = match required {
        "" => String::new(),
        _ => wrapped(&format!("  {:longest$}  {required}: {found}\n", ""), width),
    };
    for VerdictRow { word, required, found, notes } in rows {
        table.row([word, required, found, notes]);
        let said = [found.as_str(), notes].into_iter().filter(|text| !text.is_empty()).collect::<Vec<_>>().join("; ");
        lines += &wrapped(&format!("  {word:longest$}  {required}\n"), width);
        if !said.is_empty() {
            lines += &wrapped(&format!("  {:longest$}    {said}\n", ""), width);
        }
    }
    if Text::of(&table).width_of(3) > width { lines } else { table.text(width) }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Law: at every width every word is there, in its order, and no line is longer; where a table fits, each
    /// requirement has one line.
    #[test]
    fn verdicts_fit_their_width() {
        let row = |word: &str, required: &str| VerdictRow {
            word: word.to_owned(),
            required: required.to_owned(),
            found: "97.7% [95.3, 99.1]".to_owned(),
            notes: String::new(),
        };
        let rows = [row("PASS", "launched in 95%"), row("UNDECIDED", "body rate at launch <= 0.2 deg/s in 95%")];
        for width in 30..120 {
            let text = text(["requirement", "runs within [95%]"], &rows, width);
            assert!(text.lines().all(|line| line.chars().count() <= width), "{width}:\n{text}");
            let words = text.split_whitespace().collect::<Vec<_>>().join(" ");
            assert!(words.contains("UNDECIDED body rate at launch <= 0.2 deg/s in 95% 97.7% [95.3, 99.1]"), "{text}");
            assert_eq!(text.lines().count() == 3, width >= 72, "{width}:\n{text}");
        }
        assert!(super::text(["", ""], &rows, 80).starts_with("  PASS       launched in 95%"));
    }
}
