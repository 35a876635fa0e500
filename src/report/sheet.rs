//! [`Sheet`]: figures on one picture, in rows of twelve columns as on the page.

use crate::report::figure::Figure;
use crate::report::legend::Legend;
use crate::report::panel::{INK, Panel};
use crate::report::svg::{Anchor, Font, Svg};

/// Size and height of the title, pixels.
const TITLE: f64 = 19.0;
const TITLE_HEIGHT: f64 = 40.0;
/// Free width on both sides, pixels.
const EDGE: f64 = 20.0;
/// Free height at the bottom, pixels.
const BOTTOM: f64 = 8.0;
/// Size of a picture of one figure, pixels.
const ALONE: [f64; 2] = [720.0, 440.0];

/// Figures that are one file.
#[derive(Clone, Debug)]
pub struct Sheet {
    /// Title of the whole; empty where it has none.
    pub title: String,
    /// Usual width, pixels.
    pub width: f64,
    /// Usual height of a panel, pixels.
    pub panel_height: f64,
    /// Whether one legend is that of all panels.
    pub has_common_legend: bool,
    /// The figures, each as wide as its columns of twelve.
    pub panels: Vec<Figure>,
}

/// Where a panel is: corner, width and height.
type Place = ([f64; 2], [f64; 2]);

impl Sheet {
    /// A picture of one figure.
    pub fn of(figure: &Figure) -> Self {
        let [width, panel_height] = ALONE;
        let panels = vec![Figure { columns: 12, ..figure.clone() }];
        Sheet { title: String::new(), width, panel_height, has_common_legend: false, panels }
    }

    fn legend(&self, font: &Font, width: f64) -> Legend<'_> {
        if !self.has_common_legend {
            return Legend::default();
        }
        Legend::new(font, self.panels.iter().flat_map(|panel| &panel.marks), width - 2.0 * EDGE)
    }

    /// The size of the picture, and where its panels are. `size` is what is given instead of the usual one: the axes have what texts leave.
    fn layout(&self, font: &Font, size: Option<[f64; 2]>) -> ([f64; 2], Vec<Place>) {
        let width = size.map_or(self.width, |size| size[0]);
        let top = if self.title.is_empty() { 0.0 } else { TITLE_HEIGHT } + self.legend(font, width).height();
        let mut rows: Vec<(u8, f64, Vec<Place>)> = Vec::new();
        for panel in &self.panels {
            let room = f64::from(panel.columns) / 12.0 * width;
            let height = panel.height(font, room, self.panel_height, !self.has_common_legend);
            if rows.last().is_none_or(|(used, ..)| used + panel.columns > 12) {
                rows.push((0, 0.0, Vec::new()));
            }
            if let Some((used, highest, places)) = rows.last_mut() {
                places.push(([f64::from(*used) / 12.0 * width, 0.0], [room, height]));
                (*used, *highest) = (*used + panel.columns, highest.max(height));
            }
        }
        let usual = rows.iter().map(|row| row.1).sum::<f64>();
        let height = size.map_or(top + usual + BOTTOM, |size| size[1]);
        let scale = ((height - top - BOTTOM) / usual).max(0.0);
        let (mut y, mut places) = (top, Vec::new());
        for (_, highest, row) in rows {
            places.extend(row.into_iter().map(|([x, _], [width, _])| ([x, y], [width, scale * highest])));
            y += scale * highest;
        }
        ([width, height], places)
    }

    /// The picture as SVG, of `size` pixels of 1/96 inch where that is given.
    pub fn svg(&self, size: Option<[f64; 2]>) -> String {
        let font = Font::new();
        let (size, places) = self.layout(&font, size);
        let mut svg = Svg::new(font, size);
        if !self.title.is_empty() {
            let title = svg.font.fitted(&self.title, size[0] - 2.0 * EDGE, TITLE);
            svg.text(&title, [0.5 * size[0], 27.0], TITLE, Anchor::Middle, INK, false);
        }
        let legend = self.legend(&svg.font, size[0]);
        legend.draw(&mut svg, [EDGE, if self.title.is_empty() { 0.0 } else { TITLE_HEIGHT }]);
        for (panel, (at, size)) in self.panels.iter().zip(places) {
            Panel::draw(&mut svg, panel, at, size, !self.has_common_legend);
        }
        svg.finish()
    }
}
