//! `[[actuation]]`: the schedule, one arc of constant thrust and torque each; commands, which are not dispersed.

use super::components::{AXES, SCALAR, WHEELS};
use super::limit::Limit;
use super::numbers::Numbers;
use super::row::always;
use super::rows::rows;

rows! {
    /// An arc of constant thrust and torque, as commanded.
    pub struct ActuationInput in ActuationInput [table => table] {
    start_s: f64 = 0.0, "s", "Start", SCALAR, Plain, Limit::Finite, (required "0.0"), always, "";
    end_s: f64 = 1.0, "s", "End", SCALAR, Plain, Limit::Finite, (required "1.0"), always, "";
    thrust_n: [f64; 3] = [0.0; 3], "N", "Thrusts P1, P2, P3, never negative", AXES, Plain,
        Limit::Thrust("use the opposite thruster"), (optional), always, "";
    torque_n_m: [f64; 2] = [0.0; 2], "N m",
        "Motor torques tau^W1, tau^W2 on the wheels about their axes; the fuselage feels the opposite", WHEELS, Plain,
        Limit::Finite, (optional), always, "";
    } others {}
}
