//! [`DrawnFigure`]: histograms of the dispersed parameters and the rank correlation of each pair.

use plotters::coord::Shift;
use plotters::element::DashedPathElement;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

use crate::report::canvas::{COLORS, Canvas, PlotError, drawing};
use crate::report::drawn_columns::DrawnColumns;
use crate::report::expected_counts::Asked;
use crate::report::fitted_text::fitted_to_pixels;
use crate::report::histogram::{self, Histogram};

/// Size of a histogram, pixels.
const HISTOGRAM: (u32, u32) = (300, 190);
/// Histograms side by side.
const ACROSS: usize = 4;
/// Height of the figure's title, pixels.
const TITLE_HEIGHT: u32 = 44;
/// Height of the legend under the title, pixels.
const LEGEND_HEIGHT: u32 = 24;
/// Height of the title over the correlations, pixels.
const CAPTION_HEIGHT: u32 = 52;
/// Maximum side of a cell of the correlation plot, pixels.
const LARGEST_CELL: u32 = 64;
/// Width kept for the names beside the correlation plot, pixels.
const NAMES_WIDTH: u32 = 400;
/// With fewer samples than this, correlations of independent parameters beyond 0.14 are common.
const FEW: usize = 200;

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
            // the font has at most this size
            let name = fitted_to_pixels(name, NAMES_WIDTH - 48, 13)?;
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
        (ACROSS as u32 * HISTOGRAM.0, TITLE_HEIGHT + LEGEND_HEIGHT + rows * HISTOGRAM.1 + matrix)
    }

    fn draw<B: DrawingBackend>(&self, area: &DrawingArea<B, Shift>, scale: u32) -> Result<(), PlotError> {
        let (title, rest) = area.split_vertically(TITLE_HEIGHT * scale);
        let style =
            ("sans-serif", 20 * scale).into_font().into_text_style(&title).pos(Pos::new(HPos::Center, VPos::Center));
        let middle = ((ACROSS as u32 * HISTOGRAM.0 * scale / 2) as i32, (TITLE_HEIGHT * scale / 2) as i32);
        title.draw_text(&self.title, &style, middle).map_err(drawing)?;
        let (strip, rest) = rest.split_vertically(LEGEND_HEIGHT * scale);
        legend(&strip, &self.columns.asked, scale)?;
        let rows = self.columns.names.len().div_ceil(ACROSS);
        let (upper, lower) = rest.split_vertically(rows as u32 * HISTOGRAM.1 * scale);
        let of_column = self.columns.names.iter().zip(&self.columns.drawn.columns).zip(&self.columns.nominal);
        let of_column = of_column.zip(&self.columns.asked);
        for ((((name, values), nominal), asked), cell) in of_column.zip(upper.split_evenly((rows.max(1), ACROSS))) {
            Histogram { name, values, nominal: *nominal, asked: asked.as_ref() }.draw(&cell, scale)?;
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
        area.draw(&Rectangle::new([(left, y - half), (left + step, y + half)], color.filled())).map_err(drawing)?;
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

/// What the bars and lines of the histograms are, in one row for the picture: what none of them shows is left out.
fn legend<B: DrawingBackend>(
    strip: &DrawingArea<B, Shift>,
    asked: &[Option<Asked<'_>>],
    scale: u32,
) -> Result<(), PlotError> {
    let is_discrete = |asked: &Asked<'_>| asked.values().is_some();
    let mut entries = vec![(Sample::Bar, "samples"), (Sample::Nominal, "nominal value")];
    if asked.iter().flatten().any(|asked| !is_discrete(asked)) {
        entries.push((Sample::Density, "density of the distribution, as samples expected in each bar"));
    }
    if asked.iter().flatten().any(is_discrete) {
        entries.push((Sample::Probability, "probability of a discrete value, as samples expected"));
    }
    let font = ("sans-serif", 13 * scale).into_text_style(strip);
    let (length, gap, middle) = ((26 * scale) as i32, (6 * scale) as i32, (LEGEND_HEIGHT * scale / 2) as i32);
    let widths = entries.iter().map(|(_, text)| strip.estimate_text_size(text, &font).map(|size| size.0 as i32));
    let widths: Vec<i32> = widths.collect::<Result<_, _>>().map_err(drawing)?;
    let total: i32 = widths.iter().map(|width| length + width + 4 * gap).sum::<i32>() - 3 * gap;
    let mut x = (strip.dim_in_pixel().0 as i32 - total).max(0) / 2;
    for ((sample, text), width) in entries.into_iter().zip(widths) {
        let half = (5 * scale) as i32;
        let line = |style| PathElement::new(vec![(x, middle), (x + length, middle)], style);
        match sample {
            Sample::Bar => {
                strip.draw(&Rectangle::new([(x, middle - half), (x + length, middle + half)], histogram::of_samples()))
            }
            Sample::Nominal => {
                let ((dash, gap), ends) = (histogram::NOMINAL_DASH, [(x, middle), (x + length, middle)]);
                strip.draw(&DashedPathElement::new(ends, dash * scale, gap * scale, histogram::of_nominal(scale)))
            }
            Sample::Density => strip.draw(&line(histogram::of_expected(scale))),
            Sample::Probability => strip.draw(&line(histogram::of_expected(scale))).and_then(|()| {
                strip.draw(&Circle::new((x + length - gap / 2, middle), histogram::HEAD * scale, COLORS[1].filled()))
            }),
        }
        .map_err(drawing)?;
        let style = font.clone().pos(Pos::new(HPos::Left, VPos::Center));
        strip.draw_text(text, &style, (x + length + gap, middle)).map_err(drawing)?;
        x += length + width + 4 * gap;
    }
    Ok(())
}

/// What stands before the text of an entry of the legend.
#[derive(Clone, Copy, Debug)]
enum Sample {
    Bar,
    Nominal,
    Density,
    Probability,
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ensemble::DrawnScenes;
    use crate::sampling::SampleId;
    use crate::sampling::distribution::Distribution;
    use crate::sampling::distribution::choice::ChoiceQuantile;
    use crate::sampling::distribution::uniform::UniformQuantile;

    const NAMES: [&str; 2] = ["one", "two"];

    /// The picture of two columns of fifty samples: 0, 1, 2, ... and their squares.
    fn figure_of(nominal: Vec<f64>, asked: Vec<Option<Asked<'_>>>) -> String {
        let columns = vec![(0..50).map(f64::from).collect::<Vec<_>>(), (0..50).map(|k| f64::from(k * k)).collect()];
        let drawn = DrawnScenes {
            first: SampleId(1),
            physical: vec![true; 50],
            columns,
            mass: Vec::new(),
            magnitudes: Vec::new(),
        };
        let columns = DrawnColumns { names: NAMES.map(str::to_owned).to_vec(), nominal, asked, drawn };
        DrawnFigure { title: "t".into(), columns: &columns }.svg().unwrap()
    }

    /// Law: the nominal value is marked, outside the samples too; with few samples the figure warns.
    #[test]
    fn the_nominal_value_is_marked() {
        let uniform = Distribution::Uniform(UniformQuantile { min: 0.0, max: 50.0 });
        let figure = |nominal| figure_of(nominal, vec![Some(Asked::Number(&uniform)), None]);
        let svg = figure(vec![25.0, -3000.0]);
        assert!(svg.contains("caution, few samples") && svg.contains("nominal -3000: left of this"), "{svg}");
        assert!(figure(vec![25.0, 1e5]).contains("nominal 1.000e5: right of this"));
        assert_ne!(svg, figure(vec![20.0, -3000.0]));
        // the density that was asked for is drawn over the bars and in the legend, where there is one
        let lines = |svg: &str| svg.matches("<polyline").count();
        let without = figure_of(vec![25.0, -3000.0], vec![None; 2]);
        assert_eq!(lines(&svg), lines(&without) + 2);
        assert!(caution(1000) == "1000 samples: up to \u{b1}0.06 by chance (95%)");
    }

    /// Law: the legend names what the picture shows, and nothing else.
    #[test]
    fn the_legend_names_what_is_drawn() {
        let uniform = Distribution::Uniform(UniformQuantile { min: 0.0, max: 50.0 });
        let choice = Distribution::Choice(ChoiceQuantile::new(&[0.0, 49.0], &[1.0; 2]));
        let (density, probability) = ("density of the distribution", "probability of a discrete value");
        for (asked, has_density, has_probability) in [
            (vec![None, None], false, false),
            (vec![Some(Asked::Number(&uniform)), None], true, false),
            (vec![Some(Asked::Number(&choice)), None], false, true),
            (vec![Some(Asked::Number(&choice)), Some(Asked::UniformTilt)], true, true),
        ] {
            let svg = figure_of(vec![25.0, 25.0], asked);
            assert!(svg.contains("nominal value") && svg.contains("samples"));
            assert_eq!((svg.contains(density), svg.contains(probability)), (has_density, has_probability));
            // two values, each with a head, and one in the legend
            assert_eq!(svg.matches("<circle").count(), if has_probability { 3 } else { 0 });
        }
    }
}
