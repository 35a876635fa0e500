//! [`SceneDraws`]: from a plan and the number of a sample to its scene; nothing else draws scenes.

use super::plan::Plan;
use crate::sampling::{SampleId, Sampler};
use crate::scene::{Scene, SceneError, SceneInput};

/// The scene of a sample.
///
/// # Errors
/// Why the drawn scene is not physical.
pub fn draw(plan: &Plan, sample: SampleId) -> Result<Scene, Vec<SceneError>> {
    SceneDraws::new(plan).scene(sample)
}

/// Draws the scenes of a plan; owned by one worker. A scene depends on the plan and the sample alone, not on earlier
/// draws.
#[derive(Debug)]
pub struct SceneDraws<'p> {
    sampler: Sampler<'p>,
    input: SceneInput,
    applied: Vec<f64>,
}

impl<'p> SceneDraws<'p> {
    /// Draws of `plan`. Allocates; [`SceneDraws::scene_at`] does not, once each scene is there.
    pub fn new(plan: &'p Plan) -> Self {
        SceneDraws {
            sampler: plan.dispersions.sampler(),
            input: plan.nominal.clone(),
            applied: vec![0.0; plan.dispersions.columns().len()],
        }
    }

    /// The scene of `sample` as written, physical or not.
    pub fn input(&mut self, sample: SampleId) -> &SceneInput {
        self.sampler.draw(sample, &mut self.input, &mut self.applied);
        &self.input
    }

    /// The scene that the last draw made, as written.
    pub fn drawn(&self) -> &SceneInput {
        &self.input
    }

    /// The scene of `sample`.
    ///
    /// # Errors
    /// Why it is not physical.
    pub fn scene(&mut self, sample: SampleId) -> Result<Scene, Vec<SceneError>> {
        self.sampler.draw(sample, &mut self.input, &mut self.applied);
        Scene::resolve(&self.input)
    }

    /// The same into `scenes[index]`, which is reused if it is there and else added; where it is not physical, an
    /// existing scene stays as it was.
    ///
    /// # Errors
    /// Why the drawn scene is not physical.
    pub fn scene_at(&mut self, sample: SampleId, scenes: &mut Vec<Scene>, index: usize) -> Result<(), Vec<SceneError>> {
        self.sampler.draw(sample, &mut self.input, &mut self.applied);
        match scenes.get_mut(index) {
            Some(scene) => scene.resolve_into(&self.input),
            None => Scene::resolve(&self.input).map(|scene| scenes.push(scene)),
        }
    }

    /// The values that the last draw applied, as [`crate::sampling::Dispersions::columns`] lists them.
    pub fn applied(&self) -> &[f64] {
        &self.applied
    }
}
