//! [`Svg`]: a picture as the text of an SVG file.
//!
//! Letters are outlines of the font in `assets/` (a subset of DejaVu Sans, licence beside it), each stored once and placed where it is used: browsers and
//! [`super::image`] draw the same picture, whatever fonts a system has. Every text is the label of its group too, so that it can be found and read aloud.

use std::collections::BTreeMap;
use std::fmt::Write as _;

use ttf_parser::{Face, GlyphId, OutlineBuilder};

use crate::report::escaped::escaped;
use crate::table::wrapped::fitted;

static FONT: &[u8] = include_bytes!("../../assets/DejaVuSans-subset.ttf");

/// Colour of texts; size of most of them, pixels.
pub(super) const INK: &str = "#1a1a1a";
pub(super) const LABEL: f64 = 12.0;

pub(super) struct Font {
    face: Option<Face<'static>>,
}

impl Font {
    /// The font in `assets/`.
    pub(super) fn new() -> Self {
        Font { face: Face::parse(FONT, 0).ok() }
    }

    fn units(&self) -> f64 {
        self.face.as_ref().map_or(1.0, |face| f64::from(face.units_per_em()))
    }

    fn glyph(&self, letter: char) -> GlyphId {
        self.face.as_ref().and_then(|face| face.glyph_index(letter)).unwrap_or_default()
    }

    /// Units from a letter to the next.
    fn advance(&self, glyph: GlyphId) -> f64 {
        self.face.as_ref().and_then(|face| face.glyph_hor_advance(glyph)).map_or(0.0, f64::from)
    }

    /// The width of a text, pixels.
    pub(super) fn width(&self, text: &str, size: f64) -> f64 {
        text.chars().map(|letter| self.advance(self.glyph(letter))).sum::<f64>() * size / self.units()
    }

    /// `text`, shortened where it is wider than `width` pixels.
    pub(super) fn fitted(&self, text: &str, width: f64, size: f64) -> String {
        fitted(text, width.max(0.0) as usize, |text| self.width(text, size).ceil() as usize)
    }
}

/// A line: colour, width, dashes.
#[derive(Clone, Copy, Debug)]
pub(super) struct Stroke {
    pub color: &'static str,
    pub width: f64,
    /// Lengths of dash and gap; none of a solid line.
    pub dash: Option<[u32; 2]>,
}

/// What the letters of a picture are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Letters {
    /// Outlines of the font in `assets/`: the same picture everywhere.
    Outlines,
    /// Text in that font, or what a reader has instead of it.
    Text,
}

/// Where a text is: the end of it that is at the given place.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Anchor {
    Start,
    Middle,
    End,
}

/// The outline of a letter as a path.
#[derive(Default)]
struct Outline(String);

impl OutlineBuilder for Outline {
    fn move_to(&mut self, x: f32, y: f32) {
        self.0 += &format!("M{x} {y}");
    }
    fn line_to(&mut self, x: f32, y: f32) {
        self.0 += &format!("L{x} {y}");
    }
    fn quad_to(&mut self, x1: f32, y1: f32, x: f32, y: f32) {
        self.0 += &format!("Q{x1} {y1} {x} {y}");
    }
    fn curve_to(&mut self, x1: f32, y1: f32, x2: f32, y2: f32, x: f32, y: f32) {
        self.0 += &format!("C{x1} {y1} {x2} {y2} {x} {y}");
    }
    fn close(&mut self) {
        self.0 += "Z";
    }
}

/// A picture that is being drawn; lengths are in pixels of 1/96 inch, from the upper left corner.
pub(super) struct Svg {
    pub font: Font,
    size: [f64; 2],
    body: String,
    /// Outlines of the letters that are used.
    letters: BTreeMap<u16, String>,
    clips: usize,
    kind: Letters,
}

