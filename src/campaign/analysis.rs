//! [`Analysis`]: what is made of the rows: `[statistics]`, `[summary]`, `[[observable]]`, `[[require]]`, `[stop]`, `[display]`. No row depends on it.

use super::columns::KnownColumns;
use super::derived_observable::DerivedObservable;
use super::display::Display;
use super::document::Document;
use super::limits::{CONFIDENCE, MAX_SAMPLES};
use super::lines::Lines;
use super::requirement::{DEFAULT_CONFIDENCE, Requirement};
use super::section::Section;
use super::size::MOST_TABLES;
use super::stop::{Stop, When};
use crate::observables::Request;
use crate::observables::window::{MAX_WINDOWS, Window};
use crate::sampling::{Column, Design};

/// What is made of the rows of a campaign.
#[derive(Clone, Debug, PartialEq)]
pub struct Analysis {
    /// Which quantiles every observable has, ascending, each in (0, 1).
    pub quantiles: Vec<f64>,
    /// Confidence of every interval but those of requirements.
    pub confidence: f64,
    /// Observables that the screen and the tables of sensitivity have besides the usual ones.
    pub summary_columns: Vec<String>,
    /// Observables that follow from others.
    pub derived: Vec<DerivedObservable>,
    /// What the campaign must show.
    pub requirements: Vec<Requirement>,
    /// When it has enough samples; `None`: after `campaign.samples`.
    pub stop: Option<Stop>,
    /// In which units its numbers are shown.
    pub display: Display,
}

/// The quantiles of a file that does not name any.
pub const QUANTILES: [f64; 9] = [0.001, 0.01, 0.05, 0.25, 0.5, 0.75, 0.95, 0.99, 0.999];
/// Most quantiles.
const MOST_QUANTILES: usize = 100;

impl Default for Analysis {
    fn default() -> Self {
        Analysis {
            quantiles: QUANTILES.to_vec(),
            confidence: DEFAULT_CONFIDENCE,
            summary_columns: Vec::new(),
            derived: Vec::new(),
            requirements: Vec::new(),
            stop: None,
            display: Display::default(),
        }
    }
}

impl Analysis {
    /// Reads the tables; what is wrong is noted, and left out here. `of_rows` are the observables of the rows.
    pub(super) fn read(root: &mut Section<'_, '_>, of_rows: Request) -> Self {
        let rows = KnownColumns::new(of_rows);
        let mut known = rows.clone();
        let derived = root.sections("observable", MOST_TABLES, |table| {
            let found = DerivedObservable::read(table, &rows)?;
            if known.observable(&found.name).is_some() {
                table.refuse("name", "a name of its own", "delete one of the two [[observable]] tables");
                return None;
            }
            known.add(found.quantity());
            Some(found)
        });
        let mut section = root.section("statistics");
        let quantiles = quantiles(&mut section);
        let confidence = section.number("confidence", CONFIDENCE);
        section.finish();
        let mut section = root.section("summary");
        let summary_columns = columns(&mut section, &known);
        section.finish();
        let requirements = root.sections("require", MOST_TABLES, |table| Requirement::read(table, &known));
        let stop = Stop::read(&mut root.section("stop"), &known);
        let written = std::mem::take(&mut root.document.units);
        let display = Display::read(&mut root.section("display"), &written, &known);
        let default = Analysis::default();
        Analysis {
            quantiles: quantiles.unwrap_or(default.quantiles),
            confidence: confidence.unwrap_or(default.confidence),
            summary_columns: summary_columns.unwrap_or_default(),
            derived: derived.into_iter().flatten().collect(),
            requirements: requirements.into_iter().flatten().collect(),
            stop,
            display,
        }
    }

