//! Control in the loop: reads the tables of a loop, and makes and flies what [`crate::loops`] describes.
//!
//! [`tables`] are read, [`loop_maker`] makes laws; in the [`control_loop`] of a run, [`plant`] and [`flight_software`]
//! exchange the data of [`bus`]. [`outcome`] and [`recorder`] are its results, [`review`] and [`mod@capacity`] checks
//! before it flies.

pub mod actuators;
pub mod allocation;
pub mod bus;
pub mod capacity;
pub mod control_loop;
pub mod estimators;
pub mod flight_code;
pub mod flight_software;
pub mod guidance;
pub mod laws;
pub mod loop_maker;
pub mod net_launch;
pub mod outcome;
pub mod parameters;
pub mod plant;
pub mod recorder;
pub mod review;
pub mod sensors;
pub mod stability;
pub mod tables;
pub mod tick_times;
pub mod truth;

pub use crate::loops::{ControlLaw, LawContext};
