//! Figures of the page as SVG and PNG files, for papers: the same numbers, titles and captions, without a browser.

use std::ops::Range;
use std::path::Path;

use plotters::coord::Shift;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

use crate::report::canvas::{Canvas, PlotError, drawing};
use crate::report::page::figure::{Figure, Mark, Scale};
use crate::report::page::figure_axis::{FigureAxis, MOST_TICKS, Ticked};

/// Size of a figure, pixels.
const SIZE: (u32, u32) = (720, 460);
/// Free width beside the title of the vertical axis, pixels: its superscripts reach beyond the box of the text.
const EDGE: u32 = 6;
/// Height of the title and of the legend, pixels.
const TITLE: u32 = 38;
const LEGEND: u32 = 24;
/// Left edge of the legend, width of a mark with the space around it, and of a letter, pixels.
const LEGEND_EDGE: u32 = 16;
const LEGEND_MARK: u32 = 40;
const LEGEND_LETTER: u32 = 7;
/// Width kept for the names of a vertical axis, pixels.
const NAMES: u32 = 290;

/// The palette of Okabe & Ito, text, grey: [`super::figure::Hue::place`].
const PALETTE: [RGBColor; 9] = [
    RGBColor(0, 114, 178),
    RGBColor(213, 94, 0),
    RGBColor(0, 158, 115),
    RGBColor(204, 121, 167),
    RGBColor(86, 180, 233),
    RGBColor(230, 159, 0),
    RGBColor(240, 228, 66),
    RGBColor(20, 20, 20),
    RGBColor(110, 110, 110),
];

type Chart<'a, B> = ChartContext<'a, B, Cartesian2d<Ticked, Ticked>>;

/// Writes every figure into `folder` as SVG and as PNG; returns the number of files.
///
/// # Errors
/// [`PlotError`].
pub fn save(figures: &[Figure], folder: &Path) -> Result<usize, PlotError> {
    std::fs::create_dir_all(folder)?;
    for figure in figures {
        for extension in ["svg", "png"] {
            figure.save(&folder.join(format!("{}.{extension}", figure.name)))?;
        }
    }
    Ok(2 * figures.len())
}

impl Figure {
    /// The finite values that the axes have to show.
    fn values(&self) -> (Vec<f64>, Vec<f64>) {
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
                Mark::Limit { .. } | Mark::Matrix { .. } => {}
            }
        }
        xs.retain(|value: &f64| value.is_finite());
        ys.retain(|value: &f64| value.is_finite());
        (xs, ys)
    }

    fn names(&self) -> Option<&[String]> {
        if let Scale::Names(names) = &self.y.scale { Some(names) } else { None }
    }
}

impl Canvas for Figure {
    fn size(&self) -> (u32, u32) {
        let rows = self.names().map_or(0, <[String]>::len) as u32;
        let extra = LEGEND * (self.legend_rows() - 1);
        (SIZE.0, (SIZE.1 + extra).max(TITLE + LEGEND + extra + 90 + 22 * rows))
    }

    fn draw<B: DrawingBackend>(&self, area: &DrawingArea<B, Shift>, scale: u32) -> Result<(), PlotError> {
        let (head, rest) = area.split_vertically(TITLE * scale);
        let style = ("sans-serif", 18 * scale).into_font().into_text_style(&head);
        head.draw_text(&self.title, &style, ((14 * scale) as i32, (10 * scale) as i32)).map_err(drawing)?;
        let (strip, axes) = rest.split_vertically(LEGEND * self.legend_rows() * scale);
        self.legend(&strip, scale)?;
        let (xs, ys) = self.values();
        let (x, y) = (FigureAxis::of(&self.x, &xs), FigureAxis::of(&self.y, &ys));
        let left = if self.names().is_some() { NAMES } else { 78 };
        let mut chart = ChartBuilder::on(&axes)
            .margin_left(EDGE * scale)
            .margin_right(18 * scale)
            .margin_bottom(8 * scale)
            .x_label_area_size(42 * scale)
            .y_label_area_size((left - EDGE) * scale)
            .build_cartesian_2d(x.coordinates(), y.coordinates())
            .map_err(drawing)?;
        chart
            .configure_mesh()
            .x_desc(&x.title)
            .y_desc(&y.title)
            .y_labels(if self.names().is_some() { 0 } else { MOST_TICKS })
            .x_label_formatter(&|value| x.label(*value))
            .y_label_formatter(&|value| y.label(*value))
            .label_style(("sans-serif", 13 * scale))
            .axis_desc_style(("sans-serif", 14 * scale))
            .light_line_style(WHITE)
            .bold_line_style(RGBColor(228, 228, 228))
            .draw()
            .map_err(drawing)?;
        for mark in &self.marks {
            self.mark(&mut chart, mark, &x, &y, scale)?;
        }
        if let Some(names) = self.names() {
            let style =
                ("sans-serif", 12 * scale).into_font().into_text_style(&axes).pos(Pos::new(HPos::Right, VPos::Center));
            for (row, name) in names.iter().enumerate() {
                let (_, top) = chart.backend_coord(&(x.range.start, names.len() as f64 - 1.0 - row as f64));
                let origin = axes.get_base_pixel().1;
                axes.draw_text(name, &style, (((NAMES - 8) * scale) as i32, top - origin)).map_err(drawing)?;
            }
        }
        Ok(())
    }
}

