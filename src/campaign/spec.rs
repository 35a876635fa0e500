//! [`Spec`]: a campaign file as written, key by key.
//!
//! Every key of the file is read here (those of `[[disperse]]` in [`super::disperse`]); a number that is missing or wrong is
//! NaN here and noted in the document. What is left out stays `None`: the plan fills it in.

use super::analysis::Analysis;
use super::chosen::Chosen;
use super::columns::{KnownColumns, request};
use super::compression::Compression;
use super::document::Document;
use super::limits::{FRACTION, LARGEST_SEED, MAX_POINTS, MAX_SAMPLES, TOLERANCE};
use super::numbers::POSITIVE;
use super::retention::Retention;
use super::section::Section;
use super::size::MOST_TABLES;
use super::{bands, dependence, description, design, disperse, scene};
use crate::math::vector::norm;
use crate::observables::Group;
use crate::observables::request::NutationAxis;
use crate::propagation::Method;
use crate::sampling::{Correlation, Derivation, Design, Dispersion};
use crate::scene::SceneInput;
use toml::de::DeTable;

/// A campaign file as written.
#[derive(Clone, Debug, PartialEq)]
pub struct Spec {
    /// `campaign.name`: also the name of the folder of results.
    pub name: Option<String>,
    /// `campaign.description`.
    pub description: Option<String>,
    /// `campaign.samples`.
    pub samples: Option<u64>,
    /// `campaign.only`.
    pub chosen: Option<Chosen>,
    /// `campaign.seed`.
    pub seed: Option<u64>,
    /// `campaign.duration_s`, s.
    pub duration_s: Option<f64>,
    /// `integrator.method`.
    pub method: Option<Method>,
    /// `integrator.tolerance`: both of the following.
    pub tolerance: Option<f64>,
    /// `integrator.relative_tolerance`.
    pub relative_tolerance: Option<f64>,
    /// `integrator.absolute_tolerance`.
    pub absolute_tolerance: Option<f64>,
    /// `integrator.step_s`, s, of a method with a fixed step.
    pub step_s: Option<f64>,
    /// `integrator.max_steps`.
    pub max_steps: Option<u64>,
    /// `observe.points`.
    pub points: Option<u64>,
    /// `observe.groups`.
    pub groups: Option<Vec<Group>>,
    /// `observe.nutation_axis`.
    pub nutation_axis: NutationAxis,
    /// The scene; NaN where a number is missing or wrong.
    pub scene: SceneInput,
    /// `[design]`; `None` where it is wrong.
    pub design: Option<Design>,
    /// `[[disperse]]`; `None` where a table is wrong.
    pub dispersions: Vec<Option<Dispersion>>,
    /// `[[correlate]]`; `None` where a table is wrong.
    pub correlations: Vec<Option<Correlation>>,
    /// `[[derive]]`; `None` where a table is wrong.
    pub derivations: Vec<Option<Derivation>>,
    /// `audit.fraction`.
    pub audit_fraction: Option<f64>,
    /// `bands.points`.
    pub band_points: Option<u64>,
    /// `output.compression`.
    pub compression: Option<Compression>,
    /// What is made of the rows; without the tables that are wrong.
    pub analysis: Analysis,
    /// `retain.trajectories`.
    pub retention: Option<Retention>,
}

impl Spec {
    /// Reads the parsed text of a document; what is wrong is noted there.
    pub fn read<'a>(document: &mut Document<'a>, table: &DeTable<'a>) -> Spec {
        let mut root = Section::root(document, table);
        if !root.has("campaign") {
            let content = "a table with name, samples, seed, duration_s";
            root.document.add("campaign", None, content, "add a [campaign] table");
        }

        let scene = scene::read(&mut root);
        root.document.scene = scene.clone();
        let design = design::read(&mut root.section("design"));
        let has_size = design.as_ref().is_none_or(Design::has_size);

        let mut section = root.section("campaign");
        let name = name(&mut section);
        let description = description::read(&mut section);
        if !has_size {
            section.require("samples", "a whole number of at least 1", "1000");
        }
        let samples = section.count("samples", 1..=MAX_SAMPLES);
        let chosen = Chosen::read(&mut section);
        section.require("seed", "a whole number of at least 0", "1");
        let seed = section.count("seed", 0..=LARGEST_SEED);
        section.require("duration_s", POSITIVE.allowed, "10.0");
        let duration_s = section.number("duration_s", POSITIVE);
        section.finish();

