//! [`Acting`]: when anything acts on a run, and how much torque that is at most.

use crate::dynamics::arc_record::ArcRecord;
use crate::dynamics::effects::{largest_changing_torque, largest_constant_torque};
use crate::math::Real;
use crate::math::vector::dot;
use crate::scene::{Arc, Scene};

/// What acts on a run.
#[derive(Clone, Copy)]
pub(super) struct Acting<'a> {
    scene: &'a Scene,
    arcs: Arcs<'a>,
}

/// The arcs of the actuators.
#[derive(Clone, Copy)]
enum Arcs<'a> {
    /// Those of a schedule, which may have gaps; the environment acts beside them.
    Scheduled(&'a [Arc]),
    /// Those flown, without a gap; they contain the effects that are constant over an arc.
    Flown(&'a ArcRecord),
}

/// The dipoles of torque rods as time goes on.
pub(super) struct Rods<I> {
    later: I,
    last: Option<Arc>,
}

impl<I: Iterator<Item = Arc>> Rods<I> {
    /// That at `time`, F_s, A m^2, in the arc that ends there at a switch; times do not descend.
    pub(super) fn dipole(&mut self, time: f64) -> [f64; 3] {
        while self.last.is_none_or(|arc| arc.end() < time)
            && let Some(next) = self.later.next()
        {
            self.last = Some(next);
        }
        self.last.map_or([0.0; 3], |arc| arc.applied.dipole)
    }
}

impl<'a> Acting<'a> {
    /// The schedule of `scene` and its environment.
    pub(super) fn scheduled(scene: &'a Scene) -> Self {
        Acting { scene, arcs: Arcs::Scheduled(&scene.schedule) }
    }

    /// The arcs that a run of `scene` has flown, which contain its constant effects.
    pub(super) fn flown(scene: &'a Scene, arcs: &'a ArcRecord) -> Self {
        Acting { scene, arcs: Arcs::Flown(arcs) }
    }

    /// The dipoles of torque rods, where a law drives some.
    pub(super) fn rods(&self) -> Option<Rods<impl Iterator<Item = Arc> + use<'a>>> {
        match self.arcs {
            Arcs::Flown(arcs) if !self.scene.torque_rods.is_empty() => Some(Rods { later: arcs.iter(), last: None }),
            _ => None,
        }
    }

    /// The scene.
    pub(super) fn scene(&self) -> &'a Scene {
        self.scene
    }

    /// The time at which a law has ended the run, s.
    pub(super) fn end(&self) -> Option<f64> {
        let last = match self.arcs {
            Arcs::Scheduled(arcs) => arcs.last(),
            Arcs::Flown(arcs) => arcs.last(),
        };
        last.filter(|arc| arc.applied.ends_run).map(|arc| arc.start)
    }

    /// Whether nothing acts in the first `duration` seconds.
    pub(super) fn is_free(&self, duration: f64) -> bool {
        match self.arcs {
            Arcs::Scheduled(arcs) => !self.scene.environment.acts() && arcs.iter().all(|arc| arc.start >= duration),
            Arcs::Flown(arcs) => arcs.is_empty() || duration <= 0.0,
        }
    }

    /// Whether anything acts at `time`.
    #[inline(always)]
    pub(super) fn acts(&self, time: f64) -> bool {
        match self.arcs {
            Arcs::Scheduled(arcs) => {
                self.scene.environment.acts() || arcs.iter().any(|arc| arc.start <= time && time <= arc.end())
            }
            Arcs::Flown(arcs) => arcs.last().is_some_and(|last| time <= last.end()),
        }
    }

    /// Upper bound of the torque on the body, N m: the magnitudes of thrusters, motors, effects and the arcs' own
    /// torque on the body added.
    #[inline(always)]
    pub(super) fn largest_torque(&self) -> f64 {
        let changing = largest_changing_torque(self.scene);
        match self.arcs {
            Arcs::Scheduled(arcs) => {
                let effects = largest_constant_torque(self.scene) + changing;
                arcs.iter().fold(effects, |largest, arc| largest.larger(self.torque(arc, effects)))
            }
            Arcs::Flown(arcs) => {
                let (mut arcs, mut largest) = (arcs.reader(), changing);
                while let Some(arc) = arcs.next() {
                    largest = largest.larger(self.torque(arc, changing));
                }
                largest
            }
        }
    }

    /// That in `arc`, beside `effects`.
    fn torque(&self, arc: &Arc, effects: f64) -> f64 {
        let applied = &arc.applied;
        let thrust = self.scene.thruster_torque_s(applied.thrust);
        let thrust = dot(thrust, thrust).sqrt();
        let actuators = applied.motor_torque.iter().fold(thrust, |sum, torque| sum + torque.abs()) + effects;
        actuators + dot(applied.body_torque, applied.body_torque).sqrt()
    }
}
