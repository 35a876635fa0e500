//! What a plan means for its runs: the observables it requests ([`request`]) and the settings of the engine ([`propagator`]).

use crate::campaign::Plan;
use crate::observables::Request;
use crate::ode::Control;
use crate::propagation::Method;
use crate::propagation::PropagationSettings;
use crate::run::{Grid, StateFields};
use crate::scene::Scene;

/// The observables that `plan` requests.
pub fn request(plan: &Plan) -> Request {
    Request {
        groups: plan.groups.iter().copied().collect(),
        debris: plan.nominal.debris.is_some(),
        actuated: plan.nominal.is_actuated(),
        constrained: plan.method == Method::NullSpace,
    }
}

/// The settings for scenes of `plan` with states `blocks` at the times of `grid`.
pub fn propagator(plan: &Plan, grid: Grid, blocks: StateFields) -> PropagationSettings {
    let control = Control { tolerance: plan.tolerance, step: plan.step_s, max_steps: plan.max_steps };
    let nominal = Scene::resolve(&plan.nominal).expect("a plan's nominal scene was resolved when the plan was made");
    PropagationSettings::new(plan.method, control, grid, blocks, &nominal)
}
