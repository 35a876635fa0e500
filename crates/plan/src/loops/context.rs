//! [`LawContext`]: settings of the law of a run.

use super::loop_record::SharedRecord;
use crate::sampling::{Noise, SampleId};
use crate::scene::{ControlInput, Scene};

/// A law may use what flight software knows: the nominal scene, its own parameters and its sensors' measurements. The
/// drawn scene is the truth, for models of sensors and actuators only.
#[derive(Clone, Copy, Debug)]
pub struct LawContext<'a> {
    /// The scene without dispersions.
    pub nominal: &'a Scene,
    /// The scene that is flown.
    pub drawn: &'a Scene,
    /// The law's parameters as drawn for this run.
    pub parameters: &'a ControlInput,
    /// The parameters without dispersions.
    pub nominal_parameters: &'a ControlInput,
    /// The sample; 0 is the nominal run.
    pub sample: SampleId,
    /// Seed of the campaign.
    pub seed: u64,
    /// Duration of the campaign, s.
    pub duration: f64,
    /// Latest end of this run, s; an event may end it earlier. The law must not depend on it: ends at events are
    /// located in a run that goes on.
    pub end: f64,
    /// Record of a control loop's quantities over time, if they are read.
    pub record: Option<&'a SharedRecord>,
    /// True if the law records telemetry ([`crate::dynamics::actuation::ActuationLaw::telemetry`]).
    pub records: bool,
    /// Number of arcs, of equal lengths, into which each arc of the law is divided; 1 except in twins of runs.
    pub parts: u32,
}

impl LawContext<'_> {
    /// The number of the parameter `key`.
    ///
    /// # Panics
    /// Unless the law declares it as a number.
    pub fn number(&self, key: &str) -> f64 {
        match self.parameters.named(key) {
            Some([number]) => *number,
            _ => panic!("the law declares no number {key}"),
        }
    }

    /// The vector of the parameter `key`.
    ///
    /// # Panics
    /// Unless the law declares it as three numbers.
    pub fn vector(&self, key: &str) -> [f64; 3] {
        match self.parameters.named(key) {
            Some(&[x, y, z]) => [x, y, z],
            _ => panic!("the law declares no vector {key}"),
        }
    }

    /// Random numbers of this run for the purpose `name` (`gyro.noise.x`), addressed by tick: a function of seed,
    /// sample, name and tick alone.
    pub fn noise(&self, name: &str) -> Noise {
        Noise::new(self.seed, name, self.sample)
    }
}
