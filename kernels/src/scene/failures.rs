//! Failures of wheels and thrusters in a schedule: from their time on, devices deviate from commands.

use super::schedule::{Actuation, Arc};
use super::schema::failure::{Device, FailureInput};

/// Applies `failures` to `schedule`: arcs end at a failure, and a thruster that is stuck on also acts between arcs.
/// Under a control loop, `has_loop`, its models of the motors handle failures of wheels.
pub(super) fn apply(failures: &[FailureInput], has_loop: bool, schedule: &mut Vec<Arc>) {
    for failure in failures {
        match failure.device {
            Device::Wheel(_) if has_loop => continue,
            Device::Wheel(_) => split(schedule, failure.at_s),
            Device::Thruster(_) => {
                split(schedule, failure.at_s);
                if failure.thrust_n.is_some_and(|thrust| thrust > 0.0) {
                    fill(schedule, failure.at_s);
                }
            }
            Device::Rod(_) | Device::Sensor(_) | Device::Unknown => continue,
        }
        for arc in schedule.iter_mut().filter(|arc| arc.start >= failure.at_s) {
            match failure.device {
                Device::Wheel(place) => arc.applied.motor_torque[place] *= failure.torque_scale.unwrap_or(1.0),
                Device::Thruster(place) => arc.applied.thrust[place] = failure.thrust_n.unwrap_or(0.0),
                Device::Rod(_) | Device::Sensor(_) | Device::Unknown => {}
            }
        }
    }
}

/// Splits the arc at `time`.
fn split(schedule: &mut Vec<Arc>, time: f64) {
    if let Some(index) = schedule.iter().position(|arc| arc.start < time && time < arc.end()) {
        let rest = Arc { start: time, ..schedule[index] };
        schedule[index].applied.until = time;
        schedule.insert(index + 1, rest);
    }
}

/// Fills the gaps of `schedule` from `time` on, and the time after its last arc, with idle arcs.
fn fill(schedule: &mut Vec<Arc>, time: f64) {
    let mut end = time;
    let mut index = schedule.partition_point(|arc| arc.end() <= time);
    while index < schedule.len() {
        let arc = schedule[index];
        if arc.start > end {
            schedule.insert(index, Arc { start: end, applied: Actuation::none(arc.start) });
            index += 1;
        }
        end = arc.end();
        index += 1;
    }
    if end < f64::INFINITY {
        schedule.push(Arc { start: end, applied: Actuation::none(f64::INFINITY) });
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::schedule::actuation_at;

    fn schedule() -> Vec<Arc> {
        let arc = |start, end: f64, torque| Arc {
            start,
            applied: Actuation::none(end).with_thrust(&[10.0, 20.0]).with_motor_torque(&[torque, 5.0]),
        };
        vec![arc(1.0, 2.0, 3.0), arc(4.0, 6.0, -4.0)]
    }

    /// Law: at every time the applied values are the scheduled ones, except those of the device after its failure; arcs
    /// stay in order and end at the failure.
    #[test]
    fn what_a_failed_device_applies() {
        let wheel = FailureInput { device: Device::Wheel(0), torque_scale: Some(0.5), ..FailureInput::DEFAULT };
        let thruster = FailureInput { device: Device::Thruster(1), ..FailureInput::DEFAULT };
        for at_s in [0.0, 0.5, 1.0, 1.25, 2.0, 3.0, 4.0, 5.0, 6.0, 9.0] {
            for failure in [
                FailureInput { at_s, ..wheel },
                FailureInput { at_s, thrust_n: Some(0.0), ..thruster },
                FailureInput { at_s, thrust_n: Some(7.0), ..thruster },
            ] {
                let (before, mut after) = (schedule(), schedule());
                apply(&[failure], false, &mut after);
                assert!(after.iter().all(|arc| arc.start < arc.end()));
                assert!(after.windows(2).all(|pair| pair[0].end() <= pair[1].start));
                for step in 0..100 {
                    let time = 0.125 * f64::from(step);
                    let (mut expected, found) = (actuation_at(&before, time), actuation_at(&after, time));
                    if time >= at_s {
                        match failure.device {
                            Device::Wheel(_) => expected.motor_torque[0] *= 0.5,
                            _ => expected.thrust[1] = failure.thrust_n.expect("a thrust"),
                        }
                    } else {
                        assert!(found.until <= at_s || found.until == expected.until, "{at_s} {time}");
                    }
                    assert_eq!(
                        (found.thrust, found.motor_torque),
                        (expected.thrust, expected.motor_torque),
                        "{failure:?} {time}"
                    );
                }
            }
        }
    }
}
