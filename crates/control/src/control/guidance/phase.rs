//! [`Phase`]: a phase of guidance with the numbers of a run.

use crate::control::laws::momentum_unloading::UnloadingNumbers;
use crate::loops::condition::Condition;
use crate::loops::phase::{Maneuver, Next};
use crate::loops::rod_law::RodLaw;
use crate::loops::target::Target;

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
