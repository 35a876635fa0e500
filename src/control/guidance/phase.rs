//! [`Phase`]: one phase of guidance, with the numbers of a run.

use super::condition::Condition;
use super::target::Target;
use crate::control::laws::MomentumUnloading;
use crate::control::laws::rod_law::RodLaw;

/// The use of thrust along s3.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Maneuver {
    /// None.
    None,
    /// The first impulse of a transfer to the station.
    Transfer,
    /// The second: the velocity relative to the debris is taken away.
    Stop,
}

/// The names of the maneuvers in campaign files.
pub const MANEUVERS: [(&str, Maneuver); 3] =
    [("none", Maneuver::None), ("transfer", Maneuver::Transfer), ("stop", Maneuver::Stop)];

/// The phase that follows another one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Next {
    /// None: the phase lasts until the run ends.
    Stay,
    /// Another phase, by its place in the list.
    Phase(usize),
    /// The launch of the net.
    Launch,
}

/// A phase.
#[derive(Clone, Debug)]
pub struct Phase {
    /// The condition that ends it.
    pub until: Option<Condition>,
    /// The phase that follows then.
    pub next: Next,
    /// The phase that follows at once if the condition is not met.
    pub otherwise: Option<usize>,
    /// Time for which the condition must be met, s.
    pub hold: f64,
    /// After which the mission fails, s; infinite without.
    pub timeout: f64,
    /// The attitude.
    pub target: Target,
    /// The use of thrust.
    pub thrust: Maneuver,
    /// Time of a transfer that begins in this phase, s.
    pub transfer_time: f64,
    /// Unloading of the wheels by thrusters, if any.
    pub unloading: Option<MomentumUnloading>,
    /// The law of torque rods.
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
