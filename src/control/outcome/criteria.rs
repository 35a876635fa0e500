//! [`MissionCriteria`]: the numbers by which the outcome of a run is judged.

use crate::control::net_launch::geometry::LaunchState;
use crate::control::net_launch::launch::PlumeCone;

/// The numbers by which the outcome of a run is judged.
#[derive(Clone, Copy, Debug)]
pub struct MissionCriteria {
    /// The launch state.
    pub launch: LaunchState,
    /// Distance from the debris below which the mission fails, m.
    pub keep_out: f64,
    /// The cone in which plumes hit the debris.
    pub plume: PlumeCone,
    /// Pointing error of an attitude that has settled, rad.
    pub settling_band: f64,
    /// Start and length of the window of the relative performance error, s; zero: from settling on, and to the end.
    pub stability: [f64; 2],
    /// Control period, s.
    pub period: f64,
    /// Specific impulse, s; zero where it is not known.
    pub isp: f64,
}
