//! The arcs of a run: intervals of constant actuation; and what the actuators make of the commands.

use super::THRUSTER_DIRECTIONS;
use super::input::SceneInput;
use super::mass::turned;

/// Number of thrusters.
pub const THRUSTERS: usize = 3;
/// Number of wheels.
pub const WHEELS: usize = 2;

/// What acts on the spacecraft until a time: the values as they are applied, constant, SI.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Actuation {
    /// The time since the start of the run until which the values are constant, s; infinite where nothing is to change.
    pub until: f64,
    /// Thrusts P1, P2, P3 along the thrusters' directions (`thruster_directions`), N.
    pub thrust: [f64; THRUSTERS],
    /// Motor torques on W1, W2 about their axes, N m; the fuselage feels the opposite.
    pub motor_torque: [f64; WHEELS],
    /// External torque on the spacecraft beside that of the thrusters, in F_s, N m.
    pub body_torque: [f64; 3],
}

/// An interval of constant actuation: from `start` to the actuation's `until`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Arc {
    /// Start, s.
    pub start: f64,
    /// What acts, and until when.
    pub applied: Actuation,
}

/// The arc that command `index` of `input` becomes: scales, bias, delays. With ideal actuators, the command itself.
///
/// [`super::check`] checks that the result is a schedule (every arc starts before it ends, no negative thrust).
pub fn applied(input: &SceneInput, index: usize) -> Arc {
    let (actuators, command) = (&input.actuators, &input.actuation[index]);
    let start = |index: usize| {
        // a command that would start before the run starts with it
        (input.actuation[index].start_s + actuators.switch_on_delay_s).max(0.0)
    };
    let next = input.actuation.get(index + 1).filter(|next| next.start_s == command.end_s);
    Arc {
        start: start(index),
        applied: Actuation {
            until: if next.is_some() { start(index + 1) } else { command.end_s + actuators.switch_off_delay_s },
            thrust: std::array::from_fn(|i| actuators.thrust_scale[i] * command.thrust_n[i]),
            motor_torque: std::array::from_fn(|i| {
                let torque = command.torque_n_m[i];
                if torque == 0.0 { 0.0 } else { actuators.torque_scale[i] * torque + actuators.torque_bias_n_m[i] }
            }),
            body_torque: [0.0; 3],
        },
    }
}

/// The directions of the thrusts P1, P2, P3 with the misalignments of `input`, unit vectors in F_s.
pub fn thruster_directions(input: &SceneInput) -> [[f64; 3]; 3] {
    let tilts = input.actuators.tilts_rad();
    std::array::from_fn(|k| turned(THRUSTER_DIRECTIONS[k], [tilts[k][0], tilts[k][1], 0.0], 1.0))
}

/// What the commands of `schedule` (in order, not overlapping) apply at `time`, and until when: between them and after the last
/// nothing acts. At the boundary of two arcs the later one applies.
#[inline]
pub fn actuation_at(schedule: &[Arc], time: f64) -> Actuation {
    match schedule.get(schedule.partition_point(|arc| arc.end() <= time)) {
        Some(arc) if arc.start <= time => arc.applied,
        Some(arc) => Actuation::none(arc.start),
        None => Actuation::none(f64::INFINITY),
    }
}

impl Actuation {
    /// Nothing acts until `until`.
    pub const fn none(until: f64) -> Self {
        Actuation { until, thrust: [0.0; THRUSTERS], motor_torque: [0.0; WHEELS], body_torque: [0.0; 3] }
    }

    /// Whether any thrust, motor or body torque acts.
    #[inline]
    pub fn acts(&self) -> bool {
        self.thrust != [0.0; THRUSTERS] || self.motor_torque != [0.0; WHEELS] || self.body_torque != [0.0; 3]
    }
}

impl Arc {
    /// The arc of `applied` from `start` on, ended at `duration` at the latest.
    #[inline]
    pub fn new(start: f64, applied: Actuation, duration: f64) -> Self {
        Arc { start, applied: Actuation { until: applied.until.min(duration), ..applied } }
    }

    /// End, s.
    #[inline]
    pub const fn end(&self) -> f64 {
        self.applied.until
    }
}

#[cfg(test)]
mod tests {
    use crate::scene::{ActuationInput, Scene, samples};

    #[test]
    fn actuators_delay_and_scale_what_is_commanded() {
        let mut input = samples::table_two();
        let command = |start_s, end_s, torque| ActuationInput {
            start_s,
            end_s,
            thrust_n: [10.0, 20.0, 30.0],
            torque_n_m: [torque, 0.0],
        };
        input.actuation = vec![command(0.0, 1.0, 2.0), command(1.0, 2.0, 0.0), command(3.0, 4.0, -2.0)];
        let ideal = Scene::resolve(&input).expect("a legal schedule");
        for (arc, command) in ideal.schedule.iter().zip(&input.actuation) {
            assert_eq!((arc.start, arc.end()), (command.start_s, command.end_s));
            assert_eq!((arc.applied.thrust, arc.applied.motor_torque), (command.thrust_n, command.torque_n_m));
        }
        input.actuators.thrust_scale = [0.5, 1.0, 1.5];
        input.actuators.torque_scale = [2.0, 1.0];
        input.actuators.torque_bias_n_m = [0.25, 7.0];
        input.actuators.switch_on_delay_s = -0.25;
        input.actuators.switch_off_delay_s = 0.5;
        let schedule = Scene::resolve(&input).expect("a legal schedule").schedule;
        let times: Vec<_> = schedule.iter().map(|arc| (arc.start, arc.end())).collect();
        assert_eq!(times, [(0.0, 0.75), (0.75, 2.5), (2.75, 4.5)], "one switch where commands meet, none before zero");
        assert!(schedule.iter().all(|arc| arc.applied.thrust == [5.0, 20.0, 45.0]));
        let torques: Vec<_> = schedule.iter().map(|arc| arc.applied.motor_torque).collect();
        assert_eq!(torques, [[4.25, 0.0], [0.0, 0.0], [-3.75, 0.0]], "no bias where nothing is commanded");
    }

    #[test]
    fn a_misaligned_thruster_pushes_where_it_points() {
        let mut input = samples::table_two();
        input.actuators.thruster2_tilt_rad = [0.1, 0.0];
        let scene = Scene::resolve(&input).expect("a legal scene");
        // -s3 turned about s1: towards +s2; at (0, -0.5, 3), 1.5 above c
        let (sine, cosine) = libm::sincos(0.1);
        let force = scene.thruster_force_s([0.0, 10.0, 0.0]);
        assert!((force[1] - 10.0 * sine).abs() < 1e-14 && (force[2] + 10.0 * cosine).abs() < 1e-14, "{force:?}");
        let torque = scene.thruster_torque_s([0.0, 10.0, 0.0]);
        assert!((torque[0] - (0.5 * 10.0 * cosine - 1.5 * 10.0 * sine)).abs() < 1e-13, "{torque:?}");
        // the general form is the plain one where nothing is tilted
        let aligned = Scene::resolve(&samples::table_two()).expect("a legal scene");
        let mut nearly = aligned.clone();
        nearly.thruster_directions[0][0] = 1e-300;
        let thrust = [10.0, 20.0, 35.0];
        for (a, b) in aligned.thruster_torque_s(thrust).into_iter().zip(nearly.thruster_torque_s(thrust)) {
            assert!((a - b).abs() < 1e-13);
        }
    }
}
