//! [`Plant`]: the truth of one run: its drawn scene, its sensors, and the response of its actuators to commands
//! ([`super::bus`]).

use std::sync::Arc;

use super::actuators::WheelDrive;
use super::bus::{ActingCommands, Measurements};
use super::sensors::SampledSensor;
use super::tick_times::SAME_TIME;
use super::truth::{DebrisMotion, Truth};
use crate::dynamics::actuation::{Actuation, BodyState, WheelState, actuation_at};
use crate::loops::estimate::Estimate;
use crate::loops::measurement::Measurement;
use crate::loops::spec::LoopSpec;
use crate::loops::vector::{scaled, sum};
use crate::scene::{Device, FailureInput, MAX_THRUSTERS, Scene, WheelMode};

/// Response of the actuators over an arc.
#[derive(Clone, Copy, Debug)]
pub struct Applied {
    /// True if a thruster fires or is stuck on.
    pub fires: bool,
    /// Length of the arc, to its end or that of the run.
    pub length: f64,
    /// True if a motor reached its torque limit, and its wheel's speed limit.
    pub saturated: [bool; 2],
    /// Largest commanded torque beyond a limit.
    pub torque_excess: f64,
    /// True if a rod saturated.
    pub is_rod_saturated: bool,
    /// Scheduled thrusts over the arc, including stuck thrusters.
    pub scheduled_thrust: [f64; MAX_THRUSTERS],
}

pub struct Plant {
    spec: Arc<LoopSpec>,
    /// The flown scene.
    pub drawn: Scene,
    debris: Option<DebrisMotion>,
    sensors: Vec<SampledSensor>,
    wheel_drives: Vec<WheelDrive>,
    /// True if thrusters are on or off.
    pub is_on_off: bool,
    /// Duration of the campaign and end of the run.
    duration: f64,
    end: f64,
    delivered: Vec<Measurement>,
    /// Output of the ideal sensor of a loop with perfect knowledge.
    state: Option<Estimate>,
}

impl Plant {
    /// A run of `drawn` over `duration` seconds that ends at `end`, with a drive for each turning wheel.
    pub fn new(spec: &Arc<LoopSpec>, drawn: Scene, sensors: Vec<SampledSensor>, [duration, end]: [f64; 2]) -> Self {
        Plant {
            debris: DebrisMotion::of(&drawn),
            delivered: Vec::with_capacity(sensors.len()),
            wheel_drives: WheelDrive::of(&drawn),
            is_on_off: super::actuators::modulation::is_on_off(spec.modulation),
            spec: spec.clone(),
            drawn,
            sensors,
            duration,
            end,
            state: None,
        }
    }

    /// The true state for the engine's motion at `time`; times do not descend.
    pub fn truth(&mut self, time: f64, body: &BodyState, wheels: &WheelState) -> Truth {
        Truth {
            time,
            body: *body,
            r_cp_s: self.drawn.mass.center,
            wheel_rates: wheels.rates,
            debris: self.debris.as_mut().map(|motion| motion.at(time)),
        }
    }

