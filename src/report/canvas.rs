//! [`Canvas`]: figures as SVG or PNG files.
//!
//! The font is the one in `assets/` (a subset of DejaVu Sans, licence beside it): a plot needs nothing from the system, and
//! its text has the same size everywhere. The bitmap is drawn at twice its size and averaged, since lines are not smoothed.
//! PNG is encoded by the `png` crate (the encoder of plotters needs a whole image library).

use std::io;
use std::path::Path;
use std::sync::OnceLock;

use plotters::coord::Shift;
use plotters::prelude::*;
use plotters::style::{FontStyle, register_font};
use thiserror::Error;

use crate::report::bitmap::Bitmap;
use crate::storage::atomic;

static FONT: &[u8] = include_bytes!("../../assets/DejaVuSans-subset.ttf");

/// Colours that colour-blind readers can tell apart (Okabe & Ito 2008).
pub(super) const COLORS: [RGBColor; 6] = [
    RGBColor(0, 114, 178),
    RGBColor(213, 94, 0),
    RGBColor(0, 158, 115),
    RGBColor(204, 121, 167),
    RGBColor(86, 180, 233),
    RGBColor(0, 0, 0),
];

/// The bitmap is drawn this much larger and averaged.
const OVERSAMPLING: u32 = 2;

/// Why a plot could not be made.
#[derive(Debug, Error)]
pub enum PlotError {
    /// The file could not be written.
    #[error(transparent)]
    Io(#[from] io::Error),
    /// The extension is neither SVG nor PNG.
    #[error("a plot is written as .svg or .png, and `{0}` is neither")]
    Format(String),
    /// The plotting library reported an error.
    #[error("drawing failed: {0}")]
    Drawing(String),
}

/// The formats of a plot.
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

/// A figure that can be drawn.
pub trait Canvas {
    /// Width and height, pixels.
    fn size(&self) -> (u32, u32);

    /// Draws everything on `area`, which is white and `scale` times as large as [`Canvas::size`].
    ///
    /// # Errors
    /// [`PlotError::Drawing`].
    fn draw<B: DrawingBackend>(&self, area: &DrawingArea<B, Shift>, scale: u32) -> Result<(), PlotError>;

    /// Draws the figure to `path`, in the format of its extension; the file is whole or absent.
    ///
    /// # Errors
    /// [`PlotError`].
    fn save(&self, path: &Path) -> Result<(), PlotError> {
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
    fn svg(&self) -> Result<String, PlotError> {
        install_font()?;
        let mut text = String::new();
        let area = SVGBackend::with_string(&mut text, self.size()).into_drawing_area();
        area.fill(&WHITE).map_err(drawing)?;
        self.draw(&area, 1)?;
        area.present().map_err(drawing)?;
        drop(area);
        Ok(text)
    }

    /// The figure as RGB pixels, row by row.
    ///
    /// # Errors
    /// [`PlotError::Drawing`].
    fn pixels(&self) -> Result<Vec<u8>, PlotError> {
        install_font()?;
        let (width, height) = self.size();
        let mut pixels = Vec::new();
        let area = Bitmap::new(&mut pixels, width * OVERSAMPLING, height * OVERSAMPLING).into_drawing_area();
        self.draw(&area, OVERSAMPLING)?;
        area.present().map_err(drawing)?;
        drop(area);
        Ok(averaged(&pixels, width as usize, height as usize))
    }

    /// The figure as an encoded PNG.
    ///
    /// # Errors
    /// [`PlotError::Drawing`].
    fn png(&self) -> Result<Vec<u8>, PlotError> {
        let (width, height) = self.size();
        encode(&self.pixels()?, width, height)
    }
}

/// Makes the built-in font known to the plotting library.
pub(super) fn install_font() -> Result<(), PlotError> {
    static INSTALLED: OnceLock<bool> = OnceLock::new();
    let installed = INSTALLED.get_or_init(|| register_font("sans-serif", FontStyle::Normal, FONT).is_ok());
    if *installed { Ok(()) } else { Err(PlotError::Drawing("the built-in font cannot be read".to_owned())) }
}

/// The plotting library's error as ours.
pub(super) fn drawing<E: std::error::Error + Send + Sync>(error: DrawingAreaErrorKind<E>) -> PlotError {
    PlotError::Drawing(error.to_string())
}

/// Averages squares of [`OVERSAMPLING`] pixels; `width` and `height` are those of the result.
fn averaged(pixels: &[u8], width: usize, height: usize) -> Vec<u8> {
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

fn encode(pixels: &[u8], width: u32, height: u32) -> Result<Vec<u8>, PlotError> {
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
