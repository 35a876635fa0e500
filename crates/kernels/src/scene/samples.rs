//! Scenes for unit tests: Berdoz's Tables I and II.

use super::input::SceneInput;
use super::schema::{DebrisInput, InitialInput};
use core::f64::consts::PI;

/// Berdoz's scene: bodies of Table II, initial state of Table I, no force.
pub(crate) fn table_two() -> SceneInput {
    let mut scene = SceneInput::report().with_debris(DebrisInput::Cube { side_m: 0.2, density_kg_m3: 2700.0 });
    scene.wheels[0].rate_rad_s = 100.0 * PI;
    scene.wheels[1].rate_rad_s = 50.0 * PI;
    scene.initial = InitialInput {
        velocity_m_s: [10.0, 0.0, 0.0],
        angular_velocity_rad_s: [0.0, PI, 10.0 * PI],
        debris_velocity_m_s: [10.0, 0.0, 0.0],
        debris_relative_angular_velocity_rad_s: [100.0, 0.0, 0.0],
        ..InitialInput::DEFAULT
    };
    scene
}
