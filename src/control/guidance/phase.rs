//! [`Phase`]: one phase of guidance, as the file says it, with the numbers of a run.

use super::condition::Condition;
use super::target::Target;
use crate::control::laws::MomentumUnloading;
use crate::control::laws::rod_law::RodLaw;

/// What thrust along s3 is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Maneuver {
    /// Nothing.
    None,
    /// The first impulse of a transfer to the station.
    Transfer,
    /// The second: the velocity relative to the debris is taken away.
    Stop,
}

/// The names of the maneuvers in campaign files.
pub const MANEUVERS: [(&str, Maneuver); 3] =
    [("none", Maneuver::None), ("transfer", Maneuver::Transfer), ("stop", Maneuver::Stop)];

/// What follows a phase.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Next {
    /// Nothing: it lasts until the run ends.
    Stay,
    /// Another phase, by its place in the list.
    Phase(usize),
    /// The launch of the net.
    Launch,
}

/// One phase.
#[derive(Clone, Debug)]
pub struct Phase {
    /// The condition that ends it.
    pub until: Option<Condition>,
    /// What follows then.
    pub next: Next,
    /// What follows at once where the condition is not met.
    pub otherwise: Option<usize>,
    /// How long the condition must be met, s.
    pub hold: f64,
    /// After which the mission fails, s; infinite without.
    pub timeout: f64,
    /// The attitude.
    pub target: Target,
    /// What thrust is for.
    pub thrust: Maneuver,
    /// Time of a transfer that begins in this phase, s.
    pub transfer_time: f64,
    /// How thrusters unload the wheels; `None` where they do not.
    pub unloading: Option<MomentumUnloading>,
    /// What torque rods do.
    pub rods: RodLaw,
}

impl Phase {
    /// The maneuver whose impulse is the velocity to go: that of the thrust, else that for which s3 is pointed.
    pub fn maneuver(&self) -> Maneuver {
        match (self.thrust, self.target) {
            (Maneuver::None, Target::Transfer) => Maneuver::Transfer,
            (Maneuver::None, Target::Stop) => Maneuver::Stop,
            (thrust, _) => thrust,
        }
    }
}
