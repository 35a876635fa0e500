//! What a plan means for its runs: the settings of the engine ([`propagator`]) and the nominal scene ([`nominal()`]).

use crate::campaign::Plan;
use crate::ode::Control;
use crate::propagation::PropagationSettings;
use crate::run::{Grid, StateFields};
use crate::scene::Scene;

/// The settings for scenes of `plan` with states `fields` at the times of `grid`.
pub fn propagator(plan: &Plan, grid: Grid, fields: StateFields) -> PropagationSettings {
    let control = Control { tolerance: plan.tolerance, step: plan.step_s, max_steps: plan.max_steps };
    let settings = PropagationSettings::new(plan.method, control, grid, fields, &nominal(plan));
    match &plan.law {
        Some(law) => settings.with_feedback(law.commands()),
        None => settings,
    }
}

/// The nominal scene of `plan`.
pub fn nominal(plan: &Plan) -> Scene {
    Scene::resolve(&plan.nominal).expect("a plan's nominal scene was resolved when the plan was made")
}
