//! Failures of wheels and thrusters in a schedule.

use super::schedule::{Actuation, Arc};
use super::schema::failure::{Device, FailureInput};

/// Applies `failures` to `schedule`: arcs end at a failure, and a thruster that is stuck on also acts between arcs.
/// Under a control loop, `has_loop`, its models of the motors handle failures of wheels.
pub(super) fn apply(failures: &[FailureInput], has_loop: bool, schedule: &mut Vec<Arc>) {
    for failure in failures {
        match failure.device {
            Device::Wheel(_) if !has_loop => split(schedule, failure.at_s),
            Device::Thruster(_) => {
                split(schedule, failure.at_s);
                if failure.thrust_n.is_some_and(|thrust| thrust > 0.0) {
                    fill(schedule, failure.at_s);
                }
            }
            _ => continue,
        }
        for arc in schedule.iter_mut().filter(|arc| arc.start >= failure.at_s) {
            match failure.device {
                Device::Wheel(place) => arc.applied.motor_torque[place] *= failure.torque_scale.unwrap_or(1.0),
                Device::Thruster(place) => arc.applied.thrust[place] = failure.thrust_n.unwrap_or(0.0),
                _ => {}
            }
        }
    }
}

fn split(schedule: &mut Vec<Arc>, time: f64) {
    if let Some(index) = schedule.iter().position(|arc| arc.start < time && time < arc.end()) {
        let rest = Arc { start: time, ..schedule[index] };
        schedule[index].applied.until = time;
        schedule.insert(index + 1, rest);
    }
}

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
