//! The stretches of a run: where thrust and torque are constant, from one switch to the next.

use super::{Actuation, Scene};

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
