//! [`Figure`]: curves against time in panels, as SVG or PNG.
//!
//! The font is the one in `assets/` (a subset of DejaVu Sans, licence beside it), so that a plot needs nothing from the system
//! and measures its text alike everywhere. The bitmap is drawn at twice its size and averaged down, since the backend does not
//! smooth lines; PNG is encoded by the `png` crate (the plotting crate's own way would pull in a whole image library).

use std::io;
use std::ops::Range;
use std::path::Path;
use std::sync::OnceLock;

use plotters::coord::Shift;
use plotters::prelude::*;
use plotters::style::{FontStyle, register_font};
use thiserror::Error;

use crate::dataset::atomic;

static FONT: &[u8] = include_bytes!("../../assets/DejaVuSans-subset.ttf");

/// Colours that stay apart for colour-blind readers (Okabe & Ito 2008).
pub(super) const COLORS: [RGBColor; 6] = [
    RGBColor(0, 114, 178),
    RGBColor(213, 94, 0),
    RGBColor(0, 158, 115),
    RGBColor(204, 121, 167),
    RGBColor(86, 180, 233),
    RGBColor(0, 0, 0),
];

/// Width of a panel, pixels.
const PANEL_WIDTH: u32 = 640;
/// Height of a panel, pixels.
const PANEL_HEIGHT: u32 = 320;
/// Height of the figure's title, pixels.
const TITLE_HEIGHT: u32 = 44;
/// The bitmap is drawn this much larger and averaged down.
pub(super) const OVERSAMPLING: u32 = 2;

/// Where a variable moves by less than this fraction of its size, its axis counts from a base value.
const OFFSET_BELOW: f64 = 1e-3;

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
}

/// Panels over a common abscissa, two to a row.
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

/// Why a plot could not be made.
#[derive(Debug, Error)]
pub enum PlotError {
    /// The file could not be written.
    #[error(transparent)]
    Io(#[from] io::Error),
    /// The name says neither SVG nor PNG.
    #[error("a plot is written as .svg or .png, and `{0}` is neither")]
    Format(String),
    /// The plotting library gave up.
    #[error("drawing failed: {0}")]
    Drawing(String),
}

/// The formats a plot can be written in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PlotFormat {
    /// Scalable vector graphics.
    Svg,
    /// Portable network graphics.
    Png,
}

impl PlotFormat {
    /// The format that the extension of `path` names.
    ///
    /// # Errors
    /// [`PlotError::Format`].
    pub fn of(path: &Path) -> Result<Self, PlotError> {
        match path.extension().and_then(|extension| extension.to_str()).map(str::to_ascii_lowercase).as_deref() {
            Some("svg") => Ok(PlotFormat::Svg),
            Some("png") => Ok(PlotFormat::Png),
            _ => Err(PlotError::Format(path.display().to_string())),
        }
    }
}

impl Figure {
    /// Draws the figure to `path`, in the format of its extension.
    ///
    /// # Errors
    /// [`PlotError`].
    pub fn save(&self, path: &Path) -> Result<(), PlotError> {
        let bytes = match PlotFormat::of(path)? {
            PlotFormat::Svg => self.svg()?.into_bytes(),
            PlotFormat::Png => self.png()?,
        };
        Ok(atomic::write_bytes(path, &bytes)?)
    }

    /// The figure as SVG text.
    ///
    /// # Errors
    /// [`PlotError::Drawing`].
    pub fn svg(&self) -> Result<String, PlotError> {
        let mut text = String::new();
        self.draw(SVGBackend::with_string(&mut text, self.size()).into_drawing_area(), 1)?;
        Ok(text)
    }

    /// The figure as an encoded PNG.
    ///
    /// # Errors
    /// [`PlotError::Drawing`].
    pub fn png(&self) -> Result<Vec<u8>, PlotError> {
        let (width, height) = self.size();
        let large = (width * OVERSAMPLING, height * OVERSAMPLING);
        let mut pixels = vec![255; (large.0 * large.1 * 3) as usize];
        self.draw(BitMapBackend::with_buffer(&mut pixels, large).into_drawing_area(), OVERSAMPLING)?;
        encode(&averaged(&pixels, width as usize, height as usize), width, height)
    }

    fn size(&self) -> (u32, u32) {
        let columns = self.panels.len().clamp(1, 2) as u32;
        (columns * PANEL_WIDTH, self.panels.len().div_ceil(2).max(1) as u32 * PANEL_HEIGHT + TITLE_HEIGHT)
    }

