//! Figures as files, all drawn by the scripts of the report page: an HTML file contains them; a program that runs them
//! (the package `spindrift-figures`) registers its [`Draw`] and produces SVG.

use std::fmt::Write as _;
use std::io::{self, Read};
use std::path::{Path, PathBuf};
use std::sync::OnceLock;

use flate2::read::GzDecoder;
use serde_json::{Value, json};
use thiserror::Error;

use crate::campaign::Display;
use crate::report::figure::{Figure, FigureSection};
use crate::report::page::document::{ECHARTS, PageSection, document, script_of};
use crate::report::page::figure_json::json_of;
use crate::report::page::payload::Payload;
use crate::storage::atomic;
use crate::table::html::escaped;

/// Turns a JSON list of figures into one SVG each.
pub type Draw = fn(&str) -> Result<Vec<String>, String>;

static DRAW: OnceLock<Draw> = OnceLock::new();

/// Registers the SVG renderer of this process.
pub fn draw_by(draw: Draw) {
    let _ = DRAW.set(draw);
}

/// The scripts of a [`Draw`]: the chart library, which defines `echarts`, and ours, which define `svgText(figure,
/// echarts)`.
///
/// # Errors None: the library is embedded.
pub fn drawing_scripts() -> io::Result<[String; 2]> {
    let mut echarts = String::new();
    GzDecoder::new(ECHARTS).read_to_string(&mut echarts)?;
    Ok([echarts, script_of(&["numbers.js", "theme.js", "axes.js", "chart.js", "save.js"])])
}

#[derive(Debug, Error)]
pub enum FigureError {
    /// The file could not be written.
    #[error(transparent)]
    Io(#[from] io::Error),
    /// The extension is neither HTML nor SVG.
    #[error("a plot is written as .html or .svg, and `{0}` is neither")]
    Format(String),
    #[error("drawing failed: {0}")]
    Drawing(String),
}

/// Space between the figures of a file, and above them for the title, pixels.
const GAP: f64 = 24.0;
const TITLE: f64 = 44.0;
/// Figures side by side.
const ACROSS: usize = 2;

#[derive(Clone, Debug)]
pub struct FigureSheet {
    pub title: String,
    pub figures: Vec<Figure>,
}

/// Checks the extension of a plot.
///
/// # Errors [`FigureError::Format`].
pub fn check_format(path: &Path) -> Result<(), FigureError> {
    extension(path).map(|_| ())
}

/// `html` or `svg`.
fn extension(path: &Path) -> Result<&'static str, FigureError> {
    let found = path.extension().and_then(|found| found.to_str()).map(str::to_ascii_lowercase);
    let known = ["html", "svg"].into_iter().find(|known| found.as_deref() == Some(known));
    known.ok_or_else(|| FigureError::Format(path.display().to_string()))
}

/// Reports the page written in place of an SVG.
pub fn instead(written: &Path) -> String {
    format!(
        "{}: a page with the figures, since this build draws no SVG; its buttons save each as SVG, PNG or CSV, and \
         `cargo run --release -p spindrift-figures -- ...` draws SVG files",
        written.display()
    )
}

impl FigureSheet {
    #[must_use]
    pub fn in_units(self, display: &Display) -> Self {
        FigureSheet { figures: self.figures.into_iter().map(|figure| figure.in_units(display)).collect(), ..self }
    }

    /// Writes the figures atomically in the format of the extension; without a [`Draw`], SVG becomes HTML. Returns the
    /// path written.
    ///
    /// # Errors [`FigureError`].
    pub fn save(&self, path: &Path) -> Result<PathBuf, FigureError> {
        match (extension(path)?, DRAW.get()) {
            ("svg", Some(draw)) => {
                atomic::write_bytes(path, self.svg(*draw)?.as_bytes())?;
                Ok(path.to_owned())
            }
            _ => {
                let path = path.with_extension("html");
                atomic::write_bytes(&path, self.html().as_bytes())?;
                Ok(path)
            }
        }
    }

    /// Writes each figure to an SVG named after it in `folder`; without a [`Draw`], all to `figures.html`. Returns the
    /// number of files and a remark.
    ///
    /// # Errors [`FigureError`].
    pub fn save_all(&self, folder: &Path) -> Result<(usize, Option<String>), FigureError> {
        atomic::make_folder(folder)?;
        let Some(draw) = DRAW.get() else {
            let path = self.save(&folder.join("figures.html"))?;
            return Ok((1, Some(instead(&path))));
        };
        for (figure, svg) in self.figures.iter().zip(self.drawn(*draw)?) {
            atomic::write_bytes(&folder.join(format!("{}.svg", figure.name)), svg.as_bytes())?;
        }
        Ok((self.figures.len(), None))
    }

