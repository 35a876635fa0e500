//! Marks of a [`Panel`] as shapes.

use crate::report::figure::Mark;
use crate::report::panel::{FLIGHT, Panel};
use crate::report::shapes::{BAR, PALETTE, bar_opacity, color, point, shade, stroke};
use crate::report::svg::{Anchor, INK, Stroke, Svg};

/// With more points than this they are small and transparent.
const MANY: usize = 200;
/// Most of half the height of a strip in a row, pixels.
const STRIP: f64 = 11.0;
/// Cells of a matrix that are smaller have no number, pixels.
const NUMBER_CELL: f64 = 32.0;

impl Panel<'_> {
    /// The places that two columns of values have.
    pub(super) fn places(&self, xs: &[f64], ys: &[f64]) -> Vec<[f64; 2]> {
        let places = xs.iter().zip(ys).map(|(x, y)| [self.x(*x), self.y(*y)]);
        places.filter(|place| place.iter().all(|value| value.is_finite())).collect()
    }

    /// Draws a mark; limits are drawn by `draw_limits` of `limit_names`.
    pub(super) fn draw_mark(&self, svg: &mut Svg, mark: &Mark) {
        let bottom = self.edges[3];
        match mark {
            Mark::Line { hue, dash, x, y, .. } => svg.line(&self.places(x, y), stroke(*hue, dash.lengths())),
            Mark::Band { hue, opacity, x, low, high, .. } => {
                let [mut lower, mut upper] = [low, high].map(|ends| self.places(x, ends));
                if self.has_names() {
                    // a strip of a row is a strip, however few rows there are
                    for (one, other) in lower.iter_mut().zip(&mut upper) {
                        let (middle, half) = (0.5 * (one[1] + other[1]), 0.5 * (one[1] - other[1]));
                        let half = half.clamp(-STRIP, STRIP);
                        (one[1], other[1]) = (middle + half, middle - half);
                    }
                }
                let mut outline = lower;
                outline.extend(upper.into_iter().rev());
                svg.area(&outline, color(*hue), *opacity);
            }
            Mark::Points { hue, shape, x, y, .. } => {
                let places = self.places(x, y);
                let (size, opacity) = if places.len() > MANY { (1.8, 0.6) } else { (3.0, 1.0) };
                for place in places {
                    point(svg, place, (*shape, size, bottom), *hue, opacity);
                }
            }
            Mark::Bars { hue, edges, heights, .. } => {
                for (ends, height) in edges.windows(2).zip(heights).filter(|(_, height)| **height > 0.0) {
                    let corners = [[self.x(ends[0]), bottom], [self.x(ends[1]), self.y(*height)]];
                    svg.rectangle(corners[0], corners[1], color(*hue), bar_opacity(*hue));
                }
            }
            Mark::Whiskers { hue, x, low, high, .. } => {
                for (row, value) in x.iter().enumerate().filter(|(_, value)| value.is_finite()) {
                    let (height, end) = (self.y(row as f64), self.x(*value));
                    svg.rectangle([self.x(0.0), height - 6.0], [end, height + 6.0], color(*hue), 0.35);
                    let ends = [self.x(low[row]), self.x(high[row])];
                    if ends.iter().all(|end| end.is_finite()) {
                        svg.line(&ends.map(|x| [x, height]), Stroke { color: INK, width: 1.2, dash: None });
                    }
                    svg.disc([end, height], 3.0, color(*hue), 1.0);
                }
            }
            Mark::Matrix { values } => {
                let names = libm::sqrt(values.len() as f64) as usize;
                let half = 0.5 * (self.edges[2] - self.edges[0]) / names.max(1) as f64;
                for (index, r) in values.iter().enumerate() {
                    let [x, y] = [self.x((index % names) as f64), self.y((index / names) as f64)];
                    let (color, opacity) = shade(*r);
                    svg.rectangle([x - half, y - half], [x + half - 1.0, y + half - 1.0], color, opacity);
                    if 2.0 * half >= NUMBER_CELL {
                        let text = format!("{r:.2}");
                        let text = if text == "-0.00" { "0.00" } else { &text };
                        let color = if opacity > 0.6 { "#ffffff" } else { INK };
                        svg.text(text, [x, y + 4.0], 11.0, Anchor::Middle, color, false);
                    }
                }
            }
            Mark::Limit { .. } | Mark::Flight { .. } => {}
        }
    }

    /// The runs in flight, as a strip whose height is their share.
    pub(super) fn draw_flight(&self, svg: &mut Svg) {
        let [left, _, right, bottom] = self.edges;
        let floor = bottom + FLIGHT - 2.0;
        for mark in self.marks() {
            let Mark::Flight { x, counts, runs, .. } = mark else { continue };
            let place =
                |(time, count): (&f64, &f64)| [self.x(*time).clamp(left, right), floor - (FLIGHT - 4.0) * count / runs];
            let mut outline: Vec<[f64; 2]> = x.iter().zip(counts).map(place).collect();
            let ends = [outline.last(), outline.first()].map(|end| end.map_or(left, |end| end[0]));
            outline.extend(ends.map(|x| [x, floor]));
            svg.area(&outline, PALETTE[8], BAR);
        }
    }
}