    fn draw<B: DrawingBackend>(&self, area: DrawingArea<B, Shift>, scale: u32) -> Result<(), PlotError> {
        install_font()?;
        area.fill(&WHITE).map_err(drawing)?;
        let area = area.margin((12 * scale) as i32, 0, 0, 0);
        let area = area.titled(&self.title, ("sans-serif", 20 * scale)).map_err(drawing)?;
        let columns = self.panels.len().clamp(1, 2);
        let cells = area.split_evenly((self.panels.len().div_ceil(columns).max(1), columns));
        for (panel, cell) in self.panels.iter().zip(&cells) {
            panel.draw(cell, &self.abscissa, &self.abscissa_label, scale)?;
        }
        area.present().map_err(drawing)
    }
}

impl Panel {
    fn draw<B: DrawingBackend>(
        &self,
        cell: &DrawingArea<B, Shift>,
        abscissa: &[f64],
        abscissa_label: &str,
        scale: u32,
    ) -> Result<(), PlotError> {
        let horizontal = Axis::of(abscissa.iter().copied());
        let vertical = Axis::of(self.curves.iter().flat_map(|curve| curve.values.iter().copied()));
        let label = (15 * scale) as i32;
        let mut chart = ChartBuilder::on(cell)
            .caption(&self.title, ("sans-serif", 17 * scale))
            .margin(8 * scale)
            .margin_right(20 * scale)
            .x_label_area_size(40 * scale)
            .y_label_area_size(74 * scale)
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
        for (index, curve) in self.curves.iter().enumerate() {
            let style = COLORS[index % COLORS.len()].stroke_width(scale + scale / 2);
            let points = abscissa.iter().zip(&curve.values);
            let points =
                points.filter(|(_, value)| value.is_finite()).map(|(x, y)| (horizontal.map(*x), vertical.map(*y)));
            let drawn = chart.draw_series(LineSeries::new(points, style)).map_err(drawing)?;
            if self.curves.len() > 1 {
                let length = (18 * scale) as i32;
                drawn.label(&curve.label).legend(move |(x, y)| PathElement::new(vec![(x, y), (x + length, y)], style));
            }
        }
        if self.curves.len() > 1 {
            chart
                .configure_series_labels()
                .position(SeriesLabelPosition::UpperRight)
                .legend_area_size(24 * scale)
                .background_style(WHITE.mix(0.8))
                .border_style(RGBColor(200, 200, 200))
                .label_font(("sans-serif", label - 1))
                .draw()
                .map_err(drawing)?;
        }
        Ok(())
    }
}

/// How the values of an axis are written: counted from `base`, in units of 10^`power`.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Axis {
    low: f64,
    high: f64,
    base: f64,
    power: i32,
}

impl Axis {
    fn of(values: impl Iterator<Item = f64>) -> Self {
        let (low, high) = values
            .filter(|value| value.is_finite())
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| (low.min(value), high.max(value)));
        let (low, high) = if low <= high { (low, high) } else { (0.0, 0.0) };
        let size = low.abs().max(high.abs());
        let span = high - low;
        let base = if span > 0.0 && span < OFFSET_BELOW * size { low } else { 0.0 };
        let reach = if base == 0.0 { size } else { span };
        let decade = if reach > 0.0 { libm::floor(libm::log10(reach)) as i32 } else { 0 };
        let power = if (-2..4).contains(&decade) { 0 } else { decade.div_euclid(3) * 3 };
        Axis { low, high, base, power }
    }

    fn map(&self, value: f64) -> f64 {
        (value - self.base) / libm::pow(10.0, f64::from(self.power))
    }

    fn range(&self, margin: f64) -> Range<f64> {
        let (low, high) = (self.map(self.low), self.map(self.high));
        if high > low {
            low - margin * (high - low)..high + margin * (high - low)
        } else {
            let half = if low == 0.0 { 1.0 } else { 0.01 * low.abs() };
            low - half..high + half
        }
    }

    /// A tick's text: as many decimals as neighbouring ticks need to differ, and no more.
    fn label(&self, value: f64) -> String {
        let span = self.map(self.high) - self.map(self.low);
        let decimals = if span > 0.0 { (1.0 - libm::floor(libm::log10(span))).clamp(0.0, 9.0) as usize } else { 3 };
        let text = format!("{value:.decimals$}");
        let text = if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.') } else { &text };
        if text == "-0" { "0".to_owned() } else { text.to_owned() }
    }

    fn description(&self, unit: &str) -> String {
        let unit = match (self.power, unit) {
            (0, unit) => unit.to_owned(),
            (power, "") => format!("10{}", superscript(power)),
            (power, unit) => format!("10{} {unit}", superscript(power)),
        };
        if self.base == 0.0 { unit } else { format!("{unit}, from {:.9e}", self.base) }
    }
}

