//! [`MissionCriteria`]: the numbers that judge the outcome of a run.

use crate::control::net_launch::geometry::LaunchState;
use crate::control::net_launch::launch::PlumeCone;

#[derive(Clone, Copy, Debug)]
pub struct MissionCriteria {
    pub launch: LaunchState,
    /// Distance from the debris below which the mission fails, m.
    pub keep_out: f64,
    pub plume: PlumeCone,
    pub settling_band: f64,
    /// Start and length of the window of the relative performance error, s; zero for settling time and end of the run.
    pub stability: [f64; 2],
    pub period: f64,
    /// Specific impulse, s; zero if unknown.
    pub isp: f64,
}