    /// Checks what needs other tables: the rows have the `dispersed` columns, and `samples` samples of `design`.
    pub(super) fn check(
        &self,
        document: &mut Document<'_>,
        known: &KnownColumns,
        dispersed: &[Column],
        samples: u64,
        design: &Design,
        [times, band_times]: [&[f64]; 2],
    ) {
        if self.windows().count() > MAX_WINDOWS {
            let allowed = format!("with at most {MAX_WINDOWS} different extremes, each a column of the rows");
            let path = format!("require[{}].at_all_times", self.requirements.len() - 1);
            document.add(&path, Some("true".to_owned()), allowed, "delete some of them");
        }
        for (index, requirement) in self.requirements.iter().enumerate() {
            let Some(band) = requirement.band() else { continue };
            let (times, what, key) = match requirement.window() {
                Some(_) => (times, "the grid", "observe.points"),
                None => (band_times, "the bands", "bands.points"),
            };
            if times.is_empty() {
                let allowed = "left out where there are no bands: bands.points is 0";
                let path = format!("require[{index}].band");
                document.add(&path, Some(format!("{:?}", band.series)), allowed.to_owned(), "delete bands.points");
            } else if !times.iter().any(|time| band.contains(*time)) {
                let (end_key, end) = band.from_s.map_or(("to_s", band.to_s), |from| ("from_s", Some(from)));
                let last = times.last().copied().unwrap_or_default();
                let count = times.len();
                let allowed =
                    format!("part of an interval with a point of {what}: there are {count} from 0 s to {last} s");
                let path = format!("require[{index}].{end_key}");
                let remedy = format!("write a wider interval, or more {key}");
                document.add(&path, end.map(|end| end.to_string()), allowed, remedy);
            }
        }
        let scene = document.scene.clone();
        for (index, derived) in self.derived.iter().enumerate() {
            if let Some((parameter, component)) = derived.undispersed(&scene, known, dispersed) {
                let value = Some(format!("{:?}", parameter.component_name(component)));
                let allowed = "made of columns of the rows and of dispersed parameters";
                let remedy = "disperse it, or write its number";
                document.add(&format!("observable[{index}].expression"), value, allowed, remedy);
            }
        }
        let Some(stop) = &self.stop else { return };
        if *design != Design::DEFAULT {
            let allowed = format!(
                "left out with design {:?}: its samples are not independent, and looks at fewer of them mean nothing",
                design.name()
            );
            document.add("stop", Some("[stop]".to_owned()), allowed, "delete it, or use design \"random\"");
        } else if stop.max_samples < samples {
            let allowed = format!("a whole number from campaign.samples ({samples}) to {MAX_SAMPLES}");
            let remedy = "write at least the samples of the first look";
            document.add("stop.max_samples", Some(stop.max_samples.to_string()), allowed, remedy);
        } else if stop.when == When::Decided && self.requirements.is_empty() {
            let allowed = "\"precise\" where there is no [[require]] table to decide";
            document.add("stop.when", Some("\"decided\"".to_owned()), allowed, "write a [[require]] table");
        }
    }

    /// The extremes over time that the rows have for requirements, each once.
    pub fn windows(&self) -> impl Iterator<Item = Window> {
        let of = |index: usize| self.requirements[index].window();
        let is_first = move |index: &usize| (0..*index).all(|other| of(other) != of(*index));
        (0..self.requirements.len()).filter(is_first).filter_map(of)
    }

    /// Writes the tables.
    pub(super) fn write(&self, lines: &mut Lines) {
        self.derived.iter().for_each(|derived| derived.write(lines));
        lines.table("[statistics]");
        lines.key("quantiles", &self.quantiles);
        lines.key("confidence", self.confidence);
        if !self.summary_columns.is_empty() {
            lines.table("[summary]");
            lines.key("columns", &self.summary_columns);
        }
        self.requirements.iter().for_each(|requirement| requirement.write(lines));
        if let Some(stop) = &self.stop {
            stop.write(lines);
        }
        self.display.write(lines);
    }
}

fn quantiles(section: &mut Section<'_, '_>) -> Option<Vec<f64>> {
    let list = section.numbers("quantiles", "1")?;
    let is_ascending = list.windows(2).all(|pair| pair[0] < pair[1]);
    let is_inside = list.iter().all(|p| *p > 0.0 && *p < 1.0);
    if list.is_empty() || list.len() > MOST_QUANTILES || !is_ascending || !is_inside {
        let allowed = format!("1 to {MOST_QUANTILES} numbers between 0 and 1, neither included, in ascending order");
        section.refuse("quantiles", allowed, "write it like [0.05, 0.5, 0.95]");
        return None;
    }
    Some(list)
}

fn columns(section: &mut Section<'_, '_>, known: &KnownColumns) -> Option<Vec<String>> {
    let example = "[\"energy_error_max\"]";
    let names = section.texts("columns", example)?;
    for (index, name) in names.iter().enumerate() {
        if known.observable(name).is_none() {
            let (allowed, remedy) = known.refusal(name);
            section.refuse_value("columns", format!("{name:?}"), format!("made of names, each {allowed}"), remedy);
            return None;
        }
        if names[..index].contains(name) {
            section.refuse("columns", "different names", format!("delete the second {name:?}"));
            return None;
        }
    }
    Some(names)
}
