//! [`Panel`]: one figure in its rectangle of a picture: title, axes, ticks, legend, marks.

use crate::report::axis::DrawnAxis;
use crate::report::figure::{Axis, Figure, Mark, Scale};
use crate::report::legend::{self, Legend};
use crate::report::svg::{Anchor, Font, INK, LABEL, Stroke, Svg};

/// Size of titles and of the titles of axes, pixels.
const TITLE: f64 = 16.0;
const AXIS_TITLE: f64 = 13.0;
/// Height of the title; free height over the axes, and under them with texts at ticks and title; free width right of them, pixels.
const HEAD: f64 = 30.0;
const ABOVE: f64 = 8.0;
const BELOW: f64 = 48.0;
const BESIDE: f64 = 22.0;
/// Height between ticks, and width between their texts, at least, pixels.
const TICK_HEIGHT: f64 = 30.0;
const TICK_GAP: f64 = 14.0;
/// Height of the strip of runs in flight under the axis, with what is free around it, pixels.
pub(super) const FLIGHT: f64 = 14.0;
/// Most ticks of an axis; of a horizontal one whose step is given.
const MOST_TICKS: usize = 9;
const MOST_STEPS: usize = 13;
/// Most of the width that names beside the axes take.
const NAMES: f64 = 0.4;
/// Height of a row of names; largest side of a cell of a matrix, pixels.
const ROW: f64 = 24.0;
const CELL: f64 = 48.0;

const GRID: &str = "#e4e4e4";

/// A figure that is being drawn.
pub(super) struct Panel<'f> {
    figure: &'f Figure,
    x: DrawnAxis,
    y: DrawnAxis,
    /// Left, top, right and bottom edge of the axes, pixels.
    pub edges: [f64; 4],
}

impl Figure {
    /// The finite values that its axes have to show. A limit across the figure does not widen the vertical axis.
    pub(super) fn values(&self) -> [Vec<f64>; 2] {
        let (mut xs, mut ys) = (Vec::new(), Vec::new());
        for mark in &self.marks {
            match mark {
                Mark::Line { x, y, .. } | Mark::Points { x, y, .. } => {
                    xs.extend(x);
                    ys.extend(y);
                }
                Mark::Band { x, low, high, .. } => {
                    xs.extend(x);
                    ys.extend(low.iter().chain(high));
                }
                Mark::Bars { edges, heights, .. } => {
                    xs.extend(edges);
                    ys.extend(heights.iter().chain([&0.0]));
                }
                Mark::Whiskers { x, low, high, .. } => xs.extend(x.iter().chain(low).chain(high).chain([&0.0])),
                Mark::Limit { at, vertical: true, .. } => xs.push(*at),
                Mark::Limit { .. } | Mark::Flight { .. } | Mark::Matrix { .. } => {}
            }
        }
        [xs, ys].map(|values| values.into_iter().filter(|value: &f64| value.is_finite()).collect())
    }

    fn drawn_axes(&self) -> [DrawnAxis; 2] {
        let [xs, ys] = self.values();
        let ends = |values: &[f64]| values.iter().fold([f64::MAX, f64::MIN], |[a, b], x| [a.min(*x), b.max(*x)]);
        let within = |axis: &Axis, [low, high]: [f64; 2]| {
            let is_free = axis.range.is_none() && axis.scale == Scale::Linear && low < high;
            if is_free { axis.clone().within(low, high) } else { axis.clone() }
        };
        let x = if self.is_over_time { within(&self.x, ends(&xs)) } else { self.x.clone() };
        let has_bars = self.marks.iter().any(|mark| matches!(mark, Mark::Bars { .. }));
        // free height over bars, where limits are named
        let y = if has_bars { within(&self.y, [0.0, 1.2 * ends(&ys)[1]]) } else { self.y.clone() };
        [DrawnAxis::new(&x, &xs), DrawnAxis::new(&y, &ys)]
    }

    /// The height of the strip of runs in flight; zero where there is none.
    fn flight_height(&self) -> f64 {
        if self.marks.iter().any(|mark| matches!(mark, Mark::Flight { .. })) { FLIGHT } else { 0.0 }
    }

