//! [`SceneInput`]: a scene as written, number by number, before anything is derived or checked.
//!
//! This is the content of a campaign file, and what a dispersion changes: plain SI numbers, no serde. The structures and their
//! defaults come from [`super::schema`]. [`super::Scene::resolve`] turns a scene into a [`super::Scene`] or says why it is not
//! physical.

use super::schema::{
    ActuationInput, ActuatorsInput, DebrisInput, EnvironmentInput, FuselageInput, InitialInput, Usage, WheelInput,
    WheelMode,
};

/// A scene as written: bodies, initial state, actuation.
///
/// The default is the report's fuselage (Table II) alone, at rest at the inertial origin, without wheels, debris and actuation.
///
/// ```
/// use spindrift::scene::{DebrisInput, Scene, SceneInput, WheelInput};
///
/// let scene = SceneInput::default()
///     .with_wheel(0, WheelInput { station_m: 1.0, ..WheelInput::default() })
///     .with_debris(DebrisInput::Cube { side_m: 0.2, density_kg_m3: 2700.0 })
///     .with("initial.angular_velocity_rad_s", &[0.0, 0.1, 0.5])
///     .with("initial.wheel_rates_rad_s.1", &[314.0]);
/// let scene = Scene::resolve(&scene).expect("physical");
/// assert_eq!(scene.initial.wheel_rates[..2], [314.0, 0.0]);
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SceneInput {
    /// The fuselage S.
    pub fuselage: FuselageInput,
    /// The wheels W1 (axis s2) and W2 (axis s3); `None` where the spacecraft has no such wheel.
    pub wheels: [Option<WheelInput>; 2],
    /// The debris body D, if there is one.
    pub debris: Option<DebrisInput>,
    /// The state at time zero.
    pub initial: InitialInput,
    /// Arcs of constant thrust and torque, in order and not overlapping.
    pub actuation: Vec<ActuationInput>,
    /// What the actuators make of it.
    pub actuators: ActuatorsInput,
    /// Torques of the environment.
    pub environment: EnvironmentInput,
}

impl SceneInput {
    /// Whether anything does work on the spacecraft: a schedule, a torque of the environment, or a motor that holds its wheel's
    /// speed.
    pub fn is_actuated(&self) -> bool {
        let is_held = |wheel: &Option<WheelInput>| wheel.is_some_and(|wheel| wheel.mode == WheelMode::SpeedHeld);
        !self.actuation.is_empty() || self.environment.acts() || self.wheels.iter().any(is_held)
    }

    /// The same scene with wheel `index`: 0 is W1, 1 is W2.
    ///
    /// # Panics
    /// Where `index` is neither.
    pub fn with_wheel(mut self, index: usize, wheel: WheelInput) -> Self {
        self.wheels[index] = Some(wheel);
        self
    }

    /// The same scene with debris.
    pub fn with_debris(mut self, debris: DebrisInput) -> Self {
        self.debris = Some(debris);
        self
    }

    /// The same scene with another arc at the end of its schedule.
    pub fn with_actuation(mut self, arc: ActuationInput) -> Self {
        self.actuation.push(arc);
        self
    }

    /// What the scene has and commands, as far as keys of the schema depend on it.
    pub fn usage(&self) -> Usage {
        let fires = |thruster: usize| self.actuation.iter().any(|arc| arc.thrust_n[thruster] != 0.0);
        let drives = |wheel: usize| self.actuation.iter().any(|arc| arc.torque_n_m[wheel] != 0.0);
        Usage {
            is_scheduled: !self.actuation.is_empty(),
            fires: std::array::from_fn(fires),
            drives: std::array::from_fn(|wheel| self.wheels[wheel].is_some() && drives(wheel)),
            wheels: self.wheels.map(|wheel| wheel.is_some()),
            debris: self.debris.is_some(),
        }
    }
}
