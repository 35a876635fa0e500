//! [`Failure`]: the reason why a mission has failed.

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub enum Failure {
    None,
    /// A phase took longer than its `timeout_s`.
    Timeout,
    /// A wheel was at its limit of speed for longer than `control.saturation_timeout_s`.
    WheelSaturated,
    /// The debris was not measured for longer than `control.lost_target_timeout_s`.
    LostTarget,
    /// The spacecraft came closer to the debris than `control.keep_out_m`.
    KeepOut,
    /// The debris is too slow to define an axis, and the file gives no other.
    NoAxis,
    /// An estimate or a command is not finite.
    Diverged,
    /// The phase's module has trapped ([`super::flight_code`]).
    ModuleTrap,
    /// The phase's module has used up the fuel of a step.
    ModuleFuel,
}

impl Failure {
    /// Names in the order of the codes.
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

    pub fn code(self) -> f64 {
        f64::from(self as u8)
    }
}
