//! [`Analysis`]: the evaluation of the rows: `[statistics]`, `[summary]`, `[[observable]]`, `[[require]]`, `[stop]`,
//! `[display]`. No row depends on it.

use super::derived_observable::DerivedObservable;
use super::display::Display;
use super::document::Document;
use super::known_columns::KnownColumns;
use super::numbers::{CONFIDENCE, MAX_SAMPLES};
use super::requirement::{DEFAULT_CONFIDENCE, Requirement};
use super::section::Section;
use super::size::MOST_TABLES;
use super::stop::{Stop, When};
use crate::observables::Request;
use crate::observables::window::{MAX_WINDOWS, Window};
use crate::sampling::keys::{Kind, ListLimit, Presence, Row};
use crate::sampling::{Column, Design};

#[derive(Clone, Debug, PartialEq)]
pub struct Analysis {
    /// Quantiles of every observable, ascending, each in (0, 1).
    pub quantiles: Vec<f64>,
    /// Confidence of all intervals except those of requirements.
    pub confidence: f64,
    /// Observables on the screen and in the tables of sensitivity besides the usual ones.
    pub summary_columns: Vec<String>,
    pub derived: Vec<DerivedObservable>,
    pub requirements: Vec<Requirement>,
    /// `None`: after `campaign.samples`.
    pub stop: Option<Stop>,
    pub display: Display,
}

pub const QUANTILES: [f64; 9] = [0.001, 0.01, 0.05, 0.25, 0.5, 0.75, 0.95, 0.99, 0.999];

const QUANTILE_LIST: ListLimit = ListLimit {
    allowed: "1 to 100 numbers between 0 and 1, neither included, in ascending order",
    remedy: "write it like [0.05, 0.5, 0.95]",
    test: |list| {
        let is_ascending = list.windows(2).all(|pair| pair[0] < pair[1]);
        is_ascending && (1..=100).contains(&list.len()) && list.iter().all(|p| *p > 0.0 && *p < 1.0)
    },
};

pub const STATISTICS: [Row; 2] = [
    Row::new(
        "quantiles",
        Kind::Numbers(QUANTILE_LIST),
        "Quantiles to compute for every observable; default: 0.1, 1, 5, 25, 50, 75, 95, 99, 99.9%",
    ),
    Row::new("confidence", Kind::Number, "Confidence of every interval except those of requirements")
        .limited(CONFIDENCE)
        .or(Presence::Or(DEFAULT_CONFIDENCE)),
];

pub const SUMMARY: [Row; 1] = [Row::new(
    "columns",
    Kind::Observables,
    "Observables to show on the screen, in `summary.json` and in the sensitivity tables besides the usual ones",
)];

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
    /// Reads the tables and omits invalid ones. `of_rows`: the observables of the rows.
    pub(super) fn read(root: &mut Section<'_, '_>, of_rows: Request) -> Self {
        let mut known = KnownColumns::new(of_rows);
        root.document.known = Some(known.clone());
        let derived = root.sections("observable", MOST_TABLES, |table| {
            let found = DerivedObservable::read(table)?;
            if known.observable(&found.name).is_some() {
                return table.refused("name", "a name of its own", "delete one of the two [[observable]] tables");
            }
            known.add(found.quantity());
            Some(found)
        });
        // derived observables do not build on each other
        root.document.known = Some(known);
        let statistics = root.kept("[statistics]", &STATISTICS, |written| {
            if !written.has("quantiles") {
                written.set("quantiles", &QUANTILES[..]);
            }
        });
        let summary = root.kept("[summary]", &SUMMARY, |_| {});
        let requirements = root.sections("require", MOST_TABLES, Requirement::read);
        let stop = Stop::read(&mut root.section("stop"));
        let written = std::mem::take(&mut root.document.units);
        let display = Display::read(root, written);
        Analysis {
            quantiles: statistics.numbers("quantiles").unwrap_or_default().to_vec(),
            confidence: statistics.number("confidence").unwrap_or_default(),
            summary_columns: summary.texts("columns").to_vec(),
            derived: derived.into_iter().flatten().collect(),
            requirements: requirements.into_iter().flatten().collect(),
            stop,
            display,
        }
    }

    /// The requirements on the observable `name`.
    pub fn requirements_on(&self, name: &str) -> impl Iterator<Item = &Requirement> {
        self.requirements.iter().filter(move |one| one.observable() == Some(name))
    }

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

    /// The extremes over time that requirements add to the rows, each once.
    pub fn windows(&self) -> impl Iterator<Item = Window> {
        let of = |index: usize| self.requirements[index].window();
        let is_first = move |index: &usize| (0..*index).all(|other| of(other) != of(*index));
        (0..self.requirements.len()).filter(is_first).filter_map(of)
    }
}
