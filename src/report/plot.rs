//! [`Figure`]: curves against time in panels.

use std::ops::Range;

use plotters::coord::Shift;
use plotters::coord::types::RangedCoordf64;
use plotters::prelude::*;

use crate::report::axis::Axis;
use crate::report::canvas::{Canvas, PlotError, drawing};
use crate::report::fitted_text::{fitted_to_pixels, text_width};
use crate::report::legend::{Legend, dash, style};
use crate::report::number::short;

/// Width of a panel, pixels.
const PANEL_WIDTH: u32 = 640;
/// Height of a panel whose legend has few rows, pixels.
const PANEL_HEIGHT: u32 = 320;
/// Height of the figure's title, pixels.
const TITLE_HEIGHT: u32 = 44;
/// Left and right margins of a panel, pixels.
const MARGINS: (u32, u32) = (8, 20);
/// Width of what is left of the axes: ticks and unit, pixels.
const LABELS_WIDTH: u32 = 74;
/// Size of a panel's title, pixels.
const TITLE: u32 = 17;

/// Relative errors below this are rounding: on an axis of their own they would look like a drift.
const ROUNDING: f64 = 1e-14;

type Chart<'a, B> = ChartContext<'a, B, Cartesian2d<RangedCoordf64, RangedCoordf64>>;

/// One curve.
#[derive(Clone, Debug)]
pub struct Curve {
    /// Its name in the legend; no legend is drawn for a single curve.
    pub label: String,
    /// Its values, one for each abscissa of the figure.
    pub values: Vec<f64>,
}

/// Curves over one pair of axes.
#[derive(Clone, Debug)]
pub struct Panel {
    /// What is shown.
    pub title: String,
    /// Unit of the values; empty where they have none.
    pub unit: String,
    /// The curves.
    pub curves: Vec<Curve>,
    /// Where the curves are changes of quantities, the magnitude of these; else 0. Changes of rounding errors look constant.
    pub size: f64,
    /// Whether the curves are relative errors: they are drawn on a symmetric axis.
    pub has_errors: bool,
    /// The tolerance of the run, for relative errors, where it follows one: it is marked where it is within the range. Errors that are
    /// rounding are drawn on its scale.
    pub tolerance: Option<f64>,
}

/// Panels over a common abscissa, two to a row; an odd last panel is as wide as two.
#[derive(Clone, Debug)]
pub struct Figure {
    /// Title of the whole.
    pub title: String,
    /// Label of the abscissa with its unit.
    pub abscissa_label: String,
    /// The abscissa, ascending.
    pub abscissa: Vec<f64>,
    /// The panels.
    pub panels: Vec<Panel>,
}

impl Figure {
    /// Width of the panel `index` at scale 1, pixels.
    fn panel_width(&self, index: usize) -> u32 {
        let is_alone = index.is_multiple_of(2) && index + 1 == self.panels.len();
        if is_alone { self.width() } else { PANEL_WIDTH }
    }

    /// Width of the figure at scale 1, pixels.
    fn width(&self) -> u32 {
        self.panels.len().clamp(1, 2) as u32 * PANEL_WIDTH
    }

    /// Heights of the rows of panels at scale 1, pixels: that of the higher panel of each.
    fn row_heights(&self) -> Vec<u32> {
        let heights = self.panels.iter().enumerate().map(|(index, panel)| panel.height(self.panel_width(index)));
        heights.collect::<Vec<_>>().chunks(2).map(|row| row.iter().copied().max().unwrap_or(0)).collect()
    }

    /// Corner, width and height of each panel at scale 1, pixels.
    fn places(&self) -> Vec<(i32, i32, u32, u32)> {
        let (mut places, mut top) = (Vec::new(), TITLE_HEIGHT);
        for (row, height) in self.row_heights().into_iter().enumerate() {
            for index in (2 * row..self.panels.len()).take(2) {
                let left = (index % 2) as u32 * PANEL_WIDTH;
                places.push((left as i32, top as i32, self.panel_width(index), height));
            }
            top += height;
        }
        places
    }
}

impl Canvas for Figure {
    fn size(&self) -> (u32, u32) {
        (self.width(), self.row_heights().iter().sum::<u32>().max(PANEL_HEIGHT) + TITLE_HEIGHT)
    }

