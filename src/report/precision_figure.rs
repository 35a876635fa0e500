//! [`PrecisionFigure`]: work-precision diagrams, CPU time of a run against its maximum error, both logarithmic.
//!
//! One panel for each error; errors decrease to the right, so that the better method is lower and further right. The axes are
//! decimal logarithms: plotters labels its own logarithmic axes with plain numbers.

use std::ops::Range;

use plotters::coord::Shift;
use plotters::prelude::*;

use crate::ensemble::precision::{Deviation, Measurement};
use crate::propagation::Method;
use crate::report::axis::superscript;
use crate::report::canvas::{COLORS, Canvas, PlotError, drawing};

/// Width of a panel, pixels.
const PANEL_WIDTH: u32 = 680;
/// Height of a panel, pixels.
const PANEL_HEIGHT: u32 = 440;
/// Height of the figure's title, pixels.
const TITLE_HEIGHT: u32 = 44;
/// Height of the legend below the title, pixels: outside the panels, since curves may be anywhere in them.
const LEGEND_HEIGHT: u32 = 28;
/// Width of one method in the legend, pixels.
const LEGEND_WIDTH: u32 = 160;
/// Errors below this are drawn here: they are rounding of the observation.
const LEAST_ERROR: f64 = 1e-17;
/// Errors above this are drawn here: nothing of the solution is right.
const MOST_ERROR: f64 = 1e1;

/// An error of a measurement.
type Pick = fn(&Measurement) -> Option<Deviation>;

/// The panels: title and what is shown.
const PANELS: [(&str, Pick); 4] = [
    ("Angular velocity: maximum relative error", |m| m.rate),
    ("Attitude: maximum error, rad", |m| m.attitude),
    ("Energy balance: maximum relative error", |m| m.energy),
    ("Angular momentum: maximum relative error", |m| m.momentum),
];

/// Run time against error.
#[derive(Clone, Debug)]
pub struct PrecisionFigure<'a> {
    /// Title of the whole.
    pub title: String,
    /// What was measured.
    pub measured: &'a [Measurement],
}

impl PrecisionFigure<'_> {
    /// The panels with at least one curve.
    fn panels(&self) -> Vec<(&'static str, Vec<Curve>)> {
        PANELS
            .into_iter()
            .map(|(title, pick)| (title, self.curves(pick)))
            .filter(|(_, curves)| !curves.is_empty())
            .collect()
    }

    /// A curve for each method, with the same colour in all panels.
    fn curves(&self, pick: Pick) -> Vec<Curve> {
        let curve = |(number, method): (usize, Method)| {
            let of = self.measured.iter().filter(|measurement| measurement.method == method);
            let points: Vec<(f64, f64)> = of
                .filter_map(|m| pick(m).filter(|error| error.max.is_finite()).map(|error| (error.max, m.cpu[0])))
                .map(|(error, cpu)| (-libm::log10(error.clamp(LEAST_ERROR, MOST_ERROR)), libm::log10(cpu)))
                .filter(|(_, cpu)| cpu.is_finite())
                .collect();
            (!points.is_empty()).then(|| Curve { method, color: COLORS.get(number).copied().unwrap_or(GREY), points })
        };
        Method::ALL.into_iter().enumerate().filter_map(curve).collect()
    }
}

impl Canvas for PrecisionFigure<'_> {
    fn size(&self) -> (u32, u32) {
        let panels = self.panels().len();
        let columns = panels.clamp(1, 2);
        let rows = panels.div_ceil(columns).max(1);
        (columns as u32 * PANEL_WIDTH, rows as u32 * PANEL_HEIGHT + TITLE_HEIGHT + LEGEND_HEIGHT)
    }

    fn draw<B: DrawingBackend>(&self, area: &DrawingArea<B, Shift>, scale: u32) -> Result<(), PlotError> {
        let panels = self.panels();
        let area = area.margin((12 * scale) as i32, 0, 0, 0);
        let area = area.titled(&self.title, ("sans-serif", 20 * scale)).map_err(drawing)?;
        let (strip, area) = area.split_vertically((LEGEND_HEIGHT * scale) as i32);
        legend(&strip, panels.first().map_or(&[], |(_, curves)| curves), scale)?;
        let columns = panels.len().clamp(1, 2);
        let cells = area.split_evenly((panels.len().div_ceil(columns).max(1), columns));
        for ((title, curves), cell) in panels.iter().zip(&cells) {
            draw_panel(cell, title, curves, scale)?;
        }
        Ok(())
    }
}

