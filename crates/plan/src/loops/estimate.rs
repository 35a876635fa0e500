//! [`Estimate`]: flight software's belief of the state at a tick.

use super::measurement::PointMotion;
use crate::scene::{InitialState, MAX_WHEELS};

/// The motion of the debris.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DebrisState {
    /// Position of its centre of mass in F_e, m.
    pub r_gdo_e: [f64; 3],
    /// Velocity of its centre of mass relative to F_e, in F_e, m/s.
    pub v_gdo_e: [f64; 3],
    /// Attitude quaternion, F_d -> F_e, scalar first.
    pub q_ed: [f64; 4],
    /// Angular velocity of F_d relative to F_e, in F_d, rad/s.
    pub omega_de_d: [f64; 3],
}

impl DebrisState {
    /// The state at the start of a run.
    pub fn start(initial: &InitialState) -> Self {
        let InitialState { r_gdo_e, v_gdo_e, q_ed, omega_de_d, .. } = *initial;
        DebrisState { r_gdo_e, v_gdo_e, q_ed, omega_de_d }
    }
}

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
    /// The debris, if the nominal scene has any.
    pub debris: Option<DebrisState>,
}

impl Estimate {
    /// Motion of the centres of mass of spacecraft and debris; `None` without debris.
    pub fn centers(&self) -> Option<[PointMotion; 2]> {
        let own = PointMotion { r_e: self.r_co_e, v_e: self.v_co_e };
        self.debris.map(|debris| [own, PointMotion { r_e: debris.r_gdo_e, v_e: debris.v_gdo_e }])
    }

    pub fn is_finite(&self) -> bool {
        // 0 times a non-finite number is NaN, and the sum cannot overflow
        let zero = |numbers: &[f64]| numbers.iter().fold(0.0, |sum, number| sum + 0.0 * number);
        let own = zero(&self.q_es) + zero(&self.omega_se_s) + zero(&self.gyro_bias_s) + zero(&self.wheel_rates);
        let of_debris = self.debris.as_ref().map_or(0.0, |debris| {
            zero(&debris.r_gdo_e) + zero(&debris.v_gdo_e) + zero(&debris.q_ed) + zero(&debris.omega_de_d)
        });
        own + zero(&self.r_co_e) + zero(&self.v_co_e) + of_debris == 0.0
    }
}
