//! Tables as aligned text for terminals.
//!
//! Cells are never broken: a number stays next to its unit. If lines are too narrow, names are shortened, then the
//! right columns continue on lines below the row.

use std::borrow::Cow;

use crate::table::wrapped::{fitted, wrapped};
use crate::table::{Cell, Content, Table};

/// Alignment and shortening of a column.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Align {
    /// Left: names, shortened in the middle if necessary.
    Left,
    /// Left, the first column: names, above the other cells if necessary.
    Title,
    /// Left, never shortened: verdicts, texts with numbers.
    Whole,
    Right,
    /// Left, the last column: sentences, wrapped within their column, or below the other cells if that is too narrow.
    Sentence,
}

impl From<Content> for Align {
    fn from(content: Content) -> Self {
        if content == Content::Word { Align::Left } else { Align::Right }
    }
}

/// Spaces before each line, and between columns.
const GAP: usize = 2;
/// Minimum width of sentences beside their row.
const LEAST_SENTENCE: usize = 24;
/// Indentation of sentences below their row.
const BELOW: usize = 6;
/// Extra indentation of continued rows.
const CONTINUED: usize = 4;
/// Minimum width of a shortened name.
const LEAST_NAME: usize = 12;

#[derive(Clone, Debug)]
pub struct Text<'t> {
    aligns: Vec<Align>,
    /// Heads, units if any, rows.
    rows: Vec<Vec<Cow<'t, str>>>,
    /// Number of lines of heads.
    heads: usize,
    least: Vec<usize>,
    gaps: [usize; 2],
}

impl<'t> Text<'t> {
    /// Column names are heads, with units below; empty lines are omitted.
    pub fn of(table: &'t Table<'_>) -> Self {
        let quantities = || table.columns.iter().map(|column| &column.quantity);
        let heads: [Vec<Cow<'t, str>>; 2] = [
            quantities().map(|quantity| quantity.name().into()).collect(),
            quantities().map(|quantity| quantity.unit().into()).collect(),
        ];
        let mut rows: Vec<_> = heads.into_iter().filter(|line| line.iter().any(|head| !head.is_empty())).collect();
        let heads = rows.len();
        let text = |cell| match cell {
            Cell::Null => "-".into(),
            Cell::Real(number) => format!("{number:?}").into(),
            Cell::Count(count) => count.to_string().into(),
            Cell::Text(text) => text.into(),
        };
        rows.extend((0..table.rows()).map(|row| table.values.iter().map(|of| text(of.cell(row))).collect::<Vec<_>>()));
        let aligns: Vec<Align> = table.columns.iter().map(|column| column.align).collect();
        Text { least: vec![0; aligns.len()], aligns, rows, heads, gaps: [GAP; 2] }
    }

    /// Sets the spaces before each line and between columns.
    #[must_use]
    pub fn spaced(self, before: usize, between: usize) -> Self {
        Text { gaps: [before, between], ..self }
    }

    /// Sets minimum column widths, for tables shown row by row.
    #[must_use]
    pub fn at_least(self, widths: &[usize]) -> Self {
        Text { least: widths.to_vec(), ..self }
    }

    #[must_use]
    pub fn first(mut self, rows: usize) -> Self {
        self.rows.truncate(self.heads.saturating_add(rows));
        self
    }

    /// Widths of the values of a column and of their intervals, which stand below each other.
    fn parts(&self, column: usize) -> [usize; 2] {
        let is_right = self.aligns[column] == Align::Right;
        let parts = self.rows[self.heads..].iter().map(|row| split(&row[column], is_right).map(letters));
        parts.fold([0; 2], |[a, b], [value, interval]| [a.max(value), b.max(interval)])
    }

    /// Width of a column whose cells have these `parts`.
    fn wide(&self, column: usize, parts: [usize; 2]) -> usize {
        let heads = self.rows[..self.heads].iter().map(|row| letters(&row[column]));
        heads.fold(self.least[column].max(parts[0] + parts[1]), usize::max)
    }

    fn widest(&self, column: usize) -> usize {
        self.wide(column, self.parts(column))
    }

    fn used(&self, widths: &[usize]) -> usize {
        let [before, between] = self.gaps;
        before + widths.iter().sum::<usize>() + between * widths.len().saturating_sub(1)
    }

    pub fn width(&self) -> usize {
        self.width_of(self.aligns.len())
    }

    /// Full width of the first `count` columns.
    pub fn width_of(&self, count: usize) -> usize {
        self.used(&(0..count).map(|column| self.widest(column)).collect::<Vec<_>>())
    }

