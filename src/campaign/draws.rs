//! `[design]`, `[[disperse]]`, `[[correlate]]` and `[[derive]]`, read and as canonical text. Designs and distributions
//! declare their keys ([`crate::sampling::design`], [`crate::sampling::distribution`]).

use super::lines::Lines;
use super::numbers::MAX_SAMPLES;
use super::parameter::{PARAMETER, parameter, unknown_parameter};
use super::section::Section;
use super::units;
use crate::sampling::design::replicates::REPLICATES;
use crate::sampling::keys::{ALL_BUT_ONE, ANY_TEXT, Kind, Row, Rule};
use crate::sampling::{Correlation, Derivation, Design, Dispersion, DistributionKind, Measure, Numbers, Table};
use crate::scene::Parameter;

pub const CORRELATE: [Row; 5] = [
    Row::new("parameters", Kind::Names, "The dispersed parameters that depend on each other")
        .required_as("an array of texts", "[\"wheels.w1.radius_m\", \"wheels.w1.length_m\"]"),
    Row::new("correlation", Kind::Correlations, "Correlation of their normal scores"),
    Row::new("rank_correlation", Kind::Correlations, "Rank correlation"),
    Row::new("covariance", Kind::Correlations, "Covariance of normal distributions"),
    Row::new("nearest_psd", Kind::Flag, "Whether to take the nearest matrix of correlations; default: false"),
];

const MEASURE: Rule = Rule::One(&[&["correlation"], &["rank_correlation"], &["covariance"]], "0.5", ALL_BUT_ONE);

pub const DERIVE: [Row; 2] = [
    PARAMETER,
    Row::new("expression", Kind::Text(ANY_TEXT), "Arithmetic over other parameters")
        .required_as("arithmetic over other parameters", "\"wheels.w1.density_kg_m3\""),
];

/// Reads a `[[correlate]]` table; `None` after a problem.
pub fn correlation(table: &mut Section<'_, '_>) -> Option<Correlation> {
    table.right_rows(&CORRELATE[..1]);
    let names = table.texts("parameters", "[\"wheels.w1.radius_m\", \"wheels.w1.length_m\"]");
    let parameters = names.and_then(|names| {
        let mut parameters = Vec::with_capacity(names.len());
        for name in names {
            let Some(found) = Parameter::find(&table.document.scene, &name) else {
                if !table.document.may_be_of_loop(&name) {
                    let (allowed, remedy) = unknown_parameter(&table.document.scene, &name);
                    table.refuse_value(
                        "parameters",
                        format!("{name:?}"),
                        format!("made of names, each {allowed}"),
                        remedy,
                    );
                }
                return None;
            };
            parameters.push(found);
        }
        Some(parameters)
    });
    let is_one = table.obeys(&MEASURE, true);
    let mut numbers = Vec::new();
    for measure in Measure::ALL {
        numbers.extend(table.correlations(measure.key()).map(|numbers| (measure, numbers)));
    }
    let nearest_psd = table.flag("nearest_psd");
    let flag_passed = !table.has("nearest_psd") || nearest_psd.is_some();
    table.finish();
    match (parameters, numbers.pop()) {
        (Some(parameters), Some((measure, numbers))) if flag_passed && is_one => {
            Some(Correlation { parameters, measure, numbers, nearest_psd: nearest_psd.unwrap_or(false) })
        }
        _ => None,
    }
}

/// Reads a `[[derive]]` table; `None` after a problem.
pub fn derivation(table: &mut Section<'_, '_>) -> Option<Derivation> {
    let target = parameter(table, "parameter");
    let expression = table.right_rows(&DERIVE[1..]).text("expression").map(str::to_owned);
    table.finish();
    let ((parameter, component), expression) = target.zip(expression)?;
    Some(Derivation { parameter, component, expression })
}

/// Reads `[design]`; `None` after a problem.
pub fn design(table: &mut Section<'_, '_>) -> Option<Design> {
    if !table.is_present() {
        return Some(Design::DEFAULT);
    }
    let name = table.required_word("kind", Design::NAMES, "\"sobol\"")?;
    let (rows, rules) = Design::keys_of(name)?;
    let written = table.rows(rows, rules);
    let key = REPLICATES.key;
    let mut is_right = true;
    if !rows.iter().any(|row| row.key == key) && table.has(key) && table.counts(key, 1..=MAX_SAMPLES).is_some() {
        let allowed = format!(
            "left out with design {name:?}: designs with replicates are {}",
            Design::names_with(key).join(", ")
        );
        table.refuse(key, allowed, "delete it, or choose one of these designs");
        is_right = false;
    }
    table.finish();
    Design::of(name, &written?).filter(|_| is_right)
}

