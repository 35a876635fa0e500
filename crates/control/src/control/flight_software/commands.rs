//! From a wanted torque and force to commands, and the commands that act.

use super::{CommandedImpulse, FlightSoftware, Guided};
use crate::control::allocation::rods::NO_DIPOLES;
use crate::control::bus::{ActingCommands, Commanded, Pulses};
use crate::control::tick_times::SAME_TIME;
use crate::loops::attitude_law::{LawInput, stored_momentum};
use crate::loops::failure::Failure;
use crate::loops::phase::Maneuver;
use crate::loops::sensor_spec::Readings;
use crate::loops::target::Target;
use crate::loops::vector::{cross, dcm_from_quaternion, difference, dot, product, scaled, sum};
use crate::scene::{MAX_THRUSTERS, MAX_WHEELS};

impl FlightSoftware {
    /// Commands the torque of the law and the force of the maneuver.
    ///
    /// # Errors
    /// If the law stops or a command is not finite; then nothing is commanded.
    pub fn command(&mut self, time: f64, guided: &Guided) -> Result<(), Failure> {
        let (estimate, error) = (&self.estimate, &guided.error);
        let mass = &self.believed.mass;
        let input = LawInput {
            q_ts: error.q_ts,
            omega_se_s: estimate.omega_se_s,
            omega_te_s: error.omega_te_s,
            acceleration_te_s: [0.0; 3],
            momentum_s: self.body.momentum(mass, estimate.omega_se_s, &estimate.wheel_rates),
            time,
            estimate: Some(estimate),
            readings: Readings { sensors: &self.spec.sensors, last: &self.readings },
        };
        let phase = &self.phases[self.guidance.phase];
        // zero at the first tick of a phase
        let since = if self.guidance.since == time { 0.0 } else { self.spec.period };
        let torque = self.law.torque(&self.body, &input, since);
        if !torque.iter().all(|component| component.is_finite()) {
            return Err(self.law.failure().unwrap_or(Failure::Diverged));
        }
        let begin = time + self.delay;
        let (mut by_thrusters, mut mean) = ([0.0; 3], [0.0; MAX_THRUSTERS]);
        if let Some(allocation) = &self.thrusters {
            let mut wanted = self.wheels.as_ref().map_or(torque, |wheels| wheels.out_of_reach(torque));
            if let Some(unloading) = &phase.unloading {
                let stored = stored_momentum(mass, &estimate.wheel_rates);
                wanted = sum(wanted, unloading.torque(stored, self.two_sided));
            }
            let force = match phase.thrust {
                Maneuver::None => self.spec.holds_force.then_some([0.0; 3]),
                _ => {
                    let s3_e = product(dcm_from_quaternion(estimate.q_es), [0.0, 0.0, 1.0]);
                    let along = mass.total * dot(guided.velocity_to_go, s3_e) / self.spec.period;
                    // no thruster brakes if s3 is turned for one that pushes along it
                    let only_forward = matches!(phase.target, Target::Transfer | Target::Stop);
                    Some([0.0, 0.0, if only_forward { along.max(0.0) } else { along }])
                }
            };
            let thrust = allocation.allocate(force, wanted);
            let mut pulses = Pulses { begin, ..Pulses::default() };
            for &i in &self.spec.thrusters {
                let period = self.spec.period;
                let valve = &self.believed.actuators.thrusters[i];
                let pulse = self.thrust_mode.over(valve, thrust[i], period, &mut self.pulses[i]);
                (pulses.thrust[i], pulses.on_time[i]) = (pulse.thrust, pulse.on_time);
                mean[i] = pulse.thrust * pulse.on_time / period;
            }
            by_thrusters = self.believed.thruster_torque_s(mean);
            self.thrust_under_way.push(begin, pulses);
        }
        let (mut by_others, mut rods) = (by_thrusters, NO_DIPOLES);
        if let Some(allocation) = &self.rods {
            let wanted = self.field.dipole(phase.rods, stored_momentum(mass, &estimate.wheel_rates));
            rods = allocation.limited(wanted);
            self.rods_under_way.push(begin, rods);
            if phase.rods.unloads() {
                by_others = sum(by_others, cross(allocation.dipole(&rods.dipoles), self.field.field_s));
            }
        }
        let mut motor_torque = [0.0; MAX_WHEELS];
        if let Some(allocation) = &self.wheels {
            let motors = allocation.motors(difference(torque, by_others));
            self.spec.wheels.iter().zip(motors).for_each(|(place, motor)| motor_torque[*place] = motor);
        }
        let total = motor_torque.iter().sum::<f64>()
            + self.spec.thrusters.iter().map(|place| mean[*place]).sum::<f64>()
            + rods.dipoles.iter().sum::<f64>();
        if !total.is_finite() {
            return Err(Failure::Diverged);
        }
        self.motors_under_way.push(begin, motor_torque);
        if self.is_recorded {
            self.latest = Commanded { motor_torque, thrust: mean, dipoles: rods.dipoles };
        }
        Ok(())
    }

    /// The commands that act at `time`, which does not descend.
    pub fn acting(&mut self, time: f64) -> ActingCommands<'_> {
        let same = SAME_TIME * self.spec.period;
        let (motor_torque, mut until) = self.motors_under_way.at(time + same);
        let mut pulses = None;
        if !self.spec.thrusters.is_empty() {
            let (acting, next) = self.thrust_under_way.at(time + same);
            (pulses, until) = (Some(acting), until.min(next));
        }
        let mut rods = &NO_DIPOLES;
        if self.rods.is_some() {
            let next;
            (rods, next) = self.rods_under_way.at(time + same);
            until = until.min(next);
        }
        ActingCommands { motor_torque, pulses, rods, until }
    }

    /// Accumulates the commands acting for `length` seconds from `time` on, for the estimator.
    pub fn count(&mut self, time: f64, length: f64) {
        if self.spec.knows_the_truth() {
            // only filters need them
            return;
        }
        let same = SAME_TIME * self.spec.period;
        if !self.spec.thrusters.is_empty() {
            let (pulses, _) = self.thrust_under_way.all();
            let mut thrust = [0.0; MAX_THRUSTERS];
            for &i in &self.spec.thrusters {
                // a real valve may fire longer than its believed pulse
                let left = pulses.begin + pulses.on_time[i] - time;
                if left > same {
                    thrust[i] = pulses.thrust[i] * if left < length - same { left / length } else { 1.0 };
                }
            }
            if thrust != [0.0; MAX_THRUSTERS] {
                let CommandedImpulse { force_s, torque_s, .. } = &mut self.commanded;
                *force_s = sum(*force_s, scaled(length, self.believed.thruster_force_s(thrust)));
                *torque_s = sum(*torque_s, scaled(length, self.believed.thruster_torque_s(thrust)));
            }
        }
        if let Some(allocation) = &self.rods {
            let (command, _) = self.rods_under_way.all();
            let torque = cross(allocation.dipole(&command.dipoles), self.field.field_s);
            self.commanded.torque_s = sum(self.commanded.torque_s, scaled(length, torque));
        }
        let (motor_torque, _) = self.motors_under_way.all();
        for (i, wheel) in self.believed.mass.wheels.iter().enumerate() {
            let most = self.believed.actuators.wheels[i].torque_limit;
            let impulse = length * motor_torque[i].clamp(-most, most);
            self.commanded.torque_s = difference(self.commanded.torque_s, scaled(impulse, wheel.axis));
            self.commanded.motors[i] += impulse;
        }
    }
}
