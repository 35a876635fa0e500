//! Scenes for the tests of this crate: the report's Tables I and II.

use super::input::SceneInput;
use super::schema::{ActuatorsInput, DebrisInput, FuselageInput, InitialInput, MassErrors, WheelInput, WheelMode};
use core::f64::consts::PI;

/// The report's scene: bodies of Table II, initial state of Table I, no force.
pub(crate) fn table_two() -> SceneInput {
    let wheel = |station_m| {
        Some(WheelInput {
            radius_m: 0.25,
            length_m: 0.1,
            station_m,
            density_kg_m3: 2700.0,
            offset_m: [0.0; 2],
            tilt_rad: [0.0; 2],
            mode: WheelMode::Free,
        })
    };
    SceneInput {
        fuselage: FuselageInput {
            wall_thickness_m: 0.03,
            outer_radius_m: 1.0,
            length_m: 3.0,
            density_kg_m3: 2700.0,
            thruster_offset_m: 0.5,
            mass_kg: None,
            center_of_mass_m: None,
            inertia_kg_m2: None,
            principal: None,
            errors: MassErrors::NONE,
        },
        wheels: [wheel(1.0), wheel(2.0)],
        debris: Some(DebrisInput::Cube { side_m: 0.2, density_kg_m3: 2700.0 }),
        initial: InitialInput {
            position_m: [0.0; 3],
            velocity_m_s: [10.0, 0.0, 0.0],
            attitude: [1.0, 0.0, 0.0, 0.0],
            angular_velocity_rad_s: [0.0, PI, 10.0 * PI],
            wheel_angles_rad: [0.0; 2],
            wheel_rates_rad_s: [100.0 * PI, 50.0 * PI],
            debris_position_m: [0.0; 3],
            debris_velocity_m_s: [10.0, 0.0, 0.0],
            debris_attitude: [1.0, 0.0, 0.0, 0.0],
            debris_relative_angular_velocity_rad_s: [100.0, 0.0, 0.0],
        },
        actuation: Vec::new(),
        actuators: ActuatorsInput::IDEAL,
        ..SceneInput::default()
    }
}
