//! Torques of wheels and thrusts of thrusters under the commands of a control loop.

use crate::prelude::*;
use nalgebra::{Matrix3, Vector3};
use spindrift::scene::{Arc, WheelModel};

use crate::loops::flown_loop::{SAME_TIME, State};

const AGREED: f64 = 1e-12;

#[derive(Clone, Copy, Debug)]
pub struct Driven {
    pub torque: f64,
    /// Commanded torque, with its scale and bias, beyond that of the motor, N m.
    pub excess: f64,
    pub is_torque_limited: bool,
    pub is_speed_limited: bool,
    pub is_stopped: bool,
}

pub fn driven(scene: &Scene, wheel: usize, commanded: f64, rate: f64, length: f64) -> Driven {
    let model: WheelModel = scene.actuators.wheels[wheel];
    // Omega' = tau (1/J + a.K^-1 a): the body takes the opposite torque
    let of_wheel = scene.mass.wheels[wheel];
    let axis = Vector3::from(of_wheel.axis);
    let rows = scene.mass.inertia_free.concat();
    let inverse = Matrix3::from_row_slice(&rows).try_inverse().unwrap();
    let inertia = 1.0 / (1.0 / of_wheel.axial + axis.dot(&(inverse * axis)));
    let asked = if commanded == 0.0 { 0.0 } else { model.torque_scale * commanded + model.torque_bias };
    let within = asked.abs().min(model.torque_limit) * asked.signum();
    let along = rate * within.signum();
    let against = if along > 0.0 { model.coulomb_friction + model.viscous_friction * along } else { 0.0 };
    let room = (inertia * (model.speed_limit - along) / length + against).max(0.0);
    let motor = within.abs().min(room) * within.signum();
    let mut after = rate + motor * length / inertia;
    let mut friction = 0.0;
    if after * rate > 0.0 {
        let torque = (model.viscous_friction * rate.abs()).min(after.abs() * inertia / length);
        friction -= torque * rate.signum();
        after -= torque * length / inertia * rate.signum();
    }
    let to_stop = after.abs() * inertia / length;
    friction -= model.coulomb_friction.min(to_stop) * after.signum();
    Driven {
        torque: motor + friction,
        excess: (asked - motor).abs(),
        is_torque_limited: asked.abs() > model.torque_limit,
        is_speed_limited: within.abs() > room * (1.0 + AGREED),
        is_stopped: model.coulomb_friction > 0.0 && to_stop < model.coulomb_friction,
    }
}

pub fn driven_wheels(flown: &FlownLoop) -> Vec<Vec<Driven>> {
    let spec = flown.spec();
    let commands: Vec<Vec<f64>> = spec
        .wheels
        .iter()
        .map(|wheel| flown.told(&format!("commanded_torque_{}_n_m", spec.wheel_names[*wheel])))
        .collect();
    let of_arc = |(arc, state): &(Arc, State)| {
        let tick = acting(flown, arc.start);
        let wheels = 0..flown.run.scene.mass.wheels.len();
        wheels
            .map(|wheel| {
                let place = spec.wheels.iter().position(|driven| *driven == wheel);
                let commanded = place.zip(tick).map_or(0.0, |(place, tick)| commands[place][tick]);
                driven(&flown.run.scene, wheel, commanded, state.wheel_rates[wheel], arc.end() - arc.start)
            })
            .collect()
    };
    flown.arcs.iter().map(of_arc).collect()
}

pub fn acting(flown: &FlownLoop, time: f64) -> Option<usize> {
    let delay = flown.control("delay_s");
    let came = |state: &State| state.time + delay < time + SAME_TIME;
    flown.ticks.partition_point(came).checked_sub(1)
}

fn assert_driven(flown: &FlownLoop) -> [usize; 4] {
    let mut met = [0; 4];
    for ((arc, state), wheels) in flown.arcs.iter().zip(driven_wheels(flown)) {
        for (wheel, driven) in wheels.iter().enumerate() {
            let model = flown.run.scene.actuators.wheels[wheel];
            let scale = model.torque_limit.min(1.0);
            let off = arc.applied.motor_torque[wheel] - driven.torque;
            assert!(off.abs() < AGREED * scale, "{} s, wheel {wheel} at {state:?}: {off:e}, {driven:?}", arc.start);
            met[0] += usize::from(driven.is_torque_limited);
            met[1] += usize::from(driven.is_speed_limited);
            met[2] += usize::from(driven.is_stopped);
            met[3] += usize::from(!driven.is_torque_limited && !driven.is_speed_limited && !driven.is_stopped);
        }
    }
    met
}

pub fn limited_slew() -> String {
    changed(
        SLEW_CLOSED,
        &[
            ("duration_s = \"3 min\"", "duration_s = 70.1"),
            ("time_s >= 30", "time_s >= 5"),
            ("torque_limit_n_m = 0.02", "torque_limit_n_m = 0.007\ncoulomb_friction_n_m = 3e-4"),
            ("speed_limit_rad_s = \"4000 rpm\"", "speed_limit_rad_s = 45"),
            ("viscous_friction_n_m_s = 1e-6", "viscous_friction_n_m_s = 2e-5"),
        ],
    ) + "\n[[disperse]]\nparameter = \"wheels.w2.torque_bias_n_m\"\ndistribution = \"offset\"\noffset = 2e-4\n"
}

