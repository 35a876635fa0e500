//! [`without_effect`]: which dispersed parameters change no requested column, found by running the nominal scene with one parameter changed at
//! a time. What follows from the equations (a position changes no energy of rotation) need not be listed anywhere.

use std::time::Instant;

use crate::campaign::{Plan, SceneDraws};
use crate::ensemble::single::SingleRun;
use crate::math::Isa;
use crate::sampling::{Design, Dispersions, Draws, SampleId};
use crate::scene::{Parameter, Scene};

/// Values of each parameter that are tried.
const TRIED: usize = 3;
/// Samples that are drawn to find values other than the nominal one, which a discrete distribution gives seldom.
const DRAWN: u64 = 1000;
/// Nothing is found out where that would take longer, s.
const LONGEST_S: f64 = 5.0;

/// The names of the dispersed parameters of `plan`, or of their dispersed components, that leave every requested column of the nominal run as it is,
/// bit for bit, when they change. Inputs of derived parameters have an effect; what no draw changes is not judged. `None` where the runs would take
/// too long, or the nominal scene cannot be run.
pub fn without_effect(plan: &Plan, isa: Isa) -> Option<Vec<String>> {
    let columns = plan.dispersions.columns();
    let mut parameters: Vec<Parameter> = columns.iter().map(|column| column.parameter).collect();
    parameters.sort_unstable();
    parameters.dedup();
    let inputs: Vec<Parameter> = plan
        .derived
        .iter()
        .flat_map(|derivation| derivation.inputs(&plan.nominal))
        .map(|(parameter, _)| parameter)
        .collect();
    parameters.retain(|parameter| !inputs.contains(parameter));
    let start = Instant::now();
    let nominal = row(plan, isa)?;
    if start.elapsed().as_secs_f64() * parameters.len() as f64 * TRIED as f64 > LONGEST_S {
        return None;
    }
    let values = changed_values(plan, &parameters);
    let is_seen = |parameter: &Parameter, values: &[f64]| {
        let mut changed = plan.clone();
        for (column, value) in columns.iter().zip(values).filter(|(column, _)| column.parameter == *parameter) {
            parameter.set(&mut changed.nominal, column.component, *value);
        }
        let none =
            Draws { seed: 0, samples: Some(1), design: &Design::DEFAULT, disperse: &[], correlate: &[], derive: &[] };
        let Ok(dispersions) = Dispersions::new(none, &changed.nominal) else { return true };
        changed.dispersions = dispersions;
        // a value that makes the scene unphysical has an effect
        Scene::resolve(&changed.nominal).is_err() || row(&changed, isa).is_none_or(|row| row != nominal)
    };
    let unseen = parameters
        .iter()
        .zip(&values)
        .filter(|(parameter, tried)| !tried.is_empty() && !tried.iter().any(|values| is_seen(parameter, values)));
    Some(unseen.map(|(parameter, _)| dispersed_name(plan, *parameter)).collect())
}

/// For each of `parameters` the applied values of the first samples that change it.
fn changed_values(plan: &Plan, parameters: &[Parameter]) -> Vec<Vec<Vec<f64>>> {
    let columns = plan.dispersions.columns();
    let mut draws = SceneDraws::new(plan);
    let mut values: Vec<Vec<Vec<f64>>> = vec![Vec::new(); parameters.len()];
    for sample in 1..plan.samples.min(DRAWN + 1) {
        if values.iter().all(|tried| tried.len() >= TRIED) {
            break;
        }
        // a sample that is not physical as a whole may be so with one of its values
        let _ = draws.scene(SampleId(sample));
        let applied = draws.applied();
        for (parameter, tried) in parameters.iter().zip(&mut values).filter(|(_, tried)| tried.len() < TRIED) {
            let mut of_parameter = columns.iter().zip(applied).filter(|(column, _)| column.parameter == *parameter);
            if of_parameter.any(|(column, value)| *value != column.nominal) {
                tried.push(applied.to_vec());
            }
        }
    }
    values
}

/// The name of a parameter; of its dispersed components, where only some are dispersed.
fn dispersed_name(plan: &Plan, parameter: Parameter) -> String {
    let columns = plan.dispersions.columns().iter().filter(|column| column.parameter == parameter);
    let names: Vec<String> = columns.map(|column| parameter.component_name(column.component)).collect();
    if names.len() == parameter.width() { parameter.name() } else { names.join(", ") }
}

/// The bits of the requested columns of the nominal run.
fn row(plan: &Plan, isa: Isa) -> Option<Vec<u64>> {
    let run = SingleRun::new(plan, SampleId(0), plan.grid.clone(), isa).ok()?;
    Some(run.row.iter().map(|value| value.to_bits()).collect())
}
