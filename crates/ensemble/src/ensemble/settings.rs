//! Engine settings of a plan ([`propagator`]) and its nominal scene ([`nominal()`]).

use crate::campaign::{Plan, SceneDraws};
use crate::ensemble::surface::leaves_orbit;
use crate::math::Isa;
use crate::math::vector::norm;
use crate::ode::Control;
use crate::propagation::{Engine, PropagationSettings};
use crate::run::{Grid, StateField, StateFields};
use crate::sampling::SampleId;
use crate::scene::Scene;

pub type EngineMaker = fn(&PropagationSettings, Isa) -> Box<dyn Engine>;

#[derive(Clone, Copy, Debug)]
pub struct Engines {
    pub isa: Isa,
    pub own: Option<EngineMaker>,
}

impl Engines {
    pub fn of(isa: Isa) -> Self {
        Engines { isa, own: None }
    }

    pub fn engine(self, settings: &PropagationSettings) -> Box<dyn Engine> {
        self.own.map_or_else(|| settings.engine(self.isa), |new_engine| new_engine(settings, self.isa))
    }
}

/// States for a law at the end of a run.
const SEEN_BY_LAWS: StateFields = StateFields::NONE
    .with(StateField::Rate)
    .with(StateField::Attitude)
    .with(StateField::WheelRates)
    .with(StateField::WheelAngles)
    .with(StateField::ComPosition)
    .with(StateField::ComVelocity);

/// Settings for scenes of `plan` with `fields` at the times of `grid`, and the law's states.
pub fn propagator(plan: &Plan, grid: Grid, fields: StateFields) -> PropagationSettings {
    let control = Control { tolerance: plan.tolerance, step: plan.step_s, max_steps: plan.max_steps };
    let nominal = nominal(plan);
    let settings = |fields| PropagationSettings::new(plan.method, control, grid, fields, &nominal);
    // it may end at the surface
    let place = StateFields::NONE.with(StateField::ComPosition).with(StateField::ComVelocity);
    let fields = if leaves_orbit(plan) { fields.union(place) } else { fields };
    match &plan.law {
        Some(law) => {
            let period = law.spec().map_or(f64::INFINITY, |spec| spec.period);
            let settings = settings(fields.union(SEEN_BY_LAWS)).with_feedback(law.commands);
            settings.turning_by(plan.method, period * fastest(plan))
        }
        None => settings(fields),
    }
}

/// Number of first drawn samples, which stand for all.
pub const FIRST_DRAWN: u64 = 7;

/// Largest initial rate of these and the nominal one, rad/s.
fn fastest(plan: &Plan) -> f64 {
    let mut draws = SceneDraws::new(plan);
    let rate = |sample| draws.scene(SampleId(sample)).map_or(0.0, |scene| norm(scene.initial.omega_se_s));
    (0..=FIRST_DRAWN).map(rate).fold(0.0, f64::max)
}

pub fn nominal(plan: &Plan) -> Scene {
    Scene::resolve(&plan.nominal).expect("a plan's nominal scene was resolved when the plan was made")
}