/// Law: a motor gives the command of `delay_s` before, with scale and bias, within its limits, less friction.
#[test]
fn motors_give_what_their_wheels_make_of_the_commands() {
    for delay in ["0.0", "0.05", "0.25", "0.6"] {
        let text = changed(&limited_slew(), &[("delay_s = 0.05", &format!("delay_s = {delay}"))]);
        let met = assert_driven(&FlownLoop::new(&text, 3));
        assert!(met.iter().all(|count| *count > 20), "each effect is met, delay {delay}: {met:?}");
    }
    let detumble = changed(DETUMBLE, &[("duration_s = \"10 min\"", "duration_s = 90.2")]);
    let met = assert_driven(&FlownLoop::new(&detumble, 5));
    assert!(met[3] > 100, "{met:?}");
}

fn assert_fired(flown: &FlownLoop, is_on_off: bool) -> usize {
    let spec = flown.spec();
    let (period, delay) = (spec.period, flown.control("delay_s"));
    let mut pulses = 0;
    for thruster in spec.thrusters.iter().copied() {
        let commands = flown.told(&format!("commanded_thrust_{}_n", spec.thruster_names[thruster]));
        let believed = flown.plan.nominal.thrusters[thruster].max_thrust_n.unwrap_or(f64::INFINITY);
        let drawn = flown.run.scene.actuators.thrusters[thruster];
        for (arc, _) in &flown.arcs {
            for share in [1e-4, 0.5, 1.0 - 1e-4] {
                let time = arc.start + share * (arc.end() - arc.start);
                let expected = acting(flown, time).map_or(0.0, |tick| {
                    let since = time - (flown.ticks[tick].time + delay);
                    let mean = commands[tick];
                    if !is_on_off {
                        return drawn.thrust_scale * mean.min(drawn.max_thrust);
                    }
                    let on_time = (mean / believed * period).max(drawn.min_on_time);
                    if mean > 0.0 && since < on_time { drawn.thrust_scale * drawn.max_thrust } else { 0.0 }
                });
                let found = arc.applied.thrust[thruster];
                assert!((found - expected).abs() < AGREED * 20.0, "p{thruster} at {time}: {found} for {expected}");
            }
        }
        let thrusts = flown.arcs.windows(2).map(|pair| [0, 1].map(|arc| pair[arc].0.applied.thrust[thruster]));
        pulses += thrusts.filter(|[before, after]| before > after).count();
    }
    pulses
}

fn assert_begun(flown: &FlownLoop, is_on_off: bool) -> usize {
    let spec = flown.spec();
    let (period, delay) = (spec.period, flown.control("delay_s"));
    let mut instants: Vec<f64> = flown.ticks.iter().flat_map(|tick| [tick.time, tick.time + delay]).collect();
    let mut believed_ends = Vec::new();
    for thruster in spec.thrusters.iter().copied() {
        let commands = flown.told(&format!("commanded_thrust_{}_n", spec.thruster_names[thruster]));
        let believed = flown.plan.nominal.thrusters[thruster].max_thrust_n.unwrap_or(f64::INFINITY);
        let least = if is_on_off { flown.run.scene.actuators.thrusters[thruster].min_on_time } else { 0.0 };
        for (mean, tick) in commands.iter().zip(&flown.ticks).filter(|(mean, _)| **mean > 0.0) {
            let on_time = if is_on_off { mean / believed * period } else { period };
            instants.push(tick.time + delay + on_time.max(least));
            believed_ends.push(tick.time + delay + on_time);
        }
    }
    let is_among = |list: &[f64], time: f64| list.iter().any(|other| (other - time).abs() < SAME_TIME);
    let starts: Vec<f64> = flown.arcs.iter().map(|(arc, _)| arc.start).collect();
    for start in &starts {
        assert!(is_among(&instants, *start), "an arc begins at {start}");
    }
    believed_ends.into_iter().filter(|end| !is_among(&starts, *end)).count()
}

#[test]
fn thrusters_give_what_their_valves_make_of_the_commands() {
    let drawn = "\n[[disperse]]\nparameter = \"thrusters.p3.min_on_time_s\"\ndistribution = \"offset\"\noffset = 0.05\n\
        [[disperse]]\nparameter = \"thrusters.p1.max_thrust_n\"\ndistribution = \"offset\"\noffset = -13.0\n";
    for modulation in spindrift::control::actuators::modulation::NAMES {
        for delay in ["0.0", "0.1", "0.7"] {
            let change = [
                ("modulation = \"pulse_width\"", &format!("modulation = \"{modulation}\"")[..]),
                ("delay_s = 0.1", &format!("delay_s = {delay}")),
                ("duration_s = \"10 min\"", "duration_s = 90.2"),
                ("[\"0.5 deg/s\", \"0.8 deg/s\"", "[\"3 deg/s\", \"0.8 deg/s\""),
            ];
            let flown = FlownLoop::new(&(changed(DETUMBLE, &change) + drawn), 2);
            let is_on_off = modulation != "throttled";
            let ended = assert_fired(&flown, is_on_off);
            assert!(ended > 3, "{modulation}, delay {delay}: {ended} pulses");
            let prolonged = assert_begun(&flown, is_on_off);
            assert!(!is_on_off || prolonged > 3, "{modulation}, delay {delay}: {prolonged}");
        }
    }
}
