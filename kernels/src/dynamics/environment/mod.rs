//! Torques of the environment: what acts on the body beside the actuators, under a schedule and under any law alike.
//!
//! Each torque is a source of actuation in a file of its own, listed in [`SOURCES`]; its parameters are the keys of `[environment]`
//! ([`crate::scene::schema::environment`]). A scene without such keys has no environment and costs nothing.

mod constant_torque;

use super::actuation::sum;
use crate::scene::{Actuation, Scene};

/// What a torque applies to a run of a scene from a time (s) on, and until when.
pub type Source = fn(&Scene, f64) -> Actuation;

/// All torques of the environment.
pub const SOURCES: [Source; 1] = [constant_torque::actuation];

/// `applied` by the actuators at `time`, and everything that the environment of `scene` adds, until the first of them changes.
#[inline]
pub fn with_environment(scene: &Scene, time: f64, applied: Actuation) -> Actuation {
    if !scene.environment.acts() {
        return applied;
    }
    SOURCES.iter().fold(applied, |total, source| sum(&total, &source(scene, time)))
}
