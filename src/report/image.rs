//! Figures as files: SVG, and PNG, which is this SVG rendered by `resvg`.

use std::io;
use std::path::Path;

use resvg::tiny_skia::{Pixmap, Transform};
use resvg::usvg;
use thiserror::Error;

use crate::report::figure::Figure;
use crate::report::sheet::Sheet;
use crate::storage::atomic;

/// Pixels of SVG to an inch.
const SVG_DPI: f64 = 96.0;
const INCH: f64 = 25.4;

/// Why a plot could not be made.
#[derive(Debug, Error)]
pub enum PlotError {
    /// The file could not be written.
    #[error(transparent)]
    Io(#[from] io::Error),
    /// The extension is neither SVG nor PNG.
    #[error("a plot is written as .svg or .png, and `{0}` is neither")]
    Format(String),
    /// The picture could not be rendered.
    #[error("drawing failed: {0}")]
    Drawing(String),
}

/// The formats of a plot.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PlotFormat {
    Svg,
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

pub use super::svg::Letters;

/// How large a picture is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlotSize {
    /// Width and height, mm; those of the figure where they are not given.
    pub size_mm: Option<[f64; 2]>,
    /// Dots per inch of a PNG.
    pub dpi: f64,
    /// What letters of an SVG file are.
    pub letters: Letters,
}

impl Default for PlotSize {
    fn default() -> Self {
        PlotSize { size_mm: None, dpi: 2.0 * SVG_DPI, letters: Letters::Outlines }
    }
}

impl Sheet {
    /// Draws the figure to `path`, in the format of its extension; the file is whole or absent.
    ///
    /// # Errors
    /// [`PlotError`].
    pub fn save(&self, path: &Path, size: PlotSize) -> Result<(), PlotError> {
        let pixels = size.size_mm.map(|size| size.map(|side| side / INCH * SVG_DPI));
        let bytes = match PlotFormat::of(path)? {
            PlotFormat::Svg => self.svg_with(pixels, size.letters).into_bytes(),
            PlotFormat::Png => png(&self.svg(pixels), size.dpi)?,
        };
        Ok(atomic::write_bytes(path, &bytes)?)
    }
}

/// Writes every figure into `folder` as SVG and as PNG, each with its caption and what all are `of`: campaign and number of runs; returns the number of files.
///
/// # Errors
/// [`PlotError`].
pub fn save_all(figures: &[Figure], of: &str, folder: &Path, size: PlotSize) -> Result<usize, PlotError> {
    atomic::make_folder(folder)?;
    for figure in figures {
        let caption = format!("{} {of}", figure.caption.trim()).trim().to_owned();
        let sheet = Sheet::of(&Figure { caption, ..figure.clone() });
        for extension in ["svg", "png"] {
            sheet.save(&folder.join(format!("{}.{extension}", figure.name)), size)?;
        }
    }
    Ok(2 * figures.len())
}

/// The pixels of an SVG.
pub(super) fn pixels(svg: &str, dpi: f64) -> Result<Pixmap, PlotError> {
    let failed = |error: &dyn std::fmt::Display| PlotError::Drawing(error.to_string());
    let tree = usvg::Tree::from_str(svg, &usvg::Options::default()).map_err(|error| failed(&error))?;
    let scale = (dpi / SVG_DPI) as f32;
    let [width, height] = [tree.size().width(), tree.size().height()].map(|side| (side * scale).round().max(1.0));
    let too_large = || PlotError::Drawing(format!("{width} x {height} pixels are too many; a smaller --dpi has fewer"));
    let mut pixmap = Pixmap::new(width as u32, height as u32).ok_or_else(too_large)?;
    resvg::render(&tree, Transform::from_scale(scale, scale), &mut pixmap.as_mut());
    Ok(pixmap)
}

fn png(svg: &str, dpi: f64) -> Result<Vec<u8>, PlotError> {
    pixels(svg, dpi)?.encode_png().map_err(|error| PlotError::Drawing(error.to_string()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::figure::{Axis, Dash, Hue, Mark};

    /// Law: the pixels of a PNG are its size times the dots per inch, and both formats have the size that is asked for.
    #[test]
    fn pictures_have_the_size_that_is_asked_for() {
        let curve = Mark::line("a", Hue::Body, Dash::Solid, vec![0.0, 1.0], vec![2.0, 3.0]);
        let figure = Figure::new("Title", Axis::linear("x", "s"), Axis::linear("y", "J"), vec![curve]);
        let figure = Figure { name: "f".to_owned(), caption: "What it means.".to_owned(), ..figure };
        let folder = std::env::temp_dir().join(format!("spindrift-image-{}", std::process::id()));
        std::fs::create_dir_all(&folder).unwrap();
        for (size_mm, dpi) in [(Some([101.6, 50.8]), 96.0), (Some([101.6, 50.8]), 300.0), (Some([254.0, 76.2]), 100.0)]
        {
            let inches = size_mm.unwrap_or_default().map(|side| side / INCH);
            save_all(
                std::slice::from_ref(&figure),
                "small: 20 runs.",
                &folder,
                PlotSize { size_mm, dpi, ..PlotSize::default() },
            )
            .unwrap();
            let pixmap = Pixmap::load_png(folder.join("f.png")).unwrap();
            assert_eq!([pixmap.width(), pixmap.height()], inches.map(|side| (side * dpi).round() as u32));
            let svg = std::fs::read_to_string(folder.join("f.svg")).unwrap();
            let [width, height] = inches.map(|side| (side * SVG_DPI).round());
            // title, caption and number of runs are texts of the picture
            for text in ["Title", "What it means.", "small: 20 runs."] {
                assert!(svg.contains(text), "{text} in {svg}");
            }
            assert!(svg.contains(&format!(" width=\"{width}\" height=\"{height}\" viewBox")));
            assert!(!svg.contains("<text"), "{svg}");
        }
        // the same as text: the PNG does not change
        let png = std::fs::read(folder.join("f.png")).unwrap();
        let size = PlotSize { size_mm: Some([254.0, 76.2]), dpi: 100.0, letters: Letters::Text };
        save_all(std::slice::from_ref(&figure), "small: 20 runs.", &folder, size).unwrap();
        let svg = std::fs::read_to_string(folder.join("f.svg")).unwrap();
        for text in [">Title</text>", ">What it means. small: 20 runs.</text>", ">x / s</text>", ">y / J</text>"] {
            assert!(svg.contains(text), "{text} in {svg}");
        }
        assert!(!svg.contains("<use") && !svg.contains("<path"), "{svg}");
        assert_eq!(std::fs::read(folder.join("f.png")).unwrap(), png);
        std::fs::remove_dir_all(&folder).unwrap();
    }

    #[test]
    fn other_formats_are_refused() {
        let refused = PlotFormat::of(Path::new("x.pdf")).unwrap_err();
        assert_eq!(refused.to_string(), "a plot is written as .svg or .png, and `x.pdf` is neither");
    }
}
