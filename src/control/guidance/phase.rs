//! [`Phase`]: a phase of guidance with the numbers of a run.

use super::condition::Condition;
use super::target::Target;
use crate::control::laws::momentum_unloading::UnloadingNumbers;
use crate::control::laws::rod_law::RodLaw;

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

/// Successor of a phase.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Next {
    /// The phase lasts until the run ends.
    Stay,
    /// Index of another phase.
    Phase(usize),
    /// Launch of the net.
    Launch,
}

/// A phase of guidance.
#[derive(Clone, Debug)]
pub struct Phase {
    pub until: Option<Condition>,
    pub next: Next,
    /// Phase that begins at once if the condition is not met.
    pub otherwise: Option<usize>,
    /// Time for which the condition must hold.
    pub hold: f64,
    /// Time after which the mission fails; may be infinite.
    pub timeout: f64,
    pub target: Target,
    pub thrust: Maneuver,
    /// Time of a transfer that begins in this phase.
    pub transfer_time: f64,
    pub unloading: Option<UnloadingNumbers>,
    pub rods: RodLaw,
}

impl Phase {
    /// The maneuver of the velocity to go: that of the thrust, else the one for which s3 is pointed.
    pub fn maneuver(&self) -> Maneuver {
        match (self.thrust, self.target) {
            (Maneuver::None, Target::Transfer) => Maneuver::Transfer,
            (Maneuver::None, Target::Stop) => Maneuver::Stop,
            (thrust, _) => thrust,
        }
    }
}
