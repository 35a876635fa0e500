//! `[environment]`: effects of the environment on the spacecraft.

use super::components::XYZ;
use super::limit::Limit;
use super::numbers::Numbers;
use super::rows::rows;

rows! {
    /// Effects of the environment on the spacecraft. An effect that is not written does not act.
    pub struct EnvironmentInput in EnvironmentInput [table => table] {
    body_torque_n_m: Option<[f64; 3]> = None, "N m", "Constant torque on the spacecraft, in F_s", XYZ, Plain, Limit::Finite,
        (optional);
    } others {
        /// Whether the torque of the gravity gradient acts; it needs an orbit.
        gravity_gradient: bool = false,
    }
}

impl EnvironmentInput {
    /// Whether any effect of the environment acts: whether any key is written.
    pub fn acts(&self) -> bool {
        *self != EnvironmentInput::DEFAULT
    }
}
