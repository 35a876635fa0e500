//! From a wanted torque and force to commands, and from these to the torques and thrusts of an arc.

use super::maneuver::stored_momentum;
use super::{ControlLoop, SAME_TIME};
use crate::control::estimate::Estimate;
use crate::control::guidance::phase::Maneuver;
use crate::control::guidance::target::{AttitudeError, Target};
use crate::control::laws::LawInput;
use crate::control::loop_record::set;
use crate::control::outcome::ArcApplied;
use crate::control::truth::Truth;
use crate::control::vector::{difference, dot, scaled, sum};
use crate::dynamics::actuation::{Actuation, BodyState, WheelState};
use crate::observables::Series;
use crate::scene::{MAX_THRUSTERS, MAX_WHEELS, WheelMode};

/// What the motors are commanded, N m, by wheel.
pub type MotorCommand = [f64; MAX_WHEELS];

/// What the thrusters are commanded.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pulses {
    /// When they begin, s.
    pub begin: f64,
    /// Thrusts while they last, N, by thruster.
    pub thrust: [f64; MAX_THRUSTERS],
    /// How long each lasts, s.
    pub on_time: [f64; MAX_THRUSTERS],
}

/// No thruster fires.
pub const NO_PULSES: Pulses = Pulses { begin: 0.0, thrust: [0.0; MAX_THRUSTERS], on_time: [0.0; MAX_THRUSTERS] };

impl ControlLoop {
    /// Commands what the law and the maneuver want.
    pub(super) fn command(
        &mut self,
        time: f64,
        estimate: &Estimate,
        error: &AttitudeError,
        velocity_to_go: [f64; 3],
        s3_e: [f64; 3],
    ) {
        let mass = &self.believed.mass;
        let input = LawInput {
            q_ts: error.q_ts,
            omega_se_s: estimate.omega_se_s,
            omega_te_s: error.omega_te_s,
            acceleration_te_s: [0.0; 3],
            momentum_s: self.known.momentum(mass, estimate.omega_se_s, &estimate.wheel_rates),
        };
        let phase = &self.phases[self.guidance.phase];
        // zero at the first tick of a phase
        let since = if self.guidance.since == time { 0.0 } else { self.spec.period };
        let torque = self.law.torque(&self.known, &input, since);
        let begin = time + self.delay;
        let (mut by_thrusters, mut mean) = ([0.0; 3], [0.0; MAX_THRUSTERS]);
        if let Some(allocation) = &self.thrusters {
            let mut wanted = self.wheels.as_ref().map_or(torque, |wheels| wheels.out_of_reach(torque));
            if let Some(unloading) = &phase.unloading {
                let stored = stored_momentum(&self.believed, estimate);
                wanted = sum(wanted, unloading.torque(stored, self.two_sided));
            }
            let force = match phase.thrust {
                Maneuver::None => self.spec.holds_force.then_some([0.0; 3]),
                _ => {
                    let along = mass.total * dot(velocity_to_go, s3_e) / self.spec.period;
                    // where s3 is turned for the thruster that pushes along it, none brakes
                    let only_forward = matches!(phase.target, Target::Transfer | Target::Stop);
                    Some([0.0, 0.0, if only_forward { along.max(0.0) } else { along }])
                }
            };
            let thrust = allocation.allocate(force, wanted);
            let mut pulses = Pulses { begin, ..NO_PULSES };
            for &i in &self.spec.thrusters {
                let period = self.spec.period;
                let pulse = self.thruster_drives[i].over(thrust[i], period, &mut self.pulses[i]);
                (pulses.thrust[i], pulses.on_time[i]) = (pulse.thrust, pulse.on_time);
                mean[i] = pulse.thrust * pulse.on_time / period;
            }
            by_thrusters = self.believed.thruster_torque_s(mean);
            self.thrust_commands.push(begin, pulses);
        }
        let mut motor_torque = [0.0; MAX_WHEELS];
        if let Some(allocation) = &self.wheels {
            let motors = allocation.motors(difference(torque, by_thrusters));
            self.spec.wheels.iter().zip(motors).for_each(|(place, motor)| motor_torque[*place] = motor);
        }
        let total =
            motor_torque.iter().sum::<f64>() + self.spec.thrusters.iter().map(|place| mean[*place]).sum::<f64>();
        if !total.is_finite() {
            self.has_ended = true;
            self.outcome.diverges(time);
            return;
        }
        self.motor_commands.push(begin, motor_torque);
        if self.recorder.is_some() {
            self.latest = (motor_torque, mean);
        }
    }