        let mut section = root.section("integrator");
        let method = section.name("method", &Method::ALL.map(Method::name), Method::from_name);
        let tolerance = section.number("tolerance", TOLERANCE);
        let relative_tolerance = section.number("relative_tolerance", TOLERANCE);
        let absolute_tolerance = section.number("absolute_tolerance", TOLERANCE);
        let step_s = section.number("step_s", POSITIVE);
        let max_steps = section.count("max_steps", 1..=LARGEST_SEED);
        section.finish();

        let mut section = root.section("observe");
        let points = section.count("points", 2..=MAX_POINTS);
        let groups = section.names("groups", &Group::ALL.map(Group::name), Group::from_name, &default_groups());
        let nutation_axis = nutation_axis(&mut section);
        section.finish();

        let dispersions = root.sections("disperse", MOST_TABLES, disperse::read);
        let correlations = root.sections("correlate", MOST_TABLES, dependence::correlation);
        let derivations = root.sections("derive", MOST_TABLES, dependence::derivation);

        let band_points = bands::read(&mut root.section("bands"));

        let mut section = root.section("audit");
        let audit_fraction = section.number("fraction", FRACTION);
        section.finish();

        let mut section = root.section("output");
        let names = Compression::ALL.map(Compression::name);
        let compression = section.name("compression", &names, Compression::from_name);
        section.finish();

        let noted = root.document.noted();
        let observed = request(
            groups.as_deref().unwrap_or(&Group::DEFAULT),
            &scene,
            method.unwrap_or(Method::Auto),
            root.document.law.as_ref(),
        );
        let analysis = Analysis::read(&mut root, observed);
        let mut known = KnownColumns::new(observed);
        analysis.derived.iter().for_each(|derived| known.add(derived.quantity()));
        let retention = Retention::read(&mut root.section("retain"), &known);
        if root.document.is_loop_unknown {
            // which columns there are depends on the loop
            root.document.forget_since(noted);
        }
        root.finish();

        Spec {
            name,
            description,
            samples,
            chosen,
            seed,
            duration_s,
            method,
            tolerance,
            relative_tolerance,
            absolute_tolerance,
            step_s,
            max_steps,
            points,
            groups,
            nutation_axis,
            scene,
            design,
            dispersions,
            correlations,
            derivations,
            audit_fraction,
            band_points,
            compression,
            analysis,
            retention,
        }
    }
}

/// The axis of nutation: "s3", "principal", or a direction in F_s.
fn nutation_axis(section: &mut Section<'_, '_>) -> NutationAxis {
    const KEY: &str = "nutation_axis";
    if section.plain_text(KEY).is_some() {
        let parse = |text: &str| NUTATION_AXES.iter().find(|(name, _)| *name == text).map(|(_, axis)| *axis);
        return section.name(KEY, &NUTATION_AXES.map(|(name, _)| name), parse).unwrap_or_default();
    }
    let Some(direction) = section.direction(KEY) else { return NutationAxis::default() };
    let length = norm(direction);
    if !(length > 0.0 && length.is_finite()) {
        if direction.iter().all(|x| x.is_finite()) {
            section.refuse(KEY, "\"s3\", \"principal\" or a direction in F_s", "write it like [0.0, 0.0, 1.0]");
        }
        return NutationAxis::default();
    }
    // a unit vector stays as it is, bit for bit
    let is_unit = (length - 1.0).abs() <= 4.0 * f64::EPSILON;
    NutationAxis::Along(if is_unit { direction } else { direction.map(|x| x / length) })
}

/// The axes of nutation that have names.
pub(super) const NUTATION_AXES: [(&str, NutationAxis); 2] =
    [("s3", NutationAxis::SpinAxis), ("principal", NutationAxis::Principal)];

/// The groups of a campaign that names none, in words.
fn default_groups() -> String {
    let others = Group::ALL.into_iter().filter(|group| !Group::DEFAULT.contains(group));
    format!("all of them but {}", others.map(Group::name).collect::<Vec<_>>().join(" and "))
}

/// A name that is a folder's name on every system.
fn name(section: &mut Section<'_, '_>) -> Option<String> {
    const ALLOWED: &str = "1 to 100 letters, digits, _, - or . (the first one a letter, a digit or _)";
    section.require("name", ALLOWED, "\"my_campaign\"");
    let name = section.text("name")?;
    let plain = name.chars().all(|c| c.is_ascii_alphanumeric() || "_-.".contains(c));
    if !plain || name.starts_with(['.', '-']) || name.is_empty() || name.len() > 100 {
        section.refuse(
            "name",
            ALLOWED,
            "it names the folder of results, and is a word of commands: write it without spaces and slashes",
        );
        return None;
    }
    Some(name.to_owned())
}
