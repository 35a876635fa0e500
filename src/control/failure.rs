//! [`Failure`]: why a mission has failed.

/// Why a mission has failed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub enum Failure {
    /// It has not.
    None,
    /// A phase took longer than its `timeout_s`.
    Timeout,
    /// A wheel was at its limit of speed for longer than `control.saturation_timeout_s`.
    WheelSaturated,
    /// The debris was not measured for longer than `control.lost_target_timeout_s`.
    LostTarget,
    /// The spacecraft came closer to the debris than `control.keep_out_m`.
    KeepOut,
    /// The debris is too slow for its velocity to have a direction, and the file names no other axis.
    NoAxis,
    /// An estimate or a command is no finite number.
    Diverged,
    /// The module that is the law of the phase has trapped: [`crate::control::flight_code`].
    ModuleTrap,
    /// It has used up the fuel of a step.
    ModuleFuel,
}

impl Failure {
    /// The names, in the order of their codes.
    pub const NAMES: [&'static str; 9] = [
        "none",
        "timeout",
        "wheel_saturated",
        "lost_target",
        "keep_out",
        "no_axis",
        "diverged",
        "module_trap",
        "module_fuel",
    ];

    /// Its code in a row.
    pub fn code(self) -> f64 {
        f64::from(self as u8)
    }
}
