//! [`Engine`]: the interface of a method to a worker.

use crate::dynamics::actuation::Laws;
use crate::dynamics::arc_record::ArcRecord;
use crate::run::{Outcome, StateTable};
use crate::scene::Scene;

/// A completed run.
#[derive(Clone, Copy, Debug)]
pub struct CompletedRun<'a> {
    /// The index among the scenes.
    pub index: usize,
    /// The states at the observation points.
    pub table: &'a StateTable,
    /// Its outcome.
    pub outcome: &'a Outcome,
    /// The arcs in order, without gaps from time zero, with the effects that are constant over an arc
    /// (`environment.body_torque_n_m`). As a schedule, with the other effects alone, they give the same run.
    pub arcs: &'a ArcRecord,
}

/// Receives a completed run.
pub type CompletionCallback<'a> = dyn FnMut(CompletedRun<'_>) + 'a;

/// Memory and code of a method for one worker and one instruction set.
pub trait Engine: Send {
    /// Runs every scene by its own schedule; calls `finish` in order of completion.
    fn propagate(&mut self, scenes: &[Scene], finish: &mut CompletionCallback<'_>) {
        self.propagate_under(Laws::OpenLoop, scenes, finish);
    }

    /// Runs every scene under `laws`; results depend on the scene and its law alone.
    ///
    /// # Panics
    /// If a law is given without [`super::PropagationSettings::with_feedback`], or its arc ends before it starts.
    fn propagate_under(&mut self, laws: Laws<'_>, scenes: &[Scene], finish: &mut CompletionCallback<'_>);
}