    /// What the actuators make of the command from `time` on, and until when.
    pub(super) fn applied(&mut self, time: f64, body: &BodyState, wheels: &WheelState) -> Actuation {
        let same = SAME_TIME * self.spec.period;
        let (motor_torque, next_motors) = self.motor_commands.at(time + same);
        let motor_torque = *motor_torque;
        let mut until = self.next_tick.min(next_motors);
        let (mut thrust, mut commanded) = ([0.0; MAX_THRUSTERS], [0.0; MAX_THRUSTERS]);
        if !self.spec.thrusters.is_empty() {
            let (pulses, next_pulses) = self.thrust_commands.at(time + same);
            until = until.min(next_pulses);
            for &i in &self.spec.thrusters {
                let valve = &self.drawn.actuators.thrusters[i];
                let (level, least) = if self.is_on_off {
                    (valve.max_thrust, valve.min_on_time)
                } else {
                    (pulses.thrust[i].min(valve.max_thrust), 0.0)
                };
                let end = pulses.begin + pulses.on_time[i].max(least);
                if pulses.thrust[i] > 0.0 && end > time + same {
                    (thrust[i], commanded[i]) = (level, pulses.thrust[i]);
                    until = until.min(end);
                }
            }
        }
        // the run ends an arc too
        let length = until.min(self.duration) - time;
        let mut actuation = Actuation::none(until);
        let (mut saturated, mut excess) = ([false; 2], 0.0_f64);
        // a wheel whose speed is held has a motor of its own
        for (i, drive) in self.wheel_drives[..self.drawn.mass.wheels.len()].iter().enumerate() {
            if self.drawn.mass.wheels[i].mode != WheelMode::Free {
                continue;
            }
            let driven = drive.over(motor_torque[i], wheels.rates[i], length);
            actuation.motor_torque[i] = driven.torque;
            set(&mut self.over_time, Series::MotorTorque.of_wheel(i), driven.torque);
            saturated[0] |= driven.is_torque_limited;
            saturated[1] |= driven.is_speed_limited;
            excess = excess.max(driven.excess);
        }
        if !saturated[1] {
            self.saturated_since = f64::NAN;
        } else if self.saturated_since.is_nan() {
            self.saturated_since = time;
        }
        let mut hits = false;
        if thrust != [0.0; MAX_THRUSTERS] {
            for &i in &self.spec.thrusters {
                actuation.thrust[i] = self.drawn.actuators.thrusters[i].thrust_scale * thrust[i];
            }
            self.commanded[0] = sum(self.commanded[0], scaled(length, self.believed.thruster_force_s(commanded)));
            self.commanded[1] = sum(self.commanded[1], scaled(length, self.believed.thruster_torque_s(commanded)));
            if self.spec.approaches() {
                let truth = Truth::new(&self.drawn, time, body, wheels, self.debris.as_mut());
                hits = self.outcome.plume_hits(&self.drawn, &truth, &actuation.thrust, &self.judgement);
            }
        }
        let applied = ArcApplied { length, thrust: actuation.thrust, hits, saturated, torque_excess: excess };
        self.outcome.arc(&self.drawn, &applied);
        if self.spec.knows_the_truth() {
            // only filters ask what was commanded
            return actuation;
        }
        for (i, wheel) in self.believed.mass.wheels.iter().enumerate() {
            let most = self.believed.actuators.wheels[i].torque_limit;
            let impulse = length * motor_torque[i].clamp(-most, most);
            self.commanded[1] = difference(self.commanded[1], scaled(impulse, wheel.axis));
            self.commanded_motors[i] += impulse;
        }
        actuation
    }
}