    /// Lines of at most `width` characters, unless a single cell is wider.
    pub fn lines(&self, width: usize) -> String {
        self.blocks(width).concat()
    }

    pub fn head(&self, width: usize) -> String {
        self.blocks(width)[..self.heads].concat()
    }

    pub fn body(&self, width: usize) -> String {
        self.blocks(width)[self.heads..].concat()
    }

    /// The first column of each line of a row, filled greedily; lines after the first are `continued` by more spaces.
    fn starts(&self, widths: &[usize], width: usize, continued: usize) -> Vec<usize> {
        let [before, between] = self.gaps;
        let (mut starts, mut used) = (vec![0], before);
        for (column, needed) in widths.iter().enumerate() {
            let is_first = starts.last() == Some(&column);
            let wider = used + if is_first { 0 } else { between } + needed;
            used = if wider > width && !is_first {
                starts.push(column);
                before + continued + needed
            } else {
                wider
            };
        }
        starts
    }

    fn blocks(&self, width: usize) -> Vec<String> {
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
        // a title above leaves its gap, so that columns keep their place
        let continued = if is_above { between } else { CONTINUED };
        let mut parts: Vec<[usize; 2]> = (0..count).map(|column| self.parts(column)).collect();
        if is_above && self.starts(&widths, width, continued).len() > 1 {
            // the lines of a row share their columns
            let most = parts[1..].iter().fold([0; 2], |[a, b], [value, interval]| [a.max(*value), b.max(*interval)]);
            let widest = (1..count).map(|column| self.wide(column, most)).max().unwrap_or(0);
            parts[1..].fill(most);
            widths[1..].fill(widest);
        }
        let starts = self.starts(&widths, width, continued);
        let mut blocks = Vec::with_capacity(self.rows.len());
        let mut alike = 0;
        for (index, row) in self.rows.iter().enumerate() {
            let is_head = index < self.heads;
            let (mut text, mut line) = (String::new(), " ".repeat(before));
            for (column, ((cell, cell_width), align)) in row.iter().zip(&widths).zip(&self.aligns).enumerate() {
                if column == 0 && is_above {
                    if !cell.is_empty() {
                        text += &wrapped(&format!("{line}{cell}\n"), width);
                    }
                    continue;
                }
                let is_start = starts.contains(&column);
                if is_start && column > 0 {
                    push_line(&mut text, &line);
                    line = " ".repeat(before + continued);
                }
                let [value, interval] = split(cell, *align == Align::Right && !is_head);
                let cell = match parts[column][1] {
                    wide if wide > 0 && !is_head => format!("{value}{interval:wide$}"),
                    _ => fitted(cell, *cell_width, letters),
                };
                let space = " ".repeat(cell_width - letters(&cell));
                line += &" ".repeat(if is_start { 0 } else { between });
                line += &if *align == Align::Right { space + &cell } else { cell + &space };
            }
            let sentence = row.last().filter(|_| has_sentences).map_or("", |sentence| sentence);
            if is_below || starts.len() > 1 {
                push_line(&mut text, &line);
                // repeated sentences appear once, with the number of their rows
                alike = if is_head { 0 } else { alike + 1 };
                if self.rows.get(index + 1).is_none_or(|next| next.last() != row.last()) {
                    let of = if alike > 1 { format!("the {alike} above: ") } else { String::new() };
                    if !sentence.is_empty() && alike > 0 {
                        text += &wrapped(&format!("{:BELOW$}{of}{sentence}\n", ""), width);
                    }
                    alike = 0;
                }
            } else {
                let begin = letters(&line) + between;
                let said = wrapped(sentence, width.saturating_sub(begin).max(LEAST_SENTENCE));
                let hanging = format!("\n{:begin$}", "");
                let said = said.split("\n  ").collect::<Vec<_>>().join(&hanging);
                push_line(&mut text, &format!("{line}{:between$}{said}", ""));
            }
            blocks.push(text);
        }
        blocks
    }
}

/// A number and its interval, " [1, 2]", if it `has_interval`.
fn split(cell: &str, has_interval: bool) -> [&str; 2] {
    let at = cell.find(" [").filter(|_| has_interval).unwrap_or(cell.len());
    cell.split_at(at).into()
}

fn push_line(text: &mut String, line: &str) {
    *text += line.trim_end();
    text.push('\n');
}

