//! Remaining impulse of a maneuver, and the attitude that it needs.

use super::FlightSoftware;
use crate::control::guidance::phase::Phase;
use crate::control::guidance::target::{TargetInput, VelocityToGo};
use crate::loops::launch_geometry::LaunchGeometry;
use crate::loops::phase::Maneuver;
use crate::loops::target::AttitudeError;
use crate::loops::vector::{dcm_from_quaternion, difference, product, scaled};
use crate::scene::MAX_THRUSTERS;

impl FlightSoftware {
    /// Remaining impulse per mass of the phase's maneuver.
    pub fn velocity_to_go(&self, geometry: Option<&LaunchGeometry>, time: f64) -> VelocityToGo {
        let Some(geometry) = geometry else { return VelocityToGo::default() };
        let phase = &self.phases[self.guidance.phase];
        match phase.maneuver() {
            Maneuver::None => VelocityToGo::default(),
            Maneuver::Stop => {
                let velocity_e = scaled(-1.0, geometry.relative_velocity);
                let change = difference([0.0; 3], geometry.acceleration());
                VelocityToGo { velocity_e, change_e: geometry.inertial_change(velocity_e, change) }
            }
            // during the burn the transfer time runs down, and the impulse keeps its direction
            Maneuver::Transfer if phase.thrust == Maneuver::Transfer => {
                let left = self.guidance.arrival - time;
                if left < self.spec.period - self.ticks.same() {
                    // the transfer time is over: the stop removes the rest
                    return VelocityToGo::default();
                }
                let velocity_e = geometry.transfer(left);
                VelocityToGo { velocity_e, change_e: geometry.inertial_change(velocity_e, [0.0; 3]) }
            }
            // before the burn the whole transfer is ahead
            Maneuver::Transfer => {
                let velocity_e = geometry.transfer(phase.transfer_time);
                let change = geometry.change_of_transfer(phase.transfer_time);
                VelocityToGo { velocity_e, change_e: geometry.inertial_change(velocity_e, change) }
            }
        }
    }

    /// Impulse per mass, in F_e, of commanded thrust that has yet to act at `time`, at the attitude `q_es`.
    fn on_its_way(&self, q_es: [f64; 4], time: f64) -> [f64; 3] {
        let (acting, waiting) = self.thrust_under_way.all();
        let mut impulse = [0.0; MAX_THRUSTERS];
        for &i in &self.spec.thrusters {
            let left = (acting.begin + acting.on_time[i] - time).clamp(0.0, acting.on_time[i]);
            impulse[i] = acting.thrust[i] * left;
        }
        for pulses in waiting {
            self.spec.thrusters.iter().for_each(|i| impulse[*i] += pulses.thrust[*i] * pulses.on_time[*i]);
        }
        let impulse_s = self.believed.thruster_force_s(impulse);
        scaled(1.0 / self.believed.mass.total, product(dcm_from_quaternion(q_es), impulse_s))
    }

    /// Attitude relative to the phase's target, and velocity to go in F_e.
    pub fn wanted(&self, geometry: Option<&LaunchGeometry>, time: f64) -> (AttitudeError, [f64; 3]) {
        let estimate = &self.estimate;
        let mut to_go = self.velocity_to_go(geometry, time);
        let Phase { target, thrust, .. } = self.phases[self.guidance.phase];
        if thrust != Maneuver::None {
            to_go.velocity_e = difference(to_go.velocity_e, self.on_its_way(estimate.q_es, time));
        }
        let orbit = if target.needs_orbit() { self.orbit_motion(time) } else { None };
        (TargetInput { geometry, to_go: &to_go, orbit }.error(target, estimate.q_es), to_go.velocity_e)
    }
}
