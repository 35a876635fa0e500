//! [`Growth`]: bounds of commands that hold a body.
//!
//! A loop under which small errors die away asks in a period T for a change of the rate of at most 4 pi/T + 2 |omega|,
//! since k T^2 < 4 and c T < 2 ([`crate::control::stability`]), and its rate comes from that at the start and from its
//! slews. A loop has diverged where it asks for more than [`TURN`]/T, of which the body would turn around a dozen times
//! until the next tick, and for more than [`RISE`] times the rate at the start. Disturbances and thrusters that are
//! stuck on are no commands.

use crate::control::plant::{Applied, Plant};
use crate::control::small_matrix::inverse;
use crate::control::vector::{cross, difference, norm, product, scaled, sum};
use crate::dynamics::actuation::Actuation;
use crate::scene::Scene;

/// The change of the rate in a period, times the period, rad.
const TURN: f64 = 100.0;
/// The change of the rate in a period, over the rate at the start.
const RISE: f64 = 1e3;

/// Bounds of the commands of a run.
#[derive(Clone, Copy, Debug)]
pub struct Growth {
    /// Inverse of K, 1/(kg m^2), F_s.
    inverse: [[f64; 3]; 3],
    /// The largest change of the rate in a control period, rad/s.
    most: f64,
    /// The control period, s.
    period: f64,
}

impl Growth {
    /// Bounds of a run of `scene` under a loop of `period` seconds.
    pub fn new(scene: &Scene, period: f64) -> Self {
        let start = norm(scene.initial.omega_se_s);
        let most = (TURN / period).max(RISE * start);
        Growth { inverse: inverse(scene.mass.inertia_rotating()), most, period }
    }

    /// The change of the rate in a control period, rad/s, by commands over an arc of `plant`, if that is beyond the
    /// bounds; the field is measured as `field_s`, T.
    pub fn beyond(
        &self,
        plant: &Plant,
        (actuation, applied): (&Actuation, &Applied),
        field_s: [f64; 3],
    ) -> Option<f64> {
        let scene = plant.scene();
        let mut torque = cross(actuation.dipole, field_s);
        for (wheel, motor) in scene.mass.wheels.iter().zip(actuation.motor_torque) {
            torque = difference(torque, scaled(motor, wheel.axis));
        }
        // a pulse ends before the period does
        let pulse = if plant.is_on_off() { applied.length.min(self.period) } else { self.period };
        let impulse = scaled(pulse, scene.thruster_torque_s(actuation.thrust));
        let change = norm(product(self.inverse, sum(scaled(self.period, torque), impulse)));
        (change > self.most).then_some(change)
    }
}
