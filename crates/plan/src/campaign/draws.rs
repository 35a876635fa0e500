//! `[design]`, `[[disperse]]`, `[[correlate]]` and `[[derive]]`, read (`None` after a problem) and as canonical text.
//! Designs and distributions declare their keys ([`crate::sampling::design`], [`crate::sampling::distribution`]).

use super::lines::Lines;
use super::numbers::MAX_SAMPLES;
use super::parameter::{PARAMETER, name_of};
use super::section::Section;
use super::units;
use crate::sampling::design::replicates::REPLICATES;
use crate::sampling::keys::{ALL_BUT_ONE, ANY_TEXT, Kind, Row, Rule};
use crate::sampling::{Correlation, Derivation, Design, Dispersion, DistributionKind, Measure};
use crate::scene::Parameter;

pub const CORRELATE: [Row; 5] = [
    Row::new("parameters", Kind::Parameters, "The dispersed parameters that depend on each other")
        .required_as("an array of texts", "[\"wheels.w1.radius_m\", \"wheels.w1.length_m\"]"),
    Row::new("correlation", Kind::Correlations, "Correlation of their normal scores"),
    Row::new("rank_correlation", Kind::Correlations, "Rank correlation"),
    Row::new("covariance", Kind::Correlations, "Covariance of normal distributions"),
    Row::new("nearest_psd", Kind::Flag, "Whether to take the nearest matrix of correlations; default: false").sparse(),
];

const MEASURE: Rule = Rule::One(&[&["correlation"], &["rank_correlation"], &["covariance"]], "0.5", ALL_BUT_ONE);

pub const DERIVE: [Row; 2] = [
    PARAMETER,
    Row::new("expression", Kind::Text(ANY_TEXT), "Arithmetic over other parameters")
        .required_as("arithmetic over other parameters", "\"wheels.w1.density_kg_m3\""),
];

pub fn correlation(table: &mut Section<'_, '_>) -> Option<Correlation> {
    let written = table.whole(&CORRELATE, &[MEASURE])?;
    let numbers = |measure: Measure| Some((measure, written.values(measure.key())?.clone()));
    let (measure, numbers) = Measure::ALL.into_iter().find_map(numbers)?;
    let find = |name: &String| Parameter::find(&table.document.scene, name);
    let parameters = written.texts("parameters").iter().map(find).collect::<Option<_>>()?;
    let nearest_psd = written.flag("nearest_psd");
    Some(Correlation {
        table: table.index,
        parameters,
        measure,
        numbers,
        nearest_psd,
        written: written.completed(&CORRELATE, &[]),
    })
}

pub fn derivation(table: &mut Section<'_, '_>) -> Option<Derivation> {
    let written = table.whole(&DERIVE, &[])?;
    let (parameter, component) = Parameter::find(&table.document.scene, written.text("parameter")?)?;
    Some(Derivation {
        table: table.index,
        parameter,
        component,
        expression: written.text("expression")?.to_owned(),
        written,
    })
}

pub fn design(table: &mut Section<'_, '_>) -> Option<Design> {
    if !table.is_present() {
        return Some(Design::DEFAULT);
    }
    let name = table.required_word("kind", Design::NAMES, "\"sobol\"")?;
    let (rows, rules) = Design::keys_of(name)?;
    let written = table.rows(rows, rules);
    let key = REPLICATES.key;
    let mut is_right = true;
    let stray = Row::new(key, Kind::Counts(MAX_SAMPLES), REPLICATES.meaning);
    if table.has(key) && !rows.iter().any(|row| row.key == key) && table.right_rows(&[stray]).has(key) {
        let allowed = format!(
            "left out with design {name:?}: designs with replicates are {}",
            Design::names_with(key).join(", ")
        );
        table.refuse(key, allowed, "delete it, or choose one of these designs");
        is_right = false;
    }
    table.finish();
    // one replicate is the default
    let written = Some(written?).filter(|written| written.count(key) != Some(1)).unwrap_or_default();
    Design::of(name, written).filter(|_| is_right)
}

pub fn dispersion(table: &mut Section<'_, '_>) -> Option<Dispersion> {
    let kind = table.plain_text("distribution").and_then(DistributionKind::from_name);
    if kind.is_some_and(DistributionKind::names_parameters) {
        table.describes(None, units::UNKNOWN);
        let distribution = table.distribution()?;
        let (parameter, component) = distribution.written.columns().first()?.target?;
        return Some(Dispersion { table: table.index, parameter, component: Some(component), distribution });
    }
    let written = table.right_rows(&[PARAMETER]);
    let target = written.text("parameter").and_then(|name| Parameter::find(&table.document.scene, name));
    // a wrong name is reported; any unit is accepted then
    match target {
        Some((parameter, _)) => table.describes(parameter.name(), parameter.unit()),
        None => table.describes(None, units::UNKNOWN),
    }
    let distribution = table.distribution();
    let ((parameter, component), distribution) = target.zip(distribution)?;
    Some(Dispersion { table: table.index, parameter, component, distribution })
}

pub(super) fn dispersion_lines(dispersion: &Dispersion, lines: &mut Lines) {
    lines.table("[[disperse]]");
    if !dispersion.distribution.kind.names_parameters() {
        lines.key("parameter", name_of((dispersion.parameter, dispersion.component)));
    }
    lines.key("distribution", dispersion.distribution.kind.name());
    lines.written("disperse", &dispersion.distribution.written);
}

pub(super) fn design_lines(design: &Design, lines: &mut Lines) {
    if *design != Design::DEFAULT {
        lines.table("[design]");
        lines.key("kind", design.name());
        lines.written("design", design.written());
    }
}