    /// Names on the vertical axis; none on one of numbers.
    pub(super) fn names(&self) -> &[String] {
        if let Scale::Names(names) = &self.y.scale { names } else { &[] }
    }

    fn is_matrix(&self) -> bool {
        self.x.scale == self.y.scale && !self.names().is_empty()
    }

    /// What is written beside a row: a matrix numbers its rows, since its columns have numbers only.
    fn row_name(&self, row: usize, name: &str) -> String {
        if self.is_matrix() { format!("{name}  {}", row + 1) } else { name.to_owned() }
    }

    fn names_width(&self, font: &Font, width: f64) -> f64 {
        let names = self.names().iter().enumerate().map(|(row, name)| font.width(&self.row_name(row, name), LABEL));
        (names.fold(0.0, f64::max) + 20.0).min(NAMES * width)
    }

    /// Its height where others are `usual` pixels high, with its own legend or without.
    pub(super) fn height(&self, font: &Font, width: f64, usual: f64, has_legend: bool) -> f64 {
        let legend = if has_legend { self.legend(font, width).height() } else { 0.0 };
        let around = HEAD + legend + ABOVE + BELOW;
        match self.names().len() as f64 {
            0.0 => usual.max(usual - legend::ROW + legend),
            count if self.is_matrix() => {
                around + count * CELL.min((width - self.names_width(font, width) - BESIDE) / count)
            }
            count => around + self.flight_height() + ROW * count,
        }
    }

    pub(super) fn legend(&self, font: &Font, width: f64) -> Legend<'_> {
        Legend::new(font, self.marks.iter(), width - 2.0 * BESIDE)
    }
}

impl<'f> Panel<'f> {
    /// Where the axes of `figure` are, which is drawn from the corner `at` on.
    pub(super) fn laid_out(
        font: &Font,
        figure: &'f Figure,
        at: [f64; 2],
        [width, height]: [f64; 2],
        has_legend: bool,
    ) -> Self {
        let [x, y] = figure.drawn_axes();
        let legend = if has_legend { figure.legend(font, width).height() } else { 0.0 };
        let top = at[1] + HEAD + legend + ABOVE;
        let bottom = (at[1] + height - BELOW - figure.flight_height()).max(top + 20.0);
        let left = if figure.names().is_empty() {
            let rows = rows(&y, bottom - top);
            let widest = rows.iter().map(|(_, text)| font.width(text, LABEL)).fold(0.0, f64::max);
            at[0] + widest + if y.title().is_empty() { 18.0 } else { 38.0 }
        } else {
            at[0] + figure.names_width(font, width)
        };
        let right = (at[0] + width - BESIDE).max(left + 20.0);
        let mut panel = Panel { figure, x, y, edges: [left, top, right, bottom] };
        if figure.is_matrix() {
            let side = ((right - left).min(bottom - top)) / figure.names().len() as f64;
            let end = side.min(CELL) * figure.names().len() as f64;
            panel.edges = [left, top, left + end, top + end];
        }
        panel
    }

    /// Draws `figure` from the corner `at` on.
    pub(super) fn draw(svg: &mut Svg, figure: &'f Figure, at: [f64; 2], [width, height]: [f64; 2], has_legend: bool) {
        let panel = Self::laid_out(&svg.font, figure, at, [width, height], has_legend);
        let legend = if has_legend { figure.legend(&svg.font, width) } else { Legend::default() };
        let added = panel.y.start();
        let room = width - BESIDE - 14.0;
        // a long title is smaller before it is shorter
        let is_long = svg.font.width(&format!("{}{added}", figure.title), TITLE) > room;
        let size = if is_long { AXIS_TITLE } else { TITLE };
        let room = room - svg.font.width(&added, size);
        let head = format!("{}{added}", svg.font.fitted(&figure.title, room, size));
        svg.text(&head, [at[0] + 14.0, at[1] + 21.0], size, Anchor::Start, INK, false);
        legend.draw(svg, [at[0] + 16.0, at[1] + HEAD]);
        panel.draw_axes(svg, at);
        let [left, top, right, bottom] = panel.edges;
        svg.clip([left - 1.0, top - 1.0], [right + 1.0, bottom + 1.0]);
        figure.marks.iter().for_each(|mark| panel.draw_mark(svg, mark));
        svg.end_of_clip();
        panel.draw_limits(svg);
        panel.draw_flight(svg);
    }