    fn drawn(&self, draw: Draw) -> Result<Vec<String>, FigureError> {
        let mut numbers = Payload::inline();
        let list: Vec<Value> = self.figures.iter().map(|figure| json_of(figure, &mut numbers)).collect();
        draw(&Value::from(list).to_string()).map_err(FigureError::Drawing)
    }

    fn svg(&self, draw: Draw) -> Result<String, FigureError> {
        let mut drawn = self.drawn(draw)?;
        if self.title.is_empty() && drawn.len() == 1 {
            return Ok(drawn.remove(0));
        }
        let size = |svg: &str| ["width", "height"].map(|side| side_of(svg, side));
        let width = drawn.iter().map(|svg| size(svg)[0]).fold(0.0, f64::max);
        let across = ACROSS.min(drawn.len());
        let (mut body, mut top) = (String::new(), TITLE);
        for row in drawn.chunks(across) {
            for (place, svg) in row.iter().enumerate() {
                let left = place as f64 * (width + GAP);
                body += &svg.replacen("<svg ", &format!("<svg x=\"{left}\" y=\"{top}\" "), 1);
            }
            top += GAP + row.iter().map(|svg| size(svg)[1]).fold(0.0, f64::max);
        }
        let all = across as f64 * (width + GAP) - GAP;
        let mut text = String::new();
        let _ = writeln!(
            text,
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{all}\" height=\"{top}\" viewBox=\"0 0 {all} {top}\">\
             <rect width=\"100%\" height=\"100%\" fill=\"#ffffff\"/><text x=\"14\" y=\"28\" font-family=\"sans-serif\" \
             font-size=\"18\">{}</text>{body}</svg>",
            escaped(&self.title)
        );
        Ok(text)
    }

    fn html(&self) -> String {
        let mut payload = Payload::default();
        let section = FigureSection::Time;
        let of_section = |figure: &Figure| Figure { section, columns: 6.max(figure.columns), ..figure.clone() };
        let drawn: Vec<Value> = self.figures.iter().map(|figure| json_of(&of_section(figure), &mut payload)).collect();
        let data = json!({ "name": self.title, "figures": drawn, "replay": null, "pairs": null });
        let section =
            PageSection { has_figures: true, ..PageSection::new(section.anchor(), "Figures", "", String::new()) };
        let first = format!("<h1>{}</h1>", escaped(&self.title));
        document(&self.title, (&first, None), &[section], &data, &payload.text())
    }
}

/// The attribute `name` of the first element of `svg`, pixels; zero without one.
fn side_of(svg: &str, name: &str) -> f64 {
    let start = format!("{name}=\"");
    let found = svg.split_once(&start).and_then(|(_, rest)| rest.split_once('"'));
    found.and_then(|(number, _)| number.trim_end_matches("px").parse().ok()).unwrap_or(0.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::figure::{Axis, Dash, Hue, Mark};

    fn figure(name: &str) -> Figure {
        let curve = Mark::line("a", Hue::Body, Dash::Solid, vec![0.0, 1.0], vec![2.0, 3.0]);
        let figure = Figure::new("Rate", Axis::linear("time", "s"), Axis::linear("rate", "rad/s"), vec![curve]);
        Figure { name: name.to_owned(), caption: "What it means.".to_owned(), ..figure }
    }

    /// Law: figures reach the scripts with their numbers; drawings on a sheet do not overlap.
    #[test]
    fn drawings_of_a_sheet_are_apart() {
        let draw: Draw = |text| {
            let list: Vec<Value> = serde_json::from_str(text).map_err(|error| error.to_string())?;
            assert_eq!(list[0]["marks"][0]["y"], json!([2.0, 3.0]));
            Ok(list.iter().map(|one| format!("<svg width=\"700\" height=\"300\">{}</svg>", one["name"])).collect())
        };
        let sheet = |count: usize| FigureSheet {
            title: "a < b".to_owned(),
            figures: (0..count).map(|index| figure(&format!("f{index}"))).collect(),
        };
        let svg = sheet(3).svg(draw).expect("drawn");
        assert!(svg.starts_with("<svg xmlns") && svg.contains("a &lt; b"), "{svg}");
        for place in ["x=\"0\" y=\"44\"", "x=\"724\" y=\"44\"", "x=\"0\" y=\"368\""] {
            assert!(svg.contains(place), "{place} in {svg}");
        }
        assert!(svg.contains("width=\"1424\" height=\"692\""), "{svg}");
        let alone = FigureSheet { title: String::new(), ..sheet(1) };
        assert_eq!(alone.svg(draw).expect("drawn"), "<svg width=\"700\" height=\"300\">\"f0\"</svg>");
    }
}