pub(super) fn superscript(power: i32) -> String {
    const DIGITS: [char; 10] = ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'];
    let digits = power.unsigned_abs().to_string();
    let digits = digits.chars().filter_map(|digit| digit.to_digit(10)).map(|digit| DIGITS[digit as usize]);
    (power < 0).then_some('⁻').into_iter().chain(digits).collect()
}

pub(super) fn install_font() -> Result<(), PlotError> {
    static INSTALLED: OnceLock<bool> = OnceLock::new();
    let installed = INSTALLED.get_or_init(|| register_font("sans-serif", FontStyle::Normal, FONT).is_ok());
    if *installed { Ok(()) } else { Err(PlotError::Drawing("the built-in font cannot be read".to_owned())) }
}

pub(super) fn drawing<E: std::error::Error + Send + Sync>(error: DrawingAreaErrorKind<E>) -> PlotError {
    PlotError::Drawing(error.to_string())
}

/// Averages squares of [`OVERSAMPLING`] pixels; `width` and `height` are those of the result.
pub(super) fn averaged(pixels: &[u8], width: usize, height: usize) -> Vec<u8> {
    let side = OVERSAMPLING as usize;
    let mut small = Vec::with_capacity(width * height * 3);
    for y in 0..height {
        for x in 0..width {
            for channel in 0..3 {
                let mut sum = 0;
                for dy in 0..side {
                    for dx in 0..side {
                        sum += u32::from(pixels[((y * side + dy) * width * side + x * side + dx) * 3 + channel]);
                    }
                }
                small.push((sum / (side * side) as u32) as u8);
            }
        }
    }
    small
}

pub(super) fn encode(pixels: &[u8], width: u32, height: u32) -> Result<Vec<u8>, PlotError> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, width, height);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    let failed = |error: png::EncodingError| PlotError::Drawing(error.to_string());
    let mut writer = encoder.write_header().map_err(failed)?;
    writer.write_image_data(pixels).map_err(failed)?;
    writer.finish().map_err(failed)?;
    Ok(bytes)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn figure() -> Figure {
        let abscissa: Vec<f64> = (0..200).map(|k| f64::from(k) * 0.05).collect();
        let curve = |label: &str, size: f64, base: f64| Curve {
            label: label.to_owned(),
            values: abscissa.iter().map(|t| base + size * libm::sin(3.0 * t)).collect(),
        };
        let panel =
            |title: &str, unit: &str, curves: Vec<Curve>| Panel { title: title.into(), unit: unit.into(), curves };
        Figure {
            title: "spin_sweep, nominal".into(),
            abscissa_label: "time / s".into(),
            panels: vec![
                panel("Kinetic energy of the fuselage", "J", vec![curve("fuselage", 800.0, 1_060_915.0)]),
                panel("Kinetic energy of wheel 1", "J", vec![curve("wheel 1", 900.0, 88_406.5)]),
                panel(
                    "Energy change since the start",
                    "J",
                    vec![curve("fuselage", -40.0, 0.0), curve("wheel 1", 25.0, 0.0), curve("wheel 2", 15.0, 0.0)],
                ),
                panel("Relative error of the total energy", "", vec![curve("error", 3e-13, 0.0)]),
            ],
            abscissa,
        }
    }

    /// Law: both formats come out whole; where SPINDRIFT_PLOT_FOLDER is set, they are kept to be looked at.
    #[test]
    fn draws_svg_and_png() {
        let (svg, png) = (figure().svg().unwrap(), figure().png().unwrap());
        assert!(svg.starts_with("<svg") && svg.trim_end().ends_with("</svg>"));
        assert!(svg.contains("Kinetic energy of wheel 1"));
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

    #[test]
    fn other_formats_are_refused() {
        let refused = figure().save(Path::new("x.pdf")).unwrap_err();
        assert_eq!(refused.to_string(), "a plot is written as .svg or .png, and `x.pdf` is neither");
    }

    /// Law: the ticks of a variable that hardly moves differ from each other.
    #[test]
    fn a_small_change_of_a_large_value_is_legible() {
        let axis = Axis::of([1_060_915.0, 1_060_915.2].into_iter());
        assert_eq!(axis.base, 1_060_915.0);
        assert_ne!(axis.label(axis.map(1_060_915.05)), axis.label(axis.map(1_060_915.1)));
        assert_eq!(axis.description("J"), "J, from 1.060915000e6");
        let axis = Axis::of([0.0, 3e-13].into_iter());
        assert_eq!((axis.base, axis.power, axis.description("")), (0.0, -15, "10⁻¹⁵".to_owned()));
        assert_eq!(axis.label(axis.map(1e-13)), "100");
    }
}
