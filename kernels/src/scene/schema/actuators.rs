//! `[actuators]`: when the actuators follow the commands of the schedule.

use super::components::SCALAR;
use super::limit::Limit;
use super::numbers::Numbers;
use super::rows::rows;

rows! {
    /// How late the actuators are, for all arcs of the schedule. How strong they are is said with each thruster and
    /// wheel.
    pub struct ActuatorsInput in ActuatorsInput [table => table] {
    switch_on_delay_s: f64 = 0.0, "s",
        "Delay of the start of every arc; an arc that would start before the run starts with the run", SCALAR, Plain,
        Limit::Finite, (optional);
    switch_off_delay_s: f64 = 0.0, "s",
        "Delay of the end of every arc; if one arc starts as another ends, there is a single switch, delayed by \
        switch_on_delay_s",
        SCALAR, Plain, Limit::Finite, (optional);
    } others {}
}
