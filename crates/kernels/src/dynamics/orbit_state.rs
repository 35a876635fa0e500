//! [`OrbitState`]: position and velocity relative to the central body.

use crate::math::prelude::*;

/// Position and velocity relative to the central body, one run per lane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OrbitState<R> {
    /// Position from the central body, F_e, m.
    pub position: [R; 3],
    /// Velocity, F_e, m/s.
    pub velocity: [R; 3],
    /// |position|, m.
    pub distance: R,
}

impl<R: Real> OrbitState<R> {
    /// The state at an offset of position (m) and velocity (m/s), F_e.
    #[inline(always)]
    pub fn displaced(&self, [position, velocity]: [[R; 3]; 2]) -> Self {
        let position = sum(self.position, position);
        OrbitState { position, velocity: sum(self.velocity, velocity), distance: norm(position) }
    }

    /// Copies `own` into lane `lane`.
    #[inline(always)]
    pub fn set_lane(&mut self, lane: usize, own: &OrbitState<f64>) {
        set_lanes(&mut self.position, lane, &own.position);
        set_lanes(&mut self.velocity, lane, &own.velocity);
        self.distance.set_lane(lane, own.distance);
    }

    /// A state of zero velocity at `position`, F_e, m.
    #[inline(always)]
    pub fn at_rest(position: [R; 3]) -> Self {
        OrbitState { position, velocity: [position[0].zero(); 3], distance: norm(position) }
    }

    /// NaN in the lanes of `like`: a missing orbit, of which nothing may be used.
    pub fn unknown(like: R) -> Self {
        let nan = like.splat(f64::NAN);
        OrbitState { position: [nan; 3], velocity: [nan; 3], distance: nan }
    }
}
