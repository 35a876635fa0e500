//! [`TextTable`]: rows of cells as lines that fit a terminal. Every table on a screen is one.

use crate::report::fitted_text::fitted;
use crate::report::wrapped::wrapped;

/// Where the text of a column stands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Align {
    /// At the left: names. Shortened in their middle where the lines are too narrow.
    Left,
    /// At the right: numbers.
    Right,
    /// At the left, the last column: sentences, broken into lines in their column, or below the other cells where that is too narrow.
    Sentence,
}

/// Blank characters before each line, and between columns.
const GAP: usize = 2;
/// Least width of a column of sentences; narrower ones stand below their rows.
const LEAST_SENTENCE: usize = 24;
/// Indentation of sentences below their rows.
const BELOW: usize = 6;
/// A name is not shortened to less.
const LEAST_NAME: usize = 12;

/// Rows of cells with their heads.
#[derive(Clone, Debug)]
pub struct TextTable {
    aligns: Vec<Align>,
    /// The heads are the first row; none where all are empty.
    rows: Vec<Vec<String>>,
}

impl TextTable {
    /// A table of columns with these heads.
    pub fn new<H: Into<String>>(columns: impl IntoIterator<Item = (H, Align)>) -> Self {
        let (heads, aligns): (Vec<String>, Vec<Align>) =
            columns.into_iter().map(|(head, align)| (head.into(), align)).unzip();
        TextTable { aligns, rows: vec![heads] }
    }

    /// Adds a row; cells that are not given are empty.
    pub fn row<C: Into<String>>(&mut self, cells: impl IntoIterator<Item = C>) {
        let mut cells: Vec<String> = cells.into_iter().map(Into::into).collect();
        cells.resize(self.aligns.len(), String::new());
        self.rows.push(cells);
    }

    /// Number of characters of its lines where nothing is shortened or broken.
    pub fn width(&self) -> usize {
        let widest = |column: usize| self.rows.iter().map(|row| letters(&row[column])).max().unwrap_or(0);
        (0..self.aligns.len()).map(|column| widest(column) + GAP).sum()
    }

    /// The lines, none longer than `width` characters where that can be.
    pub fn text(&self, width: usize) -> String {
        let has_sentences = self.aligns.last() == Some(&Align::Sentence);
        let count = self.aligns.len() - usize::from(has_sentences);
        let mut widths: Vec<usize> =
            (0..count).map(|column| self.rows.iter().map(|row| letters(&row[column])).max().unwrap_or(0)).collect();
        let used = |widths: &[usize]| widths.iter().map(|width| width + GAP).sum::<usize>();
        let sentences = self.rows.iter().map(|row| row.last().map_or(0, |cell| letters(cell))).max().unwrap_or(0);
        let room = width.saturating_sub(used(&widths) + GAP);
        let is_below = has_sentences && room < sentences.min(LEAST_SENTENCE);
        let excess = used(&widths).saturating_sub(width);
        let widest =
            (0..count).filter(|column| self.aligns[*column] == Align::Left).max_by_key(|column| widths[*column]);
        if let Some(widest) = widest {
            widths[widest] = widths[widest].min(widths[widest].saturating_sub(excess).max(LEAST_NAME));
        }
        let mut text = String::new();
        for (index, row) in self.rows.iter().enumerate() {
            let is_head = index == 0;
            if is_head && row.iter().all(String::is_empty) {
                continue;
            }
            let mut line = String::new();
            for ((cell, width), align) in row.iter().zip(&widths).zip(&self.aligns) {
                let cell = fitted(cell, *width, letters);
                let space = " ".repeat(width - letters(&cell));
                line += "  ";
                line += &if *align == Align::Right { space + &cell } else { cell + &space };
            }
            let sentence = row.last().filter(|_| has_sentences).map_or("", String::as_str);
            if is_below {
                text += line.trim_end();
                text.push('\n');
                // rows that say the same say it once
                let is_said_later = self.rows.get(index + 1).is_some_and(|next| next.last() == row.last());
                if !sentence.is_empty() && !is_head && !is_said_later {
                    text += &wrapped(&format!("{:BELOW$}{sentence}\n", ""), width);
                }
            } else {
                let begin = letters(&line) + GAP;
                let lines = wrapped(sentence, width.saturating_sub(begin).max(LEAST_SENTENCE));
                let hanging = format!("\n{:begin$}", "");
                text += format!("{line}  {}", lines.split("\n  ").collect::<Vec<_>>().join(&hanging)).trim_end();
                text.push('\n');
            }
        }
        text
    }
}

fn letters(text: &str) -> usize {
    text.chars().count()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn table() -> TextTable {
        let heads = [("name", Align::Left), ("value", Align::Right), ("meaning", Align::Sentence)];
        let mut table = TextTable::new(heads);
        table.row(["initial.position_m.x", "12.5", "normal about the nominal value, with the same deviation"]);
        table.row(["initial.position_m.y", "-3", "normal about the nominal value, with the same deviation"]);
        table.row(["b", "4e-9", "uniform"]);
        table
    }

    /// Law: at every width that a terminal has no line is longer, each number stands whole, and every word of a sentence is there, in its order.
    #[test]
    fn a_table_fits_and_says_all() {
        for width in 30..140 {
            let text = table().text(width);
            assert!(text.lines().all(|line| letters(line) <= width), "{width}:\n{text}");
            for number in ["12.5", "-3", "4e-9", "uniform", "deviation"] {
                assert!(text.split_whitespace().any(|word| word == number), "{width}: {number}\n{text}");
            }
            let words = text.split_whitespace().collect::<Vec<_>>().join(" ");
            let is_whole = words.contains("normal about the nominal value, with the same deviation");
            assert!(is_whole || width > 60, "{width}:\n{text}");
        }
    }

    /// Law: numbers end and names begin in one column; a wide table has a line for each row; below their rows equal sentences stand once.
    #[test]
    fn columns_stand_below_each_other() {
        let text = table().text(120);
        let lines: Vec<&str> = text.lines().collect();
        assert_eq!(lines.len(), 4, "{text}");
        let end = lines[0].find("value").map(|at| at + 5);
        assert!(lines[1].find("12.5").map(|at| at + 4) == end && lines[2].find("-3").map(|at| at + 2) == end, "{text}");
        assert!(lines[3].starts_with("  b  ") && lines[1].starts_with("  initial.position_m.x  "), "{text}");
        let narrow = table().text(40);
        assert_eq!(narrow.matches("normal about").count(), 1, "{narrow}");
        assert!(narrow.lines().any(|line| line.trim() == "uniform"), "{narrow}");
    }

    /// Law: a name is cut in its middle; a table without heads has no line for them.
    #[test]
    fn names_are_cut_in_the_middle() {
        let mut table = TextTable::new([("", Align::Left), ("", Align::Right)]);
        table.row(["initial.debris_angular_velocity_rad_s.x", "1.000"]);
        let text = table.text(40);
        assert!(text.starts_with("  initial.debris") && text.ends_with("_rad_s.x  1.000\n"), "{text}");
        assert!(text.contains("...") && text.lines().count() == 1, "{text}");
    }
}