/// Reads a `[[disperse]]` table; `None` after a problem.
pub fn dispersion(table: &mut Section<'_, '_>) -> Option<Dispersion> {
    let kind = table.plain_text("distribution").and_then(DistributionKind::from_name);
    if kind.is_some_and(DistributionKind::names_parameters) {
        table.describes(None, units::UNKNOWN);
        let distribution = table.distribution()?;
        let (parameter, component) = distribution.written.columns().first()?.target?;
        return Some(Dispersion { parameter, component: Some(component), distribution });
    }
    let target = parameter(table, "parameter");
    // a wrong name is reported; any unit is accepted then
    match target {
        Some((parameter, _)) => table.describes(parameter.name(), parameter.unit()),
        None => table.describes(None, units::UNKNOWN),
    }
    let distribution = table.distribution();
    let ((parameter, component), distribution) = target.zip(distribution)?;
    Some(Dispersion { parameter, component, distribution })
}

/// The valid tables of draws, each with its index in the file: errors of lower layers count valid tables only.
pub(super) struct DrawTables {
    pub(super) dispersed: (Vec<usize>, Vec<Dispersion>),
    pub(super) correlated: (Vec<usize>, Vec<Correlation>),
    pub(super) derived: (Vec<usize>, Vec<Derivation>),
}

impl DrawTables {
    pub(super) fn of(
        disperse: &[Option<Dispersion>],
        correlate: &[Option<Correlation>],
        derive: &[Option<Derivation>],
    ) -> Self {
        fn indexed<T: Clone>(list: &[Option<T>]) -> (Vec<usize>, Vec<T>) {
            list.iter().enumerate().filter_map(|(index, item)| item.clone().map(|item| (index, item))).unzip()
        }
        DrawTables { dispersed: indexed(disperse), correlated: indexed(correlate), derived: indexed(derive) }
    }

    pub(super) fn path(&self, table: Table, key: &str) -> String {
        let table = match table {
            Table::Disperse(index) => Table::Disperse(self.dispersed.0[index]),
            Table::Correlate(index) => Table::Correlate(self.correlated.0[index]),
            Table::Derive(index) => Table::Derive(self.derived.0[index]),
            other => other,
        };
        format!("{table}.{key}")
    }
}

pub(super) fn dispersion_lines(dispersion: &Dispersion, lines: &mut Lines) {
    lines.table("[[disperse]]");
    match dispersion.component {
        _ if dispersion.distribution.kind.names_parameters() => {}
        Some(component) => lines.key("parameter", dispersion.parameter.component_name(component)),
        None => lines.key("parameter", dispersion.parameter.name()),
    }
    lines.key("distribution", dispersion.distribution.kind.name());
    lines.written("disperse", &dispersion.distribution.written);
}

pub(super) fn design_lines(design: &Design, lines: &mut Lines) {
    if *design != Design::DEFAULT {
        lines.table("[design]");
        lines.key("kind", design.name());
        lines.written("design", &design.written());
    }
}

pub(super) fn correlation_lines(correlation: &Correlation, lines: &mut Lines) {
    lines.table("[[correlate]]");
    let name = |(parameter, component): &(Parameter, Option<usize>)| match component {
        Some(component) => parameter.component_name(*component),
        None => parameter.name().to_owned(),
    };
    lines.key("parameters", correlation.parameters.iter().map(name).collect::<Vec<_>>());
    match &correlation.numbers {
        Numbers::One(number) => lines.key(correlation.measure.key(), number),
        Numbers::Rows(rows) => lines.key(correlation.measure.key(), rows),
    }
    if correlation.nearest_psd {
        lines.key("nearest_psd", true);
    }
}

pub(super) fn derivation_lines(derivation: &Derivation, lines: &mut Lines) {
    lines.table("[[derive]]");
    match derivation.component {
        Some(component) => lines.key("parameter", derivation.parameter.component_name(component)),
        None => lines.key("parameter", derivation.parameter.name()),
    }
    lines.key("expression", &derivation.expression);
}
