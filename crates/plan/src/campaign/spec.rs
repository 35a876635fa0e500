//! [`Spec`]: a campaign file as written. A missing or wrong number is NaN and noted in the document; the plan fills in
//! defaults.

use super::analysis::Analysis;
use super::columns::request;
use super::document::Document;
use super::event::Event;
use super::extreme::Extreme;
use super::loop_tables::LoopTables;
use super::retention::Retention;
use super::section::Section;
use super::size::MOST_TABLES;
use super::{draws, scene, settings};
use crate::observables::Group;
use crate::observables::request::NutationAxis;
use crate::propagation::Method;
use crate::sampling::keys::{Row, Value};
use crate::sampling::{Correlation, Derivation, Design, Dispersion, Written};
use crate::scene::SceneInput;
use toml::de::DeTable;

#[derive(Clone, Debug, PartialEq)]
pub struct Spec {
    /// The valid keys of each table of [`settings::HEAD`] and [`settings::TAIL`].
    settings: Vec<(&'static str, Written)>,
    /// NaN for missing and wrong numbers.
    pub scene: SceneInput,
    /// `None` if wrong.
    pub design: Option<Design>,
    /// The valid tables, also below.
    pub dispersions: Vec<Dispersion>,
    pub correlations: Vec<Correlation>,
    pub derivations: Vec<Derivation>,
    pub events: Vec<Event>,
    pub extremes: Vec<Extreme>,
    pub analysis: Analysis,
    pub retention: Option<Retention>,
}

impl Spec {
    /// Reads a parsed document, which notes the problems.
    pub fn read<'a>(document: &mut Document<'a>, table: &DeTable<'a>, loops: &dyn LoopTables) -> Spec {
        let mut root = Section::root(document, table);
        if !root.has("campaign") {
            let content = "a table with name, samples, seed, duration_s";
            root.document.add("campaign", None, content, "add a [campaign] table");
        }

        let scene = scene::read(&mut root, loops);
        root.document.scene = scene.clone();
        let design = draws::design(&mut root.section("design"));
        let has_size = design.as_ref().is_none_or(Design::has_size);

        let mut settings = Vec::new();
        let mut read = |root: &mut Section<'_, '_>, tables: &[(&'static str, &[Row])]| {
            for (header, rows) in tables {
                let mut section = root.section(header);
                if *header == "campaign" && !has_size {
                    section.require("samples", "a whole number of at least 1", "1000");
                }
                settings.push((*header, section.right_rows(rows)));
                section.finish();
            }
        };
        read(&mut root, &settings::HEAD);
        let dispersions = root.sections("disperse", MOST_TABLES, draws::dispersion).into_iter().flatten().collect();
        let correlations = root.sections("correlate", MOST_TABLES, draws::correlation).into_iter().flatten().collect();
        let derivations = root.sections("derive", MOST_TABLES, draws::derivation).into_iter().flatten().collect();

        read(&mut root, &settings::TAIL);
        let mut spec = Spec {
            settings,
            scene,
            design,
            dispersions,
            correlations,
            derivations,
            events: Vec::new(),
            extremes: Vec::new(),
            analysis: Analysis::default(),
            retention: None,
        };

        let noted = root.document.noted();
        let method = spec.method().unwrap_or(Method::Auto);
        let law = root.document.law.clone();
        let with = |events: &[Event], extremes: &[Extreme]| {
            request(&spec.groups(), &spec.scene, method, law.as_ref(), (events, extremes))
        };
        let events = Event::read_all(&mut root, &with(&[], &[]));
        let extremes = Extreme::read_all(&mut root, &with(&events, &[]), &events);
        let observed = with(&events, &extremes);
        (spec.events, spec.extremes) = (events, extremes);
        spec.analysis = Analysis::read(&mut root, observed);
        spec.retention = Retention::read(&mut root.section("retain"));
        if root.document.is_loop_unknown {
            // columns depend on the loop
            root.document.forget_since(noted);
        }
        root.finish();
        spec
    }

    pub fn settings(&self, header: &str) -> &Written {
        static NONE: Written = Written::NONE;
        self.settings.iter().find(|(known, _)| *known == header).map_or(&NONE, |(_, written)| written)
    }

    /// Overrides a setting of the file.
    pub(super) fn set(&mut self, header: &str, key: &'static str, value: impl Into<Value>) {
        if let Some((_, written)) = self.settings.iter_mut().find(|(known, _)| *known == header) {
            written.set(key, value);
        }
    }

    /// `integrator.method`; `None` if wrong.
    pub fn method(&self) -> Option<Method> {
        self.settings("integrator").text("method").and_then(Method::from_name)
    }

    /// `observe.groups` or the default, in the order of the columns.
    pub fn groups(&self) -> Vec<Group> {
        match self.settings("observe").texts("groups") {
            [] => Group::DEFAULT.to_vec(),
            names => Group::ALL.into_iter().filter(|group| names.iter().any(|name| name == group.name())).collect(),
        }
    }

    pub fn nutation_axis(&self) -> NutationAxis {
        let written = self.settings("observe");
        match (written.text("nutation_axis"), written.vector("nutation_axis")) {
            (Some("principal"), _) => NutationAxis::Principal,
            (_, Some(axis)) => NutationAxis::Along(axis),
            _ => NutationAxis::SpinAxis,
        }
    }
}
