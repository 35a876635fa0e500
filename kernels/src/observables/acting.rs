//! [`Acting`]: when anything acts on a run, and how much torque that is at most.

use crate::dynamics::environment::with_environment;
use crate::math::Real;
use crate::math::vector::dot;
use crate::scene::{Actuation, Arc, Scene};

/// What acts on a run.
#[derive(Clone, Copy)]
pub(super) struct Acting<'a> {
    scene: &'a Scene,
    /// The arcs of the actuators.
    arcs: &'a [Arc],
    /// Whether the arcs contain the torque of the environment.
    has_environment: bool,
}

impl<'a> Acting<'a> {
    /// The schedule of `scene` and its environment.
    pub(super) fn scheduled(scene: &'a Scene) -> Self {
        Acting { scene, arcs: &scene.schedule, has_environment: false }
    }

    /// The arcs that a run of `scene` has flown, which contain its environment.
    pub(super) fn flown(scene: &'a Scene, arcs: &'a [Arc]) -> Self {
        Acting { scene, arcs, has_environment: true }
    }

    /// The scene.
    pub(super) fn scene(&self) -> &'a Scene {
        self.scene
    }

    /// The time at which a law has ended the run, s.
    pub(super) fn end(&self) -> Option<f64> {
        self.arcs.last().filter(|arc| arc.applied.ends_run).map(|arc| arc.start)
    }

    /// Whether nothing acts in the first `duration` seconds.
    pub(super) fn is_free(&self, duration: f64) -> bool {
        !self.scene.environment.acts() && self.arcs.iter().all(|arc| arc.start >= duration)
    }

    /// Whether anything acts at `time`.
    #[inline(always)]
    pub(super) fn acts(&self, time: f64) -> bool {
        self.scene.environment.acts() || self.arcs.iter().any(|arc| arc.start <= time && time <= arc.end())
    }

    /// Upper bound of the torque on the body, N m: the magnitudes of thrusters, motors, environment and the arcs' own torque on
    /// the body added.
    #[inline(always)]
    pub(super) fn largest_torque(&self) -> f64 {
        let environment = if self.has_environment {
            0.0
        } else {
            let torque = with_environment(self.scene, 0.0, Actuation::none(f64::INFINITY)).body_torque;
            dot(torque, torque).sqrt()
        };
        let mut largest = environment;
        for arc in self.arcs {
            let applied = &arc.applied;
            let thrust = self.scene.thruster_torque_s(applied.thrust);
            let thrust = dot(thrust, thrust).sqrt();
            let actuators = applied.motor_torque.iter().fold(thrust, |sum, torque| sum + torque.abs()) + environment;
            largest = largest.larger(actuators + dot(applied.body_torque, applied.body_torque).sqrt());
        }
        largest
    }
}
