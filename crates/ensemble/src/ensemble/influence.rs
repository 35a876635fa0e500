//! [`notes`]: dispersed parameters without effect on requested columns, found by runs of the nominal scene and some
//! samples with one parameter changed. Properties of the equations (a thruster never fired changes nothing) need no
//! list.

use crate::campaign::Plan;
use crate::ensemble::drawn::DrawnScenes;
use crate::ensemble::probe::{limited, part_of_run};
use crate::ensemble::single::SingleRuns;
use crate::math::Isa;
use crate::run::Status;
use crate::sampling::{Design, Dispersions, Draws, SampleId};
use crate::scene::{Parameter, Scene};
use std::time::Instant;

const DRAWN: u64 = 1000;
/// Longest search, s.
const LONGEST_S: f64 = 3.0;

/// A sentence for each parameter that is always nominal or has no effect on a requested column.
pub fn notes(plan: &Plan, isa: Isa) -> Vec<String> {
    let drawn = DrawnScenes::spread(plan, DRAWN);
    let columns = plan.dispersions.columns();
    let is_constant = |index: usize| drawn.columns[index].iter().all(|value| *value == columns[index].nominal);
    let mut constant: Vec<String> = Vec::new();
    for index in (0..columns.len()).filter(|index| drawn.count() > 0 && is_constant(*index)) {
        let column = &columns[index];
        let mut own = (0..columns.len()).filter(|other| columns[*other].parameter == column.parameter);
        let name = if own.all(is_constant) {
            dispersed_name(plan, column.parameter)
        } else {
            column.parameter.component_name(column.component)
        };
        if !constant.contains(&name) {
            constant.push(name);
        }
    }
    let never = |name| format!("{name} is never varied: each of {} draws is the nominal value", drawn.count());
    let mut notes: Vec<String> = constant.into_iter().map(never).collect();
    match without_effect(plan, &drawn, isa) {
        Some(unseen) => notes.extend(unseen.into_iter().map(|parameter| {
            let does = if parameter.contains(", ") { "do" } else { "does" };
            format!(
                "{parameter} {does} not affect any requested column (observe.groups), in the samples that were tried"
            )
        })),
        None if columns.is_empty() => {}
        None => {
            notes.push("not tried: whether each dispersion changes a column (runs fail or take too long)".to_owned());
        }
    }
    notes
}

/// The dispersed parameters, or components, that leave every requested column unchanged, bit for bit, when they take
/// values of samples in the nominal scene and nominal values in these samples. Inputs of derived parameters and of
/// `[[observable]]` count as effective; constant ones are not judged. `None` if runs take too long or the nominal scene
/// cannot run.
pub fn without_effect(plan: &Plan, drawn: &DrawnScenes, isa: Isa) -> Option<Vec<String>> {
    let mut parameters: Vec<Parameter> = plan.dispersions.columns().iter().map(|column| column.parameter).collect();
    parameters.sort_unstable();
    parameters.dedup();
    let derivations = plan.derived.iter().flat_map(|derivation| derivation.inputs(&plan.nominal));
    let observables = plan.analysis.derived.iter().flat_map(|observable| observable.parameters(&plan.nominal));
    let inputs: Vec<Parameter> = derivations.chain(observables).map(|(parameter, _)| parameter).collect();
    parameters.retain(|parameter| !inputs.contains(parameter));
    if part_of_run(plan).is_some() {
        return None;
    }
    let start = Instant::now();
    let plan = &limited(plan);
    let nominal = row_with(plan, isa, &[], &|_| false)?;
    let tried: Vec<Vec<Vec<f64>>> =
        parameters.iter().map(|parameter| extreme_samples(plan, drawn, *parameter)).collect();
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
        if start.elapsed().as_secs_f64() > LONGEST_S {
            return None;
        }
    }
    Some(unseen)
}

/// True if a row differs once `parameter` takes its value among `applied` in the nominal scene, whose row is `nominal`,
/// or its nominal value in that sample. An unphysical scene is an effect.
fn is_seen(plan: &Plan, isa: Isa, parameter: Parameter, applied: &[f64], nominal: &[u64]) -> bool {
    let row_with = |is_applied: &dyn Fn(Parameter) -> bool| row_with(plan, isa, applied, is_applied);
    row_with(&|other| other == parameter).is_none_or(|row| row != nominal)
        || row_with(&|_| true).is_some_and(|row| row_with(&|other| other != parameter).is_none_or(|other| other != row))
}

/// The bits of the nominal scene's row with some parameters from `applied`; `None` if it is not physical or takes too
/// long.
fn row_with(plan: &Plan, isa: Isa, applied: &[f64], is_applied: &dyn Fn(Parameter) -> bool) -> Option<Vec<u64>> {
    let mut changed = plan.clone();
    for (column, value) in plan.dispersions.columns().iter().zip(applied).filter(|(c, _)| is_applied(c.parameter)) {
        column.parameter.set(&mut changed.nominal, column.component, *value);
    }
    let none =
        Draws { seed: 0, samples: Some(1), design: &Design::DEFAULT, disperse: &[], correlate: &[], derive: &[] };
    changed.dispersions = Dispersions::new(none, &changed.nominal).ok()?;
    Scene::resolve(&changed.nominal).ok()?;
    let run = SingleRuns::new(&changed, plan.grid.clone(), isa, &[], false).run(SampleId(0)).ok()?;
    (run.outcome.status != Status::StepLimit).then(|| run.row.iter().map(|value| value.to_bits()).collect())
}

fn extreme_samples(plan: &Plan, drawn: &DrawnScenes, parameter: Parameter) -> Vec<Vec<f64>> {
    let own = plan.dispersions.columns().iter().zip(&drawn.columns).filter(|(column, _)| column.parameter == parameter);
    let extremes = own.flat_map(|(column, values)| {
        let changed = || (0..values.len()).filter(|sample| values[*sample] != column.nominal);
        let by_value = |a: &usize, b: &usize| values[*a].total_cmp(&values[*b]);
        [changed().min_by(by_value), changed().max_by(by_value)]
    });
    let mut samples: Vec<usize> = extremes.flatten().collect();
    samples.sort_unstable();
    samples.dedup();
    samples.into_iter().map(|sample| drawn.columns.iter().map(|values| values[sample]).collect()).collect()
}

fn dispersed_name(plan: &Plan, parameter: Parameter) -> String {
    let columns = plan.dispersions.columns().iter().filter(|column| column.parameter == parameter);
    let names: Vec<String> = columns.map(|column| parameter.component_name(column.component)).collect();
    if names.len() == parameter.width() { parameter.name() } else { names.join(", ") }
}
