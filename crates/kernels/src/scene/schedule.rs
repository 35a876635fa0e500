//! Arcs of constant actuation, and the response of the actuators to commands.

use super::alignment::aligned;
use super::input::SceneInput;
use super::schema::{MAX_THRUSTERS, MAX_WHEELS, WheelMode};
use super::thruster::Thruster;

/// Applied values, constant until a time, SI.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Actuation {
    /// End of the values since the start of the run, s; infinite if none.
    pub until: f64,
    /// Thrusts of the thrusters, in order of [`super::Scene::thrusters`], N; zero beyond.
    pub thrust: [f64; MAX_THRUSTERS],
    /// Motor torques on the wheels about their axes, in order, N m; the body feels the opposite. Zero beyond.
    pub motor_torque: [f64; MAX_WHEELS],
    /// External torque on the spacecraft other than that of the thrusters, F_s, N m.
    pub body_torque: [f64; 3],
    /// Magnetic dipole of the torque rods, F_s, A m^2; acts in a scene with torque rods or a residual dipole.
    pub dipole: [f64; 3],
    /// True if the run ends where these values begin.
    pub ends_run: bool,
}

/// An interval of constant actuation, from `start` to the actuation's `until`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Arc {
    /// Start, s.
    pub start: f64,
    /// Actuation and end.
    pub applied: Actuation,
}

/// True if the next command starts at the end of command `index`: there is one switch.
fn meets_next(input: &SceneInput, index: usize) -> bool {
    input.actuation.get(index + 1).is_some_and(|next| next.start_s == input.actuation[index].end_s)
}

/// The arc of command `index` of `input`, with scales, bias and delays (motors of a control loop: `motor_torques`).
pub fn applied(input: &SceneInput, index: usize) -> Arc {
    let (actuators, command) = (&input.actuators, &input.actuation[index]);
    let start = |index: usize| {
        let command = &input.actuation[index];
        // a command before the start of the run starts with it
        (command.start_s + actuators.switch_on_delay_s + command.errors.switch_on_delay_s).max(0.0)
    };
    Arc {
        start: start(index),
        applied: Actuation {
            until: if meets_next(input, index) {
                start(index + 1)
            } else {
                command.end_s + actuators.switch_off_delay_s + command.errors.switch_off_delay_s
            },
            thrust: thrusts(input, index),
            motor_torque: motor_torques(input, index),
            body_torque: [0.0; 3],
            dipole: [0.0; 3],
            ends_run: false,
        },
    }
}

fn first<const N: usize>(numbers: &[f64]) -> [f64; N] {
    let mut all = [0.0; N];
    all[..numbers.len()].copy_from_slice(numbers);
    all
}

fn thrusts(input: &SceneInput, index: usize) -> [f64; MAX_THRUSTERS] {
    let (mut thrust, command) = ([0.0; MAX_THRUSTERS], &input.actuation[index]);
    for (i, thruster) in input.thrusters.iter().enumerate() {
        thrust[i] = thruster.thrust_scale * (command.errors.thrust_scale * command.thrust_n[i]);
    }
    thrust
}

/// Motor torques of command `index` on the turning wheels, N m; under a control loop the commands, to which the loop's
/// motor model applies scale and bias.
fn motor_torques(input: &SceneInput, index: usize) -> [f64; MAX_WHEELS] {
    let (mut torques, command) = ([0.0; MAX_WHEELS], &input.actuation[index]);
    let turning = input.wheels.iter().enumerate().filter(|(_, wheel)| wheel.mode != WheelMode::Locked);
    for (place, (i, wheel)) in turning.enumerate() {
        let torque = command.errors.torque_scale * command.torque_n_m[i];
        let is_applied = torque != 0.0 && !input.control.has_loop();
        torques[place] = if is_applied { wheel.torque_scale * torque + wheel.torque_bias_n_m } else { torque };
    }
    torques
}

