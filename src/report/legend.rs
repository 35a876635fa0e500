//! [`Legend`]: names of curves in rows between the title and the axes of a panel, none of them outside of it.

use plotters::coord::Shift;
use plotters::element::DashedPathElement;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

use crate::report::canvas::{COLORS, PlotError, drawing};
use crate::report::fitted_text::{fitted_to_pixels, text_width};

/// Height of a row, pixels.
pub(super) const ROW_HEIGHT: u32 = 22;
/// Rows that a panel has space for: the axes keep two thirds of its height. More rows make the panel higher.
const USUAL_ROWS: u32 = 3;
/// Length of the piece of a curve before its name, pixels.
const SAMPLE: u32 = 26;
/// From this piece to the name, and a third of what separates two entries, pixels.
const GAP: u32 = 6;
/// Size of the names, pixels.
const FONT: u32 = 14;

/// Dash and gap of the curves of a panel in their order, pixels: curves differ without colour too.
const DASHES: [Option<(u32, u32)>; 4] = [None, Some((8, 4)), Some((3, 3)), Some((14, 4))];
/// After so many curves colours and dashes would repeat together.
const PERIOD: usize = 12;

/// Colour and width of a curve.
pub(super) fn style(index: usize, scale: u32) -> ShapeStyle {
    COLORS[index % COLORS.len()].stroke_width(scale + scale / 2)
}

/// Dash and gap of a curve at scale 1, pixels; `None` for a solid one.
pub(super) fn dash(index: usize) -> Option<(u32, u32)> {
    DASHES[(index + index / PERIOD) % DASHES.len()]
}

/// The name of a curve.
#[derive(Clone, Debug, PartialEq)]
struct Entry {
    text: String,
    row: usize,
    /// Left end, pixels.
    x: u32,
    /// Right end of the text, pixels.
    end: u32,
}

/// A legend at scale 1.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Legend {
    entries: Vec<Entry>,
}

impl Legend {
    /// The legend of curves with these names in `width` pixels, in as many rows as it takes. A name that is wider than a row is shortened.
    ///
    /// # Errors
    /// [`PlotError::Drawing`].
    pub(super) fn new<'a>(names: impl IntoIterator<Item = &'a str>, width: u32) -> Result<Self, PlotError> {
        let mut entries: Vec<Entry> = Vec::new();
        for name in names {
            let text = fitted_to_pixels(name, width.saturating_sub(SAMPLE + GAP), FONT)?;
            let length = SAMPLE + GAP + text_width(&text, FONT)? as u32;
            let (row, x) = next(&entries, length, width);
            entries.push(Entry { text, row, x, end: x + length });
        }
        Ok(Legend { entries })
    }

    /// Its height at scale 1, pixels.
    pub(super) fn height(&self) -> u32 {
        self.entries.last().map_or(1, |entry| entry.row as u32 + 1) * ROW_HEIGHT
    }

    /// What it needs beyond the height that a panel has for it, at scale 1, pixels.
    pub(super) fn extra_height(&self) -> u32 {
        self.height().saturating_sub(USUAL_ROWS * ROW_HEIGHT)
    }

    /// Draws it from `left` pixels (at scale 1) on in `strip`.
    ///
    /// # Errors
    /// [`PlotError::Drawing`].
    pub(super) fn draw<B: DrawingBackend>(
        &self,
        strip: &DrawingArea<B, Shift>,
        left: u32,
        scale: u32,
    ) -> Result<(), PlotError> {
        let font = ("sans-serif", FONT * scale).into_text_style(strip).pos(Pos::new(HPos::Left, VPos::Center));
        for (curve, entry) in self.entries.iter().enumerate() {
            let middle = (((entry.row as u32 * ROW_HEIGHT) + ROW_HEIGHT / 2) * scale) as i32;
            let x = ((left + entry.x) * scale) as i32;
            let (line, style) = ([(x, middle), (x + (SAMPLE * scale) as i32, middle)], style(curve, scale));
            match dash(curve) {
                None => strip.draw(&PathElement::new(line, style)),
                Some((dash, gap)) => strip.draw(&DashedPathElement::new(line, dash * scale, gap * scale, style)),
            }
            .map_err(drawing)?;
            let text_at = x + ((SAMPLE + GAP) * scale) as i32;
            strip.draw_text(&entry.text, &font, (text_at, middle)).map_err(drawing)?;
        }
        Ok(())
    }
}

/// Row and left end of another entry of this length.
fn next(entries: &[Entry], length: u32, width: u32) -> (usize, u32) {
    let Some(last) = entries.last() else { return (0, 0) };
    let x = last.end + 3 * GAP;
    if x + length <= width { (last.row, x) } else { (last.row + 1, 0) }
}

#[cfg(test)]
mod tests {
    use super::*;

    const WIDTH: u32 = 540;

    fn legend(count: usize, name: &str) -> Legend {
        let names: Vec<String> = (0..count).map(|k| format!("{name}{k}")).collect();
        Legend::new(names.iter().map(String::as_str), WIDTH).unwrap()
    }

    /// Law: every curve has a name, no entry leaves the width, and none overlaps its neighbour.
    #[test]
    fn entries_stay_within_the_width() {
        let long = "a_wheel_whose_name_is_longer_than_the_whole_panel_is_wide_and_which_continues_".repeat(2);
        for (count, name) in [(1, "x"), (3, "x"), (8, "wheel_number_"), (12, "wheel_number_"), (64, "w"), (5, &long)] {
            let found = legend(count, name);
            assert_eq!(found.entries.len(), count, "{count} of {name}");
            for (index, entry) in found.entries.iter().enumerate() {
                assert!(entry.end <= WIDTH && entry.text.ends_with(&index.to_string()), "{entry:?}");
                assert_eq!(entry.end - entry.x - SAMPLE - GAP, text_width(&entry.text, FONT).unwrap() as u32);
            }
            for pair in found.entries.windows(2) {
                let is_next = pair[0].row == pair[1].row && pair[0].end + GAP < pair[1].x;
                assert!(is_next || (pair[0].row + 1 == pair[1].row && pair[1].x == 0), "{pair:?}");
            }
        }
        // few names are in one row, many in three or more; only these make a panel higher
        assert_eq!([legend(3, "x").height(), legend(8, "wheel_number_").height()], [ROW_HEIGHT, 3 * ROW_HEIGHT]);
        assert_eq!([legend(3, "x").extra_height(), legend(8, "wheel_number_").extra_height()], [0, 0]);
        assert_eq!(legend(5, &long).extra_height(), 2 * ROW_HEIGHT);
    }

    /// Law: two dozen curves differ in colour or dash.
    #[test]
    fn curves_differ() {
        let looks: Vec<_> = (0..2 * PERIOD).map(|index| (style(index, 1).color.rgb(), dash(index))).collect();
        for (index, look) in looks.iter().enumerate() {
            assert!(!looks[..index].contains(look), "{index}: {look:?}");
        }
    }
}
