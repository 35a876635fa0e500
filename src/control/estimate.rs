//! [`Estimate`]: what flight software believes of the state at a tick.

use super::truth::DebrisState;
use crate::scene::MAX_WHEELS;

/// The estimated state at a tick.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Estimate {
    /// Attitude quaternion, F_s -> F_e, scalar first.
    pub q_es: [f64; 4],
    /// Angular velocity of F_s relative to F_e, in F_s, rad/s.
    pub omega_se_s: [f64; 3],
    /// Bias of the gyro, in F_s, rad/s.
    pub gyro_bias_s: [f64; 3],
    /// Position of the spacecraft's centre of mass c in F_e, m.
    pub r_co_e: [f64; 3],
    /// Velocity of c relative to F_e, in F_e, m/s.
    pub v_co_e: [f64; 3],
    /// Rates of the wheels relative to the body, rad/s.
    pub wheel_rates: [f64; MAX_WHEELS],
    /// The debris, where the nominal scene has one.
    pub debris: Option<DebrisState>,
}
