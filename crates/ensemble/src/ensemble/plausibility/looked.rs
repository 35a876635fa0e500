//! [`Looked`]: a plan with its nominal scene and some draws, for the rules.

use crate::campaign::Plan;
use crate::ensemble::drawn::DrawnScenes;
use crate::loops::LoopSpec;
use crate::scene::parameter::Shape;
use crate::scene::{Parameter, Scene, SceneError};
use crate::statistics::quantile::quantile;

const DRAWS: u64 = 1000;
/// Fraction of draws beyond a limit.
const FEW: f64 = 0.01;

pub struct Looked<'p> {
    pub plan: &'p Plan,
    pub scene: Result<Scene, Vec<SceneError>>,
    /// The first draws, or some of a fixed design.
    pub drawn: DrawnScenes,
}

impl<'p> Looked<'p> {
    pub fn new(plan: &'p Plan) -> Self {
        Looked { plan, scene: Scene::resolve(&plan.nominal), drawn: DrawnScenes::spread(plan, DRAWS) }
    }

    pub fn spec(&self) -> Option<&'p LoopSpec> {
        self.plan.loop_spec()
    }

    pub fn parameters(&self) -> impl Iterator<Item = Parameter> {
        let scene = &self.plan.nominal;
        Parameter::all(scene).filter(|parameter| parameter.exists(scene))
    }

    pub fn nominal(&self, parameter: Parameter) -> f64 {
        let values = (0..parameter.width()).filter_map(|component| parameter.value(&self.plan.nominal, component));
        values.fold(0.0, libm::hypot)
    }

    /// The distance of one draw in a hundred from nominal; `None` for an attitude or without dispersion.
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

/// The size that one in a hundred of `sizes` exceeds.
pub fn most_of(mut sizes: Vec<f64>) -> Option<f64> {
    sizes.sort_by(f64::total_cmp);
    quantile(&sizes, 1.0 - FEW)
}

/// A number with four significant digits.
pub fn digits(value: f64) -> String {
    let rounded: f64 = format!("{value:.3e}").parse().unwrap_or(value);
    if (1e-3..1e7).contains(&rounded.abs()) || rounded == 0.0 { format!("{rounded}") } else { format!("{rounded:e}") }
}
