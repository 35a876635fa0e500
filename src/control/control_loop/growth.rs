//! [`Growth`]: bounds on commands, beyond which a loop has diverged.
//!
//! Under a stable loop k T^2 < 4 and c T < 2 ([`crate::control::stability`]), so that in a period T it changes the rate
//! by at most 4 pi/T + 2 |omega|. Divergence is a change above both [`TURN`]/T, a dozen revolutions until the next
//! tick, and [`RISE`] times the initial rate. Disturbances and stuck thrusters do not count.

use crate::control::plant::{Applied, Plant};
use crate::control::small_matrix::inverse;
use crate::control::vector::{cross, difference, norm, product, scaled, sum};
use crate::dynamics::actuation::Actuation;
use crate::scene::Scene;

/// Change of the rate in a period, times the period, rad.
const TURN: f64 = 100.0;
/// Change of the rate in a period over the initial rate.
const RISE: f64 = 1e3;

/// Bounds on the commands of a run.
#[derive(Clone, Copy, Debug)]
pub struct Growth {
    /// Inverse of K, 1/(kg m^2), F_s.
    inverse: [[f64; 3]; 3],
    /// Largest change of the rate in a control period.
    most: f64,
    period: f64,
}

impl Growth {
    /// Bounds for a run of `scene` under a loop of period `period`.
    pub fn new(scene: &Scene, period: f64) -> Self {
        let start = norm(scene.initial.omega_se_s);
        let most = (TURN / period).max(RISE * start);
        Growth { inverse: inverse(scene.mass.inertia_rotating()), most, period }
    }

    /// The change of the rate in a control period by the commands of an arc, if beyond the bounds; `field_s` is the
    /// measured field.
    pub fn beyond(
        &self,
        plant: &Plant,
        (actuation, applied): (&Actuation, &Applied),
        field_s: [f64; 3],
    ) -> Option<f64> {
        let scene = &plant.drawn;
        let mut torque = cross(actuation.dipole, field_s);
        for (wheel, motor) in scene.mass.wheels.iter().zip(actuation.motor_torque) {
            torque = difference(torque, scaled(motor, wheel.axis));
        }
        // a pulse ends before the period does
        let pulse = if plant.is_on_off { applied.length.min(self.period) } else { self.period };
        let impulse = scaled(pulse, scene.thruster_torque_s(actuation.thrust));
        let change = norm(product(self.inverse, sum(scaled(self.period, torque), impulse)));
        (change > self.most).then_some(change)
    }
}