/// The thrusters with their alignment errors.
pub fn thrusters(input: &SceneInput) -> impl Iterator<Item = Thruster> {
    input.thrusters.iter().map(|thruster| Thruster {
        position: thruster.position_m,
        direction: aligned(thruster.direction, thruster.tilt_rad, 1.0),
    })
}

/// Actuation of `schedule` (in order, not overlapping) at `time`; at a boundary the later arc applies.
#[inline]
pub fn actuation_at(schedule: &[Arc], time: f64) -> Actuation {
    match schedule.get(schedule.partition_point(|arc| arc.end() <= time)) {
        Some(arc) if arc.start <= time => arc.applied,
        Some(arc) => Actuation::none(arc.start),
        None => Actuation::none(f64::INFINITY),
    }
}

impl Actuation {
    /// No actuation until `until`.
    pub const fn none(until: f64) -> Self {
        Actuation {
            until,
            thrust: [0.0; MAX_THRUSTERS],
            motor_torque: [0.0; MAX_WHEELS],
            body_torque: [0.0; 3],
            dipole: [0.0; 3],
            ends_run: false,
        }
    }

    /// End of a run.
    pub const fn end_of_run() -> Self {
        Actuation { ends_run: true, ..Actuation::none(f64::INFINITY) }
    }

    /// Sets the thrusts of the first thrusters to `thrust` (N), the others to zero.
    ///
    /// # Panics
    /// If there are more than [`MAX_THRUSTERS`].
    #[must_use]
    pub fn with_thrust(self, thrust: &[f64]) -> Self {
        Actuation { thrust: first(thrust), ..self }
    }

    /// Sets the motor torques of the first wheels to `torque` (N m), as [`Actuation::with_thrust`].
    #[must_use]
    pub fn with_motor_torque(self, torque: &[f64]) -> Self {
        Actuation { motor_torque: first(torque), ..self }
    }

    /// True if any thrust, motor, body torque or torque rod acts.
    #[inline]
    pub fn acts(&self) -> bool {
        self.thrust != [0.0; MAX_THRUSTERS]
            || self.motor_torque != [0.0; MAX_WHEELS]
            || self.body_torque != [0.0; 3]
            || self.dipole != [0.0; 3]
    }
}

impl Arc {
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
        let command = |start_s, end_s, torque| {
            ActuationInput::idle(start_s, end_s).with_thrust(&[10.0, 20.0, 30.0]).with_torque(&[torque])
        };
        input.actuation = vec![command(0.0, 1.0, 2.0), command(1.0, 2.0, 0.0), command(3.0, 4.0, -2.0)];
        let ideal = Scene::resolve(&input).expect("a legal schedule");
        for (arc, command) in ideal.schedule.iter().zip(&input.actuation) {
            assert_eq!((arc.start, arc.end()), (command.start_s, command.end_s));
            assert_eq!((arc.applied.thrust, arc.applied.motor_torque), (command.thrust_n, command.torque_n_m));
        }
        (input.thrusters[0].thrust_scale, input.thrusters[2].thrust_scale) = (0.5, 1.5);
        (input.wheels[0].torque_scale, input.wheels[0].torque_bias_n_m) = (2.0, 0.25);
        input.wheels[1].torque_bias_n_m = 7.0;
        input.actuators.switch_on_delay_s = -0.25;
        input.actuators.switch_off_delay_s = 0.5;
        let schedule = Scene::resolve(&input).expect("a legal schedule").schedule;
        let times: Vec<_> = schedule.iter().map(|arc| (arc.start, arc.end())).collect();
        assert_eq!(times, [(0.0, 0.75), (0.75, 2.5), (2.75, 4.5)], "one switch where commands meet, none before zero");
        for (number, arc) in schedule.iter().enumerate() {
            assert_eq!(arc.applied.thrust[..3], [5.0, 20.0, 45.0], "arc {number}");
        }
        let torques: Vec<_> =
            schedule.iter().map(|arc| [arc.applied.motor_torque[0], arc.applied.motor_torque[1]]).collect();
        assert_eq!(torques, [[4.25, 0.0], [0.0, 0.0], [-3.75, 0.0]], "no bias where nothing is commanded");
    }
}
