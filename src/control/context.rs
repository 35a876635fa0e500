//! [`LawContext`]: the settings of the law of a run.

use super::loop_record::SharedRecord;
use crate::sampling::{Noise, SampleId};
use crate::scene::{ControlInput, Scene};

/// The settings of the law of one run.
///
/// A law is to know what flight software knows: the nominal scene, its own parameters, and what its sensors measure.
/// The drawn scene is the truth, for models of sensors and actuators only.
#[derive(Clone, Copy, Debug)]
pub struct LawContext<'a> {
    /// The scene without dispersions.
    pub nominal: &'a Scene,
    /// The scene that is flown.
    pub drawn: &'a Scene,
    /// The parameters that the law declares, as drawn for this run.
    pub parameters: &'a ControlInput,
    /// The parameters without dispersions.
    pub nominal_parameters: &'a ControlInput,
    /// The sample; 0 is the nominal run.
    pub sample: SampleId,
    /// The seed of the campaign.
    pub seed: u64,
    /// The duration of the campaign, s.
    pub duration: f64,
    /// When this run ends, s: after that, or at an event that ends it. The law must not decide by it: where an event
    /// ends a run is found in one that goes on.
    pub end: f64,
    /// The record of quantities over time of a control loop; `None` if they are not read.
    pub record: Option<&'a SharedRecord>,
    /// True if the law is to record telemetry ([`crate::dynamics::actuation::ActuationLaw::telemetry`]).
    pub records: bool,
}

impl LawContext<'_> {
    /// The number of the parameter called `key`.
    ///
    /// # Panics
    /// If the law does not declare it as a number.
    pub fn number(&self, key: &str) -> f64 {
        match self.parameters.named(key) {
            Some([number]) => *number,
            _ => panic!("the law declares no number {key}"),
        }
    }

    /// The three numbers of the parameter called `key`.
    ///
    /// # Panics
    /// If the law does not declare it as three numbers.
    pub fn vector(&self, key: &str) -> [f64; 3] {
        match self.parameters.named(key) {
            Some(&[x, y, z]) => [x, y, z],
            _ => panic!("the law declares no vector {key}"),
        }
    }

    /// Random numbers of this run for the purpose `name` (`gyro.noise.x`), tick by tick: the same for the same seed,
    /// sample, name and tick, whatever else is drawn.
    pub fn noise(&self, name: &str) -> Noise {
        Noise::new(self.seed, name, self.sample)
    }
}
