//! What is drawn, as canonical text; see [`super::canonical`].

use super::lines::Lines;
use crate::sampling::{Correlation, Derivation, Design, Dispersion, Numbers};
use crate::scene::Parameter;

/// Writes one `[[disperse]]` table.
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

/// Writes the `[design]` table, if it is not the default.
pub(super) fn design_lines(design: &Design, lines: &mut Lines) {
    if *design != Design::DEFAULT {
        lines.table("[design]");
        lines.key("kind", design.name());
        lines.written("design", &design.written());
    }
}

/// Writes one `[[correlate]]` table.
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

/// Writes one `[[derive]]` table.
pub(super) fn derivation_lines(derivation: &Derivation, lines: &mut Lines) {
    lines.table("[[derive]]");
    match derivation.component {
        Some(component) => lines.key("parameter", derivation.parameter.component_name(component)),
        None => lines.key("parameter", derivation.parameter.name()),
    }
    lines.key("expression", &derivation.expression);
}
