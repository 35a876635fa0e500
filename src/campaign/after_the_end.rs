//! Refuses dispersions that act after the end of a run only: on arcs that start later, or on the ends of arcs that end later.
//!
//! Delays may be negative and dispersed: an arc counts with the earliest start and end that any draw gives it.

use super::document::Document;
use super::draw_tables::DrawTables;
use crate::sampling::Dispersions;
use crate::scene::schedule::applied;
use crate::scene::{ActuationInput, Parameter, SceneInput};

const SWITCH_ON: &str = "switch_on_delay_s";
const SWITCH_OFF: &str = "switch_off_delay_s";

/// Refuses them in the file of `document`; `scene` is the nominal one, whose run takes `duration` seconds.
pub(super) fn refuse(
    duration: f64,
    scene: &SceneInput,
    drawn: &DrawTables,
    dispersions: &Dispersions,
    document: &mut Document<'_>,
) {
    let earliest = earliest(scene, dispersions);
    let inputs: Vec<_> = drawn.derived.1.iter().flat_map(|derivation| derivation.inputs(scene)).collect();
    for (index, dispersion) in drawn.dispersed.1.iter().enumerate() {
        let is_late = |target: &(Parameter, usize)| {
            target.0.exists(scene, target.1)
                && !acts_before(duration, *target, scene, &earliest)
                && !inputs.contains(target)
        };
        if let Some((parameter, component)) = dispersion.components().into_iter().find(is_late) {
            let late = if parameter.facts().key == SWITCH_OFF { "end" } else { "start" };
            let allowed = format!(
                "a key with an effect before campaign.duration_s ({duration:?}): the arcs that it acts on {late} later, in every draw"
            );
            let remedy = format!("let an arc {late} earlier, or delete this table");
            let value = format!("{:?}", parameter.component_name(component));
            document.add(&drawn.path_of_parameter(index), Some(value), allowed, &remedy);
        }
    }
}

/// Whether a change of the component has an effect on the first `duration` seconds of any draw.
fn acts_before(
    duration: f64,
    (parameter, component): (Parameter, usize),
    scene: &SceneInput,
    earliest: &SceneInput,
) -> bool {
    let arcs = 0..scene.actuation.len();
    if parameter.facts().key == SWITCH_OFF {
        let ends = |arc: usize| {
            parameter.exists(&with_arc_alone(scene, arc), component) && applied(earliest, arc).applied.until < duration
        };
        return arcs.into_iter().any(ends);
    }
    let mut within = scene.clone();
    let mut starts = arcs.map(|arc| applied(earliest, arc).start);
    within.actuation.retain(|_| starts.next().is_some_and(|start| start < duration));
    parameter.exists(&within, component)
}

/// The scene in which all arcs but one command nothing.
fn with_arc_alone(scene: &SceneInput, alone: usize) -> SceneInput {
    let mut scene = scene.clone();
    for (_, arc) in scene.actuation.iter_mut().enumerate().filter(|(index, _)| *index != alone) {
        *arc = ActuationInput { name: arc.name, ..ActuationInput::idle(arc.start_s, arc.end_s) };
    }
    scene
}

/// The scene with the smallest delays that draws give: minus infinity where that is not known.
fn earliest(scene: &SceneInput, dispersions: &Dispersions) -> SceneInput {
    let mut earliest = scene.clone();
    for (index, column) in dispersions.columns().iter().enumerate() {
        if [SWITCH_ON, SWITCH_OFF].contains(&column.parameter.facts().key) {
            let smallest = dispersions.smallest_of(index).unwrap_or(f64::NEG_INFINITY);
            column.parameter.set(&mut earliest, column.component, smallest);
        }
    }
    earliest
}
