//! The JSON Schema of the tables of a loop.

use serde_json::{Value, json};

use super::control::{self, MODEL, MOST_PHASES};
use super::{phases, sensors as sensor_tables};
use crate::campaign::schema::{Keys, one_of};
use crate::campaign::size::MOST_TABLES;
use crate::control::actuators::modulation;
use crate::control::{estimators, laws, parameters, sensors};
use crate::loops::kinds::SensorKind;
use crate::loops::launch_numbers::DEBRIS;
use crate::loops::phase::Maneuver;
use crate::loops::rod_law::ROD_LAWS;
use crate::loops::target::TARGETS;

pub(super) fn schema() -> Vec<(&'static str, Option<usize>, Value)> {
    let kinds = sensors::KINDS.iter().map(|maker| (maker.kind.name, sensor(&maker.kind)));
    vec![
        ("control", None, control().table()),
        ("control.model", None, Keys::of(&MODEL).table()),
        ("sensors", Some(MOST_TABLES), one_of("kind", kinds)),
        ("guidance", Some(MOST_PHASES), guidance()),
    ]
}

fn control() -> Keys {
    let mut keys = Keys::of(&control::ROWS);
    let estimators = estimators::KINDS.iter().map(|maker| maker.kind.parameters);
    let modulations = (0..modulation::NAMES.len()).map(modulation::parameters);
    let others = [&parameters::LOOP[..], &parameters::THRUSTERS, &DEBRIS];
    estimators.chain(modulations).chain(others).for_each(|list| keys.add_parameters(list));
    keys
}

fn sensor(kind: &SensorKind) -> Keys {
    let mut keys = Keys::of(&sensor_tables::ROWS);
    keys.add_parameters(kind.parameters);
    keys
}

/// A phase with a law of this program, or with another law, whose keys are unknown.
fn guidance() -> Value {
    let mut keys = Keys::of(&phases::ROWS);
    for (_, target) in TARGETS {
        parameters::of_phase(target, Maneuver::Transfer, [true, true])
            .iter()
            .for_each(|list| keys.add_parameters(list));
    }
    ROD_LAWS.iter().for_each(|(_, rods)| keys.add_parameters(rods.parameters()));
    laws::KINDS.iter().for_each(|kind| keys.add_parameters(kind.parameters));
    let laws = keys.0["law"].clone();
    let of_others = json!({"required": ["law"], "properties": {"law": {"type": "string", "not": laws}}});
    json!({"anyOf": [keys.table(), of_others]})
}
