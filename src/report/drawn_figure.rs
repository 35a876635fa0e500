//! [`DrawnFigure`]: histograms of the dispersed parameters and the rank correlation of each pair.

use plotters::coord::Shift;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

use crate::report::canvas::{COLORS, Canvas, PlotError, drawing};
use crate::report::drawn_columns::DrawnColumns;
use crate::report::expected_counts::expected;
use crate::report::number::short;
use crate::sampling::distribution::Distribution;

/// Size of a histogram, pixels.
const HISTOGRAM: (u32, u32) = (300, 190);
/// Histograms side by side.
const ACROSS: usize = 4;
/// Height of the figure's title, pixels.
const TITLE_HEIGHT: u32 = 44;
/// Height of the title over the correlations, pixels.
const CAPTION_HEIGHT: u32 = 52;
/// Maximum side of a cell of the correlation plot, pixels.
const LARGEST_CELL: u32 = 64;
/// Width kept for the names beside the correlation plot, pixels.
const NAMES_WIDTH: u32 = 400;
/// With fewer samples than this, correlations of independent parameters beyond 0.14 are common.
const FEW: usize = 200;
/// Bars of a histogram.
const BARS: usize = 40;

/// Histograms and rank correlations of sampled parameters.
#[derive(Clone, Debug)]
pub struct DrawnFigure<'a> {
    /// Title of the whole.
    pub title: String,
    /// The dispersed samples.
    pub columns: &'a DrawnColumns<'a>,
}

impl DrawnFigure<'_> {
    /// Side of a cell of the correlation plot, pixels.
    fn cell(&self) -> u32 {
        let width = ACROSS as u32 * HISTOGRAM.0 - NAMES_WIDTH;
        (width / self.columns.names.len().max(1) as u32).clamp(2, LARGEST_CELL)
    }

    fn draw_correlations<B: DrawingBackend>(&self, area: &DrawingArea<B, Shift>, scale: u32) -> Result<(), PlotError> {
        let (cell, left, top) =
            ((self.cell() * scale) as i32, (NAMES_WIDTH * scale) as i32, (CAPTION_HEIGHT * scale) as i32);
        let font = |size: u32| ("sans-serif", size * scale).into_font();
        let caption = font(17).into_text_style(area).pos(Pos::new(HPos::Left, VPos::Center));
        area.draw_text("Rank correlation", &caption, (left, top / 3)).map_err(drawing)?;
        color_bar(area, (left + (170 * scale) as i32, top / 3), scale)?;
        let note = font(13).into_text_style(area).pos(Pos::new(HPos::Left, VPos::Center));
        area.draw_text(&caution(self.columns.drawn.count()), &note, (left + (370 * scale) as i32, top / 3))
            .map_err(drawing)?;
        let correlations = self.columns.drawn.rank_correlations();
        for (i, (name, row)) in self.columns.names.iter().zip(&correlations).enumerate() {
            let y = top + i as i32 * cell;
            let size = (self.cell().saturating_sub(2)).min(13);
            let style = font(size).into_text_style(area).pos(Pos::new(HPos::Right, VPos::Center));
            area.draw_text(&format!("{name}  {}", i + 1), &style, (left - 8 * scale as i32, y + cell / 2))
                .map_err(drawing)?;
            let number = font(size).into_text_style(area).pos(Pos::new(HPos::Center, VPos::Bottom));
            let above = (left + i as i32 * cell + cell / 2, top - 3 * scale as i32);
            area.draw_text(&format!("{}", i + 1), &number, above).map_err(drawing)?;
            for (j, r) in row.iter().enumerate() {
                let x = left + j as i32 * cell;
                let square = Rectangle::new([(x, y), (x + cell - 1, y + cell - 1)], shade(*r).filled());
                area.draw(&square).map_err(drawing)?;
                if self.cell() >= 36 {
                    let color = if r.abs() > 0.6 { WHITE } else { BLACK };
                    let style = font(12).color(&color).into_text_style(area).pos(Pos::new(HPos::Center, VPos::Center));
                    area.draw_text(&rounded(*r), &style, (x + cell / 2, y + cell / 2)).map_err(drawing)?;
                }
            }
        }
        Ok(())
    }
}

