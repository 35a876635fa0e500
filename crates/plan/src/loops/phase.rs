//! [`Maneuver`] and [`Next`]: the thrust and the successor of a phase.

/// Use of thrust along s3.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Maneuver {
    None,
    /// First impulse of a transfer to the station.
    Transfer,
    /// Second impulse, which cancels the velocity relative to the debris.
    Stop,
}

/// Names of the maneuvers in campaign files.
pub const MANEUVERS: [(&str, Maneuver); 3] =
    [("none", Maneuver::None), ("transfer", Maneuver::Transfer), ("stop", Maneuver::Stop)];

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Next {
    /// The phase lasts until the run ends.
    Stay,
    /// Index of another phase.
    Phase(usize),
    /// Launch of the net.
    Launch,
}
