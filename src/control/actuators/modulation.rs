//! How thrusters of a loop are driven: the list of `control.modulation`.

use super::thruster_drive::ThrustMode;
use crate::scene::schema::Limit;
use crate::scene::{DeclaredTable, LawParameter};

/// The names, in the order of their places.
pub const NAMES: [&str; 3] = ["throttled", "pulse_width", "hysteresis"];

/// Of hysteresis.
static LEVELS: [LawParameter; 2] = [
    LawParameter::number(
        "level_on",
        "1",
        "Share of the shortest firing at which a thruster turns on",
        Limit::NotNegative,
    )
    .or(&[0.75]),
    LawParameter::number("level_off", "1", "Share of the shortest firing at which it turns off", Limit::NotNegative)
        .or(&[0.25]),
];

/// What the modulation of place `place` declares.
pub fn parameters(place: usize) -> &'static [LawParameter] {
    if NAMES[place] == "hysteresis" { &LEVELS } else { &[] }
}

/// The modulation of place `place` with the numbers of `table`.
pub fn mode(place: usize, table: &DeclaredTable) -> ThrustMode {
    let level = |key: &str| table.named(key).map_or(0.0, |numbers| numbers[0]);
    match NAMES[place] {
        "throttled" => ThrustMode::Throttled,
        "pulse_width" => ThrustMode::Remainder,
        _ => ThrustMode::Hysteresis { on: level("level_on"), off: level("level_off") },
    }
}

/// Whether thrusters are on or off, so that each needs a largest thrust.
pub fn is_on_off(place: usize) -> bool {
    NAMES[place] != "throttled"
}
