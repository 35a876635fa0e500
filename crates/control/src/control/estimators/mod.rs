//! Estimators: from measurements to the state. Each kind has one file and one entry in [`KINDS`].
//!
//! An estimator knows the nominal scene, its own parameters and the sensors' nominal ones; the truth reaches it only
//! through measurements.

pub mod attitude_filter;
pub mod delayed;
pub mod estimator;
pub mod kalman;
mod mekf;
mod perfect;
mod raw;
pub mod rigid_body_filter;
pub mod translation_filter;

pub use estimator::{Estimator, EstimatorContext, EstimatorMaker, KnownSensor, Update};

pub static KINDS: [EstimatorMaker; 3] = [perfect::KIND, raw::KIND, mekf::KIND];
pub const NAMES: [&str; 3] = [perfect::KIND.kind.name, raw::KIND.kind.name, mekf::KIND.kind.name];

pub fn maker(name: &str) -> Option<&'static EstimatorMaker> {
    KINDS.iter().find(|maker| maker.kind.name == name)
}

#[cfg(test)]
mod tests;
