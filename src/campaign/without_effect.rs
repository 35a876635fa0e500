//! Refuses dispersions that act after the end of a run only: on arcs that start later, or on the ends of arcs that end later.
//!
//! Delays may be negative and dispersed: an arc counts with the earliest start and end that it has in the nominal scene or in any draw.

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
    let earliest = earliest_arcs(scene, dispersions);
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
    earliest: &[[f64; 2]],
) -> bool {
    if parameter.facts().key == SWITCH_OFF {
        let ends = |arc: usize| parameter.exists(&with_arc_alone(scene, arc), component) && earliest[arc][1] < duration;
        return (0..earliest.len()).any(ends);
    }
    let mut within = scene.clone();
    let mut arcs = earliest.iter();
    within.actuation.retain(|_| arcs.next().is_some_and(|[start, _]| *start < duration));
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

/// The earliest start and end of each arc, s: those with the smallest delays of the nominal scene and all draws, minus infinity where these are not
/// known.
pub(super) fn earliest_arcs(scene: &SceneInput, dispersions: &Dispersions) -> Vec<[f64; 2]> {
    let mut earliest = scene.clone();
    for (index, column) in dispersions.columns().iter().enumerate() {
        if [SWITCH_ON, SWITCH_OFF].contains(&column.parameter.facts().key) {
            let smallest = dispersions.smallest_of(index).unwrap_or(f64::NEG_INFINITY);
            column.parameter.set(&mut earliest, column.component, smallest.min(column.nominal));
        }
    }
    let arc = |index: usize| applied(&earliest, index);
    (0..scene.actuation.len()).map(|index| [arc(index).start, arc(index).applied.until]).collect()
}