    pub(super) fn has_names(&self) -> bool {
        !self.figure.names().is_empty()
    }

    pub(super) fn marks(&self) -> &'f [Mark] {
        &self.figure.marks
    }

    /// The place of values on the horizontal axis, pixels; NaN where there is none.
    pub(super) fn x(&self, value: f64) -> f64 {
        let [left, _, right, _] = self.edges;
        left + self.x.at(value) * (right - left)
    }

    /// The place of values on the vertical axis, pixels.
    pub(super) fn y(&self, value: f64) -> f64 {
        self.height_at(self.y.at(value))
    }

    fn height_at(&self, place: f64) -> f64 {
        let [_, top, _, bottom] = self.edges;
        // the first name is on top
        if self.figure.names().is_empty() { bottom - place * (bottom - top) } else { top + place * (bottom - top) }
    }

    /// Axes, grid, texts at ticks, titles.
    fn draw_axes(&self, svg: &mut Svg, at: [f64; 2]) {
        let [left, top, right, bottom] = self.edges;
        let rows = rows(&self.y, bottom - top);
        let texts = bottom + self.figure.flight_height();
        let line = |color| Stroke { color, width: 1.0, dash: None };
        let columns = self.columns(&svg.font);
        for (row, (place, text)) in rows.iter().enumerate() {
            let height = self.height_at(*place);
            let mut text = self.figure.row_name(row, text);
            if self.figure.names().is_empty() {
                svg.line(&[[left, height], [right, height]], line(GRID));
            } else {
                text = svg.font.fitted(&text, left - at[0] - 12.0, LABEL);
            }
            svg.text(&text, [left - 7.0, height + 4.0], LABEL, Anchor::End, INK, false);
        }
        for (place, text) in &columns {
            let x = left + place * (right - left);
            if !self.figure.is_matrix() {
                svg.line(&[[x, top], [x, bottom]], line(GRID));
            }
            svg.text(text, [x, texts + 16.0], LABEL, Anchor::Middle, INK, false);
        }
        if !self.figure.is_matrix() {
            svg.line(&[[left, top], [left, bottom], [right, bottom]], line("#5c5c5c"));
        }
        let middle = 0.5 * (left + right);
        // the title of a vertical axis says less where changes begin: that is in the head
        let below = format!("{}{}", self.x.title(), self.x.start());
        let below = svg.font.fitted(&below, right - left + 30.0, AXIS_TITLE);
        svg.text(&below, [middle, texts + 36.0], AXIS_TITLE, Anchor::Middle, INK, false);
        let beside = svg.font.fitted(&self.y.title(), bottom - top + 20.0, AXIS_TITLE);
        svg.text(&beside, [at[0] + 18.0, 0.5 * (top + bottom)], AXIS_TITLE, Anchor::Middle, INK, true);
    }

    /// Ticks of the horizontal axis, as many as have space for their texts.
    fn columns(&self, font: &Font) -> Vec<(f64, String)> {
        if self.figure.is_matrix() {
            return self.x.ticks(0).into_iter().enumerate().map(|(k, (at, _))| (at, (k + 1).to_string())).collect();
        }
        let width = self.edges[2] - self.edges[0];
        let has_space = |ticks: &Vec<(f64, String)>| {
            ticks.windows(2).all(|pair| {
                let half = pair.iter().map(|(_, text)| 0.5 * font.width(text, LABEL)).sum::<f64>();
                half + TICK_GAP <= (pair[1].0 - pair[0].0).abs() * width
            })
        };
        let most = if self.figure.x.step.is_some() { MOST_STEPS } else { MOST_TICKS };
        let mut choices = (2..=most).rev().map(|most| self.x.ticks(most));
        choices.find(has_space).unwrap_or_else(|| self.x.ticks(2).into_iter().take(1).collect())
    }
}

/// Ticks of a vertical axis that is so high, pixels.
fn rows(axis: &DrawnAxis, height: f64) -> Vec<(f64, String)> {
    axis.ticks((height / TICK_HEIGHT).clamp(2.0, MOST_TICKS as f64) as usize)
}