/// A length with two decimals at most.
pub(super) fn length(value: f64) -> String {
    let text = format!("{value:.2}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if text == "-0" { "0".to_owned() } else { text.to_owned() }
}

fn points(list: &[[f64; 2]]) -> String {
    list.iter().map(|[x, y]| format!("{},{}", length(*x), length(*y))).collect::<Vec<_>>().join(" ")
}

impl Svg {
    /// A white picture of this size.
    pub(super) fn new(font: Font, size: [f64; 2], kind: Letters) -> Self {
        Svg { font, size, body: String::new(), letters: BTreeMap::new(), clips: 0, kind }
    }

    fn element(&mut self, name: &str, attributes: &[(&str, String)]) {
        self.body += &format!("<{name}");
        attributes.iter().for_each(|(key, value)| self.body += &format!(" {key}=\"{value}\""));
        self.body += "/>\n";
    }

    /// Lines from point to point.
    pub(super) fn line(&mut self, list: &[[f64; 2]], stroke: Stroke) {
        let mut attributes = vec![
            ("points", points(list)),
            ("fill", "none".to_owned()),
            ("stroke", stroke.color.to_owned()),
            ("stroke-width", length(stroke.width)),
            ("stroke-linejoin", "round".to_owned()),
        ];
        attributes.extend(stroke.dash.map(|[dash, gap]| ("stroke-dasharray", format!("{dash} {gap}"))));
        self.element("polyline", &attributes);
    }

    pub(super) fn area(&mut self, list: &[[f64; 2]], color: &str, opacity: f64) {
        let attributes = [("points", points(list)), ("fill", color.to_owned()), ("fill-opacity", length(opacity))];
        self.element("polygon", &attributes);
    }

    /// A rectangle between two corners.
    pub(super) fn rectangle(&mut self, [x0, y0]: [f64; 2], [x1, y1]: [f64; 2], color: &str, opacity: f64) {
        let attributes = [
            ("x", length(x0.min(x1))),
            ("y", length(y0.min(y1))),
            ("width", length((x1 - x0).abs())),
            ("height", length((y1 - y0).abs())),
            ("fill", color.to_owned()),
            ("fill-opacity", length(opacity)),
        ];
        self.element("rect", &attributes);
    }

    pub(super) fn disc(&mut self, [x, y]: [f64; 2], radius: f64, color: &str, opacity: f64) {
        let attributes = [
            ("cx", length(x)),
            ("cy", length(y)),
            ("r", length(radius)),
            ("fill", color.to_owned()),
            ("fill-opacity", length(opacity)),
        ];
        self.element("circle", &attributes);
    }

    /// A text whose letters stand on the height of the point `at`, or, `upwards`, right-hand side of it.
    pub(super) fn text(&mut self, text: &str, at: [f64; 2], size: f64, anchor: Anchor, color: &str, upwards: bool) {
        if text.is_empty() {
            return;
        }
        let (scale, width) = (size / self.font.units(), self.font.width(text, size));
        let shift = match anchor {
            Anchor::Start => 0.0,
            Anchor::Middle => -0.5 * width,
            Anchor::End => -width,
        };
        let turn = if upwards { " rotate(-90)" } else { "" };
        if self.kind == Letters::Text {
            let anchor = match anchor {
                Anchor::Start => "start",
                Anchor::Middle => "middle",
                Anchor::End => "end",
            };
            let _ = writeln!(
                self.body,
                "<text fill=\"{color}\" font-family=\"DejaVu Sans, Verdana, sans-serif\" font-size=\"{}\" text-anchor=\"{anchor}\" transform=\"translate({} {}){turn}\">{}</text>",
                length(size),
                length(at[0]),
                length(at[1]),
                escaped(text),
            );
            return;
        }
        let _ = write!(
            self.body,
            "<g role=\"img\" aria-label=\"{}\" fill=\"{color}\" transform=\"translate({} {}){turn} translate({} 0) scale({scale:.6} -{scale:.6})\">",
            escaped(text),
            length(at[0]),
            length(at[1]),
            length(shift),
        );
        let mut x = 0.0;
        for letter in text.chars() {
            let glyph = self.font.glyph(letter);
            if self.outline(glyph) {
                self.body += &format!("<use xlink:href=\"#g{}\" x=\"{x}\"/>", glyph.0);
            }
            x += self.font.advance(glyph);
        }
        self.body += "</g>\n";
    }

    /// Keeps the outline of a letter; whether it has one, as a space has not.
    fn outline(&mut self, glyph: GlyphId) -> bool {
        let Some(face) = &self.font.face else { return false };
        let path = self.letters.entry(glyph.0).or_insert_with(|| {
            let mut outline = Outline::default();
            face.outline_glyph(glyph, &mut outline);
            outline.0
        });
        !path.is_empty()
    }

    /// What is drawn until [`Svg::end_of_clip`] is shown between these corners only.
    pub(super) fn clip(&mut self, [x0, y0]: [f64; 2], [x1, y1]: [f64; 2]) {
        self.clips += 1;
        let (id, x, y, width, height) = (self.clips, length(x0), length(y0), length(x1 - x0), length(y1 - y0));
        let _ = writeln!(
            self.body,
            "<clipPath id=\"c{id}\"><rect x=\"{x}\" y=\"{y}\" width=\"{width}\" height=\"{height}\"/></clipPath>\n<g clip-path=\"url(#c{id})\">"
        );
    }

    /// The end of what [`Svg::clip`] began.
    pub(super) fn end_of_clip(&mut self) {
        self.body += "</g>\n";
    }

    pub(super) fn finish(self) -> String {
        let [width, height] = self.size.map(length);
        let letters = self.letters.iter().filter(|(_, path)| !path.is_empty());
        let letters: String = letters.map(|(id, path)| format!("<path id=\"g{id}\" d=\"{path}\"/>\n")).collect();
        format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" xmlns:xlink=\"http://www.w3.org/1999/xlink\" width=\"{width}\" height=\"{height}\" viewBox=\"0 0 {width} {height}\">\n<defs>\n{letters}</defs>\n<rect width=\"{width}\" height=\"{height}\" fill=\"#ffffff\"/>\n{}</svg>\n",
            self.body
        )
    }
}
