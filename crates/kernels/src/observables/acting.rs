//! [`Acting`]: times of actuation of a run, and a bound of the torque.

use crate::dynamics::arc_record::ArcRecord;
use crate::dynamics::effects::{largest_changing_torque, largest_constant_torque};
use crate::math::prelude::*;
use crate::scene::{Arc, Scene};

#[derive(Clone, Copy)]
pub struct Acting<'a> {
    scene: &'a Scene,
    arcs: Arcs<'a>,
}

#[derive(Clone, Copy)]
enum Arcs<'a> {
    /// A schedule, which may have gaps; the environment acts as well.
    Scheduled(&'a [Arc]),
    /// Arcs flown, without gaps, including the effects that are constant over an arc.
    Flown(&'a ArcRecord),
}

/// Dipoles of torque rods over time.
pub struct Rods<I> {
    later: I,
    last: Option<Arc>,
}

impl<I: Iterator<Item = Arc>> Rods<I> {
    /// Dipole at `time` in F_s, A m^2, before a switch at that time; times must not decrease.
    pub fn dipole(&mut self, time: f64) -> [f64; 3] {
        while self.last.is_none_or(|arc| arc.end() < time)
            && let Some(next) = self.later.next()
        {
            self.last = Some(next);
        }
        self.last.map_or([0.0; 3], |arc| arc.applied.dipole)
    }
}

impl<'a> Acting<'a> {
    pub fn scheduled(scene: &'a Scene) -> Self {
        Acting { scene, arcs: Arcs::Scheduled(&scene.schedule) }
    }

    pub fn flown(scene: &'a Scene, arcs: &'a ArcRecord) -> Self {
        Acting { scene, arcs: Arcs::Flown(arcs) }
    }

    /// Dipoles of torque rods, if a law drives any.
    pub fn rods(&self) -> Option<Rods<impl Iterator<Item = Arc> + use<'a>>> {
        match self.arcs {
            Arcs::Flown(arcs) if !self.scene.torque_rods.is_empty() => Some(Rods { later: arcs.iter(), last: None }),
            _ => None,
        }
    }

    /// True if a law decides.
    pub fn is_flown(&self) -> bool {
        matches!(self.arcs, Arcs::Flown(_))
    }

    pub fn scene(&self) -> &'a Scene {
        self.scene
    }

    /// Time at which a law ended the run, s.
    pub fn end(&self) -> Option<f64> {
        let last = match self.arcs {
            Arcs::Scheduled(arcs) => arcs.last(),
            Arcs::Flown(arcs) => arcs.last(),
        };
        last.filter(|arc| arc.applied.ends_run).map(|arc| arc.start)
    }

    /// The arcs of a schedule; a law has none.
    fn schedule(&self) -> &'a [Arc] {
        match self.arcs {
            Arcs::Scheduled(arcs) => arcs,
            Arcs::Flown(_) => &[],
        }
    }

    /// True if nothing acts on a run without a law in the first `duration` seconds.
    pub fn is_free(&self, duration: f64) -> bool {
        !self.scene.environment.acts() && self.schedule().iter().all(|arc| arc.start >= duration)
    }

    /// True if something acts on a run without a law at `time`.
    #[inline(always)]
    pub fn acts(&self, time: f64) -> bool {
        self.scene.environment.acts() || self.schedule().iter().any(|arc| arc.start <= time && time <= arc.end())
    }

    /// Upper bound of the torque on the body of a run without a law, N m.
    #[inline(always)]
    pub fn largest_torque(&self) -> f64 {
        let effects = largest_constant_torque(self.scene) + largest_changing_torque(self.scene);
        self.schedule().iter().fold(effects, |largest, arc| largest.larger(self.torque(arc, effects)))
    }

    fn torque(&self, arc: &Arc, effects: f64) -> f64 {
        let applied = &arc.applied;
        let thrust = self.scene.thruster_torque_s(applied.thrust);
        let thrust = dot(thrust, thrust).sqrt();
        let actuators = applied.motor_torque.iter().fold(thrust, |sum, torque| sum + torque.abs()) + effects;
        actuators + dot(applied.body_torque, applied.body_torque).sqrt()
    }
}