    fn draw<B: DrawingBackend>(&self, area: &DrawingArea<B, Shift>, scale: u32) -> Result<(), PlotError> {
        let top = area.margin((12 * scale) as i32, 0, 0, 0);
        let title = fitted_to_pixels(&self.title, self.width(), 20)?;
        top.titled(&title, ("sans-serif", 20 * scale)).map_err(drawing)?;
        for (panel, (x, y, width, height)) in self.panels.iter().zip(self.places()) {
            let (x, y) = (x * scale as i32, y * scale as i32);
            let (width, height) = ((width * scale) as i32, (height * scale) as i32);
            let cell = area.clone().shrink((x, y), (width, height));
            panel.draw(&cell, &self.abscissa, &self.abscissa_label, scale)?;
        }
        Ok(())
    }
}

impl Panel {
    /// The legend in a panel of this width, pixels. A single curve has none.
    fn legend(&self, width: u32) -> Result<Legend, PlotError> {
        let names = self.curves.iter().map(|curve| curve.label.as_str());
        let names = names.take(if self.curves.len() > 1 { self.curves.len() } else { 0 });
        Legend::new(names, width - MARGINS.0 - MARGINS.1 - LABELS_WIDTH)
    }

    /// Height with this width, pixels: a legend of many rows takes none of the axes' height. (What is wrong with the legend shows where it is
    /// drawn.)
    fn height(&self, width: u32) -> u32 {
        PANEL_HEIGHT + self.legend(width).map_or(0, |legend| legend.extra_height())
    }

    /// Maximum magnitude of the finite values.
    fn worst(&self) -> f64 {
        let values = self.curves.iter().flat_map(|curve| &curve.values);
        values.filter(|value| value.is_finite()).fold(0.0, |worst, value| value.abs().max(worst))
    }

    fn axis(&self) -> Axis {
        let values = self.curves.iter().flat_map(|curve| curve.values.iter().copied());
        if self.has_errors {
            let worst = self.worst();
            let least = self.tolerance.map_or(ROUNDING, |tolerance| tolerance.max(ROUNDING));
            return Axis::symmetric(if worst < ROUNDING { least } else { worst });
        }
        if self.size > 0.0 { Axis::of_changes(values, self.size) } else { Axis::of(values) }
    }

    /// The title, shortened where it is wider than `width` pixels, and what the axis adds to it.
    fn heading(&self, vertical: &Axis, width: u32) -> Result<String, PlotError> {
        let worst = if self.has_errors { format!(" (maximum {})", short(self.worst())) } else { String::new() };
        let added = format!("{}{worst}", vertical.start(&self.unit));
        let left = width.saturating_sub(text_width(&added, TITLE)? as u32);
        Ok(format!("{}{added}", fitted_to_pixels(&self.title, left, TITLE)?))
    }

