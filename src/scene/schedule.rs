//! The stretches of a run: where thrust and torque are constant, from one switch to the next; and what the actuators make of
//! the commands.

use super::input::SceneInput;
use super::mass::turned;
use super::{Actuation, Scene, THRUSTER_DIRECTIONS};

/// What is applied where stretch `index` of `input` is commanded: scales, bias, delays. With ideal actuators, the command.
///
/// Whether what comes out is a schedule (starts before it ends, no thrust that pulls), [`super::check`] says.
pub fn applied(input: &SceneInput, index: usize) -> Actuation {
    let (actuators, command) = (&input.actuators, &input.actuation[index]);
    let start = |index: usize| {
        // where a run starts, it has started
        (input.actuation[index].start_s + actuators.switch_on_delay_s).max(0.0)
    };
    let next = input.actuation.get(index + 1).filter(|next| next.start_s == command.end_s);
    Actuation {
        start: start(index),
        end: if next.is_some() { start(index + 1) } else { command.end_s + actuators.switch_off_delay_s },
        thrust: std::array::from_fn(|i| actuators.thrust_scale[i] * command.thrust_n[i]),
        torque: std::array::from_fn(|i| {
            let torque = command.torque_n_m[i];
            if torque == 0.0 { 0.0 } else { actuators.torque_scale[i] * torque + actuators.torque_bias_n_m[i] }
        }),
    }
}

/// The directions of the thrusts P1, P2, P3 with the misalignments of `input`, unit vectors in F_s.
pub fn thruster_directions(input: &SceneInput) -> [[f64; 3]; 3] {
    let tilts = input.actuators.tilts_rad();
    std::array::from_fn(|k| turned(THRUSTER_DIRECTIONS[k], [tilts[k][0], tilts[k][1], 0.0], 1.0))
}

impl Scene {
    /// The stretches that cover [0, `duration`] without a gap, in order: those of the schedule, cut at the duration, and
    /// between them coasting (thrust and torque zero). Integration restarts exactly at every boundary. No allocation.
    pub fn stretches(&self, duration: f64) -> impl Iterator<Item = Actuation> + '_ {
        let (mut time, mut next) = (0.0, 0);
        std::iter::from_fn(move || {
            if time >= duration {
                return None;
            }
            let ahead = self.schedule.get(next).filter(|actuation| actuation.start < duration);
            let stretch = match ahead {
                Some(actuation) if actuation.start <= time => {
                    next += 1;
                    Actuation { end: actuation.end.min(duration), ..*actuation }
                }
                Some(actuation) => Actuation::coast(time, actuation.start),
                None => Actuation::coast(time, duration),
            };
            time = stretch.end;
            Some(stretch)
        })
    }
}

impl Actuation {
    /// A stretch without thrust and torque.
    pub const fn coast(start: f64, end: f64) -> Self {
        Actuation { start, end, thrust: [0.0; 3], torque: [0.0; 2] }
    }
}

#[cfg(test)]
mod tests {
    use crate::scene::{ActuationInput, Scene, samples};

    fn stretches(switches: &[[f64; 2]], duration: f64) -> Vec<(f64, f64, bool)> {
        let mut input = samples::table_two();
        input.actuation = switches
            .iter()
            .map(|&[start_s, end_s]| ActuationInput { start_s, end_s, thrust_n: [1.0, 0.0, 0.0], torque_n_m: [0.0; 2] })
            .collect();
        let scene = Scene::resolve(&input).expect("a legal schedule");
        scene.stretches(duration).map(|s| (s.start, s.end, s.thrust[0] > 0.0)).collect()
    }

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
        for (stretch, command) in ideal.schedule.iter().zip(&input.actuation) {
            assert_eq!((stretch.start, stretch.end), (command.start_s, command.end_s));
            assert_eq!((stretch.thrust, stretch.torque), (command.thrust_n, command.torque_n_m));
        }
        input.actuators.thrust_scale = [0.5, 1.0, 1.5];
        input.actuators.torque_scale = [2.0, 1.0];
        input.actuators.torque_bias_n_m = [0.25, 7.0];
        input.actuators.switch_on_delay_s = -0.25;
        input.actuators.switch_off_delay_s = 0.5;
        let schedule = Scene::resolve(&input).expect("a legal schedule").schedule;
        let times: Vec<_> = schedule.iter().map(|stretch| (stretch.start, stretch.end)).collect();
        assert_eq!(times, [(0.0, 0.75), (0.75, 2.5), (2.75, 4.5)], "one switch where stretches meet, none before zero");
        assert!(schedule.iter().all(|stretch| stretch.thrust == [5.0, 20.0, 45.0]));
        let torques: Vec<_> = schedule.iter().map(|stretch| stretch.torque).collect();
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

    #[test]
    fn stretches_cover_the_horizon_without_a_gap() {
        assert_eq!(stretches(&[], 2.0), [(0.0, 2.0, false)]);
        assert_eq!(stretches(&[[0.0, 2.0]], 2.0), [(0.0, 2.0, true)]);
        assert_eq!(stretches(&[[0.0, 5.0]], 2.0), [(0.0, 2.0, true)]);
        assert_eq!(stretches(&[[3.0, 5.0]], 2.0), [(0.0, 2.0, false)]);
        assert_eq!(
            stretches(&[[0.5, 1.0], [1.0, 1.5]], 2.0),
            [(0.0, 0.5, false), (0.5, 1.0, true), (1.0, 1.5, true), (1.5, 2.0, false)]
        );
    }
}
