//! `[[actuation]]`: the schedule, one arc of constant thrust and torque each; only errors of an arc are dispersed.

use super::rows::rows;
use super::sizes::{MAX_THRUSTERS, MAX_WHEELS};
use crate::scene::name::Name;

rows! {
    /// An arc of constant thrust and torque, as commanded.
    pub struct ActuationInput in ActuationInput [table => table] {
    start_s: f64 = 0.0, "s", "Start of the arc", Finite, required "0.0";
    end_s: f64 = 1.0, "s", "End of the arc", Finite, required "1.0";
    } others {
        /// Thrusts in the order of the thrusters, N; zero beyond. In a file a table by name, `thrust_n = { p1 = 100.0
        /// }`.
        thrust_n: [f64; MAX_THRUSTERS] = [0.0; MAX_THRUSTERS],
        /// Motor torques on the wheels about their axes, N m; the body feels the opposite. In a file a table by name,
        /// `torque_n_m = { w1 = 0.5 }`.
        torque_n_m: [f64; MAX_WHEELS] = [0.0; MAX_WHEELS],
        /// The name; by default the arc's number, from 0.
        name: Name = Name::NONE,
        /// Errors of the arc.
        errors: ArcErrors = ArcErrors::DEFAULT,
    }
}

rows! {
    /// Errors of an arc relative to its command: factors multiply, and delays add to, those of thrusters, wheels and
    /// `[actuators]`.
    pub struct ArcErrors in ActuationInput [table => table.errors] {
    thrust_scale: f64 = 1.0, "1",
        "Scale factor for the commanded thrusts of this arc", Thrust("write zero for an arc that does not ignite");
    torque_scale: f64 = 1.0, "1", "Scale factor for the commanded motor torques of this arc", Finite;
    switch_on_delay_s: f64 = 0.0, "s", "Delay of the start of this arc, added to that of the actuators", Finite;
    switch_off_delay_s: f64 = 0.0, "s",
        "Delay of the end of this arc, added to that of the actuators; no effect if the next arc starts as this one \
        ends", Finite;
    } others {}
}

impl ActuationInput {
    /// Nothing acts from `start_s` to `end_s`.
    pub const fn idle(start_s: f64, end_s: f64) -> Self {
        ActuationInput { start_s, end_s, ..ActuationInput::DEFAULT }
    }

    /// This arc with `thrust_n` for the first thrusters.
    ///
    /// # Panics
    /// If there are more than a spacecraft may have.
    #[must_use]
    pub fn with_thrust(mut self, thrust_n: &[f64]) -> Self {
        self.thrust_n[..thrust_n.len()].copy_from_slice(thrust_n);
        self
    }

    /// This arc with `torque_n_m` for the first wheels, as [`ActuationInput::with_thrust`].
    #[must_use]
    pub fn with_torque(mut self, torque_n_m: &[f64]) -> Self {
        self.torque_n_m[..torque_n_m.len()].copy_from_slice(torque_n_m);
        self
    }
}
