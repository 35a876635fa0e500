//! The values of `control.modulation`: modes of thrusters.

use super::thruster_drive::ThrustMode;
use crate::loops::declared::{declared, number};
use crate::scene::{DeclaredTable, LawParameter};

pub const NAMES: [&str; 3] = ["throttled", "pulse_width", "hysteresis"];

declared! {
    Levels = LEVELS {
        on: f64 = number("level_on", "1", "Fraction of the shortest firing at which a thruster turns on", &[0.75]);
        off: f64 = number("level_off", "1", "Fraction of the shortest firing at which it turns off", &[0.25]);
    }
}

/// Keys of the modulation `place`.
pub fn parameters(place: usize) -> &'static [LawParameter] {
    if NAMES[place] == "hysteresis" { &LEVELS } else { &[] }
}

/// The modulation `place` with the numbers of `table`.
pub fn mode(place: usize, table: &DeclaredTable) -> ThrustMode {
    match NAMES[place] {
        "throttled" => ThrustMode::Throttled,
        "pulse_width" => ThrustMode::Remainder,
        _ => {
            let Levels { on, off } = Levels::of(table);
            ThrustMode::Hysteresis { on, off }
        }
    }
}

/// True if thrusters are on or off and hence need a largest thrust.
pub fn is_on_off(place: usize) -> bool {
    NAMES[place] != "throttled"
}