    fn draw<B: DrawingBackend>(
        &self,
        cell: &DrawingArea<B, Shift>,
        abscissa: &[f64],
        abscissa_label: &str,
        scale: u32,
    ) -> Result<(), PlotError> {
        let (horizontal, vertical) = (Axis::of(abscissa.iter().copied()), self.axis());
        let label = (15 * scale) as i32;
        let cell =
            cell.margin((8 * scale) as i32, (8 * scale) as i32, (MARGINS.0 * scale) as i32, (MARGINS.1 * scale) as i32);
        let width = cell.dim_in_pixel().0 / scale;
        let title = self.heading(&vertical, width)?;
        let cell = cell.titled(&title, ("sans-serif", TITLE * scale)).map_err(drawing)?;
        let legend = self.legend(width + MARGINS.0 + MARGINS.1)?;
        let (strip, axes) = cell.split_vertically(legend.height() * scale);
        legend.draw(&strip, LABELS_WIDTH, scale)?;
        let mut chart = ChartBuilder::on(&axes)
            .margin_right(8 * scale) // half of the last tick's label
            .x_label_area_size(40 * scale)
            .y_label_area_size(LABELS_WIDTH * scale)
            .build_cartesian_2d(horizontal.range(0.0), vertical.range(0.06))
            .map_err(drawing)?;
        chart
            .configure_mesh()
            .x_desc(abscissa_label)
            .y_desc(vertical.description(&self.unit))
            .x_labels(8)
            .y_labels(7)
            .x_label_formatter(&|value| horizontal.label(*value))
            .y_label_formatter(&|value| vertical.label(*value))
            .label_style(("sans-serif", label - 2))
            .axis_desc_style(("sans-serif", label))
            .light_line_style(WHITE)
            .bold_line_style(RGBColor(225, 225, 225))
            .draw()
            .map_err(drawing)?;
        if let Some(tolerance) = self.tolerance {
            self.mark(&mut chart, &horizontal.range(0.0), &vertical, tolerance, scale)?;
        }
        for (index, curve) in self.curves.iter().enumerate() {
            let points = abscissa.iter().zip(&curve.values);
            let points: Vec<(f64, f64)> = points
                .filter(|(_, value)| value.is_finite())
                .map(|(x, y)| (horizontal.map(*x), vertical.map(*y)))
                .collect();
            let style = style(index, scale);
            match dash(index) {
                None => drop(chart.draw_series(LineSeries::new(points, style)).map_err(drawing)?),
                Some((dash, gap)) => {
                    let series = DashedLineSeries::new(points, dash * scale, gap * scale, style);
                    chart.draw_series(series).map_err(drawing)?;
                }
            }
        }
        Ok(())
    }

