//! [`Engine`]: what every method offers to a worker.

use crate::dynamics::actuation::Laws;
use crate::dynamics::arc_record::ArcRecord;
use crate::dynamics::effects::ForceModel;
use crate::run::{Outcome, StateTable};
use crate::scene::Scene;

/// A run that has ended.
#[derive(Clone, Copy, Debug)]
pub struct CompletedRun<'a> {
    /// The index among the scenes.
    pub index: usize,
    /// The states at the observation points.
    pub table: &'a StateTable,
    /// How the run ended.
    pub outcome: &'a Outcome,
    /// The arcs that were flown, in order, from time zero without a gap, with the effects that are constant over an
    /// arc. As the schedule of a scene with the other effects alone ([`crate::dynamics::effects::beside_arcs`]) they
    /// give the same run.
    pub arcs: &'a ArcRecord,
}

/// Receives a run that has ended.
pub type CompletionCallback<'a> = dyn FnMut(CompletedRun<'_>) + 'a;

/// The memory and code of a method for one worker and one instruction set.
pub trait Engine: Send {
    /// Whether the engine integrates every effect of `model`. Without a default: an engine says so for each effect.
    fn integrates(&self, model: ForceModel) -> bool;

    /// Runs every scene once by the schedule of its own and passes it to `finish`, in the order in which the runs end;
    /// results depend on the scene alone.
    fn propagate(&mut self, scenes: &[Scene], finish: &mut CompletionCallback<'_>) {
        self.propagate_under(Laws::OpenLoop, scenes, finish);
    }

    /// The same under `laws`: each run asks its law for one arc after another; results depend on the scene and its law
    /// alone.
    ///
    /// # Panics
    /// Where the settings are not for feedback ([`super::PropagationSettings::with_feedback`]) and a law is given, and
    /// where a law's answer ends before it starts.
    fn propagate_under(&mut self, laws: Laws<'_>, scenes: &[Scene], finish: &mut CompletionCallback<'_>);
}
