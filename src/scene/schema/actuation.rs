//! `[[actuation]]`: the schedule, one arc of constant thrust and torque each; commands, which are not dispersed.

use super::fuselage::{AXES, SCALAR};
use super::numbers::Numbers;
use super::rows::rows;
use super::{Key, Limit, always};
use crate::scene::error::Problems;
use crate::scene::input::SceneInput;

const WHEELS: &[&[&str]] = &[&["1", "2"]];

rows! {
    /// An arc of constant thrust and torque, as commanded.
    pub struct ActuationInput in Actuation ["actuation"], arc, arc_mut {
    start_s: f64 = 0.0, "s", "Start", SCALAR, Plain, Limit::Finite, (required "0.0"), always, "";
    end_s: f64 = 1.0, "s", "End", SCALAR, Plain, Limit::Finite, (required "1.0"), always, "";
    thrust_n: [f64; 3] = [0.0; 3], "N", "Thrusts P1, P2, P3, never negative", AXES, Plain,
        Limit::Thrust("use the opposite thruster"), (optional), always, "";
    torque_n_m: [f64; 2] = [0.0; 2], "N m",
        "Motor torques tau^W1, tau^W2 on the wheels about their axes; the fuselage feels the opposite", WHEELS, Plain,
        Limit::Finite, (optional), always, "";
    } others {}
}

/// The rows of `[[actuation]]`.
pub(super) const KEYS: &[&[Key]] = &[ActuationInput::ROWS];

fn arc(scene: &SceneInput, instance: usize) -> Option<&ActuationInput> {
    scene.actuation.get(instance)
}

fn arc_mut(scene: &mut SceneInput, instance: usize) -> Option<&mut ActuationInput> {
    scene.actuation.get_mut(instance)
}