    /// The measurements delivered at tick `tick`; ticks are in order.
    pub fn measure(&mut self, tick: u64, truth: &Truth) -> Measurements<'_> {
        self.delivered.clear();
        for (place, sensor) in self.sensors.iter_mut().enumerate() {
            self.delivered.extend(sensor.deliver(place, tick, truth));
        }
        if self.spec.knows_the_truth() {
            self.state = Some(truth.state());
        }
        self.measurements(truth.time)
    }

    /// The last measurements, delivered at `time`.
    pub fn measurements(&self, time: f64) -> Measurements<'_> {
        Measurements { time, delivered: &self.delivered, state: self.state.as_ref() }
    }

    /// True gyro bias in F_s, if there is a gyro.
    pub fn gyro_bias_s(&self) -> Option<[f64; 3]> {
        self.sensors.iter().find_map(|sensor| sensor.sensor.bias_s())
    }

    fn failure(&self, device: Device, time: f64) -> Option<&FailureInput> {
        self.drawn.failures.iter().find(|failure| failure.device == device && failure.at_s <= time)
    }

    /// Thrusters that have failed by `time`, with the thrusts at which they are stuck.
    fn stuck(&self, time: f64) -> impl Iterator<Item = (usize, f64)> + '_ {
        let same = SAME_TIME * self.spec.period;
        self.drawn.failures.iter().filter_map(move |failure| match failure.device {
            Device::Thruster(i) if failure.at_s <= time + same => Some((i, failure.thrust_n.unwrap_or(0.0))),
            _ => None,
        })
    }

    /// All thrusts from `time` on under `actuation`, including stuck thrusters.
    pub fn thrust(&self, time: f64, actuation: &Actuation) -> [f64; MAX_THRUSTERS] {
        let mut thrust = actuation.thrust;
        self.stuck(time).for_each(|(i, stuck)| thrust[i] = stuck);
        thrust
    }

    /// Applies `commands` from `time` on: writes torques, thrusts and the end of the arc to the empty `actuation`.
    /// Scheduled motor torques are added; scheduled thrusts are returned.
    pub fn apply(
        &self,
        time: f64,
        commands: &ActingCommands<'_>,
        wheels: &WheelState,
        actuation: &mut Actuation,
    ) -> Applied {
        let same = SAME_TIME * self.spec.period;
        let scheduled = actuation_at(&self.drawn.schedule, time + same);
        let mut until = commands.until.min(scheduled.until);
        // a failing actuator ends the arc, unless it does so within rounding of its end
        let of_actuators = self.drawn.failures.iter().filter(|failure| !matches!(failure.device, Device::Sensor(_)));
        for failure in of_actuators.filter(|failure| time + same < failure.at_s) {
            if failure.at_s < until - same {
                until = failure.at_s;
            }
        }
        let mut fires = false;
        if let Some(pulses) = commands.pulses {
            for &i in &self.spec.thrusters {
                if self.failure(Device::Thruster(i), time + same).is_some() {
                    continue;
                }
                let valve = &self.drawn.actuators.thrusters[i];
                let (level, least) = if self.is_on_off {
                    (valve.max_thrust, valve.min_on_time)
                } else {
                    (pulses.thrust[i].min(valve.max_thrust), 0.0)
                };
                let end = pulses.begin + pulses.on_time[i].max(least);
                if pulses.thrust[i] > 0.0 && end > time + same {
                    actuation.thrust[i] = self.drawn.actuators.thrusters[i].thrust_scale * level;
                    fires |= actuation.thrust[i] != 0.0;
                    until = until.min(end);
                }
            }
        }
        fires |= self.stuck(time).any(|(_, thrust)| thrust != 0.0);
        // the end of the campaign ends an arc too; after an event nothing is undone
        let held = until.min(self.duration) - time;
        let length = until.min(self.end) - time;
        actuation.until = until;
        let (mut saturated, mut torque_excess) = ([false; 2], 0.0_f64);
        // a wheel held at its speed has its own motor
        for (i, drive) in self.wheel_drives.iter().enumerate() {
            if self.drawn.mass.wheels[i].mode != WheelMode::Free {
                continue;
            }
            let (mut commanded, rate) = (commands.motor_torque[i], wheels.rates[i]);
            if scheduled.motor_torque[i] != 0.0 {
                commanded += scheduled.motor_torque[i];
            }
            let driven = match self.failure(Device::Wheel(i), time + same) {
                Some(failure) => drive.failed(failure).over(commanded, rate, held),
                None => drive.over(commanded, rate, held),
            };
            actuation.motor_torque[i] = driven.torque;
            saturated[0] |= driven.is_torque_limited;
            saturated[1] |= driven.is_speed_limited;
            torque_excess = torque_excess.max(driven.excess);
        }
        for &i in &self.spec.rods {
            let rod = &self.drawn.torque_rods[i];
            let failed = self.failure(Device::Rod(i), time + same).map(|failure| failure.dipole_a_m2.unwrap_or(0.0));
            let dipole = failed.unwrap_or(rod.scale * commands.rods.dipoles[i]);
            actuation.dipole = sum(actuation.dipole, scaled(dipole, rod.axis));
        }
        let is_rod_saturated = commands.rods.is_limited;
        Applied { fires, length, saturated, torque_excess, is_rod_saturated, scheduled_thrust: scheduled.thrust }
    }
}