    /// Marks plus and minus the tolerance where they are within the range.
    fn mark<B: DrawingBackend>(
        &self,
        chart: &mut Chart<'_, B>,
        horizontal: &Range<f64>,
        vertical: &Axis,
        tolerance: f64,
        scale: u32,
    ) -> Result<(), PlotError> {
        let grey = RGBColor(110, 110, 110);
        for level in [-tolerance, tolerance].map(|level| vertical.map(level)) {
            if !vertical.range(0.06).contains(&level) {
                continue;
            }
            let line = [(horizontal.start, level), (horizontal.end, level)];
            chart
                .draw_series(DashedLineSeries::new(line, 4 * scale, 4 * scale, grey.stroke_width(scale)))
                .map_err(drawing)?;
            let text = if level > 0.0 { format!("tolerance {tolerance:e}") } else { String::new() };
            let (low, high) = (vertical.range(0.06).start, vertical.range(0.06).end);
            let at = (horizontal.start + 0.01 * (horizontal.end - horizontal.start), level - 0.02 * (high - low));
            let style = ("sans-serif", 13 * scale).into_font().color(&grey);
            chart.draw_series(std::iter::once(Text::new(text, at, style))).map_err(drawing)?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;

    /// Three panels of curves over 1,201 points, the first of them noisy.
    fn figure() -> Figure {
        let abscissa: Vec<f64> = (0..1201).map(|k| f64::from(k) * 0.05).collect();
        let noise = |k: usize| libm::sin((k * k) as f64) * libm::cos(k as f64 * 1e3);
        let curve = |label: &str, values: &dyn Fn(usize) -> f64| Curve {
            label: label.to_owned(),
            values: (0..1201).map(values).collect(),
        };
        let wave = |size: f64, base: f64| move |k: usize| base + size * libm::sin(0.05 * k as f64);
        let panel = |title: &str, unit: &str, curves: Vec<Curve>, tolerance: Option<f64>| Panel {
            title: title.into(),
            unit: unit.into(),
            curves,
            size: 0.0,
            has_errors: tolerance.is_some(),
            tolerance,
        };
        Figure {
            title: "spin_sweep, nominal".into(),
            abscissa_label: "time / s".into(),
            panels: vec![
                panel("Noise", "J", vec![curve("a", &noise), curve("b", &|k| 0.5 * noise(k + 7))], None),
                panel("Kinetic energy of the fuselage", "J", vec![curve("fuselage", &wave(80.0, 1_060_915.0))], None),
                panel("Errors", "", vec![curve("energy", &|k| 1e-15 * noise(k))], Some(1e-10)),
                panel(
                    "Energy change since the start",
                    "J",
                    vec![
                        curve("one", &wave(-40.0, 0.0)),
                        curve("two", &wave(25.0, 0.0)),
                        curve("three", &wave(9.0, 0.0)),
                    ],
                    None,
                ),
                panel("Errors", "", vec![curve("energy", &|k| 1e-9 * noise(k))], Some(1e-10)),
            ],
            abscissa,
        }
    }

    /// Pixels that are neither grey nor white, of a figure.
    fn colored(figure: &Figure) -> Vec<(i32, i32)> {
        let (width, pixels) = (figure.size().0 as usize, figure.pixels().unwrap());
        let is_colored = |pixel: &[u8]| pixel.iter().max().unwrap() - pixel.iter().min().unwrap() > 30;
        let found = pixels.chunks_exact(3).enumerate().filter(|(_, pixel)| is_colored(pixel));
        found.map(|(at, _)| ((at % width) as i32, (at / width) as i32)).collect()
    }

    /// Law: both formats are complete. With SPINDRIFT_PLOT_FOLDER set the files are kept to be looked at.
    #[test]
    fn draws_svg_and_png() {
        let (svg, png) = (figure().svg().unwrap(), figure().png().unwrap());
        assert!(svg.starts_with("<svg") && svg.trim_end().ends_with("</svg>"));
        assert!(svg.contains("Kinetic energy of the fuselage"));
        let mut reader = png::Decoder::new(std::io::Cursor::new(&png)).read_info().unwrap();
        let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
        reader.next_frame(&mut pixels).unwrap();
        let dark = pixels.chunks_exact(3).filter(|pixel| pixel.iter().all(|value| *value < 100)).count();
        assert!(dark > 2000, "text and axes are drawn: {dark} dark pixels");
        if let Some(folder) = std::env::var_os("SPINDRIFT_PLOT_FOLDER") {
            figure().save(&Path::new(&folder).join("figure.svg")).unwrap();
            figure().save(&Path::new(&folder).join("figure.png")).unwrap();
        }
    }

    /// Law: a curve stays in its panel, however noisy it is: with one panel's curves alone, all colour is in that panel, below
    /// its title and above the labels of its abscissa.
    #[test]
    fn no_colored_pixel_leaves_its_panel() {
        let all = figure();
        for (index, (x, y, width, height)) in all.places().into_iter().enumerate() {
            let mut one = figure();
            let others = one.panels.iter_mut().enumerate().filter(|(other, _)| *other != index);
            others.for_each(|(_, panel)| panel.curves.clear());
            let colored = colored(&one);
            assert!(colored.len() > 1000, "the curves are drawn");
            let (left, right) = (x + 80, x + width as i32 - 20);
            let (top, bottom) = (y + 25, y + height as i32 - 45);
            let outside = colored.iter().filter(|(x, y)| !(left..right).contains(x) || !(top..bottom).contains(y));
            assert_eq!(outside.collect::<Vec<_>>(), Vec::<&(i32, i32)>::new(), "panel {index}");
        }
    }

    /// Law: a legend stays in its panel, however many and long its names are: they change no pixel of another panel, and no text of the SVG
    /// leaves the panel.
    #[test]
    fn legends_stay_in_their_panels() {
        for (index, count, name) in [(0, 8, "wheel wheel_number_"), (3, 40, "w"), (4, 3, &"long".repeat(60))] {
            let curves = |count: usize, name: &str| -> Vec<Curve> {
                let curve = |k: usize| Curve { label: format!("{name}{k}"), values: vec![k as f64; 1201] };
                (0..count).map(curve).collect()
            };
            let of_curves = |shown: usize| {
                let mut figure = figure();
                figure.panels[index].curves = curves(shown, name);
                // with as many curves in the panel next to it, the panels have one height with few and with many curves
                if let Some(neighbour) = figure.panels.get_mut(index ^ 1) {
                    neighbour.curves = curves(count, &format!("_{name}"));
                }
                figure
            };
            let (one, all) = (of_curves(1), of_curves(count));
            assert_eq!(one.size(), all.size());
            let (x, y, width, height) = all.places()[index];
            let (right, bottom) = (x + width as i32, y + height as i32);
            let pixels = [&one, &all].map(|figure| figure.pixels().unwrap());
            let [one, other] = pixels.each_ref().map(|pixels| pixels.chunks_exact(3));
            let differing: Vec<usize> =
                one.zip(other).enumerate().filter(|(_, (a, b))| a != b).map(|(at, _)| at).collect();
            assert!(differing.len() > 1000, "the legend is drawn");
            let size = all.size().0 as usize;
            let is_outside = |at: &usize| {
                let (column, row) = ((at % size) as i32, (at / size) as i32);
                !((x..right).contains(&column) && (y..bottom).contains(&row))
            };
            assert_eq!(differing.into_iter().filter(is_outside).count(), 0, "{count} of {name}");

            let svg = all.svg().unwrap();
            let start: String = name.chars().take(4).collect();
            let mut names = 0;
            for element in svg.split("<text ").skip(1) {
                let (attributes, rest) = element.split_once('>').unwrap();
                let text = rest.split_once('<').unwrap().0.trim();
                let at = |key: &str| attributes.split(key).nth(1).unwrap().split('"').next().unwrap().parse::<i32>();
                if text.starts_with(&start) {
                    names += 1;
                    let (left, top) = (at("x=\"").unwrap(), at(" y=\"").unwrap());
                    let end = left + text_width(text, 14).unwrap() as i32;
                    assert!(x <= left && end <= right && (y..bottom).contains(&top), "{text}: {left} to {end}");
                }
            }
            assert_eq!(names, count, "every name is in the SVG");
        }
    }

    /// Law: a legend of many rows makes its row of panels higher, by what it needs, and no other; figures with few curves keep their size.
    #[test]
    fn many_names_make_a_panel_higher() {
        let (few, mut many) = (figure(), figure());
        assert_eq!(few.size(), (2 * PANEL_WIDTH, 3 * PANEL_HEIGHT + TITLE_HEIGHT));
        let curve = |k: usize| Curve { label: format!("reaction_wheel_number_{k}"), values: vec![k as f64; 1201] };
        many.panels[3].curves = (0..8).map(curve).collect();
        let extra = many.panels[3].legend(PANEL_WIDTH).unwrap().extra_height();
        assert!(extra > 0, "eight long names do not fit the usual rows");
        assert_eq!(many.row_heights(), [PANEL_HEIGHT, PANEL_HEIGHT + extra, PANEL_HEIGHT]);
        assert_eq!(many.size(), (few.size().0, few.size().1 + extra));
        let svg = many.svg().unwrap();
        assert!((0..8).all(|k| svg.contains(&format!("reaction_wheel_number_{k}"))), "{svg}");
    }

    /// Law: rounding errors are drawn on the scale of the tolerance, larger ones on their own, both with zero in the middle.
    #[test]
    fn errors_are_on_a_symmetric_scale() {
        let panels = figure().panels;
        assert_eq!(panels[2].axis(), Axis::symmetric(1e-10));
        let range = panels[4].axis().range(0.0);
        assert_eq!(range.start, -range.end);
        assert_ne!(panels[4].axis(), Axis::symmetric(1e-10));
    }

    /// Law: errors of a method that follows no tolerance are on a symmetric scale too, without a line or a word of a tolerance.
    #[test]
    fn no_tolerance_is_marked_where_there_is_none() {
        let (mut with, mut without) = (figure(), figure());
        for (panel, tolerance) in [(&mut with.panels[4], Some(1e-10)), (&mut without.panels[4], None)] {
            panel.tolerance = tolerance;
        }
        without.panels[2].tolerance = None;
        assert_eq!(without.panels[2].axis(), Axis::symmetric(ROUNDING));
        assert_eq!(without.panels[4].axis(), with.panels[4].axis());
        assert!(with.svg().unwrap().contains("tolerance 1e-10"));
        let svg = without.svg().unwrap();
        assert!(!svg.contains("tolerance") && svg.matches("(maximum ").count() == 2, "{svg}");
    }

    #[test]
    fn other_formats_are_refused() {
        let refused = figure().save(Path::new("x.pdf")).unwrap_err();
        assert_eq!(refused.to_string(), "a plot is written as .svg or .png, and `x.pdf` is neither");
    }
}
