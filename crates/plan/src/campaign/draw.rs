//! [`SceneDraws`]: the scenes of samples.

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

/// Draws the scenes of a plan for one worker; a scene depends on plan and sample alone.
#[derive(Debug)]
pub struct SceneDraws<'p> {
    sampler: Sampler<'p>,
    input: SceneInput,
    applied: Vec<f64>,
}

impl<'p> SceneDraws<'p> {
    /// Allocates; [`SceneDraws::scene_at`] does not once its scenes exist.
    pub fn new(plan: &'p Plan) -> Self {
        SceneDraws {
            sampler: plan.dispersions.sampler(),
            input: plan.nominal.clone(),
            applied: vec![0.0; plan.dispersions.columns().len()],
        }
    }

    /// The input of `sample`, physical or not.
    pub fn input(&mut self, sample: SampleId) -> &SceneInput {
        self.sampler.draw(sample, &mut self.input, &mut self.applied);
        &self.input
    }

    /// The input of the last draw.
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

    /// Draws into `scenes[index]`, or appends; an existing scene is unchanged after an error.
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

    /// The values of the last draw, in the order of [`crate::sampling::Dispersions::columns`].
    pub fn applied(&self) -> &[f64] {
        &self.applied
    }
}
