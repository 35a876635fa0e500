//! [`SceneInput`]: the scene of a campaign file as written, before checks and derivation, changed by dispersions. SI;
//! structures and defaults come from [`super::schema`].

use super::name::Name;
use super::schema::{
    ActuationInput, ActuatorsInput, BodyInput, ControlInput, DebrisInput, EnvironmentInput, FailureInput, InitialInput,
    MAX_WHEELS, OrbitInput, PartInput, PartShape, PlateInput, ThrusterInput, TorqueRodInput, WheelInput, WheelMode,
};
use crate::math::list::List;

/// A scene as written. By default a box of 1 m and 100 kg/m^3 at rest, without devices, debris and actuation.
///
/// ```
/// # extern crate spindrift_kernels as spindrift;
/// use spindrift::scene::{DebrisInput, Scene, SceneInput, WheelInput};
///
/// let scene = SceneInput::report()
///     .with_wheel(WheelInput::named("w3", [1.0, 0.0, 0.0], [0.0, 0.0, 1.5]))
///     .with_debris(DebrisInput::Cube { side_m: 0.2, density_kg_m3: 2700.0 })
///     .with("initial.angular_velocity_rad_s", &[0.0, 0.1, 0.5])
///     .with("wheels.w3.rate_rad_s", &[314.0]);
/// let scene = Scene::resolve(&scene).expect("physical");
/// assert_eq!(scene.initial.wheel_rates[..3], [0.0, 0.0, 314.0]);
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct SceneInput {
    /// The body as a whole.
    pub body: BodyInput,
    /// The parts of the body.
    pub parts: Vec<PartInput>,
    /// The wheels.
    pub wheels: Vec<WheelInput>,
    /// The thrusters.
    pub thrusters: Vec<ThrusterInput>,
    /// The torque rods.
    pub torque_rods: Vec<TorqueRodInput>,
    /// The debris body D, if there is one.
    pub debris: Option<DebrisInput>,
    /// The state at time zero.
    pub initial: InitialInput,
    /// Arcs of constant thrust and torque, in order, not overlapping.
    pub actuation: Vec<ActuationInput>,
    /// Delays of the actuators.
    pub actuators: ActuatorsInput,
    /// The orbit of the spacecraft, if any.
    pub orbit: Option<OrbitInput>,
    /// Plates for air and light; by default those of the parts.
    pub plates: Vec<PlateInput>,
    /// Effects of the environment.
    pub environment: EnvironmentInput,
    /// Parameters of the control law, if any.
    pub control: ControlInput,
    /// Failures of devices during a run.
    pub failures: Vec<FailureInput>,
}

impl Default for SceneInput {
    fn default() -> Self {
        let cube = PartInput {
            name: Name::of("cube"),
            shape: PartShape::Box,
            size_m: Some([1.0; 3]),
            density_kg_m3: Some(100.0),
            ..PartInput::DEFAULT
        };
        SceneInput { parts: vec![cube], ..SceneInput::blank() }
    }
}

impl SceneInput {
    /// An empty scene at rest.
    pub const fn blank() -> Self {
        SceneInput {
            body: BodyInput::DEFAULT,
            parts: Vec::new(),
            wheels: Vec::new(),
            thrusters: Vec::new(),
            torque_rods: Vec::new(),
            debris: None,
            initial: InitialInput::DEFAULT,
            actuation: Vec::new(),
            actuators: ActuatorsInput::DEFAULT,
            orbit: None,
            plates: Vec::new(),
            environment: EnvironmentInput::DEFAULT,
            control: ControlInput::NONE,
            failures: Vec::new(),
        }
    }

    /// The spacecraft of the paper (F. Berdoz, *Final Report - ADR Spacecraft*, Table II) at rest: a hollow cylinder,
    /// wheels w1 about s2 and w2 about s3, thrusters p1, p2, p3.
    pub fn report() -> Self {
        let fuselage = PartInput {
            name: Name::of("fuselage"),
            shape: PartShape::HollowCylinder,
            outer_radius_m: Some(1.0),
            wall_thickness_m: Some(0.03),
            length_m: Some(3.0),
            density_kg_m3: Some(2700.0),
            position_m: [0.0, 0.0, 1.5],
            ..PartInput::DEFAULT
        };
        SceneInput {
            parts: vec![fuselage],
            wheels: vec![
                WheelInput::named("w1", [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]),
                WheelInput::named("w2", [0.0, 0.0, 1.0], [0.0, 0.0, 2.0]),
            ],
            thrusters: vec![
                ThrusterInput::named("p1", [0.0; 3], [0.0, 0.0, 1.0]),
                ThrusterInput::named("p2", [0.0, -0.5, 3.0], [0.0, 0.0, -1.0]),
                ThrusterInput::named("p3", [0.0, 0.5, 3.0], [0.0, 0.0, -1.0]),
            ],
            ..SceneInput::blank()
        }
    }

    /// Adds a wheel.
    #[must_use]
    pub fn with_wheel(mut self, wheel: WheelInput) -> Self {
        self.wheels.push(wheel);
        self
    }

    /// Adds debris.
    #[must_use]
    pub fn with_debris(mut self, debris: DebrisInput) -> Self {
        self.debris = Some(debris);
        self
    }

    /// Appends an arc to the schedule.
    #[must_use]
    pub fn with_actuation(mut self, arc: ActuationInput) -> Self {
        self.actuation.push(arc);
        self
    }

    /// The turning wheels, in order.
    pub fn turning(&self) -> impl Iterator<Item = &WheelInput> {
        self.wheels.iter().filter(|wheel| wheel.mode != WheelMode::Locked)
    }

    /// Their names.
    pub fn turning_wheels(&self) -> List<Name, MAX_WHEELS> {
        let mut names = List::empty(Name::NONE);
        self.turning().for_each(|wheel| names.push(wheel.name));
        names
    }
}
