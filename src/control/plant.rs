//! [`Plant`]: the truth of one run: the scene that is flown, its sensors, and what its actuators make of commands.
//!
//! [`super::bus`]: what passes between it and flight software.

use std::sync::Arc;

use super::actuators::WheelDrive;
use super::bus::{ActingCommands, Measurements};
use super::estimate::Estimate;
use super::measurement::Measurement;
use super::sensors::SampledSensor;
use super::spec::LoopSpec;
use super::tick_times::SAME_TIME;
use super::truth::{DebrisMotion, Truth};
use super::vector::{scaled, sum};
use crate::dynamics::actuation::{Actuation, BodyState, OpenLoop, WheelState};
use crate::scene::{Device, FailureInput, MAX_THRUSTERS, Scene, WheelMode};

/// The answer of the actuators to commands over an arc.
#[derive(Clone, Copy, Debug)]
pub struct Applied {
    /// True if a thruster fires, or is stuck on.
    pub fires: bool,
    /// The length of the arc, s: to its end or that of the run.
    pub length: f64,
    /// True if a motor was limited by its torque, and by the speed of its wheel.
    pub saturated: [bool; 2],
    /// Largest commanded torque beyond a limit, N m.
    pub torque_excess: f64,
    /// True if a limit of a rod cut the wanted dipole.
    pub is_rod_saturated: bool,
    /// The thrusts of the schedule over the arc, those of thrusters that are stuck on among them, N.
    pub scheduled_thrust: [f64; MAX_THRUSTERS],
}

/// The truth of one run.
pub struct Plant {
    spec: Arc<LoopSpec>,
    drawn: Scene,
    debris: Option<DebrisMotion>,
    sensors: Vec<SampledSensor>,
    wheel_drives: Vec<WheelDrive>,
    is_on_off: bool,
    /// The duration of the campaign and the end of the run, s.
    duration: f64,
    end: f64,
    delivered: Vec<Measurement>,
    /// The measurement of the ideal sensor of a loop with perfect knowledge.
    state: Option<Estimate>,
}

impl Plant {
    /// A run of the scene `drawn` for `duration` seconds that ends at `end`, measured by `sensors`, with a motor for
    /// each wheel that turns.
    pub fn new(
        spec: &Arc<LoopSpec>,
        drawn: Scene,
        (sensors, wheel_drives): (Vec<SampledSensor>, Vec<WheelDrive>),
        [duration, end]: [f64; 2],
    ) -> Self {
        Plant {
            debris: DebrisMotion::of(&drawn),
            delivered: Vec::with_capacity(sensors.len()),
            is_on_off: super::actuators::modulation::is_on_off(spec.modulation),
            spec: spec.clone(),
            drawn,
            sensors,
            wheel_drives,
            duration,
            end,
            state: None,
        }
    }

    /// The scene that is flown.
    pub fn scene(&self) -> &Scene {
        &self.drawn
    }

    /// True if thrusters are on or off.
    pub fn is_on_off(&self) -> bool {
        self.is_on_off
    }

    /// The true state at `time`, s, where the engine has this motion. Times do not descend.
    pub fn truth(&mut self, time: f64, body: &BodyState, wheels: &WheelState) -> Truth {
        Truth::new(&self.drawn, time, body, wheels, self.debris.as_mut())
    }

    /// The measurements delivered at tick number `tick`. Ticks are called in order.
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

    /// The last measurements, delivered at `time`, s.
    pub fn measurements(&self, time: f64) -> Measurements<'_> {
        Measurements { time, delivered: &self.delivered, state: self.state.as_ref() }
    }

    /// The true bias of the gyro, in F_s, rad/s; `None` without one.
    pub fn gyro_bias_s(&self) -> Option<[f64; 3]> {
        self.sensors.iter().find_map(|sensor| sensor.sensor().bias_s())
    }

    /// The failure of `device` by `time`, s.
    fn failure(&self, device: Device, time: f64) -> Option<&FailureInput> {
        self.drawn.failures.iter().find(|failure| failure.device == device && failure.at_s <= time)
    }

    /// The thrusters that have failed by `time`, s, with the thrusts at which they are stuck, N.
    fn stuck(&self, time: f64) -> impl Iterator<Item = (usize, f64)> + '_ {
        let same = SAME_TIME * self.spec.period;
        self.drawn.failures.iter().filter_map(move |failure| match failure.device {
            Device::Thruster(i) if failure.at_s <= time + same => Some((i, failure.thrust_n.unwrap_or(0.0))),
            _ => None,
        })
    }

    /// The thrusts of all thrusters from `time` on, N, those that are stuck on among them, where `actuation` acts.
    pub fn thrust(&self, time: f64, actuation: &Actuation) -> [f64; MAX_THRUSTERS] {
        let mut thrust = actuation.thrust;
        self.stuck(time).for_each(|(i, stuck)| thrust[i] = stuck);
        thrust
    }

    /// Applies `commands` from `time` on: writes the torques and thrusts of the actuators, and the end of the arc, to
    /// `actuation`, in which nothing acts. The torques that the schedule of the scene commands add to those
    /// of the motors; its thrusts are returned.
    pub fn apply(
        &self,
        time: f64,
        commands: &ActingCommands<'_>,
        wheels: &WheelState,
        actuation: &mut Actuation,
    ) -> Applied {
        let same = SAME_TIME * self.spec.period;
        let scheduled = OpenLoop { schedule: &self.drawn.schedule }.at(time + same);
        let mut until = commands.until.min(scheduled.until);
        // an actuator that fails ends the arc, unless it is one time with its end
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
        // the end of the campaign ends an arc too; where an event does, what has acted is what would act until then
        let held = until.min(self.duration) - time;
        let length = until.min(self.end) - time;
        actuation.until = until;
        let (mut saturated, mut torque_excess) = ([false; 2], 0.0_f64);
        // a wheel whose speed is held has a motor of its own
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