fn letters(text: &str) -> usize {
    text.chars().count()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::table::tests::every_kind;

    fn table() -> Table<'static> {
        let heads = [("name", Align::Left), ("value", Align::Right), ("meaning", Align::Sentence)];
        let mut table = Table::with(heads);
        table.row(["initial.position_m.x", "12.5", "normal about the nominal value, with the same deviation"]);
        table.row(["initial.position_m.y", "-3", "normal about the nominal value, with the same deviation"]);
        table.row(["b", "4e-9", "uniform"]);
        table
    }

    /// Law: columns are aligned; a wide table has a line per row; repeated sentences below rows appear once, with
    /// the number of their rows.
    #[test]
    fn columns_stand_below_each_other() {
        let text = table().text(120);
        let lines: Vec<&str> = text.lines().collect();
        assert_eq!(lines.len(), 4, "{text}");
        let end = lines[0].find("value").map(|at| at + 5);
        assert!(lines[1].find("12.5").map(|at| at + 4) == end && lines[2].find("-3").map(|at| at + 2) == end, "{text}");
        assert!(lines[3].starts_with("  b  ") && lines[1].starts_with("  initial.position_m.x  "), "{text}");
        let narrow = table().text(40);
        assert_eq!(narrow.matches("the 2 above: normal about").count(), 1, "{narrow}");
        assert!(narrow.lines().any(|line| line.trim() == "uniform"), "{narrow}");
    }

    /// Law: numbers, with and without intervals, stand below each other, also on the several lines of a row.
    #[test]
    fn intervals_are_aligned() {
        let heads = ["median", "p5", "mean", "max"].map(|head| (head, Align::Right));
        let mut table = Table::with([("outcome", Align::Title)].into_iter().chain(heads));
        table.row(["a", "0.51 [0.38, 0.60]", "1.5 [?, 2]", "0.502 [0.433, 0.581]", "1.16"]);
        table.row(["b", "2030 [1870, 2160]", "-", "-0.0030 [-0.0038, 0.0033]", "3194"]);
        for (width, lines, columns) in [(200, 3, 3), (60, 9, 2), (40, 15, 1)] {
            let text = table.text(width);
            let places = text.lines().flat_map(|line| line.match_indices(" [").map(|(at, _)| at));
            let places = places.collect::<std::collections::BTreeSet<_>>();
            assert_eq!((text.lines().count(), places.len()), (lines, columns), "{width}:\n{text}");
        }
    }

    /// Law: at every width and for all alignments, numbers stay whole with their units and in order, and lines fit; a
    /// table that fits has a line per row. A table of a hundred columns never fits.
    #[test]
    fn numbers_are_never_broken() {
        let number = |row: usize, column: usize| format!("{}.{}e-{} km/s", 7 * row + column, column * column, row + 1);
        for first in [Align::Left, Align::Title, Align::Whole] {
            for count in [2, 5, 10, 100] {
                let heads =
                    (1..count).map(|column| (format!("p{column} [m/s]"), [Align::Right, Align::Whole][column % 2]));
                let mut table = Table::with([("name".to_owned(), first)].into_iter().chain(heads));
                for row in 0..3 {
                    table.row(["wheel_1".to_owned()].into_iter().chain((1..count).map(|column| number(row, column))));
                }
                for width in 40..=200 {
                    let text = table.text(width);
                    assert!(text.lines().all(|line| letters(line) <= width), "{width}:\n{text}");
                    let mut rest = text.as_str();
                    for row in 0..3 {
                        for column in 1..count {
                            let number = number(row, column);
                            let at = rest.find(&number).unwrap_or_else(|| panic!("{width}: {number} in\n{text}"));
                            rest = &rest[at + number.len()..];
                        }
                    }
                    let is_whole = Text::of(&table).width() <= width;
                    assert_eq!(text.lines().count() == 4, is_whole, "{width}:\n{text}");
                }
            }
        }
    }

    /// Law: all values of every kind appear; null is a dash, units stand below the heads.
    #[test]
    fn every_kind_of_value_is_shown() {
        let table = every_kind();
        let text = table.text(usize::MAX);
        for (column, values) in table.columns.iter().zip(&table.values) {
            assert!(text.contains(column.quantity.name()));
            for row in 0..table.rows() {
                assert!(match values.cell(row) {
                    Cell::Null => text.contains(" - "),
                    Cell::Real(number) => text.contains(&format!("{number:?}")),
                    Cell::Count(count) => text.contains(&count.to_string()),
                    Cell::Text(words) => text.contains(words),
                });
            }
        }
        assert_eq!(text.lines().nth(1).map(|units| units.matches("m/s").count()), Some(5));
    }
}
