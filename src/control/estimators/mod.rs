//! From measurements to an estimate of the state. One file for each kind, one line for each in [`KINDS`].
//!
//! - [`estimator`]: what all of them are. `perfect`: the true state. `raw`: the last measurements. `mekf`: filters.
//! - [`attitude_filter`], [`rigid_body_filter`], [`translation_filter`]: the filters, with [`kalman`], and [`delayed`]
//!   for measurements that come late.
//!
//! An estimator knows the nominal scene, its own parameters, and the nominal parameters of the sensors; the truth
//! reaches it in measurements alone.

pub mod attitude_filter;
pub mod attitude_innovation;
pub mod delayed;
pub mod estimator;
pub mod kalman;
mod mekf;
mod perfect;
mod raw;
pub mod rigid_body_filter;
pub mod translation_filter;

pub use estimator::{Estimator, EstimatorContext, EstimatorKind, KnownSensor, Update};

/// All kinds.
pub static KINDS: [EstimatorKind; 3] = [perfect::KIND, raw::KIND, mekf::KIND];
/// Their names.
pub const NAMES: [&str; 3] = [perfect::KIND.name, raw::KIND.name, mekf::KIND.name];

/// The kind called `name`.
pub fn kind(name: &str) -> Option<&'static EstimatorKind> {
    KINDS.iter().find(|kind| kind.name == name)
}

#[cfg(test)]
mod camera_tests;
#[cfg(test)]
mod tests;
