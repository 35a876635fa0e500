//! [`without_effect`]: which dispersed parameters change no requested column, found by running the nominal scene with one parameter changed at
//! a time. What follows from the equations (a position changes no energy of rotation) need not be listed anywhere.

use std::time::Instant;

use crate::campaign::{Plan, SceneDraws};
use crate::ensemble::single::SingleRun;
use crate::math::Isa;
use crate::sampling::dispersions::Draws;
use crate::sampling::{Design, Dispersions, SampleId};
use crate::scene::Parameter;

/// Samples whose values are tried: a discrete distribution may give the nominal value once.
const TRIED: u64 = 3;
/// Nothing is found out where that would take longer, s.
const LONGEST_S: f64 = 5.0;

/// The dispersed parameters of `plan` that leave every requested column of the nominal run as it is, bit for bit, when they change; inputs of
/// derived parameters have an effect. `None` where the runs would take too long, or the nominal scene cannot be run.
pub fn without_effect(plan: &Plan, isa: Isa) -> Option<Vec<Parameter>> {
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
    if start.elapsed().as_secs_f64() * parameters.len() as f64 * 2.0 > LONGEST_S {
        return None;
    }
    let mut draws = SceneDraws::new(plan);
    let samples = 1..plan.samples.min(TRIED + 1);
    let applied: Vec<Vec<f64>> = samples
        .map(|sample| {
            // a sample that is not physical as a whole may be so with one of its values
            let _ = draws.scene(SampleId(sample));
            draws.applied().to_vec()
        })
        .collect();
    let is_seen = |parameter: &Parameter| {
        applied.iter().any(|values| {
            let mut changed = plan.clone();
            for (column, value) in columns.iter().zip(values).filter(|(column, _)| column.parameter == *parameter) {
                parameter.set(&mut changed.nominal, column.component, *value);
            }
            let none = Draws {
                seed: 0,
                samples: Some(1),
                design: &Design::DEFAULT,
                disperse: &[],
                correlate: &[],
                derive: &[],
            };
            let Ok(dispersions) = Dispersions::new(none, &changed.nominal) else { return true };
            changed.dispersions = dispersions;
            // a value that makes the scene unphysical has an effect
            row(&changed, isa).is_none_or(|row| row != nominal)
        })
    };
    parameters.retain(|parameter| !is_seen(parameter));
    Some(parameters)
}

/// The bits of the requested columns of the nominal run.
fn row(plan: &Plan, isa: Isa) -> Option<Vec<u64>> {
    let run = SingleRun::new(plan, SampleId(0), plan.grid.clone(), isa).ok()?;
    Some(run.row.iter().map(|value| value.to_bits()).collect())
}
