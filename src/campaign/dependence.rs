//! The keys of `[[correlate]]` and `[[derive]]` tables.

use super::parameter::{parameter, unknown_parameter};
use super::section::Section;
use crate::sampling::{Correlation, Derivation, Measure};
use crate::scene::Parameter;

/// Reads one `[[correlate]]` table; `None` where something is wrong, which is then noted.
pub fn correlation(table: &mut Section<'_, '_>) -> Option<Correlation> {
    table.require("parameters", "an array of texts", "[\"wheels.w1.radius_m\", \"wheels.w1.length_m\"]");
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
    let written: Vec<Measure> = Measure::ALL.into_iter().filter(|measure| table.has(measure.key())).collect();
    match written[..] {
        [_] => {}
        [] => table.require("correlation", "given (correlation, rank_correlation or covariance)", "0.5"),
        [_, second, ..] => {
            let allowed = "the only one of correlation, rank_correlation, covariance";
            table.refuse(second.key(), allowed, "delete all but one of them");
        }
    }
    let mut numbers = Vec::new();
    for measure in Measure::ALL {
        numbers.extend(table.correlations(measure.key()).map(|numbers| (measure, numbers)));
    }
    let nearest_psd = table.flag("nearest_psd");
    let flag_passed = !table.has("nearest_psd") || nearest_psd.is_some();
    table.finish();
    match (parameters, numbers.pop()) {
        (Some(parameters), Some((measure, numbers))) if flag_passed && written.len() == 1 => {
            Some(Correlation { parameters, measure, numbers, nearest_psd: nearest_psd.unwrap_or(false) })
        }
        _ => None,
    }
}

/// Reads one `[[derive]]` table; `None` where something is wrong, which is then noted.
pub fn derivation(table: &mut Section<'_, '_>) -> Option<Derivation> {
    let target = parameter(table, "parameter");
    table.require("expression", "arithmetic over other parameters", "\"wheels.w1.density_kg_m3\"");
    let expression = table.text("expression").map(str::to_owned);
    table.finish();
    let ((parameter, component), expression) = target.zip(expression)?;
    Some(Derivation { parameter, component, expression })
}
