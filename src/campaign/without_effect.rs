//! Refuses dispersions of what the scene has, but that change no run in any draw: of arcs that start after the end of the run, of ends that come
//! later, of starts that are all those of the run, and of commands that a scale of zero takes away.
//!
//! Scales and delays may be dispersed: a scale counts as zero where it is that of the nominal scene and of all draws, an arc with the earliest
//! and the latest start and end that it has there.

use super::document::Document;
use super::draw_tables::DrawTables;
use crate::sampling::Dispersions;
use crate::scene::schedule::applied;
use crate::scene::{ActuationInput, Parameter, SceneInput};

const SWITCH_ON: &str = "switch_on_delay_s";
const SWITCH_OFF: &str = "switch_off_delay_s";
const TORQUE_SCALE: &str = "torque_scale";

/// Refuses them in the file of `document`; `scene` is the nominal one, whose run takes `duration` seconds.
pub(super) fn refuse(
    duration: f64,
    scene: &SceneInput,
    drawn: &DrawTables,
    dispersions: &Dispersions,
    document: &mut Document<'_>,
) {
    let effects = Effects::new(duration, scene, dispersions);
    let inputs: Vec<_> = drawn.derived.1.iter().flat_map(|derivation| derivation.inputs(scene)).collect();
    for (index, dispersion) in drawn.dispersed.1.iter().enumerate() {
        let reason = |target: (Parameter, usize)| {
            let is_meant = target.0.exists(scene, target.1) && !inputs.contains(&target);
            Some((target, effects.reason_for_none(target).filter(|_| is_meant)?))
        };
        if let Some(((parameter, component), [allowed, remedy])) = dispersion.components().into_iter().find_map(reason)
        {
            let value = format!("{:?}", parameter.component_name(component));
            document.add(&drawn.path_of_parameter(index), Some(value), allowed, &remedy);
        }
    }
}

/// What can have an effect in a nominal scene and its draws.
struct Effects {
    /// Duration of a run, s.
    duration: f64,
    /// The scene with the commands that act in it or in any draw.
    acting: SceneInput,
    /// The same with the motor torques alone that a scale multiplies, without those that are a bias.
    scaled: SceneInput,
    earliest: Vec<[f64; 2]>,
    latest: Vec<[f64; 2]>,
}

impl Effects {
    fn new(duration: f64, scene: &SceneInput, dispersions: &Dispersions) -> Self {
        Effects {
            duration,
            acting: with_acting_commands(scene, dispersions, true),
            scaled: with_acting_commands(scene, dispersions, false),
            earliest: earliest_arcs(scene, dispersions),
            latest: arcs(scene, dispersions, |range| range[1], f64::max),
        }
    }

    /// Why a change of the component has no effect in any draw, as what is allowed and the remedy; `None` where it has one.
    fn reason_for_none(&self, (parameter, component): (Parameter, usize)) -> Option<[String; 2]> {
        let key = parameter.facts().key;
        let acting = if key == TORQUE_SCALE { &self.scaled } else { &self.acting };
        if !parameter.exists(acting, component) {
            let allowed = "a key with an effect: a scale of 0 takes away, in every draw, what it acts on";
            let remedy =
                "set that thrust_scale or torque_scale to another value, disperse it too, or delete this table";
            return Some([allowed, remedy].map(str::to_owned));
        }
        let (duration, starts) = (self.duration, |arc: &usize| self.earliest[*arc][0] < self.duration);
        let late = |what: &str| {
            let allowed = format!(
                "a key with an effect before campaign.duration_s ({duration:?}): the arcs that it acts on {what} later, in every draw"
            );
            Some([allowed, format!("let an arc {what} earlier, or delete this table")])
        };
        match parameter.switches(acting) {
            Some(arcs) if key == SWITCH_OFF => {
                if arcs.iter().any(|arc| self.earliest[*arc][1] < duration) {
                    None
                } else {
                    late("end")
                }
            }
            Some(arcs) if !arcs.iter().any(starts) => late("start"),
            Some(arcs) if !arcs.iter().filter(|arc| starts(arc)).any(|arc| self.latest[*arc][0] > 0.0) => {
                let allowed = "a key with an effect after the start of the run: the arcs whose start it moves start with the run, in every draw";
                let remedy = "let the delay be positive in some draws, let an arc start later, or delete this table";
                Some([allowed, remedy].map(str::to_owned))
            }
            Some(_) => None,
            None => {
                let mut within = acting.clone();
                let mut arcs = 0..self.earliest.len();
                within.actuation.retain(|_| arcs.next().as_ref().is_some_and(starts));
                if parameter.exists(&within, component) { None } else { late("start") }
            }
        }
    }
}

/// The scene without the commands that a scale takes away in every draw: scales that are dispersed count as one. A motor gives its bias where a
/// torque is commanded; `with_bias` says whether that counts.
fn with_acting_commands(scene: &SceneInput, dispersions: &Dispersions, with_bias: bool) -> SceneInput {
    let mut acting = scene.clone();
    for column in dispersions.columns() {
        if ["thrust_scale", TORQUE_SCALE, "torque_bias_n_m"].contains(&column.parameter.facts().key) {
            column.parameter.set(&mut acting, column.component, 1.0);
        }
    }
    for arc in &mut acting.actuation {
        for (thrust, thruster) in arc.thrust_n.iter_mut().zip(&acting.thrusters) {
            if arc.errors.thrust_scale == 0.0 || thruster.thrust_scale == 0.0 {
                *thrust = 0.0;
            }
        }
        for (torque, wheel) in arc.torque_n_m.iter_mut().zip(&acting.wheels) {
            let has_bias = with_bias && wheel.torque_bias_n_m != 0.0;
            if arc.errors.torque_scale == 0.0 || wheel.torque_scale == 0.0 && !has_bias {
                *torque = 0.0;
            }
        }
    }
    acting
}

/// The scene with the commands that act in a run of `duration` seconds, in it or in any draw; its scales are not those of the scene.
pub(super) fn acting_scene(duration: f64, scene: &SceneInput, dispersions: &Dispersions) -> SceneInput {
    let mut acting = with_acting_commands(scene, dispersions, true);
    for (arc, [start, _]) in acting.actuation.iter_mut().zip(earliest_arcs(scene, dispersions)) {
        if start >= duration {
            *arc = ActuationInput::idle(arc.start_s, arc.end_s);
        }
    }
    acting
}

/// The earliest start and end of each arc, s: those with the smallest delays of the nominal scene and all draws, minus infinity where these are not
/// known.
pub(super) fn earliest_arcs(scene: &SceneInput, dispersions: &Dispersions) -> Vec<[f64; 2]> {
    arcs(scene, dispersions, |range| range[0], f64::min)
}

/// Start and end of each arc, s, with the delays at one `end` of their ranges, or the nominal ones where these are `farther`.
fn arcs(
    scene: &SceneInput,
    dispersions: &Dispersions,
    end: fn([f64; 2]) -> f64,
    farther: fn(f64, f64) -> f64,
) -> Vec<[f64; 2]> {
    let mut moved = scene.clone();
    for (index, column) in dispersions.columns().iter().enumerate() {
        if [SWITCH_ON, SWITCH_OFF].contains(&column.parameter.facts().key) {
            let range = dispersions.range_of(index).unwrap_or([f64::NEG_INFINITY, f64::INFINITY]);
            column.parameter.set(&mut moved, column.component, farther(end(range), column.nominal));
        }
    }
    let arc = |index: usize| applied(&moved, index);
    (0..scene.actuation.len()).map(|index| [arc(index).start, arc(index).applied.until]).collect()
}
