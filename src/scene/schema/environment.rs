//! `[environment]`: torques of the environment on the spacecraft.

use super::fuselage::XYZ;
use super::numbers::Numbers;
use super::rows::rows;
use super::{Key, Limit, always};
use crate::scene::error::Problems;
use crate::scene::input::SceneInput;

rows! {
    /// Torques of the environment on the spacecraft. A torque that is not written does not act.
    pub struct EnvironmentInput in Environment ["environment"], environment, environment_mut {
    body_torque_n_m: Option<[f64; 3]> = None, "N m", "Constant torque on the spacecraft, in F_s", XYZ, Plain, Limit::Finite,
        (optional), always, "give environment.body_torque_n_m a nominal value, zero if need be";
    } others {}
}

impl EnvironmentInput {
    /// Whether any torque of the environment acts: whether any key is written.
    pub fn acts(&self) -> bool {
        *self != EnvironmentInput::DEFAULT
    }
}

/// The rows of `[environment]`.
pub(super) const KEYS: &[&[Key]] = &[EnvironmentInput::ROWS];

fn environment(scene: &SceneInput, _: usize) -> Option<&EnvironmentInput> {
    Some(&scene.environment)
}

fn environment_mut(scene: &mut SceneInput, _: usize) -> Option<&mut EnvironmentInput> {
    Some(&mut scene.environment)
}
