//! Colours, strokes and points of marks, and what stands for each mark in a legend: what is drawn and its name look the same.

use crate::report::figure::{Hue, Mark, PointShape};
use crate::report::svg::{INK, Stroke, Svg};

/// The palette of Okabe & Ito (2008), text, grey: [`Hue::place`].
pub(super) const PALETTE: [&str; 13] = [
    "#0072b2", "#d55e00", "#009e73", "#cc79a7", "#56b4e9", "#e69f00", "#b8a800", "#141414", "#6e6e6e", "#882255",
    "#117733", "#999933", "#6a3d9a",
];
/// Opacity of bars, and of the bars under whiskers.
pub(super) const BAR: f64 = 0.55;
/// Width of curves, pixels.
const CURVE: f64 = 1.6;
/// Length of the piece of a mark in a legend, pixels.
pub(super) const SWATCH: f64 = 26.0;

/// Opacity of bars in a colour: those of runs that miss a requirement stand in front of all runs, and are not mixed with their colour.
pub(in crate::report) fn bar_opacity(hue: Hue) -> f64 {
    if hue == Hue::Failed { 1.0 } else { BAR }
}

pub(super) fn color(hue: Hue) -> &'static str {
    PALETTE[hue.place() % PALETTE.len()]
}

/// The colour of a correlation, with its opacity.
pub(super) fn shade(r: f64) -> (&'static str, f64) {
    (PALETTE[usize::from(r < 0.0)], r.abs().min(1.0))
}

pub(super) fn stroke(hue: Hue, dash: Option<[u32; 2]>) -> Stroke {
    Stroke { color: color(hue), width: CURVE, dash }
}

/// A point: shape, size, and the height from which stems rise.
pub(super) fn point(
    svg: &mut Svg,
    place: [f64; 2],
    (shape, size, bottom): (PointShape, f64, f64),
    hue: Hue,
    opacity: f64,
) {
    let [x, y] = place;
    match shape {
        PointShape::Disc => svg.disc(place, size, color(hue), opacity),
        PointShape::Cross => {
            let stroke = Stroke { width: 1.2, ..stroke(hue, None) };
            svg.line(&[[x - 3.0, y - 3.0], [x + 3.0, y + 3.0]], stroke);
            svg.line(&[[x - 3.0, y + 3.0], [x + 3.0, y - 3.0]], stroke);
        }
        PointShape::Stem => {
            svg.line(&[[x, bottom], place], stroke(hue, None));
            svg.disc(place, 3.0, color(hue), 1.0);
        }
    }
}

/// What stands for a mark in a legend, from `x` on around the height `y`: with the colours that are drawn.
pub(super) fn draw_swatch(svg: &mut Svg, mark: &Mark, [x, y]: [f64; 2]) {
    let (end, middle) = (x + SWATCH, [x + 0.5 * SWATCH, y]);
    let mut bar = |hue: Hue, opacity| svg.rectangle([x, y - 6.0], [end, y + 6.0], color(hue), opacity);
    match mark {
        Mark::Line { hue, dash, .. } => svg.line(&[[x, y], [end, y]], stroke(*hue, dash.lengths())),
        Mark::Band { hue, opacity, .. } => bar(*hue, *opacity),
        Mark::Bars { hue, .. } => bar(*hue, bar_opacity(*hue)),
        Mark::Flight { .. } => bar(Hue::Reference, BAR),
        Mark::Points { hue, shape, .. } => point(svg, [middle[0], y - 2.0], (*shape, 3.0, y + 6.0), *hue, 1.0),
        Mark::Whiskers { hue, .. } => {
            svg.line(&[[x, y], [end, y]], Stroke { color: INK, width: 1.2, dash: None });
            svg.disc(middle, 3.0, color(*hue), 1.0);
        }
        Mark::Matrix { .. } => {
            for k in 0..=20 {
                let (color, opacity) = shade(0.1 * f64::from(k) - 1.0);
                let left = x + SWATCH / 21.0 * f64::from(k);
                svg.rectangle([left, y - 6.0], [left + SWATCH / 21.0, y + 6.0], color, opacity);
            }
        }
        Mark::Limit { .. } => {}
    }
}
