//! `[actuators]`: delays of the actuators.

use super::rows::rows;

rows! {
    /// Delays of the actuators in all arcs of the schedule.
    pub struct ActuatorsInput in ActuatorsInput [table => table] {
    switch_on_delay_s: f64 = 0.0, "s",
        "Delay of the start of every arc; an arc that would start before the run starts with the run", Finite;
    switch_off_delay_s: f64 = 0.0, "s",
        "Delay of the end of every arc; if one arc starts as another ends, there is a single switch, delayed by \
        switch_on_delay_s", Finite;
    } others {}
}
