//! [`Legend`]: names of curves in rows between the title and the axes of a panel, none of them outside of it.

use plotters::coord::Shift;
use plotters::element::DashedPathElement;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

use crate::report::canvas::{COLORS, PlotError, drawing};
use crate::report::fitted_text::{fitted_to_pixels, text_width};

/// Height of a row, pixels.
pub(super) const ROW_HEIGHT: u32 = 22;
/// Most rows: the axes keep two thirds of their height.
const MOST_ROWS: usize = 3;
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

/// The name of a curve, or how many have none.
#[derive(Clone, Debug, PartialEq)]
struct Entry {
    /// The curve, unless the entry counts others.
    curve: Option<usize>,
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
    /// The legend of curves with these names in `width` pixels: in as many rows as it takes, up to three. A name that is wider than a row is
    /// shortened; what does not fit in three rows is counted ("and 5 more").
    ///
    /// # Errors
    /// [`PlotError::Drawing`].
    pub(super) fn new<'a>(names: impl IntoIterator<Item = &'a str>, width: u32) -> Result<Self, PlotError> {
        let names: Vec<&str> = names.into_iter().collect();
        let mut entries: Vec<Entry> = Vec::new();
        for (index, name) in names.iter().enumerate() {
            let text = fitted_to_pixels(name, width.saturating_sub(SAMPLE + GAP), FONT)?;
            let length = SAMPLE + GAP + text_width(&text, FONT)? as u32;
            let (row, x) = next(&entries, length, width);
            if row >= MOST_ROWS {
                count_others(&mut entries, names.len(), width)?;
                break;
            }
            entries.push(Entry { curve: Some(index), text, row, x, end: x + length });
        }
        Ok(Legend { entries })
    }

    /// Its height at scale 1, pixels.
    pub(super) fn height(&self) -> u32 {
        self.entries.last().map_or(1, |entry| entry.row as u32 + 1) * ROW_HEIGHT
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
        for entry in &self.entries {
            let middle = (((entry.row as u32 * ROW_HEIGHT) + ROW_HEIGHT / 2) * scale) as i32;
            let x = ((left + entry.x) * scale) as i32;
            let mut text_at = x;
            if let Some(curve) = entry.curve {
                let (line, style) = ([(x, middle), (x + (SAMPLE * scale) as i32, middle)], style(curve, scale));
                match dash(curve) {
                    None => strip.draw(&PathElement::new(line, style)),
                    Some((dash, gap)) => strip.draw(&DashedPathElement::new(line, dash * scale, gap * scale, style)),
                }
                .map_err(drawing)?;
                text_at += ((SAMPLE + GAP) * scale) as i32;
            }
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

/// Puts the number of curves without a name, of `all`, at the end of the last row; names make space for it.
fn count_others(entries: &mut Vec<Entry>, all: usize, width: u32) -> Result<(), PlotError> {
    loop {
        let text = format!("and {} more", all - entries.len());
        let length = text_width(&text, FONT)? as u32;
        let (row, x) = next(entries, length, width);
        if row < MOST_ROWS || entries.is_empty() {
            entries.push(Entry { curve: None, text, row, x, end: x + length });
            return Ok(());
        }
        entries.pop();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const WIDTH: u32 = 540;

    fn legend(count: usize, name: &str) -> Legend {
        let names: Vec<String> = (0..count).map(|k| format!("{name}{k}")).collect();
        Legend::new(names.iter().map(String::as_str), WIDTH).unwrap()
    }

    /// Law: no entry leaves the width, none overlaps its neighbour, and every curve has a name or is counted.
    #[test]
    fn entries_stay_within_the_width() {
        let long = "a_wheel_whose_name_is_longer_than_the_whole_panel_is_wide_and_which_continues_".repeat(2);
        for (count, name) in [(1, "x"), (3, "x"), (8, "wheel_number_"), (12, "wheel_number_"), (64, "w"), (5, &long)] {
            let found = legend(count, name);
            for entry in &found.entries {
                assert!(entry.end <= WIDTH && entry.row < MOST_ROWS, "{entry:?}");
                let sample = if entry.curve.is_some() { SAMPLE + GAP } else { 0 };
                assert_eq!(entry.end - entry.x - sample, text_width(&entry.text, FONT).unwrap() as u32);
            }
            for pair in found.entries.windows(2).filter(|pair| pair[0].row == pair[1].row) {
                assert!(pair[0].end + GAP < pair[1].x, "{pair:?}");
            }
            let named = found.entries.iter().filter(|entry| entry.curve.is_some()).count();
            let counted = found.entries.iter().find(|entry| entry.curve.is_none());
            let expected = (named < count).then(|| format!("and {} more", count - named));
            assert_eq!(counted.map(|entry| entry.text.clone()), expected, "{count} of {name}");
            assert!(named >= count.min(2), "{named} of {count} are named");
        }
        // few names are in one row, many in three
        assert_eq!([legend(3, "x").height(), legend(8, "wheel_number_").height()], [ROW_HEIGHT, 3 * ROW_HEIGHT]);
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
