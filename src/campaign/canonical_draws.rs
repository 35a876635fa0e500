//! What is drawn, as canonical text; see [`super::canonical`].

use super::lines::Lines;
use crate::sampling::geometric::DirectionSpread;
use crate::sampling::scalar::{LOWER_KEYS, UPPER_KEYS};
use crate::sampling::{
    AttitudeSpread, Bound, Correlation, DataColumn, Dependence, Derivation, Design, Dispersion, GeometricLaw, Law,
    Levels, LogRange, Offset, Range, Spread, Truncation, Values,
};
use crate::scene::Parameter;

/// Writes one `[[disperse]]` table.
pub(super) fn dispersion_lines(dispersion: &Dispersion, lines: &mut Lines) {
    lines.table("[[disperse]]");
    match dispersion.component {
        Some(component) => lines.key("parameter", dispersion.parameter.component_name(component)),
        None => lines.key("parameter", dispersion.parameter.name()),
    }
    law_lines(&dispersion.law, lines);
}

/// Writes the keys of a law; tables within it come last.
fn law_lines(law: &Law, lines: &mut Lines) {
    match law {
        Law::Normal(width) => {
            lines.key("distribution", "normal");
            spread(lines, width);
        }
        Law::TruncatedNormal(width, cut) => {
            lines.key("distribution", "truncated_normal");
            spread(lines, width);
            match cut {
                Truncation::Sigmas(sigmas) => lines.values("sigmas", sigmas),
                Truncation::Bounds { lower, upper } => {
                    bound(lines, lower.as_ref(), LOWER_KEYS);
                    bound(lines, upper.as_ref(), UPPER_KEYS);
                }
            }
        }
        Law::Uniform(range) => {
            lines.key("distribution", "uniform");
            match range {
                Range::Between { min, max } => ends(lines, min, max),
                Range::Around(half) => lines.values("half_width", half),
                Range::AroundRelative(half) => lines.values("relative_half_width", half),
            }
        }
        Law::LogNormal { log_std, median } => {
            lines.key("distribution", "log_normal");
            lines.values("log_std", log_std);
            optional(lines, "median", median.as_ref());
        }
        Law::LogUniform(range) => {
            lines.key("distribution", "log_uniform");
            match range {
                LogRange::Between { min, max } => ends(lines, min, max),
                LogRange::Around(factor) => lines.values("factor", factor),
            }
        }
        Law::Triangular { min, max, mode } => {
            lines.key("distribution", "triangular");
            ends(lines, min, max);
            optional(lines, "mode", mode.as_ref());
        }
        Law::Beta { alpha, beta, min, max } => {
            lines.key("distribution", "beta");
            lines.values("alpha", alpha);
            lines.values("beta", beta);
            ends(lines, min, max);
        }
        Law::Pert { min, max, mode } => {
            lines.key("distribution", "pert");
            ends(lines, min, max);
            optional(lines, "mode", mode.as_ref());
        }
        Law::Choice { values, weights } => {
            lines.key("distribution", "choice");
            lines.key("values", values);
            if let Some(weights) = weights {
                lines.key("weights", weights);
            }
        }
        Law::Bernoulli { value, probability } => {
            lines.key("distribution", "bernoulli");
            lines.values("value", value);
            lines.values("probability", probability);
        }
        Law::Empirical(DataColumn { file, sha256, column, .. }, interpolation) => {
            lines.key("distribution", "empirical");
            lines.key("file", file);
            lines.key("sha256", sha256);
            lines.key("column", column);
            lines.key("interpolation", interpolation.name());
        }
        Law::Offset(offset) => {
            lines.key("distribution", "offset");
            match offset {
                Offset::Absolute(values) => lines.values("offset", values),
                Offset::Relative(values) => lines.values("relative_offset", values),
            }
        }
        Law::UniformAttitude => lines.key("distribution", "uniform_attitude"),
        Law::Geometric(law) => geometric_lines(law, lines),
    }
}

fn geometric_lines(law: &GeometricLaw, lines: &mut Lines) {
    lines.key("distribution", law.name());
    match law {
        GeometricLaw::Direction { spread, axis, magnitude } => {
            match spread {
                DirectionSpread::Sphere => {}
                DirectionSpread::Cone { half_angle_rad } => lines.key("half_angle_rad", half_angle_rad),
                DirectionSpread::Fisher { concentration } => lines.key("concentration", concentration),
            }
            if let Some(axis) = axis {
                lines.key("axis", axis);
            }
            if let Some(magnitude) = magnitude {
                lines.table("[disperse.magnitude]");
                law_lines(magnitude, lines);
            }
        }
        GeometricLaw::AttitudeError(AttitudeSpread::Std(values)) => lines.values("std_rad", values),
        GeometricLaw::AttitudeError(AttitudeSpread::Covariance(matrix)) => lines.key("covariance_rad2", matrix),
        GeometricLaw::AboutAxis { axis, angle } => {
            lines.key("axis", axis);
            lines.table("[disperse.angle_rad]");
            law_lines(angle, lines);
        }
    }
}

/// Writes the `[design]` table, if it is not the random design.
pub(super) fn design_lines(design: &Design, lines: &mut Lines) {
    if *design == Design::Random {
        return;
    }
    lines.table("[design]");
    lines.key("kind", design.name());
    match design {
        Design::Grid(levels) | Design::OneAtATime(levels) => match levels {
            Levels::All(count) => lines.key("levels", count),
            Levels::Each(counts) => lines.key("levels", counts),
            Levels::Quantiles(list) => lines.key("quantiles", list),
        },
        Design::Table(columns) => {
            if let Some(column) = columns.first() {
                lines.key("file", &column.file);
                lines.key("sha256", &column.sha256);
            }
            lines.key("parameters", columns.iter().map(|column| column.column.as_str()).collect::<Vec<_>>());
        }
        _ => {}
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
    match &correlation.dependence {
        Dependence::Scores(matrix) => lines.key("correlation", matrix),
        Dependence::Ranks(matrix) => lines.key("rank_correlation", matrix),
        Dependence::Covariance(matrix) => lines.key("covariance", matrix),
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

fn spread(lines: &mut Lines, spread: &Spread) {
    match spread {
        Spread::Absolute(values) => lines.values("std", values),
        Spread::Relative(values) => lines.values("relative_std", values),
    }
}

fn bound(lines: &mut Lines, bound: Option<&Bound>, keys: [&str; 3]) {
    match bound {
        Some(Bound::Absolute(values)) => lines.values(keys[0], values),
        Some(Bound::Relative(values)) => lines.values(keys[1], values),
        Some(Bound::Sigmas(values)) => lines.values(keys[2], values),
        None => {}
    }
}

fn ends(lines: &mut Lines, min: &Values, max: &Values) {
    lines.values("min", min);
    lines.values("max", max);
}

fn optional(lines: &mut Lines, key: &str, values: Option<&Values>) {
    if let Some(values) = values {
        lines.values(key, values);
    }
}