impl Figure {
    fn mark<B: DrawingBackend>(
        &self,
        chart: &mut Chart<'_, B>,
        mark: &Mark,
        x: &FigureAxis,
        y: &FigureAxis,
        scale: u32,
    ) -> Result<(), PlotError> {
        let color = |hue: usize| PALETTE[hue % PALETTE.len()];
        let visible = |(a, b): &(f64, f64)| a.is_finite() && b.is_finite();
        let path = |xs: &[f64], ys: &[f64]| -> Vec<(f64, f64)> {
            xs.iter().zip(ys).map(|(a, b)| (x.at(*a), y.at(*b))).filter(visible).collect()
        };
        match mark {
            Mark::Line { hue, dashed, x: xs, y: ys, .. } => {
                let style = color(hue.place()).stroke_width(scale + scale / 2);
                if *dashed {
                    let series = DashedLineSeries::new(path(xs, ys), 6 * scale, 4 * scale, style);
                    chart.draw_series(series).map_err(drawing)?;
                } else {
                    chart.draw_series(LineSeries::new(path(xs, ys), style)).map_err(drawing)?;
                }
            }
            Mark::Band { hue, opacity, x: xs, low, high, .. } => {
                let mut outline = path(xs, low);
                outline.extend(path(xs, high).into_iter().rev());
                if outline.len() > 2 {
                    let area = Polygon::new(outline, color(hue.place()).mix(*opacity).filled());
                    chart.draw_series(std::iter::once(area)).map_err(drawing)?;
                }
            }
            Mark::Points { hue, crosses, x: xs, y: ys, .. } => {
                let (points, color) = (path(xs, ys), color(hue.place()));
                if *crosses {
                    let style = color.stroke_width(scale);
                    chart
                        .draw_series(points.into_iter().map(|at| Cross::new(at, 3 * scale, style)))
                        .map_err(drawing)?;
                } else {
                    let size = if points.len() > 200 { 3 * scale / 2 } else { 3 * scale };
                    let style = color.mix(0.6).filled();
                    chart.draw_series(points.into_iter().map(|at| Circle::new(at, size, style))).map_err(drawing)?;
                }
            }
            Mark::Bars { hue, edges, heights, .. } => {
                let style = color(hue.place()).mix(0.55).filled();
                let bars = edges.windows(2).zip(heights).map(|(ends, height)| {
                    Rectangle::new([(x.at(ends[0]), y.at(0.0)), (x.at(ends[1]), y.at(*height))], style)
                });
                chart.draw_series(bars).map_err(drawing)?;
            }
            Mark::Whiskers { hue, x: xs, low, high, .. } => {
                let color = color(hue.place());
                let count = xs.len() as f64;
                for (row, value) in xs.iter().enumerate().filter(|(_, value)| value.is_finite()) {
                    let height = count - 1.0 - row as f64;
                    let bar = [(x.at(0.0), height - 0.3), (x.at(*value), height + 0.3)];
                    let whisker = [(x.at(low[row]), height), (x.at(high[row]), height)];
                    chart
                        .draw_series(std::iter::once(Rectangle::new(bar, color.mix(0.4).filled())))
                        .map_err(drawing)?;
                    if low[row].is_finite() && high[row].is_finite() {
                        chart.draw_series(LineSeries::new(whisker, BLACK.stroke_width(scale))).map_err(drawing)?;
                    }
                    let dot = Circle::new((x.at(*value), height), 3 * scale, color.filled());
                    chart.draw_series(std::iter::once(dot)).map_err(drawing)?;
                }
            }
            Mark::Limit { label, at, vertical } => {
                let at = if *vertical { x.at(*at) } else { y.at(*at) };
                let inside = if *vertical { x.is_inside(at) } else { y.is_inside(at) };
                if inside {
                    let ends = if *vertical {
                        [(at, y.range.start), (at, y.range.end)]
                    } else {
                        [(x.range.start, at), (x.range.end, at)]
                    };
                    let grey = PALETTE[8];
                    chart
                        .draw_series(DashedLineSeries::new(ends, 4 * scale, 4 * scale, grey.stroke_width(scale)))
                        .map_err(drawing)?;
                    let share = |of: f64, range: &Range<f64>| range.start + of * (range.end - range.start);
                    let shift = |range: &Range<f64>| 0.01 * (range.end - range.start);
                    // right of the line, and left of it where the panel ends before the name does; above the line, and below it at the
                    // upper edge of the panel
                    let width = (LEGEND_LETTER * label.chars().count() as u32) as f64 / f64::from(SIZE.0);
                    let fits = at < share(0.97 - width, &x.range);
                    let beside = at + if fits { shift(&x.range) } else { -shift(&x.range) };
                    let turn = if *vertical && !fits { HPos::Right } else { HPos::Left };
                    let (place, side) = if *vertical {
                        ((beside, share(0.98, &y.range)), VPos::Top)
                    } else if at < share(0.93, &y.range) {
                        ((share(0.01, &x.range), at + shift(&y.range)), VPos::Bottom)
                    } else {
                        ((share(0.01, &x.range), at - shift(&y.range)), VPos::Top)
                    };
                    let font = ("sans-serif", 12 * scale).into_font().color(&grey);
                    let style = font.pos(Pos::new(turn, side));
                    chart.draw_series(std::iter::once(Text::new(label.clone(), place, style))).map_err(drawing)?;
                }
            }
            Mark::Matrix { values } => {
                let count = self.names().map_or(0, <[String]>::len);
                for (index, r) in values.iter().enumerate().filter(|_| count > 0) {
                    let (row, column) = (index / count, (index % count) as f64);
                    let height = (count - 1 - row) as f64;
                    let hue = if *r < 0.0 { PALETTE[1] } else { PALETTE[0] };
                    let cell = [(column - 0.48, height - 0.48), (column + 0.48, height + 0.48)];
                    let style = hue.mix(r.abs().min(1.0)).filled();
                    chart.draw_series(std::iter::once(Rectangle::new(cell, style))).map_err(drawing)?;
                }
            }
        }
        Ok(())
    }

