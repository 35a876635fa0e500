//! [`Excerpt`]: a line of a campaign file with a mark under the problem; [`printable`]: text without control sequences.

use std::borrow::Cow;
use std::fmt::{self, Display, Formatter, Write};
use std::ops::Range;

/// Most characters shown.
const WIDTH: usize = 100;
/// Characters shown before the mark in a longer line.
const BEFORE: usize = 30;

#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Excerpt {
    /// The line, or its part around the mark, without control characters.
    pub line: String,
    pub before: usize,
    /// At least one.
    pub marked: usize,
}

impl Excerpt {
    /// `line` with a mark under the bytes `span`; `None` if they begin after its end.
    pub(super) fn new(line: &str, span: Range<usize>) -> Option<Self> {
        let (before, rest) = (line.get(..span.start)?, line.get(span.start..)?);
        let marked = rest.get(..span.len().min(rest.len())).unwrap_or(rest).trim_end();
        let of_before = before.chars().rev().take(WIDTH).count();
        let is_cut = of_before > BEFORE && line.chars().take(WIDTH + 1).count() > WIDTH;
        let dropped = if is_cut { before.char_indices().nth_back(BEFORE - 1).map_or(0, |(at, _)| at) } else { 0 };
        let shown: String = line[dropped..].chars().take(WIDTH).map(visible).collect();
        let before = line[dropped..span.start].chars().count();
        let marked = marked.chars().take(WIDTH.saturating_sub(before)).count().max(1);
        Some(Excerpt { line: shown, before, marked })
    }
}

/// A harmless character one column wide.
fn visible(letter: char) -> char {
    match letter {
        '\t' => ' ',
        letter if is_unsafe(letter) => '\u{fffd}',
        letter => letter,
    }
}

impl Display for Excerpt {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "    | {}\n    | {:before$}{:^<marked$}",
            self.line,
            "",
            "",
            before = self.before,
            marked = self.marked
        )
    }
}

/// True if a terminal may obey `letter` or change the reading order for it.
fn is_unsafe(letter: char) -> bool {
    letter.is_control() || matches!(letter, '\u{200e}' | '\u{200f}' | '\u{2028}'..='\u{202e}' | '\u{2066}'..='\u{2069}')
}

/// `text` with unsafe characters escaped (`\u{1b}`).
pub fn printable(text: &str) -> Cow<'_, str> {
    let is_harmless = |letter: char| matches!(letter, '\n' | '\t') || !is_unsafe(letter);
    if text.chars().all(is_harmless) {
        return Cow::Borrowed(text);
    }
    let mut escaped = String::with_capacity(text.len() + 8);
    for letter in text.chars() {
        if is_harmless(letter) {
            escaped.push(letter);
        } else {
            let _ = write!(escaped, "{}", letter.escape_unicode()); // writing to a String does not fail
        }
    }
    Cow::Owned(escaped)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Law: the mark is under the value in short and long lines with any letters.
    #[test]
    fn the_mark_is_under_the_value() {
        let shown = |line: &str, from: &str| {
            let start = line.find(from).unwrap();
            Excerpt::new(line, start..start + from.len()).unwrap().to_string()
        };
        assert_eq!(shown("seed = -1", "-1"), "    | seed = -1\n    |        ^^");
        let long = format!("{} = 7{}", "\u{e9}".repeat(500), "x".repeat(500));
        let found = shown(&long, "7");
        let lines: Vec<&str> = found.lines().collect();
        let (column, mark) = (|text: &str, c| text.chars().position(|letter| letter == c), lines[1]);
        assert_eq!(column(lines[0], '7'), column(mark, '^'));
        assert!(lines[0].chars().count() < WIDTH + 10);
        assert_eq!(Excerpt::new("short", 9..10), None);
    }
}