impl Canvas for DrawnFigure<'_> {
    fn size(&self) -> (u32, u32) {
        let rows = self.columns.names.len().div_ceil(ACROSS) as u32;
        let matrix = self.columns.names.len() as u32 * self.cell() + CAPTION_HEIGHT + 20;
        (ACROSS as u32 * HISTOGRAM.0, TITLE_HEIGHT + rows * HISTOGRAM.1 + matrix)
    }

    fn draw<B: DrawingBackend>(&self, area: &DrawingArea<B, Shift>, scale: u32) -> Result<(), PlotError> {
        let (title, rest) = area.split_vertically(TITLE_HEIGHT * scale);
        let style =
            ("sans-serif", 20 * scale).into_font().into_text_style(&title).pos(Pos::new(HPos::Center, VPos::Center));
        let middle = ((ACROSS as u32 * HISTOGRAM.0 * scale / 2) as i32, (TITLE_HEIGHT * scale / 2) as i32);
        title.draw_text(&self.title, &style, middle).map_err(drawing)?;
        let rows = self.columns.names.len().div_ceil(ACROSS);
        let (upper, lower) = rest.split_vertically(rows as u32 * HISTOGRAM.1 * scale);
        let of_column = self.columns.names.iter().zip(&self.columns.drawn.columns).zip(&self.columns.nominal);
        let of_column = of_column.zip(&self.columns.asked);
        for ((((name, values), nominal), asked), cell) in of_column.zip(upper.split_evenly((rows.max(1), ACROSS))) {
            histogram(name, values, (*nominal, *asked), &cell, scale)?;
        }
        self.draw_correlations(&lower, scale)
    }
}

/// The colours of correlations from -1 to 1, around the height of `at`.
fn color_bar<B: DrawingBackend>(area: &DrawingArea<B, Shift>, (x, y): (i32, i32), scale: u32) -> Result<(), PlotError> {
    const STEPS: i32 = 41;
    let (step, half) = (4 * scale as i32, 6 * scale as i32);
    for k in 0..STEPS {
        let color = shade(f64::from(2 * k) / f64::from(STEPS - 1) - 1.0);
        let left = x + k * step;
        area.draw(&Rectangle::new([(left, y - half), (left + step - 1, y + half)], color.filled())).map_err(drawing)?;
    }
    let style = ("sans-serif", 12 * scale).into_font().into_text_style(area).pos(Pos::new(HPos::Center, VPos::Top));
    for (text, at) in [("-1", 0), ("0", STEPS / 2), ("1", STEPS - 1)] {
        area.draw_text(text, &style, (x + at * step + step / 2, y + half + 2 * scale as i32)).map_err(drawing)?;
    }
    Ok(())
}

/// What a correlation of `samples` samples says: that of independent parameters has the standard deviation 1/sqrt(n - 1).
fn caution(samples: usize) -> String {
    let Some(others) = samples.checked_sub(1).filter(|others| *others > 0) else {
        return "too few samples for correlations".to_owned();
    };
    let bound = (1.96 / (others as f64).sqrt()).min(1.0);
    let word = if samples < FEW { "; caution, few samples" } else { "" };
    format!("{samples} samples: up to \u{b1}{bound:.2} by chance (95%){word}")
}

/// A correlation in two decimals, without the sign of a rounded zero.
fn rounded(r: f64) -> String {
    let text = format!("{r:.2}");
    if text == "-0.00" { "0.00".to_owned() } else { text }
}

/// White at 0, blue towards 1, vermilion towards -1.
fn shade(r: f64) -> RGBColor {
    let RGBColor(red, green, blue) = if r < 0.0 { COLORS[1] } else { COLORS[0] };
    let part = r.abs().min(1.0);
    let mixed = |full: u8| (255.0 + part * (f64::from(full) - 255.0)) as u8;
    RGBColor(mixed(red), mixed(green), mixed(blue))
}

