//! What a plan means for its runs: the observables it requests ([`request`]), the settings of the engine ([`propagator`]),
//! and the nominal run that others are compared with ([`nominal()`], [`nominal_attitude`]).

use crate::campaign::Plan;
use crate::math::Isa;
use crate::observables::nominal_attitude::NominalAttitude;
use crate::observables::{Group, Request};
use crate::ode::Control;
use crate::propagation::PropagationSettings;
use crate::run::{Grid, StateField, StateFields};
use crate::scene::Scene;

/// The observables that `plan` requests.
pub fn request(plan: &Plan) -> Request {
    plan.request()
}

/// The settings for scenes of `plan` with states `fields` at the times of `grid`.
pub fn propagator(plan: &Plan, grid: Grid, fields: StateFields) -> PropagationSettings {
    let control = Control { tolerance: plan.tolerance, step: plan.step_s, max_steps: plan.max_steps };
    PropagationSettings::new(plan.method, control, grid, fields, &nominal(plan))
}

/// The attitude of the nominal run at the times of `grid`, where `request` compares runs with it.
pub fn nominal_attitude(plan: &Plan, request: &Request, grid: &Grid, isa: Isa) -> Option<NominalAttitude> {
    if !request.groups.contains(Group::Motion) {
        return None;
    }
    let mut found = None;
    let attitude = StateFields::NONE.with(StateField::Attitude);
    propagator(plan, grid.clone(), attitude).engine(isa).propagate(&[nominal(plan)], &mut |run| {
        found = Some(NominalAttitude::of(run.table, run.outcome));
    });
    found
}

/// The nominal scene of `plan`.
pub fn nominal(plan: &Plan) -> Scene {
    Scene::resolve(&plan.nominal).expect("a plan's nominal scene was resolved when the plan was made")
}
