//! `[environment]`: torques of the environment on the spacecraft.

use super::components::XYZ;
use super::limit::Limit;
use super::numbers::Numbers;
use super::rows::rows;

rows! {
    /// Torques of the environment on the spacecraft. A torque that is not written does not act.
    pub struct EnvironmentInput in EnvironmentInput [table => table] {
    body_torque_n_m: Option<[f64; 3]> = None, "N m", "Constant torque on the spacecraft, in F_s", XYZ, Plain, Limit::Finite,
        (optional);
    } others {}
}

impl EnvironmentInput {
    /// Whether any torque of the environment acts: whether any key is written.
    pub fn acts(&self) -> bool {
        *self != EnvironmentInput::DEFAULT
    }
}