    /// What is in the legend, with the row and the left edge of each, pixels: names in rows.
    fn legend_entries(&self) -> Vec<(&Mark, &str, (u32, u32))> {
        let (mut row, mut x) = (0, LEGEND_EDGE);
        let mut entries = Vec::new();
        for mark in &self.marks {
            let label = match mark {
                Mark::Line { label, .. }
                | Mark::Points { label, .. }
                | Mark::Band { label, .. }
                | Mark::Bars { label, .. }
                | Mark::Whiskers { label, .. } => label,
                Mark::Limit { .. } | Mark::Matrix { .. } => continue,
            };
            let width = LEGEND_MARK + LEGEND_LETTER * label.chars().count() as u32;
            if x > LEGEND_EDGE && x + width > SIZE.0 {
                (row, x) = (row + 1, LEGEND_EDGE);
            }
            entries.push((mark, label.as_str(), (row, x)));
            x += width;
        }
        entries
    }

    fn legend_rows(&self) -> u32 {
        self.legend_entries().last().map_or(0, |(_, _, (row, _))| *row) + 1
    }

    /// Names of the marks.
    fn legend<B: DrawingBackend>(&self, strip: &DrawingArea<B, Shift>, scale: u32) -> Result<(), PlotError> {
        let size = (12 * scale) as i32;
        for (mark, label, (row, x)) in self.legend_entries() {
            let (hue, opacity) = match mark {
                Mark::Line { hue, .. } | Mark::Points { hue, .. } => (hue, 1.0),
                Mark::Band { hue, opacity, .. } => (hue, *opacity),
                Mark::Bars { hue, .. } | Mark::Whiskers { hue, .. } => (hue, 0.55),
                Mark::Limit { .. } | Mark::Matrix { .. } => continue,
            };
            let (x, middle) = ((x * scale) as i32, ((row * LEGEND + LEGEND / 2) * scale) as i32);
            let color = PALETTE[hue.place()].mix(opacity).filled();
            let height = if matches!(mark, Mark::Line { .. }) { scale as i32 } else { size / 2 };
            let dashes = if matches!(mark, Mark::Line { dashed: true, .. }) { 3 } else { 1 };
            for dash in 0..dashes {
                let ends = [x + dash * size / dashes, x + (dash + 1) * size / dashes];
                let gap = if dashes > 1 { 2 * scale as i32 } else { 0 };
                let corners = [(ends[0], middle - height), (ends[1] - gap, middle + height)];
                strip.draw(&Rectangle::new(corners, color)).map_err(drawing)?;
            }
            let font = ("sans-serif", 12 * scale).into_text_style(strip);
            let (_, tall) = strip.estimate_text_size(label, &font).map_err(drawing)?;
            strip.draw_text(label, &font, (x + size + 5 * scale as i32, middle - tall as i32 / 2)).map_err(drawing)?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::page::figure::{Axis, Hue, Section};

    fn figure(x: Axis, y: Axis, marks: Vec<Mark>) -> Figure {
        let text = |text: &str| text.to_owned();
        Figure {
            name: text("f"),
            section: Section::Time,
            title: text("Title"),
            caption: text("."),
            columns: 6,
            is_over_time: false,
            x,
            y,
            marks,
        }
    }

    fn colored(figure: &Figure) -> usize {
        let is_colored = |pixel: &[u8]| pixel.iter().max().unwrap() - pixel.iter().min().unwrap() > 30;
        figure.pixels().unwrap().chunks_exact(3).filter(|pixel| is_colored(pixel)).count()
    }

    /// Law: every kind of mark leaves coloured pixels, on linear and logarithmic axes, and values that an axis cannot show do no harm.
    #[test]
    fn every_mark_is_drawn() {
        let x: Vec<f64> = (0..50).map(|k| 0.1 + f64::from(k)).collect();
        let y: Vec<f64> = x.iter().map(|x| x * x - 1.0).collect();
        let names = || Axis::names(vec!["one".to_owned(), "two".to_owned()]);
        let (label, hue) = (String::new, Hue::Body);
        let marks = [
            (Axis::linear("y", "J"), Mark::Line { label: label(), hue, dashed: true, x: x.clone(), y: y.clone() }),
            (Axis::log("y", ""), Mark::Line { label: label(), hue, dashed: false, x: x.clone(), y: y.clone() }),
            (
                Axis::linear("y", ""),
                Mark::Band {
                    label: label(),
                    hue,
                    opacity: 0.5,
                    x: x.clone(),
                    low: y.clone(),
                    high: x.clone(),
                    stacked: false,
                },
            ),
            (
                Axis::linear("y", ""),
                Mark::Points { label: label(), hue, crosses: true, x: x.clone(), y: y.clone(), samples: vec![] },
            ),
            (Axis::linear("y", ""), Mark::Bars { label: label(), hue, edges: x.clone(), heights: vec![1.0; 49] }),
            (
                names(),
                Mark::Whiskers {
                    label: label(),
                    hue,
                    x: vec![1.0, 2.0],
                    low: vec![0.5, f64::NAN],
                    high: vec![1.5, 3.0],
                },
            ),
            (names(), Mark::Matrix { values: vec![1.0, -0.5, -0.5, 1.0] }),
        ];
        for (y_axis, mark) in marks {
            let x_axis = if matches!(mark, Mark::Matrix { .. }) { names() } else { Axis::linear("x", "s") };
            let drawn = figure(x_axis, y_axis, vec![mark.clone()]);
            let found = colored(&drawn);
            assert!(found > 150, "{mark:?}: {found}");
            assert!(drawn.svg().unwrap().contains("Title"));
        }
        let nothing = figure(
            Axis::log("x", ""),
            Axis::log("y", ""),
            vec![Mark::Line { label: label(), hue, dashed: false, x: vec![-1.0], y: vec![f64::NAN] }],
        );
        assert!(nothing.svg().is_ok() && colored(&nothing) < 150);
    }

    /// Law: no text reaches the edge of the image, where it would be cut off: also a unit with superscripts on the vertical axis, and the
    /// names of limits at both ends of the panel.
    #[test]
    fn nothing_is_cut_off() {
        let x: Vec<f64> = (0..9).map(f64::from).collect();
        let line = |unit: f64| Mark::Line {
            label: "nominal run".to_owned(),
            hue: Hue::Body,
            dashed: false,
            y: x.iter().map(|x| x * unit).collect(),
            x: x.clone(),
        };
        for unit in [1.0, 1e6, 1e-15] {
            let limits = [0.0, 8.0 * unit].map(|at| Mark::Limit { label: "tolerance".to_owned(), at, vertical: false });
            let across = [0.0, 7.9, 8.0].map(|at| Mark::Limit { label: "nominal".to_owned(), at, vertical: true });
            let marks = limits.into_iter().chain(across).chain([line(unit)]).collect();
            let drawn = figure(Axis::linear("time", "s"), Axis::linear("relative error of the energy", "J"), marks);
            let (pixels, (width, height)) = (drawn.pixels().unwrap(), drawn.size());
            let is_white = |x: u32, y: u32| pixels[((y * width + x) * 3) as usize..][..3] == [255; 3];
            let sides = (0..height).all(|y| is_white(0, y) && is_white(width - 1, y));
            assert!(sides && (0..width).all(|x| is_white(x, 0) && is_white(x, height - 1)), "unit {unit}");
        }
    }
}
