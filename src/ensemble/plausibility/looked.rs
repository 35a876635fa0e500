//! [`Looked`]: a plan, its nominal scene and some of its draws, as the rules look at them.

use crate::campaign::Plan;
use crate::control::LoopSpec;
use crate::ensemble::drawn::DrawnScenes;
use crate::scene::parameter::Shape;
use crate::scene::{Parameter, Scene, SceneError};
use crate::statistics::quantile::quantile;

/// Most draws that are looked at.
const DRAWS: u64 = 1000;
/// The fraction of the draws that may be beyond a limit.
const FEW: f64 = 0.01;

/// A size that a rule compares with its limit, and how its note begins.
pub struct Found {
    pub size: f64,
    pub what: String,
}

pub struct Looked<'p> {
    pub plan: &'p Plan,
    pub scene: Result<Scene, Vec<SceneError>>,
    /// The first draws, or those from all over a design.
    pub drawn: DrawnScenes,
}

impl<'p> Looked<'p> {
    pub fn new(plan: &'p Plan) -> Self {
        Looked { plan, scene: Scene::resolve(&plan.nominal), drawn: DrawnScenes::spread(plan, DRAWS) }
    }

    /// The control loop of the plan.
    pub fn spec(&self) -> Option<&'p LoopSpec> {
        self.plan.loop_spec()
    }

    /// The parameters that the nominal scene has.
    pub fn parameters(&self) -> impl Iterator<Item = Parameter> {
        let scene = &self.plan.nominal;
        Parameter::all(scene).filter(|parameter| parameter.exists(scene))
    }

    /// The length of the nominal value of `parameter`.
    pub fn nominal(&self, parameter: Parameter) -> f64 {
        let values = (0..parameter.width()).filter_map(|component| parameter.value(&self.plan.nominal, component));
        values.fold(0.0, libm::hypot)
    }

    /// How far one draw in a hundred is from the nominal value of `parameter`; `None` where it is not dispersed, or
    /// is an attitude.
    pub fn spread(&self, parameter: Parameter) -> Option<f64> {
        let columns = self.plan.dispersions.columns().iter().zip(&self.drawn.columns);
        let own: Vec<_> = columns.filter(|(column, _)| column.parameter == parameter).collect();
        if own.is_empty() || parameter.shape() == Shape::Quaternion {
            return None;
        }
        let off = |draw: usize| {
            own.iter().fold(0.0, |size, (column, values)| libm::hypot(size, values[draw] - column.nominal))
        };
        most_of((0..self.drawn.count()).map(off).collect())
    }
}

/// The size that one in a hundred of `sizes` is beyond.
pub fn most_of(mut sizes: Vec<f64>) -> Option<f64> {
    sizes.sort_by(f64::total_cmp);
    quantile(&sizes, 1.0 - FEW)
}

/// A number with four significant digits.
pub fn digits(value: f64) -> String {
    let rounded: f64 = format!("{value:.3e}").parse().unwrap_or(value);
    if (1e-3..1e7).contains(&rounded.abs()) || rounded == 0.0 { format!("{rounded}") } else { format!("{rounded:e}") }
}
