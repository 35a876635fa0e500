//! [`TextTable`]: rows of cells as lines that fit a terminal. Every table on a screen is one.

use crate::report::wrapped::fitted;
use crate::report::wrapped::wrapped;

/// Where the text of a column stands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Align {
    /// At the left: names. Shortened in their middle where the lines are too narrow.
    Left,
    /// At the left, the first column: names, on lines of their own above the other cells where the lines are too narrow.
    Title,
    /// At the left, never shortened: verdicts.
    Whole,
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
    /// What each column is wide at least.
    least: Vec<usize>,
    /// Blank characters before each line, and between columns.
    gaps: [usize; 2],
}

impl TextTable {
    /// A table of columns with these heads.
    pub fn new<H: Into<String>>(columns: impl IntoIterator<Item = (H, Align)>) -> Self {
        let (heads, aligns): (Vec<String>, Vec<Align>) =
            columns.into_iter().map(|(head, align)| (head.into(), align)).unzip();
        TextTable { least: vec![0; aligns.len()], aligns, rows: vec![heads], gaps: [GAP; 2] }
    }

    /// The same table with these blank characters before each line and between columns.
    #[must_use]
    pub fn spaced(self, before: usize, between: usize) -> Self {
        TextTable { gaps: [before, between], ..self }
    }

    /// The same table, whose columns are this wide at least: of lines that are shown one by one.
    #[must_use]
    pub fn at_least(mut self, widths: &[usize]) -> Self {
        self.least.iter_mut().zip(widths).for_each(|(least, width)| *least = *width);
        self
    }

    /// Adds a row; cells that are not given are empty.
    pub fn row<C: Into<String>>(&mut self, cells: impl IntoIterator<Item = C>) {
        let mut cells: Vec<String> = cells.into_iter().map(Into::into).collect();
        cells.resize(self.aligns.len(), String::new());
        self.rows.push(cells);
    }

    /// What a column is wide where nothing is shortened.
    fn widest(&self, column: usize) -> usize {
        self.rows.iter().map(|row| letters(&row[column])).fold(self.least[column], usize::max)
    }

    /// Number of characters of lines with columns of these widths.
    fn used(&self, widths: &[usize]) -> usize {
        let [before, between] = self.gaps;
        before + widths.iter().sum::<usize>() + between * widths.len().saturating_sub(1)
    }

    /// Number of characters of its lines where nothing is shortened or broken.
    pub fn width(&self) -> usize {
        self.used(&(0..self.aligns.len()).map(|column| self.widest(column)).collect::<Vec<_>>())
    }

    /// The same of its first `count` columns.
    pub fn width_of(&self, count: usize) -> usize {
        self.used(&(0..count).map(|column| self.widest(column)).collect::<Vec<_>>())
    }

    /// The lines, none longer than `width` characters where that can be.
    pub fn text(&self, width: usize) -> String {
        self.lines(width).concat()
    }

    /// The lines of the last row.
    pub fn last(&self, width: usize) -> String {
        self.lines(width).pop().unwrap_or_default()
    }

    /// The lines of each row; none of heads that are empty.
    fn lines(&self, width: usize) -> Vec<String> {
        let [before, between] = self.gaps;
        let has_sentences = self.aligns.last() == Some(&Align::Sentence);
        let count = self.aligns.len() - usize::from(has_sentences);
        let mut widths: Vec<usize> = (0..count).map(|column| self.widest(column)).collect();
        let is_above = self.aligns.first() == Some(&Align::Title) && self.used(&widths) > width;
        if is_above {
            widths[0] = 0;
        }
        let sentences = self.rows.iter().map(|row| row.last().map_or(0, |cell| letters(cell))).max().unwrap_or(0);
        let room = width.saturating_sub(self.used(&widths) + between);
        let is_below = has_sentences && room < sentences.min(LEAST_SENTENCE);
        let excess = self.used(&widths).saturating_sub(width);
        let widest =
            (0..count).filter(|column| self.aligns[*column] == Align::Left).max_by_key(|column| widths[*column]);
        if let Some(widest) = widest {
            widths[widest] = widths[widest].min(widths[widest].saturating_sub(excess).max(LEAST_NAME));
        }
        let (mut lines, most) = (Vec::with_capacity(self.rows.len()), width);
        for (index, row) in self.rows.iter().enumerate() {
            let is_head = index == 0;
            if is_head && row.iter().all(String::is_empty) {
                continue;
            }
            let (mut text, mut line) = (String::new(), " ".repeat(before));
            for (column, ((cell, width), align)) in row.iter().zip(&widths).zip(&self.aligns).enumerate() {
                if column == 0 && is_above {
                    if !cell.is_empty() {
                        text += &wrapped(&format!("{line}{cell}\n"), most);
                    }
                    continue;
                }
                let cell = fitted(cell, *width, letters);
                let space = " ".repeat(width - letters(&cell));
                line += &" ".repeat(if column == 0 { 0 } else { between });
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
                let begin = letters(&line) + between;
                let said = wrapped(sentence, width.saturating_sub(begin).max(LEAST_SENTENCE));
                let hanging = format!("\n{:begin$}", "");
                let said = said.split("\n  ").collect::<Vec<_>>().join(&hanging);
                text += format!("{line}{:between$}{said}", "").trim_end();
                text.push('\n');
            }
            lines.push(text);
        }
        lines
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

    /// Law: a title stands beside its numbers, and above them where the lines are too narrow; rows without one have no such line.
    #[test]
    fn titles_stand_above_where_lines_are_narrow() {
        let mut table = TextTable::new([("outcome", Align::Title), ("median", Align::Right)]);
        table.row(["angular_rate_final_rad_s", "1.5"]);
        table.row(["", "[1.4, 1.6]"]);
        assert_eq!(
            table.text(38).lines().collect::<Vec<_>>(),
            [
                "  outcome                       median",
                "  angular_rate_final_rad_s         1.5",
                "                            [1.4, 1.6]",
            ]
        );
        let narrow = table.text(37);
        let lines: Vec<&str> = narrow.lines().map(str::trim_start).collect();
        assert_eq!(lines, ["outcome", "median", "angular_rate_final_rad_s", "1.5", "[1.4, 1.6]"], "{narrow}");
        assert!(narrow.lines().all(|line| letters(line) <= 28), "{narrow}");
    }

    /// Law: lines that are shown one by one stand below each other as those of the whole table do.
    #[test]
    fn single_lines_are_those_of_the_table() {
        let new = || TextTable::new([("a", Align::Left), ("b", Align::Right)]).at_least(&[6, 8]).spaced(0, 1);
        let (mut all, mut shown) = (new(), new().last(80));
        for cells in [["one", "1"], ["three", "-12.5"]] {
            all.row(cells);
            let mut one = new();
            one.row(cells);
            shown += &one.last(80);
        }
        assert_eq!((all.text(80), shown.lines().last()), (shown.clone(), Some("three     -12.5")));
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