/// The histogram of one column: bars between its minimum and its maximum; a dashed line at the nominal value; a curve of the numbers that are
/// expected of the distribution that was asked for.
fn histogram<B: DrawingBackend>(
    name: &str,
    values: &[f64],
    (nominal, asked): (f64, Option<&Distribution>),
    area: &DrawingArea<B, Shift>,
    scale: u32,
) -> Result<(), PlotError> {
    let finite = values.iter().copied().filter(|value| value.is_finite());
    let (low, high) = finite
        .clone()
        .chain(Some(nominal).filter(|nominal| nominal.is_finite()))
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(x), high.max(x)));
    // a single value, or none, is shown in the middle of an axis
    let half = if high > low {
        0.5 * (high - low)
    } else if low.is_finite() {
        0.05 * low.abs().max(1e-3)
    } else {
        1.0
    };
    let middle = if low.is_finite() { low + 0.5 * (high - low) } else { 0.0 };
    let (low, width) = (middle - half, 2.0 * half);
    let mut counts = [0u32; BARS];
    finite.clone().for_each(|x| counts[(((x - low) / width * BARS as f64) as usize).min(BARS - 1)] += 1);
    let edges: Vec<f64> = (0..=BARS).map(|k| low + width * (k as f64 / BARS as f64)).collect();
    let density = asked.map_or_else(Vec::new, |asked| expected(asked, &edges, finite.clone().count()));
    let most = density.iter().copied().fold(f64::from(counts.iter().copied().max().unwrap_or(0).max(1)), f64::max);
    let mut chart = ChartBuilder::on(area)
        .caption(name, ("sans-serif", 13 * scale))
        .margin(6 * scale)
        // half of the outermost labels
        .margin_left(28 * scale)
        .margin_right(28 * scale)
        .x_label_area_size(24 * scale)
        .build_cartesian_2d(0.0..1.0, 0.0..1.05 * most)
        .map_err(drawing)?;
    chart
        .configure_mesh()
        .disable_mesh()
        .disable_y_axis()
        .x_labels(3)
        .x_label_formatter(&|part| short(low + part * width))
        .label_style(("sans-serif", 12 * scale))
        .draw()
        .map_err(drawing)?;
    let bar = |k: usize| f64::from(k as u32) / BARS as f64;
    let bars = counts.iter().enumerate().map(|(k, count)| {
        Rectangle::new([(bar(k), 0.0), (bar(k + 1), f64::from(*count))], COLORS[0].mix(0.75).filled())
    });
    chart.draw_series(bars).map_err(drawing)?;
    let curve = density.iter().enumerate().map(|(k, count)| (0.5 * (bar(k) + bar(k + 1)), *count));
    chart.draw_series(LineSeries::new(curve, COLORS[1].stroke_width(2 * scale))).map_err(drawing)?;
    let at = (nominal - low) / width;
    let line = [(at, 0.0), (at, 1.05 * most)];
    chart.draw_series(DashedLineSeries::new(line, 5 * scale, 3 * scale, BLACK.stroke_width(scale))).map_err(drawing)?;
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ensemble::DrawnScenes;
    use crate::sampling::SampleId;
    use crate::sampling::distribution::uniform::UniformQuantile;

    /// Law: the nominal value is marked, outside the samples too; with few samples the figure warns.
    #[test]
    fn the_nominal_value_is_marked() {
        let columns = vec![(0..50).map(f64::from).collect::<Vec<_>>(), (0..50).map(|k| f64::from(k * k)).collect()];
        let drawn = DrawnScenes {
            first: SampleId(1),
            physical: vec![true; 50],
            columns,
            mass: Vec::new(),
            magnitudes: Vec::new(),
        };
        let names = vec!["one".to_owned(), "two".to_owned()];
        let uniform = Distribution::Uniform(UniformQuantile { min: 0.0, max: 50.0 });
        let figure_of = |nominal, asked| {
            let columns = DrawnColumns { names: names.clone(), nominal, asked, drawn: drawn.clone() };
            DrawnFigure { title: "t".into(), columns: &columns }.svg().unwrap()
        };
        let figure = |nominal| figure_of(nominal, vec![Some(&uniform), None]);
        let svg = figure(vec![25.0, -3000.0]);
        assert!(svg.contains("caution, few samples") && svg.contains("-3000"), "{svg}");
        assert_ne!(svg, figure(vec![20.0, -3000.0]));
        // the density that was asked for is drawn over the bars, where there is one
        let lines = |svg: &str| svg.matches("<polyline").count();
        assert_eq!(lines(&svg), lines(&figure_of(vec![25.0, -3000.0], vec![None; 2])) + 1);
        assert!(caution(1000) == "1000 samples: up to \u{b1}0.06 by chance (95%)");
    }
}
