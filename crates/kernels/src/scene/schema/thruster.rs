//! `[[thrusters]]`: a thruster.

use super::rows::rows;
use crate::scene::name::Name;

rows! {
    /// A thruster, fixed in the body; its thrust is never negative.
    pub struct ThrusterInput in ThrusterInput [table => table] {
    position_m: [f64; 3] = [0.0; 3], "m", "Point of application from p, in F_s", Finite, required "[0, 0, 0]";
    direction: [f64; 3] = [0.0, 0.0, 1.0], "1",
        "Direction of the force on the spacecraft, in F_s; need not have length one", Direction, required "[0, 0, 1]";
    tilt_rad: [f64; 2] = [0.0; 2], "rad",
        "Alignment error: components of the rotation vector that turns the nominal direction into the true one, along \
        the two axes of F_s perpendicular to it (oblique directions: docs/campaign-files.md)", Finite;
    thrust_scale: f64 = 1.0, "1",
        "Scale factor for the commanded thrust", Thrust("write zero for a thruster that does not work");
    max_thrust_n: Option<f64> = None, "N",
        "Largest thrust that a control loop commands; for an on-off thruster, its thrust", Positive;
    min_on_time_s: Option<f64> = None, "s", "Shortest firing of an on-off thruster, under a control loop", NotNegative;
    } others {
        /// The name.
        name: Name = Name::NONE,
    }
}

impl ThrusterInput {
    /// The keys that act under a control loop alone.
    pub const DRIVE: [&'static str; 2] = ["max_thrust_n", "min_on_time_s"];

    /// The ideal thruster called `name` at `position_m` that pushes along `direction`.
    ///
    /// # Panics
    /// If `name` is no name.
    pub fn named(name: &str, position_m: [f64; 3], direction: [f64; 3]) -> Self {
        ThrusterInput { name: Name::of(name), position_m, direction, ..ThrusterInput::DEFAULT }
    }
}
