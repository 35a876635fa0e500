//! `[actuators]`: what the actuators make of what the schedule commands.

use super::components::{AXES, SCALAR, WHEELS, XY};
use super::limit::Limit;
use super::numbers::Numbers;
use super::rows::rows;
use super::usage::Usage;

const REMEDY: &str = "add [[actuation]] tables";
const THRUSTER: &str = "command that thruster in an [[actuation]] table, or disperse only what is commanded";
const MOTOR: &str = "command that motor in an [[actuation]] table, or disperse only what is commanded";

rows! {
    /// What the actuators make of what the schedule commands; as a whole, for all of its arcs.
    pub struct ActuatorsInput in ActuatorsInput [table => table] {
    thrust_scale: [f64; 3] = [1.0; 3], "1", "Factors of the thrusts P1, P2, P3, never negative", AXES, Plain,
        Limit::Thrust("write zero for a thruster that does not work"), (optional), thruster_acts, THRUSTER;
    thruster1_tilt_rad: [f64; 2] = [0.0; 2], "rad",
        "Misalignment of P1: components along s1 and s2 of the rotation vector that turns the nominal direction of its thrust into the true one",
        XY, Plain, Limit::Finite, (optional), thruster1_acts, THRUSTER;
    thruster2_tilt_rad: [f64; 2] = [0.0; 2], "rad", "Misalignment of P2, like that of P1", XY, Plain, Limit::Finite,
        (optional), thruster2_acts, THRUSTER;
    thruster3_tilt_rad: [f64; 2] = [0.0; 2], "rad", "Misalignment of P3, like that of P1", XY, Plain, Limit::Finite,
        (optional), thruster3_acts, THRUSTER;
    switch_on_delay_s: f64 = 0.0, "s",
        "How much later than commanded arcs start; one that would start before the run starts with it", SCALAR, Plain,
        Limit::Finite, (optional), schedule_acts, REMEDY;
    switch_off_delay_s: f64 = 0.0, "s",
        "How much later than commanded arcs end; where one arc starts as another ends there is one switch, which is late by switch_on_delay_s",
        SCALAR, Plain, Limit::Finite, (optional), schedule_acts, REMEDY;
    torque_scale: [f64; 2] = [1.0; 2], "1", "Factors of the motor torques", WHEELS, Plain, Limit::Finite, (optional),
        motor_acts, MOTOR;
    torque_bias_n_m: [f64; 2] = [0.0; 2], "N m",
        "What a motor gives beyond the scaled torque while a torque other than zero is commanded", WHEELS, Plain,
        Limit::Finite, (optional), motor_acts, MOTOR;
    } others {}
}

impl ActuatorsInput {
    /// Ideal actuators: thrust and torque as commanded.
    pub const IDEAL: ActuatorsInput = ActuatorsInput::DEFAULT;

    /// The misalignments of P1, P2, P3, rad.
    pub fn tilts_rad(&self) -> [[f64; 2]; 3] {
        [self.thruster1_tilt_rad, self.thruster2_tilt_rad, self.thruster3_tilt_rad]
    }
}

fn schedule_acts(usage: &Usage, _: &ActuatorsInput, _: usize, _: usize) -> bool {
    usage.is_scheduled
}

/// Whether the schedule ever fires a thruster.
fn thruster_acts(usage: &Usage, _: &ActuatorsInput, _: usize, thruster: usize) -> bool {
    usage.fires[thruster]
}

fn thruster1_acts(usage: &Usage, _: &ActuatorsInput, _: usize, _: usize) -> bool {
    usage.fires[0]
}

fn thruster2_acts(usage: &Usage, _: &ActuatorsInput, _: usize, _: usize) -> bool {
    usage.fires[1]
}

fn thruster3_acts(usage: &Usage, _: &ActuatorsInput, _: usize, _: usize) -> bool {
    usage.fires[2]
}

/// Whether the schedule ever commands a motor.
fn motor_acts(usage: &Usage, _: &ActuatorsInput, _: usize, wheel: usize) -> bool {
    usage.drives[wheel]
}
