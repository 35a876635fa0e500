//! [`without_effect`]: which dispersed parameters change no requested column, found by running the nominal scene and some samples with one
//! parameter changed at a time. What follows from the equations (a position changes no energy of rotation) need not be listed anywhere.

use std::time::Instant;

use crate::campaign::{Plan, SceneDraws};
use crate::ensemble::probe::limited;
use crate::ensemble::single::SingleRun;
use crate::math::Isa;
use crate::run::Status;
use crate::sampling::{Design, Dispersions, Draws, SampleId};
use crate::scene::{Parameter, Scene};

/// Samples that are drawn to find those that are tried.
const DRAWN: u64 = 1000;
/// Nothing is found out where that would take longer, s.
const LONGEST_S: f64 = 1.0;

/// The names of the dispersed parameters of `plan`, or of their dispersed components, that leave every requested column as it is, bit for bit, when
/// they change: alone from the nominal scene to their values of some samples, and back in these samples. Inputs of derived parameters have an
/// effect; what no draw changes is not judged. `None` where the runs would take too long, or the nominal scene cannot be run.
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
    let plan = &limited(plan);
    let nominal = row_with(plan, isa, &[], &|_| false)?;
    let tried = extreme_samples(plan, &parameters);
    let runs = 3 * tried.iter().map(Vec::len).sum::<usize>();
    if start.elapsed().as_secs_f64() * runs as f64 > LONGEST_S {
        return None;
    }
    let mut unseen = Vec::new();
    for (parameter, samples) in parameters.iter().zip(&tried) {
        let is_seen = |applied: &Vec<f64>| is_seen(plan, isa, *parameter, applied, &nominal);
        if !samples.is_empty() && !samples.iter().any(is_seen) {
            unseen.push(dispersed_name(plan, *parameter));
        }
        // the runs of samples may take longer than the nominal one
        if start.elapsed().as_secs_f64() > LONGEST_S {
            return None;
        }
    }
    Some(unseen)
}

/// Whether a row differs where `parameter` has its values among `applied`, those of a sample, in place of the nominal ones: in the nominal scene,
/// whose row is `nominal`, or in that sample. A value that makes a scene unphysical has an effect.
fn is_seen(plan: &Plan, isa: Isa, parameter: Parameter, applied: &[f64], nominal: &[u64]) -> bool {
    let row_with = |is_applied: &dyn Fn(Parameter) -> bool| row_with(plan, isa, applied, is_applied);
    row_with(&|other| other == parameter).is_none_or(|row| row != nominal)
        || row_with(&|_| true).is_some_and(|row| row_with(&|other| other != parameter).is_none_or(|other| other != row))
}

/// The bits of the requested columns of the nominal scene with those parameters that are applied at their values among `applied`; `None` where it
/// is not physical, or takes too long.
fn row_with(plan: &Plan, isa: Isa, applied: &[f64], is_applied: &dyn Fn(Parameter) -> bool) -> Option<Vec<u64>> {
    let mut changed = plan.clone();
    for (column, value) in plan.dispersions.columns().iter().zip(applied).filter(|(c, _)| is_applied(c.parameter)) {
        column.parameter.set(&mut changed.nominal, column.component, *value);
    }
    let none =
        Draws { seed: 0, samples: Some(1), design: &Design::DEFAULT, disperse: &[], correlate: &[], derive: &[] };
    changed.dispersions = Dispersions::new(none, &changed.nominal).ok()?;
    Scene::resolve(&changed.nominal).ok()?;
    let run = SingleRun::new(&changed, SampleId(0), plan.grid.clone(), isa).ok()?;
    (run.outcome.status != Status::StepLimit).then(|| run.row.iter().map(|value| value.to_bits()).collect())
}

/// For each of `parameters` the applied values of those of the first samples in which one of its columns is largest or smallest, and is not
/// nominal.
fn extreme_samples(plan: &Plan, parameters: &[Parameter]) -> Vec<Vec<Vec<f64>>> {
    let columns = plan.dispersions.columns();
    let mut draws = SceneDraws::new(plan);
    // a sample that is not physical as a whole may be so with one of its values
    let draw = |sample: u64| {
        let _ = draws.scene(SampleId(sample));
        draws.applied().to_vec()
    };
    let drawn: Vec<Vec<f64>> = (1..plan.samples.min(DRAWN + 1)).map(draw).collect();
    let of_parameter = |parameter: &Parameter| {
        let own = columns.iter().enumerate().filter(|(_, column)| column.parameter == *parameter);
        let extremes = own.flat_map(|(index, column)| {
            let value = |sample: &usize| drawn[*sample][index];
            let changed = || (0..drawn.len()).filter(|sample| value(sample) != column.nominal);
            let by_value = |a: &usize, b: &usize| value(a).total_cmp(&value(b));
            [changed().min_by(by_value), changed().max_by(by_value)]
        });
        let mut samples: Vec<usize> = extremes.flatten().collect();
        samples.sort_unstable();
        samples.dedup();
        samples.into_iter().map(|sample| drawn[sample].clone()).collect()
    };
    parameters.iter().map(of_parameter).collect()
}

/// The name of a parameter; of its dispersed components, where only some are dispersed.
fn dispersed_name(plan: &Plan, parameter: Parameter) -> String {
    let columns = plan.dispersions.columns().iter().filter(|column| column.parameter == parameter);
    let names: Vec<String> = columns.map(|column| parameter.component_name(column.component)).collect();
    if names.len() == parameter.width() { parameter.name() } else { names.join(", ") }
}
