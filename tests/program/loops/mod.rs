//! Control loops recomputed from true states.

pub mod actuators;
pub mod authority;
pub mod cases;
pub mod closed_loops;
pub mod columns;
pub mod control_laws;
pub mod diverging;
pub mod filters;
pub mod flown_loop;
pub mod fusion;
pub mod ignorance;
pub mod laws;
pub mod maneuvers;
pub mod missions;
pub mod motors;
pub mod noise;
pub mod own_laws;
pub mod phases;
pub mod sensors;
pub mod series;
pub mod ticks;
pub mod torque_rods;
