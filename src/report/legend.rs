//! [`Legend`]: names of marks in rows, none of them beyond the width.

use crate::report::figure::Mark;
use crate::report::shapes::{SWATCH, draw_swatch};
use crate::report::svg::{Anchor, Font, INK, LABEL, Svg};

/// Height of a row, pixels.
pub(super) const ROW: f64 = 20.0;
/// From the piece of a mark to its name, and a third of what separates two entries, pixels.
const GAP: f64 = 6.0;

/// The name of a mark.
#[derive(Clone, Debug, PartialEq)]
struct Entry<'m> {
    mark: &'m Mark,
    text: String,
    row: usize,
    /// Left end and right end, pixels.
    x: f64,
    end: f64,
}

/// Names of marks; each name once.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Legend<'m> {
    entries: Vec<Entry<'m>>,
}

impl<'m> Legend<'m> {
    /// The legend of `marks` in `width` pixels, in as many rows as it takes. A name that is wider than a row is shortened.
    pub(super) fn new(font: &Font, marks: impl Iterator<Item = &'m Mark>, width: f64) -> Self {
        let mut entries: Vec<Entry<'m>> = Vec::new();
        let mut known: Vec<&str> = Vec::new();
        for mark in marks {
            let name = mark.legend();
            if name.is_empty() || known.contains(&name) {
                continue;
            }
            known.push(name);
            let text = font.fitted(name, width - SWATCH - GAP, LABEL);
            let length = SWATCH + GAP + font.width(&text, LABEL);
            let (row, x) = match entries.last() {
                None => (0, 0.0),
                Some(last) if last.end + 3.0 * GAP + length <= width => (last.row, last.end + 3.0 * GAP),
                Some(last) => (last.row + 1, 0.0),
            };
            entries.push(Entry { mark, text, row, x, end: x + length });
        }
        Legend { entries }
    }

    /// Its height, pixels.
    pub(super) fn height(&self) -> f64 {
        self.entries.last().map_or(0.0, |entry| ROW * (entry.row + 1) as f64)
    }

    /// Draws it from the corner `at` on.
    pub(super) fn draw(&self, svg: &mut Svg, at: [f64; 2]) {
        for entry in &self.entries {
            let [x, y] = [at[0] + entry.x, at[1] + ROW * (entry.row as f64 + 0.5)];
            draw_swatch(svg, entry.mark, [x, y]);
            svg.text(&entry.text, [x + SWATCH + GAP, y + 4.0], LABEL, Anchor::Start, INK, false);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::figure::{Dash, Hue};

    /// Law: every curve has a name, no entry leaves the width, and none overlaps its neighbour.
    #[test]
    fn entries_stay_within_the_width() {
        const WIDTH: f64 = 540.0;
        let font = Font::new();
        let long = "a_wheel_whose_name_is_longer_than_the_whole_panel_is_wide_and_which_continues_".repeat(2);
        for (count, name, rows) in [(1, "x", 1), (3, "x", 1), (8, "wheel_number_", 3), (64, "w", 9), (5, &long, 5)] {
            let curve = |k: usize| Mark::line(format!("{name}{k}"), Hue::Body, Dash::Solid, vec![], vec![]);
            let marks: Vec<Mark> = (0..count).map(curve).collect();
            let found = Legend::new(&font, marks.iter().chain(&marks), WIDTH);
            assert_eq!((found.entries.len(), found.height()), (count, ROW * f64::from(rows)), "{count} of {name}");
            for (index, entry) in found.entries.iter().enumerate() {
                assert!(entry.end <= WIDTH && entry.text.ends_with(&index.to_string()), "{entry:?}");
            }
            for pair in found.entries.windows(2) {
                let is_next = pair[0].row == pair[1].row && pair[0].end + GAP < pair[1].x;
                assert!(is_next || (pair[0].row + 1 == pair[1].row && pair[1].x == 0.0), "{pair:?}");
            }
        }
    }
}