/// The seventh method's colour.
const GREY: RGBColor = RGBColor(130, 130, 130);

/// One method: (-log10 error, log10 of the time in s), setting by setting.
struct Curve {
    method: Method,
    color: RGBColor,
    points: Vec<(f64, f64)>,
}

fn draw_panel<B: DrawingBackend>(
    cell: &DrawingArea<B, Shift>,
    title: &str,
    curves: &[Curve],
    scale: u32,
) -> Result<(), PlotError> {
    let points = || curves.iter().flat_map(|curve| &curve.points);
    let horizontal = decades(points().map(|point| point.0));
    let vertical = decades(points().map(|point| point.1));
    let label = (15 * scale) as i32;
    let mut chart = ChartBuilder::on(cell)
        .caption(title, ("sans-serif", 17 * scale))
        .margin(8 * scale)
        .margin_right(20 * scale)
        .x_label_area_size(44 * scale)
        .y_label_area_size(64 * scale)
        .build_cartesian_2d(horizontal.clone(), vertical.clone())
        .map_err(drawing)?;
    let ticks = |range: &Range<f64>| (range.end - range.start).round() as usize + 1;
    chart
        .configure_mesh()
        .x_desc("error, smaller to the right")
        .y_desc("CPU time of a run, s")
        .x_labels(ticks(&horizontal))
        .y_labels(ticks(&vertical))
        .x_label_formatter(&|value| power(-value))
        .y_label_formatter(&|value| power(*value))
        .label_style(("sans-serif", label - 2))
        .axis_desc_style(("sans-serif", label))
        .light_line_style(WHITE)
        .bold_line_style(RGBColor(225, 225, 225))
        .draw()
        .map_err(drawing)?;
    for curve in curves {
        let style = curve.color.stroke_width(scale + scale / 2);
        let color = curve.color;
        chart.draw_series(LineSeries::new(curve.points.iter().copied(), style)).map_err(drawing)?;
        let dots = curve.points.iter().map(|point| Circle::new(*point, (3 * scale) as i32, color.filled()));
        chart.draw_series(dots).map_err(drawing)?;
    }
    Ok(())
}

/// The methods with their colours in a row.
fn legend<B: DrawingBackend>(strip: &DrawingArea<B, Shift>, curves: &[Curve], scale: u32) -> Result<(), PlotError> {
    let width = (LEGEND_WIDTH * scale) as i32;
    let total = width * curves.len() as i32;
    let mut x = (strip.dim_in_pixel().0 as i32 - total).max(0) / 2;
    let (y, line) = ((LEGEND_HEIGHT * scale / 2) as i32, (24 * scale) as i32);
    for curve in curves {
        strip
            .draw(&PathElement::new(vec![(x, y), (x + line, y)], curve.color.stroke_width(2 * scale)))
            .map_err(drawing)?;
        strip.draw(&Circle::new((x + line / 2, y), (3 * scale) as i32, curve.color.filled())).map_err(drawing)?;
        let at = (x + line + (6 * scale) as i32, y - (8 * scale) as i32);
        strip.draw(&Text::new(curve.method.name(), at, ("sans-serif", 14 * scale))).map_err(drawing)?;
        x += width;
    }
    Ok(())
}

/// Whole decades around `values`.
fn decades(values: impl Iterator<Item = f64>) -> Range<f64> {
    let (low, high) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), value| (l.min(value), h.max(value)));
    if low > high {
        return 0.0..1.0;
    }
    let (low, high) = (libm::floor(low), libm::ceil(high));
    low..high.max(low + 1.0)
}

/// 10^`exponent` in the usual notation; empty between the powers.
fn power(exponent: f64) -> String {
    let whole = exponent.round();
    match whole as i32 {
        _ if (exponent - whole).abs() > 1e-6 => String::new(),
        0 => "1".to_owned(),
        1 => "10".to_owned(),
        whole => format!("10{}", superscript(whole)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn axes_have_whole_decades() {
        assert_eq!(decades([3.2, 7.9].into_iter()), 3.0..8.0);
        assert_eq!(decades([3.0].into_iter()), 3.0..4.0);
        assert_eq!(decades([].into_iter()), 0.0..1.0);
        assert_eq!([-12.0, 0.0, 1.0, 2.5].map(power), ["10⁻¹²", "1", "10", ""]);
    }
}
