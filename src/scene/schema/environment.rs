//! `[environment]`: torques of the environment on the spacecraft.

use super::Key;
use super::rows::rows;
use crate::scene::error::Problems;
use crate::scene::input::SceneInput;

rows! {
    /// Torques of the environment on the spacecraft. A torque that is not written does not act.
    pub struct EnvironmentInput in Environment ["environment"], environment, environment_mut {
    } beside {}
}

impl EnvironmentInput {
    /// Whether any torque of the environment acts: whether any key is written.
    pub fn acts(&self) -> bool {
        *self != EnvironmentInput::DEFAULT
    }
}

/// The rows of `[environment]`.
pub(super) const KEYS: &[&[Key]] = &[EnvironmentInput::ROWS];
